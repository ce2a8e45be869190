//! Data for drawing an instance, except its transform.

use framegraph_scene::{Instance, MaterialId, MeshId};

/// View-independent data for drawing an instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InstanceDraw {
    /// Mesh.
    pub mesh: MeshId,
    /// Material.
    pub material: MaterialId,
    /// True if the transform mirrors, so that front faces are clockwise.
    pub mirrored: bool,
    /// Light channels, plus 256 if the instance receives no shadows
    /// ([`DrawOptions::light_bits`](framegraph_scene::DrawOptions::light_bits)).
    pub light_bits: u16,
}

impl InstanceDraw {
    pub(super) fn new(instance: &Instance) -> Self {
        let Instance { mesh, material, .. } = *instance;
        Self { mesh, material, mirrored: instance.is_mirrored(), light_bits: instance.draw.light_bits() }
    }
}
