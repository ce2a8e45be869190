//! Conversion of stated bloom to our settings.

use super::document::{BlendMode, Bloom, BloomQuality as Stated};
use framegraph_passes::BloomSettings;
use framegraph_passes::effects::bloom::{Blend, BloomQuality, FlareSettings, Threshold};

/// Converts bloom; missing options have Filament's defaults. If `as_made`, filters are those of Filament's mobile
/// quality, otherwise those of its desktop quality. Returns `None` if bloom is off.
pub fn settings(stated: &Bloom, as_made: bool) -> Option<BloomSettings> {
    let (usual, flare) = (BloomSettings::DEFAULT, FlareSettings::DEFAULT);
    let number = |value: Option<f64>, default: f32| value.map_or(default, |x| x as f32);
    let count = |value: Option<f64>, default: u8| value.map_or(default, |x| x as u8);
    stated.enabled.then(|| BloomSettings {
        strength: number(stated.strength, usual.strength).clamp(0.0, 1.0),
        height_texels: stated.resolution.map_or(usual.height_texels, |x| x as u32),
        levels: count(stated.levels, usual.levels),
        quality: match stated.quality.unwrap_or(Stated::Low) {
            Stated::Low => BloomQuality::Low,
            Stated::Medium => BloomQuality::Medium,
            Stated::High | Stated::Ultra => BloomQuality::High,
        },
        blend: match stated.blend_mode.unwrap_or(BlendMode::Add) {
            BlendMode::Add => Blend::Add,
            BlendMode::Interpolate => Blend::Interpolate,
        },
        threshold: if stated.threshold == Some(false) { Threshold::None } else { Threshold::Soft },
        highlight: number(stated.highlight, usual.highlight),
        narrow: as_made,
        flare: (stated.lens_flare == Some(true)).then(|| FlareSettings {
            starburst: stated.starburst.unwrap_or(flare.starburst),
            aberration: number(stated.chromatic_aberration, flare.aberration),
            ghosts: count(stated.ghost_count, flare.ghosts),
            ghost_spacing: number(stated.ghost_spacing, flare.ghost_spacing),
            ghost_threshold: number(stated.ghost_threshold, flare.ghost_threshold),
            halo_radius: number(stated.halo_radius, flare.halo_radius),
            halo_thickness: number(stated.halo_thickness, flare.halo_thickness),
            halo_threshold: number(stated.halo_threshold, flare.halo_threshold),
            multiple_px: flare.multiple_px,
        }),
        multiple_px: 16,
        ..usual
    })
}
