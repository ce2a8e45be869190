//! Conversion of stated fog to our settings.

use super::document::{Fog, Scene};
use framegraph_passes::FogSettings;
use framegraph_passes::effects::fog::{FogColor, FogGlow};

/// Filament's default brightness of the environment, a factor on the fog's color.
const NO_ENVIRONMENT: f64 = 30_000.0;

/// Converts fog; missing options have Filament's defaults. Returns `None` without an environment, since Filament then
/// draws no sky and no fog in front of it.
pub fn settings(stated: &Fog, scene: &Scene) -> Option<FogSettings> {
    let usual = FogSettings { exact: false, ..FogSettings::DEFAULT };
    let number = |value: Option<f64>, default: f32| value.map_or(default, |x| x as f32);
    let intensity = scene.ibl.as_ref().map_or(NO_ENVIRONMENT, |ibl| ibl.intensity);
    let color = stated.color.unwrap_or([1.0; 3]);
    stated.enabled.then(|| FogSettings {
        density: number(stated.density, usual.density),
        height_m: number(stated.height, usual.height_m),
        falloff: number(stated.height_falloff, usual.falloff).max(0.0),
        start_m: number(stated.distance, usual.start_m),
        cut_off_m: number(stated.cut_off_distance, 1e9).min(1e9),
        most_opacity: number(stated.maximum_opacity, usual.most_opacity),
        color: if stated.fog_color_from_ibl == Some(true) && scene.ibl.is_some() {
            FogColor::Environment { tint: color.map(|x| x as f32), sharp_m: scene.camera.far as f32, sharp_levels: 1.0 }
        } else {
            FogColor::Radiance(color.map(|x| (x * intensity) as f32))
        },
        glow: stated
            .in_scattering_size
            .filter(|size| *size > 0.0)
            .map(|size| FogGlow { start_m: number(stated.in_scattering_start, 0.0), size: size as f32 }),
        ..usual
    })
}
