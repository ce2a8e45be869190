//! Selection of the sun: the light with cascaded shadows.

use framegraph_scene::{Light, LightKind, Scene, SunHalo};

/// Returns the light with cascaded shadows: `own`, the sun of the environment, if it is on; otherwise the brightest
/// directional light of the scene.
pub(crate) fn sun_of<'a>(scene: &'a Scene, own: Option<&'a Light>) -> Option<&'a Light> {
    let directional = |light: &&Light| matches!(light.kind, LightKind::Directional { .. }) && light.is_on();
    let suns = scene.lights.iter().filter(directional);
    let brightest = || suns.max_by(|a, b| illuminance_lux(a).total_cmp(&illuminance_lux(b)));
    own.filter(|sun| sun.is_on()).or_else(brightest)
}

/// Returns true if the scene, or the sun of its environment, has a sun that is on.
#[must_use]
pub fn has_sun(scene: &Scene, own: Option<&Light>) -> bool {
    sun_of(scene, own).is_some()
}

/// Returns the illuminance of a directional light in lux, on a surface that faces it; 0 for other lights.
pub(crate) fn illuminance_lux(light: &Light) -> f32 {
    match light.kind {
        LightKind::Directional { illuminance_lux, .. } => illuminance_lux,
        _ => 0.0,
    }
}

/// Returns the angular radius of a directional light's disc in radians, as drawn with a halo, and the halo. `None`
/// without a halo.
pub(crate) fn halo_of(light: &Light) -> Option<(f32, SunHalo)> {
    let radius_rad = angular_radius_rad(light);
    light.halo.map(|halo| (if radius_rad > 0.0 { radius_rad } else { SunHalo::RADIUS_RAD }, halo))
}

/// Returns the angular radius of a directional light's disc in radians; 0 for other lights.
pub(crate) fn angular_radius_rad(light: &Light) -> f32 {
    match light.kind {
        LightKind::Directional { angular_radius_rad, .. } => angular_radius_rad,
        _ => 0.0,
    }
}
