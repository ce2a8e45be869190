//! Shapes as files spell them: numbers checked and made to fit.

use super::entries::Count;
use super::error::{FileError, FileReason};
use super::features::Features;
use super::form::{BufferForm, Origin, Size, TextureForm};
use super::spot::{Source, Spot};
use crate::resource::{Extent, TextureDesc};

/// The shape of a texture.
pub(super) fn texture(source: Source<'_>, features: &Features, form: &TextureForm) -> Result<TextureDesc, FileError> {
    let number = |spot: &Option<Spot<Count>>, what, most, all| match spot {
        None => Ok(1),
        Some(spot) => count(source, features, spot, what, most, all),
    };
    let mips = number(&form.mips, "levels", 32, true)?;
    let layers = number(&form.layers, "layers", u64::from(u16::MAX), false)?;
    let samples = number(&form.samples, "samples", 64, false)?;
    Ok(TextureDesc {
        extent: form.size.as_ref().map_or(Ok(Extent::FRAME), |s| extent(source, s))?,
        format: form.format,
        mips: mips as u8,
        samples: samples as u8,
        layers: layers as u16,
        dimension: form.dimension,
    })
}

/// The size of a buffer, in bytes.
pub(super) fn buffer(source: Source<'_>, features: &Features, form: &BufferForm) -> Result<u64, FileError> {
    if let Origin::History { .. } = form.kind {
        let reason = FileReason::Value {
            detail: "a buffer cannot be a history".into(),
            hint: "import two buffers and swap them".into(),
        };
        return Err(source.error(&form.name, reason));
    }
    count(source, features, &form.bytes, "bytes", u64::MAX, false)
}

/// A number from 1 to `most`; 0 stands for all where that is allowed.
fn count(
    source: Source<'_>,
    features: &Features,
    spot: &Spot<Count>,
    what: &str,
    most: u64,
    all: bool,
) -> Result<u64, FileError> {
    let wrong = |detail: String, hint: &str| Err(source.error(spot, FileReason::Value { detail, hint: hint.into() }));
    let value = match &spot.value {
        Count::All if all => return Ok(0),
        Count::All => return wrong(format!("{what} cannot be \"all\""), "write a number"),
        Count::Fixed(value) => *value,
        Count::Choice(choices) => match choice(source, features, choices)? {
            Some(value) => value,
            None => {
                return wrong(format!("no choice of {what} applies"), "add `\"else\": 1` as the last one");
            }
        },
    };
    if value == 0 || value > most {
        return wrong(
            format!("{value} {what}"),
            &format!("write a number from 1 to {most}{}", if all { ", or \"all\"" } else { "" }),
        );
    }
    Ok(value)
}

/// The value beside the first condition that holds. All of them are looked at, so that none hides a misspelt name.
fn choice(source: Source<'_>, features: &Features, choices: &[(Spot<String>, u64)]) -> Result<Option<u64>, FileError> {
    let mut chosen = None;
    for (condition, value) in choices {
        let holds = condition.value == "else" || features.holds(source, Some(condition))?;
        if holds && chosen.is_none() {
            chosen = Some(*value);
        }
    }
    Ok(chosen)
}

fn extent(source: Source<'_>, spot: &Spot<Size>) -> Result<Extent, FileError> {
    let wrong = |detail: &str| {
        let reason = FileReason::Value { detail: detail.into(), hint: "write 1 or more".into() };
        Err(source.error(spot, reason))
    };
    match spot.value {
        Size::Texels(0, _) | Size::Texels(_, 0) => wrong("a size of 0 texels"),
        Size::Scale { num: 0, .. } => wrong("a scale with the numerator 0"),
        Size::Scale { den: 0, .. } => wrong("a scale with the denominator 0"),
        Size::Scale { align: 0, .. } => wrong("an alignment of 0 texels"),
        size => Ok(size.into()),
    }
}
