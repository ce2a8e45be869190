//! Mirrors of the structs of ambient occlusion: `wgsl/lib/unproject.wgsl`, `wgsl/pass/occlusion.wgsl` and
//! `wgsl/pass/bilateral.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::{DMat4, IVec2, Vec2, Vec4};

/// The numbers of a projection, from which positions in view space are made of depth; see
/// [`unproject`](crate::reference::unproject).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Projection {
    /// What z and w of clip space are made of.
    pub depth: Vec4,
    /// Factors on x and y.
    pub scale: Vec2,
    /// Factors on z.
    pub slide: Vec2,
    /// What is added.
    pub offset: Vec2,
    /// Padding.
    pub _pad: Vec2,
}

impl Projection {
    /// Of the matrix from view to clip space, whose x and y must not mix: central and parallel projections, jittered or off
    /// the middle.
    pub fn new(clip_from_view: &DMat4) -> Self {
        let DMat4 { x_axis, y_axis, z_axis, w_axis } = *clip_from_view;
        Self {
            depth: Vec4::new(z_axis.z as f32, w_axis.z as f32, z_axis.w as f32, w_axis.w as f32),
            scale: Vec2::new(x_axis.x as f32, y_axis.y as f32),
            slide: z_axis.truncate().truncate().as_vec2(),
            offset: w_axis.truncate().truncate().as_vec2(),
            _pad: Vec2::ZERO,
        }
    }
}

/// Cones toward the dominant light.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ConeUniforms {
    /// Length, in m.
    pub reach_m: f32,
    /// Tangent of half the angle at the tip.
    pub tangent: f32,
    /// How far in front of a cone something may be and still touch it, in m.
    pub contact_m: f32,
    /// What fills less of a slice than this, in m, fills nothing.
    pub bias_m: f32,
    /// What a surface edge-on to the light has in addition, in m.
    pub slope_bias_m: f32,
    /// Factor on what is shadowed.
    pub intensity: f32,
    /// Slices of a cone.
    pub steps: f32,
    /// Cones.
    pub rays: f32,
}

/// Settings of one pass of ambient occlusion.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct OcclusionUniforms {
    /// Of the view.
    pub projection: Projection,
    /// How far occluders count, in m.
    pub radius_m: f32,
    /// Texels of level 0 that the radius spans a meter ahead of the eye.
    pub radius_texels: f32,
    /// The most texels that the radius may span.
    pub most_texels: f32,
    /// Rise over the tangent plane that occludes nothing, a share of the distance from the eye.
    pub bias: f32,
    /// Factor on what is obscured.
    pub intensity: f32,
    /// Exponent of what is not obscured.
    pub power: f32,
    /// Squared sine of the least angle over the tangent plane that occludes.
    pub min_sin2: f32,
    /// Number of the structure's last level.
    pub last_level: i32,
    /// Cosine and sine of the angle from tap to tap of the spiral.
    pub tap_rotation: Vec2,
    /// Taps of the spiral.
    pub taps: f32,
    /// 1 / (taps - ½).
    pub per_tap: f32,
    /// Slices.
    pub slices: f32,
    /// Steps on either side of each.
    pub steps: f32,
    /// Exponent of the share of the way from step to step.
    pub step_power: f32,
    /// How far behind its front something still occludes, in m, for a bitmask.
    pub thickness_m: f32,
    /// Toward the dominant light.
    pub cone: ConeUniforms,
}

/// Settings of one direction of the bilateral blur.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct BilateralUniforms {
    /// [`Projection::depth`].
    pub depth: Vec4,
    /// Texels from sample to sample.
    pub axis: IVec2,
    /// Distance between surfaces, in m, from which on one does not count for the other.
    pub threshold_m: f32,
    /// Padding to 16 bytes; zero.
    pub _pad: f32,
    /// Weight of the middle, then of the samples away from it.
    pub weights: [Vec4; 4],
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![
        layout_of!(Projection { depth, scale, slide, offset, _pad }),
        layout_of!(OcclusionUniforms {
            projection,
            radius_m,
            radius_texels,
            most_texels,
            bias,
            intensity,
            power,
            min_sin2,
            last_level,
            tap_rotation,
            taps,
            per_tap,
            slices,
            steps,
            step_power,
            thickness_m,
            cone,
        }),
        layout_of!(ConeUniforms { reach_m, tangent, contact_m, bias_m, slope_bias_m, intensity, steps, rays }),
        layout_of!(BilateralUniforms { depth, axis, threshold_m, _pad, weights }),
    ]
}
