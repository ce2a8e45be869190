//! Mirror of `wgsl/interface/frame.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec2, Vec3, Vec4};

/// Camera, sun and ambient light of one view.
///
/// Lights are pre-exposed: photometric quantities are multiplied by [`exposure`](Self::exposure) in f32 on the CPU.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct FrameUniforms {
    /// Clip-to-world matrix.
    pub world_from_clip: Mat4,
    /// World-to-clip matrix, reversed-Z.
    pub clip_from_world: Mat4,
    /// View-to-world matrix.
    pub world_from_view: Mat4,
    /// Perspective: (position in m, 1). Orthographic: (unit vector toward the viewer, 0).
    pub camera: Vec4,
    /// Unit vector toward the sun.
    pub sun_direction: Vec3,
    /// Angular radius of the sun's disc in radians.
    pub sun_angular_radius: f32,
    /// Pre-exposed illuminance of the sun, linear Rec.709; zero without a sun.
    pub sun_illuminance: Vec3,
    /// 1 / (1.2 · 2^EV100), in 1/nits.
    pub exposure: f32,
    /// Width and height of the viewport in pixels.
    pub viewport_size_px: Vec2,
    /// (cosine, sine) of the environment's rotation about +Y.
    pub environment_rotation: Vec2,
    /// Factor from a texel of the environment map to pre-exposed radiance: intensity times exposure.
    pub environment_scale: f32,
    /// Number of punctual lights.
    pub light_count: u32,
    /// Factor from a texel of the specular cube to pre-exposed radiance.
    pub specular_scale: f32,
    /// Last mip level of the specular cube, which is filtered for roughness 1.
    pub roughness_one_lod: f32,
    /// Pre-exposed irradiance / π in 18 coefficients; w is unused. See `irradiance_sh5` in
    /// `lib/sh.wgsl`.
    pub sh: [Vec4; 18],
    /// Scale and offset that map the binary logarithm of a blended surface's distance, in m, to −1…1. Then bias and
    /// overestimation of moments
    /// (`moment_transmittance` in `lib/moment_transparency.wgsl`).
    pub blended: Vec4,
}

/// One eye of a stereo view. Positions are relative to the origin of the view's [`FrameUniforms`].
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct EyeUniforms {
    /// World-to-clip matrix, reversed-Z.
    pub clip_from_world: Mat4,
    /// Perspective: (position in m, 1). Orthographic: (unit vector toward the viewer, 0).
    pub camera: Vec4,
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![
        layout_of!(FrameUniforms {
            world_from_clip,
            clip_from_world,
            world_from_view,
            camera,
            sun_direction,
            sun_angular_radius,
            sun_illuminance,
            exposure,
            viewport_size_px,
            environment_rotation,
            environment_scale,
            light_count,
            specular_scale,
            roughness_one_lod,
            sh,
            blended,
        }),
        layout_of!(EyeUniforms { clip_from_world, camera }),
    ]
}
