// Group 0: data that stays the same for a whole frame.
//
// A pass binds only the members of this group that its entry points use (see
// `reflect::EntryPoint::bindings`). A shadow map cannot be an attachment and a sampled texture in
// the same pass, so depth passes bind only the uniforms.
//
// Pre-exposed quantities are photometric values times `exposure`, multiplied on the CPU in f32: 110
// 000 lux overflows a half float, 2.8 does not (hard case 19).

/// View, sun and ambient light of the frame. Mirrored by `layout::FrameUniforms`.
struct FrameUniforms {
    /// Clip-to-world matrix. It comes first because fragments are not shaded with it: see
    /// examples/tests/it/memory.rs.
    world_from_clip: mat4x4<f32>,
    /// World-to-clip matrix, reversed-Z: depth 1 at the near plane, 0 at the far plane.
    clip_from_world: mat4x4<f32>,
    /// View-to-world matrix; the camera looks along -Z of view space.
    world_from_view: mat4x4<f32>,
    /// Perspective: (position in m, 1). Orthographic: (unit vector toward the viewer, 0).
    camera: vec4<f32>,
    /// Unit vector toward the sun.
    sun_direction: vec3<f32>,
    /// Angular radius of the sun's disc in radians; 0.00465 for the real one.
    sun_angular_radius: f32,
    /// Pre-exposed illuminance on a surface facing the sun, linear Rec.709; zero without a sun.
    sun_illuminance: vec3<f32>,
    /// 1 / (1.2 · 2^EV100), in 1/nits.
    exposure: f32,
    /// Size of the viewport in pixels.
    viewport_size_px: vec2<f32>,
    /// (cosine, sine) of the environment's rotation about Y, applied to world directions before
    /// lookups.
    environment_rotation: vec2<f32>,
    /// Factor from texels of the environment map to pre-exposed radiance.
    environment_scale: f32,
    /// Number of elements of `lights` in use.
    light_count: u32,
    /// Factor from texels of the specular cube to pre-exposed radiance.
    specular_scale: f32,
    /// Number of the specular cube's last level, which is filtered with roughness 1.
    roughness_one_lod: f32,
    /// Pre-exposed irradiance / π of the environment; xyz of each, in the order that
    /// `irradiance_sh5` of lib/sh.wgsl states. Bands that were not projected are zero.
    sh: array<vec4<f32>, 18>,
    /// Scale and offset that map the binary logarithm of a blended surface's distance, in m, to
    /// -1…1. z and w are bias and overestimation of moments.
    blended: vec4<f32>,
}

/// Data of one eye of a stereo view. Mirrored by `layout::EyeUniforms`.
struct EyeUniforms {
    /// World-to-clip matrix of the eye.
    clip_from_world: mat4x4<f32>,
    /// As in `FrameUniforms`.
    camera: vec4<f32>,
}

/// Punctual light. Mirrored by `layout::LightUniforms`.
struct LightUniforms {
    /// Position in m, world space; unused by directional lights.
    position: vec3<f32>,
    /// 1/range² in 1/m²; zero for an unlimited range.
    inv_range2: f32,
    /// Pre-exposed intensity, linear Rec.709: candela for point and spot lights, lux for
    /// directional ones.
    intensity: vec3<f32>,
    /// LIGHT_DIRECTIONAL, LIGHT_POINT or LIGHT_SPOT.
    kind: u32,
    /// Unit vector the light travels along; unused by point lights.
    direction: vec3<f32>,
    /// 1 / max(cos inner - cos outer, 0.001).
    spot_scale: f32,
    /// -cos outer · spot_scale.
    spot_offset: f32,
    /// Number of the light's first shadow map, starting at 1; 0 if the light casts no shadows.
    shadow_map: u32,
    /// Shadow strength, 0…1.
    shadow_strength: f32,
    /// Light channels in bits 0 to 7.
    channels: u32,
}

/// Values of `LightUniforms::kind`.
const LIGHT_DIRECTIONAL: u32 = 0u;
const LIGHT_POINT: u32 = 1u;
const LIGHT_SPOT: u32 = 2u;

@group(0) @binding(0) var<uniform> frame: FrameUniforms;
/// Left and right eye. Positions are relative to the origin of `frame` for both.
@if(STEREO)
@group(0) @binding(53) var<uniform> eyes: array<EyeUniforms, 2>;
@group(0) @binding(1) var<storage, read> lights: array<LightUniforms>;
/// Equirectangular radiance of the visible environment, linear Rec.709.
@group(0) @binding(4) var environment_map: texture_2d<f32>;
/// Trilinear filter, repeat in u, clamp in v.
@group(0) @binding(5) var environment_sampler: sampler;
/// The tables of lib/dfg.wgsl in red and green, cloth in blue; square.
@group(0) @binding(6) var dfg_table: texture_2d<f32>;
/// Trilinear filter, clamp to edge; shared by the DFG table and the specular cube to save samplers.
@group(0) @binding(7) var light_sampler: sampler;
/// Prefiltered radiance, one roughness per level (lib/image_light.wgsl).
@group(0) @binding(8) var specular_map: texture_cube<f32>;
