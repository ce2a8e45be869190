//! Ranges of fog, depth of field, bloom and lens flare.

use crate::Settings;
use crate::effects::fog::FogColor;

/// Returns the numbers of a frame with their ranges.
pub(super) fn ranges(s: &Settings) -> Vec<(&'static str, f64, f64, f64)> {
    let mut all = Vec::new();
    let finite = f64::from(f32::MAX);
    if let Some(fog) = &s.fog {
        let (color, sharp_m, sharp_levels) = match fog.color {
            FogColor::Radiance(color) => (color, 1.0, 1.0),
            FogColor::Environment { tint, sharp_m, sharp_levels } => (tint, sharp_m, sharp_levels),
        };
        all.extend([
            ("settings.fog.density", fog.density.into(), 0.0, 1e3),
            ("settings.fog.height_m", fog.height_m.into(), -1e6, 1e6),
            ("settings.fog.falloff", fog.falloff.into(), 0.0, 1e3),
            ("settings.fog.start_m", fog.start_m.into(), 0.0, 1e9),
            ("settings.fog.cut_off_m", fog.cut_off_m.into(), 0.0, f64::INFINITY),
            ("settings.fog.most_opacity", fog.most_opacity.into(), 0.0, 1.0),
            ("settings.fog.color.sharp_m", sharp_m.into(), 1e-3, 1e9),
            ("settings.fog.color.sharp_levels", sharp_levels.into(), 0.0, 16.0),
            ("settings.fog.glow.start_m", fog.glow.map_or(0.0, |glow| glow.start_m.into()), 0.0, 1e9),
            ("settings.fog.glow.size", fog.glow.map_or(1.0, |glow| glow.size.into()), 1e-2, 1e4),
        ]);
        all.extend(color.map(|channel| ("settings.fog.color", channel.into(), 0.0, 1e6)));
    }
    if let Some(dof) = &s.dof {
        all.extend([
            ("settings.dof.focus_m", dof.focus_m.into(), 1e-3, 1e9),
            ("settings.dof.f_number", dof.f_number.into(), 0.1, 1e3),
            ("settings.dof.focal_length_m", dof.focal_length_m.unwrap_or(1.0).into(), 1e-3, 10.0),
            ("settings.dof.scale", dof.scale.into(), 0.0, 1e3),
            ("settings.dof.most_before_px", dof.most_before_px.into(), 0.0, 32.0),
            ("settings.dof.most_behind_px", dof.most_behind_px.into(), 0.0, 32.0),
            ("settings.dof.rings_before", dof.rings_before.into(), 3.0, 17.0),
            ("settings.dof.rings_behind", dof.rings_behind.into(), 3.0, 17.0),
            ("settings.dof.rings_even", dof.rings_even.into(), 3.0, 17.0),
        ]);
    }
    if let Some(bloom) = &s.bloom {
        all.extend([
            ("settings.bloom.strength", bloom.strength.into(), 0.0, 1.0),
            ("settings.bloom.height_texels", bloom.height_texels.into(), 16.0, 2048.0),
            ("settings.bloom.levels", bloom.levels.into(), 0.0, 12.0),
            ("settings.bloom.threshold_at", bloom.threshold_at.into(), 0.0, 1e4),
            ("settings.bloom.highlight", bloom.highlight.into(), 1e-2, f64::INFINITY),
            ("settings.bloom.dirt", bloom.dirt.into(), 0.0, 1e3),
            ("settings.bloom.multiple_px", bloom.multiple_px.into(), 1.0, 65536.0),
        ]);
    }
    if let Some(flare) = s.bloom.and_then(|bloom| bloom.flare) {
        all.extend([
            ("settings.bloom.flare.aberration", flare.aberration.into(), 0.0, 1.0),
            ("settings.bloom.flare.ghosts", flare.ghosts.into(), 0.0, 16.0),
            ("settings.bloom.flare.ghost_spacing", flare.ghost_spacing.into(), 0.0, 1.0),
            ("settings.bloom.flare.ghost_threshold", flare.ghost_threshold.into(), 0.0, finite),
            ("settings.bloom.flare.halo_radius", flare.halo_radius.into(), 0.0, 0.5),
            ("settings.bloom.flare.halo_thickness", flare.halo_thickness.into(), 0.0, 1.0),
            ("settings.bloom.flare.halo_threshold", flare.halo_threshold.into(), 0.0, finite),
        ]);
    }
    all
}
