//! Mirrors of the structs of ambient occlusion: `wgsl/lib/unproject.wgsl`, `wgsl/pass/occlusion.wgsl` and
//! `wgsl/pass/bilateral.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::{DMat4, IVec2, Vec2, Vec4};

/// Coefficients of a projection, from which view-space positions are reconstructed; see `lib/unproject.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Projection {
    /// Coefficients of z and w in clip space.
    pub depth: Vec4,
    /// Coefficients of view-space x and y in clip-space x and y.
    pub scale: Vec2,
    /// Coefficients of view-space z in clip-space x and y.
    pub slide: Vec2,
    /// Constant terms of clip-space x and y.
    pub offset: Vec2,
    /// Padding.
    pub _pad: Vec2,
}

impl Projection {
    /// Extracts the coefficients of a view-to-clip matrix, whose x and y must be independent. Perspective and
    /// orthographic projections qualify, with jitter or off-center.
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

/// Settings of cone tracing toward the dominant light.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ConeUniforms {
    /// Length of a cone, in m.
    pub reach_m: f32,
    /// Tangent of the half angle at the tip.
    pub tangent: f32,
    /// Maximum distance in front of a cone at which a surface counts as contact, in m.
    pub contact_m: f32,
    /// Depth bias, in m: surfaces that fill less of a slice are ignored.
    pub bias_m: f32,
    /// Additional depth bias for surfaces that are edge-on to the light, in m.
    pub slope_bias_m: f32,
    /// Factor on the occlusion.
    pub intensity: f32,
    /// Number of slices per cone.
    pub steps: f32,
    /// Number of cones.
    pub rays: f32,
}

/// Settings of one pass of ambient occlusion.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct OcclusionUniforms {
    /// Projection of the view.
    pub projection: Projection,
    /// Maximum distance of occluders, in m.
    pub radius_m: f32,
    /// Size of the radius in texels of level 0, at a distance of 1 m from the eye.
    pub radius_texels: f32,
    /// Maximum size of the radius, in texels.
    pub most_texels: f32,
    /// Height above the tangent plane that occludes nothing, as a fraction of the distance from the eye.
    pub bias: f32,
    /// Factor on the obscurance.
    pub intensity: f32,
    /// Exponent of the visibility.
    pub power: f32,
    /// Squared sine of the minimum angle above the tangent plane that occludes.
    pub min_sin2: f32,
    /// Index of the depth pyramid's last level.
    pub last_level: i32,
    /// Cosine and sine of the angle between taps of the spiral.
    pub tap_rotation: Vec2,
    /// Number of taps in the spiral.
    pub taps: f32,
    /// Reciprocal tap spacing, 1 / (taps - ½).
    pub per_tap: f32,
    /// Number of slices.
    pub slices: f32,
    /// Number of steps on each side of a slice.
    pub steps: f32,
    /// Exponent of the step distribution along a slice.
    pub step_power: f32,
    /// Thickness of occluders behind their front, in m, for the visibility bitmask.
    pub thickness_m: f32,
    /// Cones toward the dominant light.
    pub cone: ConeUniforms,
}

/// Settings of one direction of the bilateral blur.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct BilateralUniforms {
    /// Copy of [`Projection::depth`].
    pub depth: Vec4,
    /// Step between samples, in texels.
    pub axis: IVec2,
    /// Distance between surfaces, in m, at which the weight reaches zero.
    pub threshold_m: f32,
    /// Padding to 16 bytes; zero.
    pub _pad: f32,
    /// Weight of the center, followed by the weights of samples at increasing distance.
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
