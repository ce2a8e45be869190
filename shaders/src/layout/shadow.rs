//! Mirror of `wgsl/interface/shadow.wgsl` and of the shadow pass's view.

use bytemuck::{Pod, Zeroable};
use glam::{IVec2, Mat4, Vec2, Vec3, Vec4};

/// What is the same for all shadow maps of a view, and the maps of the sun.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ShadowUniforms {
    /// Distance ahead of the eye in m at which each cascade of the sun ends.
    pub far_ends: Vec4,
    /// 0 PCF, 1 DPCF, 2 PCSS.
    pub filter_kind: u32,
    /// Width and height of a layer in texels.
    pub texels: f32,
    /// 1/m² of the distance by which the sun's shadows have faded; 0: they do not fade.
    pub inv_far2: f32,
    /// Exponent of the warp of moments.
    pub exponent: f32,
    /// Least variance of warped depth, over its square.
    pub variance_floor: f32,
    /// Share of light that is taken for bled and removed, 0…1.
    pub bleed: f32,
    /// Length of a contact shadow's ray in m.
    pub contact_m: f32,
    /// Darkness of the sun's shadows, 0…1.
    pub sun_strength: f32,
    /// Maps of the sun; zero beyond the last.
    pub cascades: [ShadowMapUniforms; 4],
}

/// One shadow map as shaders read it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ShadowMapUniforms {
    /// World to the light's clip space, reversed-Z.
    pub clip_from_world: Mat4,
    /// World to depth away from the light: 0 at the near end of the map, 1 at the far end.
    pub linear_depth: Vec4,
    /// Across the map, as long in m as receivers are offset along a normal that points there, where w = 1.
    pub right: Vec3,
    /// World size of a texel across in m where w = 1; it grows with w.
    pub texel_right_m: f32,
    /// The same up the map.
    pub up: Vec3,
    /// World size of a texel up the map; it grows with w, of a warped map with w².
    pub texel_up_m: f32,
    /// Meters that a depth of 1 spans where w = 1; of a parallel light.
    pub depth_m: f32,
    /// near / (far - near) of a perspective map; 0 of a parallel light.
    pub near_over_range: f32,
    /// Radius of the light's bulb in m; 0: the light is a disc at infinity.
    pub bulb_m: f32,
    /// Tangent of the angular radius of that disc.
    pub tan_radius: f32,
    /// Top left of the map in its layer, in texture coordinates.
    pub uv_corner: Vec2,
    /// Part of the layer's width and height that the map takes.
    pub uv_scale: f32,
    /// Number of the last level of moments that is the map's own.
    pub last_level: f32,
    /// Which layer.
    pub layer: u32,
    /// Not 0: the map's perspective follows the camera's.
    pub warped: u32,
    /// Padding to 16 bytes; zero.
    pub _pad: [u32; 2],
}

/// The view a shadow map is drawn with; `wgsl/pass/shadow.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ShadowViewUniforms {
    /// World to the light's clip space, reversed-Z.
    pub clip_from_world: Mat4,
    /// World to depth away from the light: 0 at the near end of the map, 1 at the far end.
    pub linear_depth: Vec4,
    /// Exponent of the warp of moments.
    pub exponent: f32,
    /// Padding to 16 bytes; zero.
    pub _pad: [f32; 3],
}

/// A blur of moments along one axis; `wgsl/pass/shadow_blur.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ShadowBlurUniforms {
    /// One texel along the axis: (1, 0) or (0, 1).
    pub step: IVec2,
    /// -1 / (2 σ²) of the Gaussian, σ in texels.
    pub falloff: f32,
    /// Padding to 8 bytes; zero.
    pub _pad: f32,
    /// First and last texel of the map: beyond lies its edge.
    pub first: IVec2,
    /// See `first`.
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
