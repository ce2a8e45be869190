//! What drawing an instance takes beside its placement.

use framegraph_scene::{Instance, MaterialId, MeshId};

/// An instance as draws need it, whatever the view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InstanceDraw {
    /// Its mesh.
    pub mesh: MeshId,
    /// Its material.
    pub material: MaterialId,
    /// Its transform mirrors: front faces wind clockwise.
    pub mirrored: bool,
    /// Its light channels, and 256 if it receives no shadows ([`DrawOptions::light_bits`](framegraph_scene::DrawOptions::light_bits)).
    pub light_bits: u16,
}

impl InstanceDraw {
    pub(super) fn new(instance: &Instance) -> Self {
        let Instance { mesh, material, .. } = *instance;
        Self { mesh, material, mirrored: instance.is_mirrored(), light_bits: instance.draw.light_bits() }
    }
}
