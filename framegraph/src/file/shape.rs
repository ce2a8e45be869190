//! Descriptors in files: validates and converts numbers.

use super::entries::Count;
use super::error::FileError;
use super::features::Features;
use super::form::{BufferForm, Origin, Size, TextureForm};
use super::spanned::{Source, Spanned};
use super::value::ValueReason;
use crate::resource::{BufferSize, Extent, TextureDesc};

/// Returns the descriptor of a texture.
pub(super) fn texture(source: Source<'_>, features: &Features, form: &TextureForm) -> Result<TextureDesc, FileError> {
    let number = |at: &Option<Spanned<Count>>, what, max, all| match at {
        None => Ok(1),
        Some(at) => count(source, features, at, what, max, all),
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

/// Returns the size of a buffer.
pub(super) fn buffer(source: Source<'_>, features: &Features, form: &BufferForm) -> Result<BufferSize, FileError> {
    if let Origin::History { .. } = form.kind {
        return Err(source.value(&form.name, ValueReason::BufferHistory));
    }
    let most = if form.per_texel_of.is_some() { u64::from(u32::MAX) } else { u64::MAX };
    let bytes = count(source, features, &form.bytes, "bytes", most, false)?;
    let Some(texels) = &form.per_texel_of else {
        return Ok(BufferSize::Bytes(bytes));
    };
    Ok(BufferSize::PerTexel { bytes: bytes as u32, extent: extent(source, texels)? })
}

/// Returns a number from 1 to `max`, or 0 for "all" where allowed.
fn count(
    source: Source<'_>,
    features: &Features,
    number: &Spanned<Count>,
    what: &'static str,
    max: u64,
    all: bool,
) -> Result<u64, FileError> {
    let fault = match &number.value {
        Count::All if all => return Ok(0),
        Count::All => ValueReason::All { what },
        Count::Fixed(value) if (1..=max).contains(value) => return Ok(*value),
        Count::Fixed(value) => ValueReason::Count { what, value: *value, max, all },
        Count::Choice(choices) => match choice(source, features, choices)? {
            Some(value) if (1..=max).contains(&value) => return Ok(value),
            Some(value) => ValueReason::Count { what, value, max, all },
            None => ValueReason::NoChoice { what },
        },
    };
    Err(source.value(number, fault))
}

/// Returns the value of the first condition that holds. Evaluates all conditions, so that misspelled names are always
/// reported.
fn choice(
    source: Source<'_>,
    features: &Features,
    choices: &[(Spanned<String>, u64)],
) -> Result<Option<u64>, FileError> {
    let mut chosen = None;
    for (condition, value) in choices {
        let holds = condition.value == "else" || features.holds(source, Some(condition))?;
        if holds && chosen.is_none() {
            chosen = Some(*value);
        }
    }
    Ok(chosen)
}

fn extent(source: Source<'_>, size: &Spanned<Size>) -> Result<Extent, FileError> {
    let zero = match size.value {
        Size::Texels(0, _) | Size::Texels(_, 0) => "a size of 0 texels",
        Size::Scale { num: 0, .. } => "a scale with the numerator 0",
        Size::Scale { den: 0, .. } => "a scale with the denominator 0",
        Size::Scale { align: 0, .. } => "an alignment of 0 texels",
        size => return Ok(size.into()),
    };
    Err(source.value(size, ValueReason::Zero(zero)))
}
