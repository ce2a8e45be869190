//! Ambient occlusion as stated, in terms of ours.

use super::document::{Ao, AoQuality, AoType};
use framegraph_passes::occlusion::{Blur, OcclusionSettings, SaoQuality};
use framegraph_passes::structure::Resolution;

/// What is stated, made as Filament makes it if `as_made`, else as we do: a tap where its depth was found, and normals from
/// the nearer texels. None where it is off.
pub fn settings(ao: &Ao, as_made: bool) -> Option<OcclusionSettings> {
    let quality = match ao.quality.unwrap_or_default() {
        AoQuality::Low => SaoQuality::Low,
        AoQuality::Medium => SaoQuality::Medium,
        AoQuality::High => SaoQuality::High,
        AoQuality::Ultra => SaoQuality::Ultra,
    };
    let number = |value: Option<f64>, default: f32| value.map_or(default, |value| value as f32);
    let preset = OcclusionSettings::sao(quality);
    let threshold_m = number(ao.bilateral_threshold, 0.05);
    let blur = |blur: Blur| Some(Blur { threshold_m, ..blur });
    let settings = OcclusionSettings {
        resolution: if ao.resolution == Some(1.0) { Resolution::Full } else { Resolution::Half },
        radius_m: number(ao.radius, preset.radius_m),
        bias: number(ao.bias, preset.bias),
        intensity: number(ao.intensity, preset.intensity),
        power: number(ao.power, preset.power),
        min_horizon_rad: number(ao.min_horizon_angle_rad, preset.min_horizon_rad),
        blur: match ao.low_pass_filter.unwrap_or(AoQuality::Medium) {
            AoQuality::Low => None,
            AoQuality::Medium => blur(Blur::medium(quality.sigma())),
            AoQuality::High | AoQuality::Ultra => blur(Blur::high(quality.sigma())),
        },
        fine_normals: !as_made,
        exact_taps: !as_made,
        ..preset
    };
    ao.enabled.then_some(settings)
}

/// Keys of `scene.view.ao` that ask for what is not built.
pub fn missing(ao: &Ao) -> Vec<&'static str> {
    let asked = [
        (ao.resolution.is_some_and(|share| share != 1.0 && share != 0.5), "resolution: other than 1 or 0.5"),
        (ao.ssct.as_ref().is_some_and(|ssct| ssct.get("enabled").is_none_or(|on| on == true)), "ssct"),
        (ao.bent_normals == Some(true), "bentNormals"),
        (ao.ao_type == Some(AoType::Gtao), "aoType"),
    ];
    asked.into_iter().filter(|(asked, _)| ao.enabled && *asked).map(|(_, key)| key).collect()
}
