//! Conversion of stated ambient occlusion to our settings.

use super::document::{self, Ao, AoQuality, AoType, Ssct};
use framegraph_passes::effects::depth::structure::Resolution;
use framegraph_passes::effects::occlusion::{Blur, ConeTrace, Gtao, Method, Occluders, OcclusionSettings, SaoQuality};

/// Converts ambient occlusion; `None` if it is off. If `as_made`, details match Filament. Otherwise they are ours:
/// samples at the position of their depth, and normals from the nearer neighbors.
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
        bent_normals: ao.bent_normals == Some(true),
        cone: ao.ssct.as_ref().filter(|ssct| ssct.enabled).map(cone),
        method: match ao.ao_type.unwrap_or_default() {
            AoType::Sao => preset.method,
            AoType::Gtao => Method::Gtao(gtao(&ao.gtao.clone().unwrap_or_default(), as_made)),
        },
    };
    ao.enabled.then_some(settings)
}

fn cone(stated: &Ssct) -> ConeTrace {
    let own = ConeTrace::FILAMENT;
    let number = |value: Option<f64>, default: f32| value.map_or(default, |value| value as f32);
    ConeTrace {
        reach_m: number(stated.shadow_distance, own.reach_m),
        angle_rad: number(stated.light_cone_rad, own.angle_rad),
        contact_m: number(stated.contact_distance_max, own.contact_m),
        bias_m: number(stated.depth_bias, own.bias_m),
        slope_bias_m: number(stated.depth_slope_bias, own.slope_bias_m),
        intensity: number(stated.intensity, own.intensity),
        steps: stated.sample_count.unwrap_or(own.steps).max(1),
        rays: stated.ray_count.unwrap_or(own.rays).max(1),
    }
}

/// Converts GTAO; missing options have Filament's defaults if `as_made`, otherwise ours.
fn gtao(stated: &document::Gtao, as_made: bool) -> Gtao {
    let own = if as_made { Gtao::FILAMENT } else { Gtao::DEFAULT };
    Gtao {
        slices: stated.sample_slice_count.unwrap_or(own.slices).clamp(1, 16),
        steps: stated.sample_steps_per_slice.unwrap_or(own.steps).clamp(1, 32),
        occluders: if stated.use_visibility_bitmasks == Some(true) {
            Occluders::Thick(stated.const_thickness.unwrap_or(0.5) as f32)
        } else {
            own.occluders
        },
        ..own
    }
}

/// Returns keys of `scene.view.ao` that are implemented differently, with explanations.
pub fn otherwise(ao: &Ao) -> Vec<[&'static str; 2]> {
    let asked = [
        (ao.resolution.is_some_and(|share| share != 1.0 && share != 0.5), ["resolution", "half"]),
        (
            ao.ssct.as_ref().is_some_and(|ssct| ssct.enabled && ssct.light_direction.is_some()),
            ["ssct.lightDirection", "the sun's"],
        ),
        (
            ao.gtao.as_ref().is_some_and(|gtao| gtao.linear_thickness == Some(true)),
            ["gtao.linearThickness", "constant"],
        ),
    ];
    asked.into_iter().filter(|(asked, _)| ao.enabled && *asked).map(|(_, said)| said).collect()
}
