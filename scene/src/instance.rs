//! A mesh placed in the world with a material.

use glam::{DMat3, DMat4, DVec3, Mat3, Mat4};

use super::bounds::Aabb;
use super::id::{MaterialId, MeshId};

/// One drawn mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    /// For messages: the node's name; may be empty.
    pub name: String,
    /// What is drawn.
    pub mesh: MeshId,
    /// With which surface.
    pub material: MaterialId,
    /// Affine, column-major, in meters. Accumulated in f64 along the hierarchy and kept so: at
    /// 10⁶ m an f32 translation jitters by 8 pixels (`relative_from_model` subtracts first).
    pub world_from_model: DMat4,
    /// The mesh's bounds in the world, conservative.
    pub bounds: Aabb,
}

impl Instance {
    /// Places `mesh`, whose own bounds are `model_bounds`.
    #[must_use]
    pub fn new(name: &str, mesh: MeshId, material: MaterialId, world_from_model: DMat4, model_bounds: &Aabb) -> Self {
        Self {
            name: name.into(),
            mesh,
            material,
            world_from_model,
            bounds: model_bounds.transformed(&world_from_model),
        }
    }

    /// The transform in f32, good to about 10³ m from the origin.
    #[must_use]
    pub fn world_from_model_f32(&self) -> Mat4 {
        self.world_from_model.as_mat4()
    }

    /// The transform to world axes with `origin` (normally the eye, in meters) as the zero point:
    /// the subtraction is done in f64, the result is f32.
    #[must_use]
    pub fn relative_from_model(&self, origin: DVec3) -> Mat4 {
        let mut relative = self.world_from_model;
        relative.w_axis = (relative.w_axis.truncate() - origin).extend(1.0);
        relative.as_mat4()
    }

    /// The matrix for normals, see [`normal_from_model`].
    #[must_use]
    pub fn world_normal_from_model(&self) -> Mat3 {
        normal_from_model(&self.world_from_model)
    }

    /// Whether the transform turns the mesh inside out, so that front faces wind clockwise.
    #[must_use]
    pub fn is_mirrored(&self) -> bool {
        let linear = DMat3::from_mat4(self.world_from_model);
        linear.determinant() < 0.0
    }
}

/// The matrix that takes normals along with an affine transform: the cofactor matrix of its linear
/// part, scaled to a largest element of 1 and multiplied by the sign of the determinant.
///
/// The cofactor matrix is the inverse transpose times the determinant, and unlike the inverse it
/// exists for flat transforms such as scale (1, 1, 0). Columns are scaled first and the division by
/// the largest element keeps the products of scales such as 10⁻¹³ or (10⁸, 1, 10⁻⁸) in range, so
/// that a shader can normalise. A transform of rank 1 or 0 has no normals: the identity is returned.
#[must_use]
pub fn normal_from_model(world_from_model: &DMat4) -> Mat3 {
    let linear = DMat3::from_mat4(*world_from_model);
    let largest = |m: &DMat3| m.to_cols_array().iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    let scale = largest(&linear);
    if !(scale > 0.0 && scale.is_finite()) {
        return Mat3::IDENTITY;
    }
    let m = linear * scale.recip();
    let cofactor = DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis));
    let size = largest(&cofactor);
    if !(size > 0.0 && size.is_finite()) {
        return Mat3::IDENTITY;
    }
    let sign = if m.determinant() < 0.0 { -1.0 } else { 1.0 };
    (cofactor * (sign / size)).as_mat3()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DQuat, DVec3, Vec3};

    fn placed(world_from_model: DMat4) -> Instance {
        let bounds = Aabb { min: DVec3::NEG_ONE, max: DVec3::ONE };
        Instance::new("", MeshId::new(0), MaterialId::new(0), world_from_model, &bounds)
    }

    /// The hard cases of scale: (1,1,0), 10⁻¹³, (−1,1,1), (10⁸,1,10⁻⁸). The transformed normal stays
    /// perpendicular to the transformed surface, finite and on the outer side.
    #[test]
    fn normals_survive_hostile_scales() {
        let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 1.1, -0.7);
        for scale in
            [DVec3::splat(1e-13), DVec3::new(-1.0, 1.0, 1.0), DVec3::new(1e8, 1.0, 1e-8), DVec3::new(2.0, 3.0, 0.5)]
        {
            let model = DMat4::from_scale_rotation_translation(scale, turn, DVec3::splat(5.0));
            let matrix = normal_from_model(&model);
            for (normal, along) in [(Vec3::X, DVec3::Y), (Vec3::Y, DVec3::Z), (Vec3::Z, DVec3::X)] {
                let moved = (matrix * normal).as_dvec3();
                assert!(moved.is_finite() && moved.length() > 0.0, "{scale} {moved}");
                let moved = (moved / moved.abs().max_element()).normalize();
                let surface = model.transform_vector3(along).normalize();
                // f32 storage of the matrix: a few times 6e-8.
                assert!(moved.dot(surface).abs() < 1e-6, "{scale}");
                let outward = model.transform_vector3(normal.as_dvec3());
                assert!(moved.dot(outward) > 0.0, "{scale}: normal points inward");
            }
        }
        let flat = normal_from_model(&DMat4::from_scale(DVec3::new(1.0, 1.0, 0.0)));
        assert_eq!(flat * Vec3::Z, Vec3::Z);
        assert_eq!(normal_from_model(&DMat4::ZERO), Mat3::IDENTITY);
    }

    #[test]
    fn mirroring_is_noticed() {
        assert!(placed(DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0))).is_mirrored());
        assert!(!placed(DMat4::from_scale(DVec3::new(-1.0, -1.0, 1.0))).is_mirrored());
    }

    /// At 10⁶ m the subtraction must happen before rounding: a millimeter survives.
    #[test]
    fn relative_transform_subtracts_in_f64() {
        let at = DVec3::new(1e6, 0.0, -1e6);
        let instance = placed(DMat4::from_translation(at + DVec3::new(0.001, 0.0, 0.0)));
        let relative = instance.relative_from_model(at);
        assert!((relative.w_axis.x - 0.001).abs() < 1e-9);
        assert!((instance.world_from_model_f32().w_axis.x - 1e6).abs() < 0.1);
    }
}
