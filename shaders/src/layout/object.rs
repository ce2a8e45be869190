//! Mirror of `wgsl/interface/object.wgsl`: the transform of an object.

use bytemuck::{Pod, Zeroable};
use glam::{DMat3, DVec3, Mat4, Vec3, Vec4};

/// Transform of an object; one element of the `objects` array.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct ObjectUniforms {
    /// Model-to-world matrix. Its translation is relative to the object's reference point, in m.
    pub world_from_model: Mat4,
    /// First column of the normal matrix: cofactors of the upper 3×3, scaled to a largest entry of one, times the sign
    /// of the determinant.
    pub normal_column_x: Vec3,
    /// Sign of the determinant of `world_from_model`: -1 for mirrored objects, else 1.
    pub handedness: f32,
    /// Second column of the normal matrix.
    pub normal_column_y: Vec3,
    /// Index of the object's material in the scene.
    pub material: u32,
    /// Third column of the normal matrix.
    pub normal_column_z: Vec3,
    /// Index of the reference point in `origins`.
    pub reference_point: u32,
}

/// Transform and position of an object, as an element of the instance stream.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct ObjectAttributes {
    /// First column of the model-to-world matrix.
    pub column_x: Vec4,
    /// Second column of the model-to-world matrix.
    pub column_y: Vec4,
    /// Third column of the model-to-world matrix.
    pub column_z: Vec4,
    /// Origin of the object's mesh relative to the eye in m, in xyz.
    pub origin: Vec4,
    /// First column of the normal matrix; w is the sign of the determinant.
    pub normal_column_x: Vec4,
    /// Second column of the normal matrix.
    pub normal_column_y: Vec3,
    /// Index of the object's material in the scene.
    pub material: u32,
    /// Third column of the normal matrix.
    pub normal_column_z: Vec3,
    /// Index of the object.
    pub number: u32,
}

impl ObjectAttributes {
    /// Packs the attributes of an object.
    #[must_use]
    pub fn new(number: u32, object: &ObjectUniforms, origin: Vec4) -> Self {
        let ObjectUniforms { world_from_model: m, handedness, material, .. } = *object;
        Self {
            column_x: m.x_axis,
            column_y: m.y_axis,
            column_z: m.z_axis,
            origin,
            normal_column_x: object.normal_column_x.extend(handedness),
            normal_column_y: object.normal_column_y,
            material,
            normal_column_z: object.normal_column_z,
            number,
        }
    }
}

impl ObjectUniforms {
    /// Packs a transform, with material and reference point 0.
    ///
    /// Normals are transformed by the cofactors of the upper 3×3, which exist even without an inverse transpose: a
    /// flattened object keeps the normal of its plane. The cofactors are computed in f64 from the matrix divided by its
    /// largest entry. They are scaled to a largest entry of one and multiplied by the sign of the determinant. Scales
    /// from 1e-13 to 1e8 therefore neither overflow nor underflow (accuracy, hard case 38).
    pub fn new(world_from_model: Mat4) -> Self {
        let m = glam::Mat3::from_mat4(world_from_model).as_dmat3();
        let m = scaled_to_one(m);
        let cofactor = DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis));
        let sign = if m.x_axis.dot(cofactor.x_axis) < 0.0 { -1.0 } else { 1.0 };
        let normal = scaled_to_one(cofactor) * sign;
        Self {
            world_from_model,
            normal_column_x: normal.x_axis.as_vec3(),
            handedness: sign as f32,
            normal_column_y: normal.y_axis.as_vec3(),
            material: 0,
            normal_column_z: normal.z_axis.as_vec3(),
            reference_point: 0,
        }
    }
}

/// Returns the matrix divided by its entry of largest magnitude; the zero matrix is unchanged.
fn scaled_to_one(m: DMat3) -> DMat3 {
    let largest = |v: DVec3| v.abs().max_element();
    let largest = largest(m.x_axis).max(largest(m.y_axis)).max(largest(m.z_axis));
    if largest > 0.0 { m * (1.0 / largest) } else { m }
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![layout_of!(ObjectUniforms {
        world_from_model,
        normal_column_x,
        handedness,
        normal_column_y,
        material,
        normal_column_z,
        reference_point,
    })]
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Quat;

    fn world_normal(m: Mat4, n: Vec3) -> Vec3 {
        let o = ObjectUniforms::new(m);
        let columns = [o.normal_column_x, o.normal_column_y, o.normal_column_z];
        let sum: Vec3 = columns.iter().zip(n.to_array()).map(|(c, x)| *c * x).sum();
        sum.as_dvec3().normalize_or_zero().as_vec3()
    }

    #[test]
    fn a_normal_stays_perpendicular_to_its_surface() {
        let turn = Quat::from_axis_angle(Vec3::new(1.0, 2.0, 3.0).normalize(), 0.7);
        let m = Mat4::from_scale_rotation_translation(Vec3::new(1.0, -3.0, 0.2), turn, Vec3::new(5.0, 6.0, 7.0));
        let (t, b) = (Vec3::new(1.0, 1.0, 0.0), Vec3::new(0.0, 1.0, -1.0));
        let n = world_normal(m, t.cross(b).normalize());
        assert!(n.dot(m.transform_vector3(t)).abs() < 1e-5, "f32 rounding of unit vectors");
        assert!(n.dot(m.transform_vector3(b)).abs() < 1e-5);
    }

    #[test]
    fn a_mirror_turns_no_normal_inside_out() {
        let mirror = Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0));
        assert_eq!(ObjectUniforms::new(mirror).handedness, -1.0);
        assert_eq!(world_normal(mirror, Vec3::X), Vec3::NEG_X);
        assert_eq!(world_normal(mirror, Vec3::Y), Vec3::Y);
        let all = Mat4::from_scale(-Vec3::ONE);
        assert_eq!(world_normal(all, Vec3::Z), Vec3::NEG_Z);
    }

    #[test]
    fn extreme_scales_stay_finite_and_keep_their_sign() {
        for scale in [
            Vec3::splat(1e-13),
            Vec3::new(1e8, 1.0, 1e-8),
            Vec3::new(-1e8, 1.0, 1e-8),
            Vec3::splat(1e15),
            Vec3::new(1e-20, 1e-20, -1e-20),
        ] {
            let m = Mat4::from_scale(scale);
            let o = ObjectUniforms::new(m);
            assert_eq!(o.handedness, scale.to_array().iter().product::<f32>().signum(), "{scale}");
            for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
                let expected = (axis * scale).as_dvec3().normalize().as_vec3();
                assert_eq!(world_normal(m, axis), expected, "{scale}");
            }
        }
    }

    /// Verifies that half floats can hold the matrix, whichever axis is the longest.
    #[test]
    fn the_largest_entry_of_the_normal_matrix_is_one() {
        for scale in [[1.0, 2.0, 3.0], [3.0, 1.0, 2.0], [2.0, 3.0, 1.0], [1e4, 1e-4, 1.0], [1e-4, 1.0, 1e4]] {
            let o = ObjectUniforms::new(Mat4::from_scale(Vec3::from(scale)));
            let columns = [o.normal_column_x, o.normal_column_y, o.normal_column_z];
            let largest = columns.iter().map(|column| column.abs().max_element()).fold(0.0, f32::max);
            assert!((largest - 1.0).abs() < 1e-6, "{scale:?}: {largest}");
        }
    }

    #[test]
    fn a_flattened_object_keeps_the_normal_of_its_plane() {
        let m = Mat4::from_scale(Vec3::new(1.0, 1.0, 0.0));
        assert_eq!(world_normal(m, Vec3::Z), Vec3::Z);
        assert_eq!(world_normal(m, Vec3::X), Vec3::ZERO);
        let point = ObjectUniforms::new(Mat4::from_scale(Vec3::ZERO));
        assert!(point.normal_column_x.is_finite());
        assert_eq!(point.handedness, 1.0);
    }
}
