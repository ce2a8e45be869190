//! Devices as RON files: a preset and overridden fields.

use super::error::{FileError, FileErrors, FileReason};
use super::spanned::{Source, Spanned};
use super::syntax;
use super::value::ValueReason;
use super::version::{check_version, without_mark};
use crate::caps::{Caps, FormatCaps};
use crate::format::Format;
use crate::resolve::ResolveModes;
use serde::Deserialize;
use std::collections::BTreeMap;

/// Version of the format of device files.
pub const CAPS_VERSION: u32 = 1;

/// Defines the serde representation of a device from the fields of [`Caps`] that a file can set.
macro_rules! caps_form {
    ($($field:ident: $type:ty),+ $(,)?) => {
        #[derive(Debug, Default, Deserialize)]
        #[serde(deny_unknown_fields, default, rename = "CapsFile")]
        struct CapsForm {
            version: u32,
            like: Option<Spanned<String>>,
            /// Uses of formats, which replace those of the preset.
            formats: BTreeMap<Format, FormatCaps>,
            $($field: Option<Spanned<$type>>,)+
        }

        /// Overrides the fields that the form sets.
        fn overlay(caps: &mut Caps, form: CapsForm) {
            $(if let Some(given) = form.$field {
                caps.$field = given.value;
            })+
            for (format, uses) in form.formats {
                caps.formats = caps.formats.with(format, uses);
            }
        }
    };
}

caps_form! {
    name: String, max_color_attachments: u8, max_color_bytes_per_sample: u32, max_attached_layers: u32,
    max_texture_texels: u32, max_volume_texels: u32, max_texture_layers: u32, max_buffer_bytes: u64, max_samples: u8,
    max_sampled_textures: u32, max_samplers: u32, max_storage_textures: u32, max_storage_buffers: u32,
    max_uniform_buffers: u32, max_uniform_bytes: u64, max_storage_bytes: u64, uniform_alignment_bytes: u64,
    storage_alignment_bytes: u64, srgb_views: bool, memoryless_views: bool, multisampled_arrays: bool,
    multisampled_storage: bool, partial_blocks: bool, raster_storage: bool, empty_raster: bool, clears_to_zero: bool,
    clears_to_value: bool, memoryless: bool, memoryless_layers: bool,
    memoryless_saves: bool, merge_attachments: bool, same_pixel: bool, slot_mapping: bool, inline: bool,
    tile_bytes_per_pixel: u32, sample_read_only_depth: bool, separate_planes: bool, color_resolves: ResolveModes,
    depth_resolves: ResolveModes, placed: bool, placed_histories: bool, separate_heaps: bool,
    texture_alignment_bytes: u64, buffer_alignment_bytes: u64, explicit_barriers: bool,
    compute_queue: bool, copy_queue: bool, tile_heap_bytes: u64,
}

/// Reads a device from `text`; `path` is used in errors. Missing fields have the values of the preset named by `like`,
/// by default `wgpu`.
///
/// # Errors
/// Returns an error if `text` is not valid RON, has an unsupported form or version, or contains invalid values.
pub fn caps(path: &str, text: &str) -> Result<Caps, FileErrors> {
    let text = without_mark(text);
    let source = Source { path, text, included: &[] };
    check_version(source, CAPS_VERSION)?;
    let form: CapsForm = syntax::options().from_str(text).map_err(|error| source.refused(&error))?;
    let mut caps = Caps::wgpu();
    if let Some(like) = &form.like {
        let unknown = || source.error(like, FileReason::unknown("preset", &like.value, Caps::PRESETS.into_iter()));
        caps = Caps::preset(&like.value).ok_or_else(unknown)?;
    }
    let errors = faults(source, &form);
    if !errors.is_empty() {
        return Err(FileErrors { listed: errors, more: 0 });
    }
    overlay(&mut caps, form);
    Ok(caps)
}

/// Returns an error for each invalid value.
fn faults(source: Source<'_>, form: &CapsForm) -> Vec<FileError> {
    let mut errors = Vec::new();
    let alignments = [
        &form.texture_alignment_bytes,
        &form.buffer_alignment_bytes,
        &form.uniform_alignment_bytes,
        &form.storage_alignment_bytes,
    ];
    for at in alignments.into_iter().flatten().filter(|a| !a.value.is_power_of_two() || a.value > 1 << 32) {
        errors.push(source.value(at, ValueReason::Alignment(at.value)));
    }
    for at in form.max_samples.iter().filter(|s| !s.value.is_power_of_two()) {
        errors.push(source.value(at, ValueReason::MaxSamples(at.value)));
    }
    for at in form.max_color_attachments.iter().filter(|c| !(1..=8).contains(&c.value)) {
        errors.push(source.value(at, ValueReason::MaxColors(at.value)));
    }
    let sides = [&form.max_texture_texels, &form.max_volume_texels, &form.max_texture_layers];
    for at in sides.into_iter().flatten().filter(|s| s.value == 0 || s.value > 1 << 20) {
        errors.push(source.value(at, ValueReason::MaxSide(at.value)));
    }
    errors
}
