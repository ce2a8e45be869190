//! The shadow maps of a view.

use super::fitted::{Fitted, MapKey, Penumbra, ShadowMap};
use super::local;
use super::settings::{MAX_MAPS, ShadowSettings};
use super::sun::SunScene;
use super::volume::FitCamera;
use crate::gpu_scene::placements::Placements;
use framegraph_scene::{Light, LightKind, Renderables, Scene};
use framegraph_shaders::layout::{ShadowMapUniforms, ShadowUniforms};
use glam::{DVec3, Vec4};

/// Default radius of a punctual light's bulb in meters: Filament's.
const BULB_M: f32 = 0.02;

/// Shadow maps of a view: one layer for each cascade of the sun, then the layers that maps of punctual lights share.
#[derive(Clone, Debug)]
pub struct ViewShadows {
    /// Shader data common to all maps, and of the sun's maps.
    pub uniforms: ShadowUniforms,
    /// Number of cascades of the sun.
    pub cascades: usize,
    /// Cascades, then maps of punctual lights.
    pub maps: Vec<ShadowMap>,
    /// Transforms of all instances.
    placements: Placements,
    /// Level of detail of each instance; empty if all use full meshes.
    levels: Vec<u8>,
    /// Index of the first map of each punctual light, among the maps of punctual lights.
    pub(crate) of_lights: Vec<Option<u32>>,
    /// True if the shadows of a light are weaker than 1.
    pub are_weak: bool,
    /// Requested settings.
    pub settings: ShadowSettings,
}

impl ViewShadows {
    /// Fits maps for a view at `eye`. All `cameras` share the maps. The first camera splits the cascades, and the maps
    /// are warped to it if it is the only one. `levels` are limited to an error of `lod_error_texels`.
    pub(crate) fn fit(
        scene: &Renderables,
        sun: Option<&Light>,
        lights: &[&Light],
        cameras: &[FitCamera<'_>],
        eye: DVec3,
        settings: &ShadowSettings,
        (lod_error_texels, mut levels): (f32, Vec<u8>),
    ) -> (Self, Vec<u8>) {
        let toward = sun.map_or(DVec3::Y, |sun| -sun.direction.as_dvec3());
        let mut fitted = Vec::new();
        let (mut far_ends, mut far_m) = (Vec::new(), 0.0);
        if settings.cascades > 0 {
            let sun = SunScene::new(scene, cameras, toward, settings).fit();
            (fitted, far_ends, far_m) = (sun.maps, sun.far_ends, sun.far_m);
        }
        let cascades = fitted.len();
        let first_eye = cameras.first().map_or(eye, |camera| camera.camera.eye);
        let (of_lights, local) = local::fit(scene, lights, first_eye, settings);
        fitted.extend(local);
        fitted.iter().for_each(|map| map.limit_levels(scene, lod_error_texels.into(), &mut levels));
        let angle = sun.map_or(0.0, |sun| match sun.kind {
            LightKind::Directional { angular_radius_rad, .. } => angular_radius_rad,
            _ => 0.0,
        });
        let of_sun = settings.bulb_m.map_or(Penumbra::Disc(angle.tan()), Penumbra::Bulb);
        let of_local = Penumbra::Bulb(settings.bulb_m.unwrap_or(BULB_M));
        let map = |(i, fitted): (usize, Fitted)| {
            let penumbra = if i < cascades { of_sun } else { of_local };
            ShadowMap::new(fitted, eye, settings, penumbra)
        };
        let ends = |i: usize| far_ends.get(i).map_or(f32::MAX, |end| *end as f32);
        let moments = &settings.moments;
        let exponent = settings.filter.exponent();
        let fades = settings.far_m.is_some_and(|limit| limit <= far_m * (1.0 + 1e-9));
        let mut uniforms = ShadowUniforms {
            far_ends: Vec4::new(ends(0), ends(1), ends(2), ends(3)),
            filter_kind: settings.filter.code(),
            texels: settings.map_texels as f32,
            inv_far2: if fades { (1.0 / (far_m * far_m)) as f32 } else { 0.0 },
            exponent,
            variance_floor: (moments.min_variance_scale * 0.01 * exponent).powi(2),
            bleed: moments.bleed,
            contact_m: settings.contact.map_or(0.0, |contact| contact.distance_m),
            sun_strength: sun.map_or(1.0, Light::held_shadow_strength),
            cascades: Default::default(),
        };
        let maps: Vec<ShadowMap> = fitted.into_iter().enumerate().map(map).collect();
        for (own, map) in uniforms.cascades.iter_mut().zip(&maps[..cascades]) {
            *own = map.uniforms;
        }
        let are_weak = lights.iter().copied().chain(sun).any(|light| light.held_shadow_strength() < 1.0);
        let (placements, settings) = (Placements::default(), *settings);
        (Self { uniforms, cascades, maps, placements, levels: Vec::new(), of_lights, are_weak, settings }, levels)
    }

    /// Records the transforms of all instances, and their levels of detail by instance number.
    pub(crate) fn set_instances(&mut self, placements: &Placements, levels: &[u8]) {
        (self.placements, self.levels) = (placements.clone(), levels.to_vec());
        self.placements.release();
    }

    /// Returns the inputs of each map.
    pub(crate) fn keys(&self) -> Vec<MapKey> {
        self.maps.iter().map(|map| MapKey::new(map, &self.placements, &self.levels)).collect()
    }

    /// Returns the shader data of each map of a punctual light.
    pub(crate) fn local_uniforms(&self) -> Vec<ShadowMapUniforms> {
        self.maps[self.cascades..].iter().map(|map| map.uniforms).collect()
    }
}

/// Returns the number of maps that the punctual lights of a scene need in addition to the sun's, within the limit.
#[must_use]
pub fn local_maps(scene: &Scene, cascades: u8) -> u8 {
    let count: usize = scene.lights.iter().filter(|light| light.is_on()).map(local::maps_of).sum();
    count.min(usize::from(MAX_MAPS) - usize::from(cascades)) as u8
}

/// Returns the number of layers that maps of punctual lights share, seen from `eye`, within the limit of `settings`.
/// Use it to reduce [`ShadowSettings::local_layers`].
#[must_use]
pub fn local_layers(scene: &Scene, eye: DVec3, settings: &ShadowSettings) -> u8 {
    let lights: Vec<&Light> = scene.lights.iter().filter(|light| light.is_on()).collect();
    local::layers(&scene.bounds(), &lights, eye, settings) as u8
}
