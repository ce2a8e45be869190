//! What drawing an instance takes beside its placement.

use framegraph_scene::{Instance, MaterialId, MeshId, Scene};

/// An instance as draws need it, whatever the view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InstanceDraw {
    /// Its mesh.
    pub mesh: MeshId,
    /// Its material.
    pub material: MaterialId,
    /// Its triangles are visible from behind: they are not culled.
    pub double_sided: bool,
    /// Its transform mirrors: front faces wind clockwise.
    pub mirrored: bool,
}

impl InstanceDraw {
    pub(super) fn new(scene: &Scene, instance: &Instance) -> Self {
        let Instance { mesh, material, .. } = *instance;
        let double_sided = scene.materials[material.index()].double_sided;
        Self { mesh, material, double_sided, mirrored: instance.is_mirrored() }
    }
}
