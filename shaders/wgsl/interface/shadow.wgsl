// Group 0: shadow maps of the sun, a layer each of one texture, and of local lights, which share
// layers of it.
//
// A pass binds only those that its shader reaches: depth, or moments.

/// One map. Mirrored by `layout::ShadowMapUniforms`.
struct ShadowMapUniforms {
    /// World to the light's clip space, reversed-Z.
    clip_from_world: mat4x4<f32>,
    /// World to depth away from the light: 0 at the near end of the map, 1 at the far end.
    linear_depth: vec4<f32>,
    /// Across the map, as long in m as receivers are offset along a normal that points there,
    /// where w = 1; it grows as texels do.
    right: vec3<f32>,
    /// World size of a texel across in m where w = 1; it grows with w.
    texel_right_m: f32,
    /// The same up the map.
    up: vec3<f32>,
    /// World size of a texel up the map; it grows with w, of a warped map with w².
    texel_up_m: f32,
    /// Meters that a depth of 1 spans where w = 1; of a parallel light.
    depth_m: f32,
    /// near / (far - near) of a perspective map; 0 of a parallel light.
    near_over_range: f32,
    /// Radius of the light's bulb in m; 0: the light is a disc at infinity.
    bulb_m: f32,
    /// Tangent of the angular radius of that disc.
    tan_radius: f32,
    /// Top left of the map in its layer, in texture coordinates.
    uv_corner: vec2<f32>,
    /// Part of the layer's width and height that the map takes.
    uv_scale: f32,
    /// Number of the last level of moments that is the map's own.
    last_level: f32,
    /// Which layer.
    layer: u32,
    /// Not 0: the map's perspective follows the camera's.
    warped: u32,
}

/// What is the same for all maps of a view, and the maps of the sun. Mirrored by
/// `layout::ShadowUniforms`.
struct ShadowUniforms {
    /// Distance ahead of the eye in m at which each cascade of the sun ends.
    far_ends: vec4<f32>,
    /// How penumbrae are found: SHADOW_FILTER_DPCF or SHADOW_FILTER_PCSS; 0 where there are none.
    filter_kind: u32,
    /// Width and height of a layer in texels.
    texels: f32,
    /// 1/m² of the distance by which the sun's shadows have faded; 0: they do not fade.
    inv_far2: f32,
    /// Exponent of the warp of moments.
    exponent: f32,
    /// Least variance of warped depth, over its square.
    variance_floor: f32,
    /// Share of light that is taken for bled and removed, 0…1.
    bleed: f32,
    /// Length of a contact shadow's ray in m.
    contact_m: f32,
    /// Darkness of the sun's shadows, 0…1.
    sun_strength: f32,
    /// Maps of the sun, CASCADES of them, each of which takes the whole layer of its number. Not
    /// with the others: Mesa's software driver loads from storage fragment by fragment.
    cascades: array<ShadowMapUniforms, 4>,
}

/// Values of `ShadowUniforms::filter_kind`.
const SHADOW_FILTER_DPCF: u32 = 1u;
const SHADOW_FILTER_PCSS: u32 = 2u;

/// How many cascades there are.
override CASCADES: u32 = 4u;
/// Whether the sun's shadows end at a distance, and not where nothing is left to fall on.
override SHADOWS_END: bool = true;
/// Whether there are maps of local lights.
override LAMP_SHADOWS: bool = true;
/// Whether the shadows of a light are weaker than 1.
override WEAK_SHADOWS: bool = true;
/// Tint what is lit by the number of its cascade.
override SHOW_CASCADES: bool = false;

@group(0) @binding(30) var<uniform> shadow: ShadowUniforms;
/// Maps of local lights.
@group(0) @binding(31) var<storage, read> local_maps: array<ShadowMapUniforms>;
/// Depth, reversed: 1 nearest the light, cleared to 0.
@group(0) @binding(32) var shadow_map: texture_depth_2d_array;
/// Linear filter, clamp to edge, compare GreaterEqual.
@group(0) @binding(33) var shadow_sampler: sampler_comparison;
/// The same depth, to be read without comparing.
@group(0) @binding(34) var shadow_depth: texture_2d_array<f32>;
/// Moments of warped depth (lib/shadow_moments.wgsl).
@group(0) @binding(35) var shadow_moments: texture_2d_array<f32>;
