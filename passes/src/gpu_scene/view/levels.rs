//! In which level of detail instances are drawn: one for all that a frame draws of an instance, in pictures and in shadow maps, since
//! it would shadow itself where two levels are apart.

use super::ViewSettings;
use framegraph_scene::camera::PixelSize;
use framegraph_scene::{DrawLists, Renderables};

impl ViewSettings {
    /// Levels by the numbers of instances before anything limits them; empty where all meshes are drawn whole.
    pub(crate) fn unlimited_levels(&self, of: &Renderables) -> Vec<u8> {
        if self.lod_error_px > 0.0 { of.levels().unlimited() } else { Vec::new() }
    }

    /// Limits them to what the pixels of this view allow of what it sees.
    pub(crate) fn limit_levels(&self, of: &Renderables, visible: &DrawLists, levels: &mut [u8]) {
        let DrawLists { opaque, mask, transmit, blend, .. } = visible;
        let pixel = PixelSize::new(&self.camera, self.size_px);
        let most_m = |i: u32| f64::from(self.lod_error_px) * pixel.least_m(&of.bounds()[i as usize]);
        of.levels().limit(levels, [opaque, mask, transmit, blend].into_iter().flatten(), most_m);
    }
}
