//! Mirror of `wgsl/interface/shadow.wgsl` and of the shadow pass's view.

use bytemuck::{Pod, Zeroable};
use glam::{IVec2, Mat4, Vec2, Vec3, Vec4};

/// Shadow settings of a view, and the sun's shadow maps.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ShadowUniforms {
    /// Distance ahead of the eye in m at which each cascade of the sun ends.
    pub far_ends: Vec4,
    /// Filter of soft shadows: 0 PCF, 1 DPCF, 2 PCSS.
    pub filter_kind: u32,
    /// Width and height of a layer in texels.
    pub texels: f32,
    /// Reciprocal of the squared distance at which the sun's shadows have faded out, in 1/m²; 0 for no fade.
    pub inv_far2: f32,
    /// Exponent of the depth warp for moments.
    pub exponent: f32,
    /// Minimum variance of warped depth, divided by its square.
    pub variance_floor: f32,
    /// Amount of light bleeding reduction, 0…1.
    pub bleed: f32,
    /// Length of the ray for contact shadows, in m.
    pub contact_m: f32,
    /// Strength of the sun's shadows, 0…1.
    pub sun_strength: f32,
    /// Shadow maps of the sun's cascades; zero after the last.
    pub cascades: [ShadowMapUniforms; 4],
}

/// Shadow map as shaders read it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ShadowMapUniforms {
    /// World to light clip space, reversed-Z.
    pub clip_from_world: Mat4,
    /// World to linear depth: 0 at the near end of the map, 1 at the far end.
    pub linear_depth: Vec4,
    /// Right axis of the map. Its length is the normal offset, in m where w = 1, for normals in this direction.
    pub right: Vec3,
    /// World width of a texel, in m where w = 1; proportional to w.
    pub texel_right_m: f32,
    /// Up axis of the map. Its length is the normal offset, in m where w = 1, for normals in this direction.
    pub up: Vec3,
    /// World height of a texel, in m where w = 1; proportional to w, or to w² in a warped map.
    pub texel_up_m: f32,
    /// Depth range of a parallel light's map in m, where w = 1.
    pub depth_m: f32,
    /// near / (far - near) of a perspective map; 0 for parallel lights.
    pub near_over_range: f32,
    /// Radius of the light source in m; 0 for a disc at infinity.
    pub bulb_m: f32,
    /// Tangent of the angular radius of a light source at infinity.
    pub tan_radius: f32,
    /// Top left corner of the map in its layer, in texture coordinates.
    pub uv_corner: Vec2,
    /// Size of the map as a share of the layer's width and height.
    pub uv_scale: f32,
    /// Last mip level of moments that belongs to this map alone.
    pub last_level: f32,
    /// Index of the layer.
    pub layer: u32,
    /// Nonzero if the map's perspective is warped to the camera's.
    pub warped: u32,
    /// Padding to 16 bytes; zero.
    pub _pad: [u32; 2],
}

/// View that draws a shadow map; `wgsl/pass/shadow.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ShadowViewUniforms {
    /// World to light clip space, reversed-Z.
    pub clip_from_world: Mat4,
    /// World to linear depth: 0 at the near end of the map, 1 at the far end.
    pub linear_depth: Vec4,
    /// Exponent of the depth warp for moments.
    pub exponent: f32,
    /// Padding to 16 bytes; zero.
    pub _pad: [f32; 3],
}

/// Settings of a blur of moments along one axis; `wgsl/pass/shadow_blur.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ShadowBlurUniforms {
    /// Step of one texel along the axis: (1, 0) or (0, 1).
    pub step: IVec2,
    /// -1 / (2 σ²) of the Gaussian, σ in texels.
    pub falloff: f32,
    /// Padding to 8 bytes; zero.
    pub _pad: f32,
    /// First texel of the map; reads are clamped to it.
    pub first: IVec2,
    /// Last texel of the map; reads are clamped to it.
    pub last: IVec2,
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![
        layout_of!(ShadowUniforms {
            far_ends,
            filter_kind,
            texels,
            inv_far2,
            exponent,
            variance_floor,
            bleed,
            contact_m,
            sun_strength,
            cascades,
        }),
        layout_of!(ShadowMapUniforms {
            clip_from_world,
            linear_depth,
            right,
            texel_right_m,
            up,
            texel_up_m,
            depth_m,
            near_over_range,
            bulb_m,
            tan_radius,
            uv_corner,
            uv_scale,
            last_level,
            layer,
            warped,
            _pad,
        }),
        layout_of!(ShadowBlurUniforms { step, falloff, _pad, first, last }),
        layout_of!(ShadowViewUniforms { clip_from_world, linear_depth, exponent, _pad }),
    ]
}
