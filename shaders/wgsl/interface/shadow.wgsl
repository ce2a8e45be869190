// Group 0: shadow maps of the sun, one texture layer per cascade, and of punctual lights, which
// share layers of this texture.
//
// A pass binds only the resources that its shader uses: depth or moments.

/// Shadow map. Mirrored by `layout::ShadowMapUniforms`.
struct ShadowMapUniforms {
    /// World to light clip space, reversed-Z.
    clip_from_world: mat4x4<f32>,
    /// World to linear depth: 0 at the near end of the map, 1 at the far end.
    linear_depth: vec4<f32>,
    /// Right axis of the map. Its length is the normal offset, in m where w = 1, for normals in
    /// this direction; it grows with the texel size.
    right: vec3<f32>,
    /// World width of a texel, in m where w = 1; proportional to w.
    texel_right_m: f32,
    /// Up axis of the map, with the normal offset as its length, like `right`.
    up: vec3<f32>,
    /// World height of a texel; proportional to w, or to w² in a warped map.
    texel_up_m: f32,
    /// Depth range of a parallel light's map in m, where w = 1.
    depth_m: f32,
    /// near / (far - near) of a perspective map; 0 for parallel lights.
    near_over_range: f32,
    /// Radius of the light source in m; 0 for a disc at infinity.
    bulb_m: f32,
    /// Tangent of the angular radius of a light source at infinity.
    tan_radius: f32,
    /// Top left corner of the map in its layer, in texture coordinates.
    uv_corner: vec2<f32>,
    /// Size of the map as a share of the layer's width and height.
    uv_scale: f32,
    /// Last mip level of moments that belongs to this map alone.
    last_level: f32,
    /// Index of the layer.
    layer: u32,
    /// Nonzero if the map's perspective is warped to the camera's.
    warped: u32,
}

/// Shadow settings of a view, and the sun's shadow maps. Mirrored by `layout::ShadowUniforms`.
struct ShadowUniforms {
    /// Distance ahead of the eye in m at which each cascade of the sun ends.
    far_ends: vec4<f32>,
    /// Filter of soft shadows: SHADOW_FILTER_DPCF or SHADOW_FILTER_PCSS; 0 without penumbrae.
    filter_kind: u32,
    /// Width and height of a layer in texels.
    texels: f32,
    /// Reciprocal of the squared distance at which the sun's shadows have faded out, in 1/m²; 0 for
    /// no fade.
    inv_far2: f32,
    /// Exponent of the depth warp for moments.
    exponent: f32,
    /// Minimum variance of warped depth, divided by its square.
    variance_floor: f32,
    /// Amount of light bleeding reduction, 0…1.
    bleed: f32,
    /// Length of a contact shadow's ray in m.
    contact_m: f32,
    /// Strength of the sun's shadows, 0…1.
    sun_strength: f32,
    /// Maps of the sun's CASCADES cascades, each of which fills the layer of its index. Not in
    /// `local_maps`, because Mesa's software driver loads storage buffers per fragment.
    cascades: array<ShadowMapUniforms, 4>,
}

/// Values of `ShadowUniforms::filter_kind`.
const SHADOW_FILTER_DPCF: u32 = 1u;
const SHADOW_FILTER_PCSS: u32 = 2u;

/// Number of cascades.
override CASCADES: u32 = 4u;
/// Fades the sun's shadows out at a distance.
override SHADOWS_END: bool = true;
/// Enables shadow maps of punctual lights.
override LAMP_SHADOWS: bool = true;
/// True if the shadow strength of some light is below 1.
override WEAK_SHADOWS: bool = true;
/// Tints surfaces by the index of their cascade.
override SHOW_CASCADES: bool = false;

@group(0) @binding(30) var<uniform> shadow: ShadowUniforms;
/// Shadow maps of punctual lights.
@group(0) @binding(31) var<storage, read> local_maps: array<ShadowMapUniforms>;
/// Depth, reversed: 1 nearest the light, cleared to 0.
@group(0) @binding(32) var shadow_map: texture_depth_2d_array;
/// Linear filter, clamp to edge, compare GreaterEqual.
@group(0) @binding(33) var shadow_sampler: sampler_comparison;
/// Depth, to be read without comparison.
@group(0) @binding(34) var shadow_depth: texture_2d_array<f32>;
/// Moments of warped depth (lib/shadow_moments.wgsl).
@group(0) @binding(35) var shadow_moments: texture_2d_array<f32>;
