//! Devices as files: a preset, and what is different about this one.

use super::error::{FileError, FileErrors, FileReason};
use super::spot::{Source, Spot};
use super::suggest::nearest;
use super::syntax;
use super::{check_version, without_mark};
use crate::caps::Caps;
use serde::Deserialize;

/// The version of the format of device files.
pub const CAPS_VERSION: u32 = 1;

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default, rename = "CapsFile")]
struct CapsForm {
    version: u32,
    like: Option<Spot<String>>,
    name: Option<String>,
    max_color_attachments: Option<Spot<u8>>,
    max_color_bytes_per_sample: Option<u32>,
    max_texture_texels: Option<Spot<u32>>,
    max_texture_layers: Option<Spot<u32>>,
    max_buffer_bytes: Option<u64>,
    max_samples: Option<Spot<u8>>,
    memoryless: Option<bool>,
    memoryless_saves: Option<bool>,
    merge_attachments: Option<bool>,
    same_pixel: Option<bool>,
    inline: Option<bool>,
    tile_bytes_per_pixel: Option<u32>,
    sample_read_only_depth: Option<bool>,
    placed: Option<bool>,
    separate_heaps: Option<bool>,
    texture_alignment_bytes: Option<Spot<u64>>,
    buffer_alignment_bytes: Option<Spot<u64>>,
    explicit_barriers: Option<bool>,
}

/// Reads a device from `text`; `path` is what errors call it. Fields that are left out are those of the preset named by
/// `like`, `wgpu` when there is none.
///
/// # Errors
/// Text that is no RON, or not of this form or version; values that no device has.
pub fn caps(path: &str, text: &str) -> Result<Caps, FileErrors> {
    let text = without_mark(text);
    let source = Source { path, text };
    check_version(source, CAPS_VERSION)?;
    let form: CapsForm = syntax::options().from_str(text).map_err(|error| source.refused(&error))?;
    let mut caps = match &form.like {
        None => Caps::wgpu(),
        Some(like) => preset(source, like)?,
    };
    let mut errors = Vec::new();
    check(source, &form, &mut errors);
    if !errors.is_empty() {
        return Err(FileErrors(errors));
    }
    overlay(&mut caps, form);
    Ok(caps)
}

fn preset(source: Source<'_>, like: &Spot<String>) -> Result<Caps, FileError> {
    Caps::preset(&like.value).ok_or_else(|| {
        let reason = FileReason::Unknown {
            what: "preset",
            name: like.value.clone(),
            near: nearest(&like.value, Caps::PRESETS).map(str::to_owned),
            known: Caps::PRESETS.map(str::to_owned).into(),
        };
        source.error(like, reason)
    })
}

/// Values that no device has.
fn check(source: Source<'_>, form: &CapsForm, errors: &mut Vec<FileError>) {
    let mut refuse = |error: Option<FileError>| errors.extend(error);
    let value = |detail: String, hint: &str| FileReason::Value { detail, hint: hint.into() };
    for alignment in [&form.texture_alignment_bytes, &form.buffer_alignment_bytes] {
        let wrong = alignment.as_ref().filter(|a| !a.value.is_power_of_two() || a.value > 1 << 32);
        refuse(wrong.map(|a| {
            let detail = format!("an alignment of {} bytes", a.value);
            source.error(a, value(detail, "write a power of two from 1 to 2^32"))
        }));
    }
    let samples = form.max_samples.as_ref().filter(|s| !s.value.is_power_of_two());
    refuse(samples.map(|s| {
        let detail = format!("{} samples at most", s.value);
        source.error(s, value(detail, "write 1, 2, 4, 8 or 16"))
    }));
    let colors = form.max_color_attachments.as_ref().filter(|c| !(1..=8).contains(&c.value));
    refuse(colors.map(|c| {
        let detail = format!("{} color attachments at most", c.value);
        source.error(c, value(detail, "write a number from 1 to 8"))
    }));
    for side in [&form.max_texture_texels, &form.max_texture_layers] {
        refuse(side.as_ref().filter(|s| s.value == 0 || s.value > 1 << 20).map(|s| {
            let detail = format!("{} texels or layers at most", s.value);
            source.error(s, value(detail, "write a number from 1 to 2^20"))
        }));
    }
}

/// Replaces what the form gives.
fn overlay(caps: &mut Caps, form: CapsForm) {
    fn set<T>(place: &mut T, value: Option<T>) {
        if let Some(value) = value {
            *place = value;
        }
    }
    fn set_spot<T>(place: &mut T, value: Option<Spot<T>>) {
        set(place, value.map(|spot| spot.value));
    }
    let Caps {
        name,
        max_color_attachments,
        max_color_bytes_per_sample,
        max_texture_texels,
        max_texture_layers,
        max_buffer_bytes,
        max_samples,
        memoryless,
        memoryless_saves,
        merge_attachments,
        same_pixel,
        inline,
        tile_bytes_per_pixel,
        sample_read_only_depth,
        placed,
        separate_heaps,
        texture_alignment_bytes,
        buffer_alignment_bytes,
        explicit_barriers,
    } = caps;
    set(name, form.name);
    set_spot(max_color_attachments, form.max_color_attachments);
    set(max_color_bytes_per_sample, form.max_color_bytes_per_sample);
    set_spot(max_texture_texels, form.max_texture_texels);
    set_spot(max_texture_layers, form.max_texture_layers);
    set(max_buffer_bytes, form.max_buffer_bytes);
    set_spot(max_samples, form.max_samples);
    set(memoryless, form.memoryless);
    set(memoryless_saves, form.memoryless_saves);
    set(merge_attachments, form.merge_attachments);
    set(same_pixel, form.same_pixel);
    set(inline, form.inline);
    set(tile_bytes_per_pixel, form.tile_bytes_per_pixel);
    set(sample_read_only_depth, form.sample_read_only_depth);
    set(placed, form.placed);
    set(separate_heaps, form.separate_heaps);
    set_spot(texture_alignment_bytes, form.texture_alignment_bytes);
    set_spot(buffer_alignment_bytes, form.buffer_alignment_bytes);
    set(explicit_barriers, form.explicit_barriers);
}
