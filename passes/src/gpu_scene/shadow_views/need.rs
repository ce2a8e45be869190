//! What shadow maps a view has use for, found before any is fitted.

use super::local;
use super::settings::ShadowSettings;
use super::sun::SunScene;
use super::volume::FitCamera;
use framegraph_scene::{Light, Renderables};
use glam::DVec3;

/// What shadow maps a view has use for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ShadowNeed {
    /// Casters whose shadows of the sun may fall on what is seen: those within what is seen, swept toward the sun.
    pub sun_casters: usize,
    /// Distances ahead of the eye of the nearest and farthest place that they may fall on.
    pub receivers_m: Option<(f64, f64)>,
    /// Maps that the lamps which reach what is seen have room for.
    pub lamp_maps: usize,
    /// Layers that these share.
    pub lamp_layers: usize,
    /// Casters in these.
    pub lamp_casters: usize,
}

impl ShadowNeed {
    /// That of cameras which share maps, for the sun and for the lamps that reach what they see.
    pub fn of(
        scene: &Renderables,
        sun: Option<&Light>,
        lamps: &[&Light],
        cameras: &[FitCamera<'_>],
        settings: &ShadowSettings,
    ) -> Self {
        let mut need = Self::default();
        if let Some(sun) = sun.filter(|_| settings.cascades > 0) {
            let toward = -sun.direction.as_dvec3();
            (need.sun_casters, need.receivers_m) = SunScene::new(scene, cameras, toward, settings).need();
        }
        if settings.local_maps > 0 {
            let eye = cameras.first().map_or(DVec3::ZERO, |camera| camera.camera.eye);
            let (_, maps) = local::fit(scene, lamps, eye, settings);
            need.lamp_maps = maps.len();
            need.lamp_layers = local::layers(&scene.whole(), lamps, eye, settings) as usize;
            need.lamp_casters = maps.iter().map(|map| map.casters.opaque.len() + map.casters.mask.len()).sum();
        }
        need
    }
}
