//! Current and previous transforms of instances to clip space.

use crate::gpu_scene::placements::Placements;
use framegraph_shaders::layout::MotionUniforms;
use glam::{DMat4, DVec3};

/// Camera and transforms of one frame.
pub(super) struct Moment<'a> {
    pub(super) clip_from_world: DMat4,
    pub(super) eye: DVec3,
    pub(super) placements: &'a Placements,
}

impl Moment<'_> {
    /// Returns current and previous transforms, multiplied in f64; empty if no instance moved.
    pub(super) fn motions_since(&self, before: &Self) -> Vec<MotionUniforms> {
        let mut motions = Vec::new();
        for (number, here, there) in self.placements.moved_since(before.placements) {
            motions.resize(self.placements.count(), MotionUniforms::default());
            motions[number] = self.motion(before, here, there);
        }
        motions
    }

    /// Writes current and previous transforms of these instances to `motions`, moved or not.
    pub(super) fn motions_of(
        &self,
        instances: impl Iterator<Item = usize>,
        before: &Self,
        mut motions: Vec<MotionUniforms>,
    ) -> Vec<MotionUniforms> {
        for instance in instances {
            if let (Some(here), Some(there)) = (self.placements.of(instance), before.placements.of(instance)) {
                motions.resize(self.placements.count(), MotionUniforms::default());
                motions[instance] = self.motion(before, here, there);
            }
        }
        motions
    }

    /// Returns the transforms of one instance from its current and previous model-to-world matrices.
    fn motion(&self, before: &Self, here: &DMat4, there: &DMat4) -> MotionUniforms {
        let clip = |moment: &Self, placed: &DMat4| {
            (moment.clip_from_world * DMat4::from_translation(-moment.eye) * *placed).as_mat4()
        };
        MotionUniforms { clip_from_model: clip(self, here), earlier_clip_from_model: clip(before, there) }
    }
}
