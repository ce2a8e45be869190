//! Level of detail of each instance. Pictures and shadow maps use the same level, since different levels would cause
//! self-shadowing.

use super::ViewSettings;
use framegraph_scene::camera::PixelSize;
use framegraph_scene::{DrawLists, Renderables};

impl ViewSettings {
    /// Returns unlimited levels by instance number; empty if full meshes are drawn.
    pub(crate) fn unlimited_levels(&self, of: &Renderables) -> Vec<u8> {
        if self.lod_error_px > 0.0 { of.levels().unlimited() } else { Vec::new() }
    }

    /// Limits the levels to the geometric error that this view allows for visible instances.
    pub(crate) fn limit_levels(&self, of: &Renderables, visible: &DrawLists, levels: &mut [u8]) {
        let DrawLists { opaque, mask, transmit, blend, .. } = visible;
        let pixel = PixelSize::new(&self.camera, self.size_px);
        let most_m = |i: u32| f64::from(self.lod_error_px) * pixel.least_m(&of.bounds()[i as usize]);
        of.levels().limit(levels, [opaque, mask, transmit, blend].into_iter().flatten(), most_m);
    }
}
