//! Shadow maps that a view needs, determined before any map is fitted.

use super::local;
use super::settings::ShadowSettings;
use super::sun::SunScene;
use super::volume::FitCamera;
use framegraph_scene::{Light, Renderables};
use glam::DVec3;

/// Shadow maps that a view needs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ShadowNeed {
    /// Number of casters whose sun shadows may fall on visible surfaces: those within the view volume, swept toward
    /// the sun.
    pub sun_casters: usize,
    /// Distances ahead of the eye of the nearest and farthest receiver.
    pub receivers_m: Option<(f64, f64)>,
    /// Number of maps of the punctual lights that reach visible surfaces, within the limit.
    pub lamp_maps: usize,
    /// Number of layers that these maps share.
    pub lamp_layers: usize,
    /// Number of casters in these maps.
    pub lamp_casters: usize,
}

impl ShadowNeed {
    /// Returns the need of cameras that share maps, for the sun and for the punctual lights that reach visible
    /// surfaces.
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
