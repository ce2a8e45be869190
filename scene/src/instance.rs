//! Instances: meshes placed in the world with a material.

use glam::{DMat3, DMat4, DVec3, Mat4};

use super::bounds::Aabb;
use super::draw_options::DrawOptions;
use super::material::MaterialId;
use super::mesh::MeshId;

/// A mesh with a material and a world transform.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    /// Name of the node, for messages; may be empty.
    pub name: String,
    /// Mesh of the instance.
    pub mesh: MeshId,
    /// Material of the instance.
    pub material: MaterialId,
    /// World transform: affine, column-major, in meters. It is in f64 since at 10⁶ m an f32 translation jitters by 8
    /// pixels; see [`relative_from_model`](Instance::relative_from_model).
    pub world_from_model: DMat4,
    /// Bounds of the mesh in world space, conservative.
    pub bounds: Aabb,
    /// Layers, light channels, priority and shadows.
    pub draw: DrawOptions,
}

impl Instance {
    /// Creates an instance of `mesh`, whose own bounds are `model_bounds`, with the default [`DrawOptions`].
    #[must_use]
    pub fn new(name: &str, mesh: MeshId, material: MaterialId, world_from_model: DMat4, model_bounds: &Aabb) -> Self {
        Self {
            name: name.into(),
            mesh,
            material,
            world_from_model,
            bounds: model_bounds.transformed(&world_from_model),
            draw: DrawOptions::default(),
        }
    }

    /// Returns the f32 transform to world axes relative to `origin` (normally the eye, in meters). The origin is
    /// subtracted in f64 before rounding.
    #[must_use]
    pub fn relative_from_model(&self, origin: DVec3) -> Mat4 {
        let mut relative = self.world_from_model;
        relative.w_axis = (relative.w_axis.truncate() - origin).extend(1.0);
        relative.as_mat4()
    }

    /// Returns true if the transform mirrors the mesh, so that front faces wind clockwise.
    #[must_use]
    pub fn is_mirrored(&self) -> bool {
        let linear = DMat3::from_mat4(self.world_from_model);
        linear.determinant() < 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn placed(world_from_model: DMat4) -> Instance {
        let bounds = Aabb { min: DVec3::NEG_ONE, max: DVec3::ONE };
        Instance::new("", MeshId::new(0), MaterialId::new(0), world_from_model, &bounds)
    }

    #[test]
    fn mirroring_is_noticed() {
        assert!(placed(DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0))).is_mirrored());
        assert!(!placed(DMat4::from_scale(DVec3::new(-1.0, -1.0, 1.0))).is_mirrored());
    }

    /// At 10⁶ m, subtraction before rounding preserves millimeters.
    #[test]
    fn relative_transform_subtracts_in_f64() {
        let at = DVec3::new(1e6, 0.0, -1e6);
        let instance = placed(DMat4::from_translation(at + DVec3::new(0.001, 0.0, 0.0)));
        let relative = instance.relative_from_model(at);
        assert!((relative.w_axis.x - 0.001).abs() < 1e-9);
    }
}
