// Effect: adds bloom and lens flare to the image, with dirt on the lens.

/// Settings of `bloom`. Mirrored by `layout::BloomMixUniforms`.
struct BloomMixUniforms {
    /// Weight of the glow.
    glow: f32,
    /// Weight of the image.
    picture: f32,
    /// Weight of the flare.
    flare: f32,
    /// Factor on the lens dirt.
    dirt: f32,
    /// Position of the image in the area of the bloom texture, in pixels.
    begin_px: vec2<f32>,
    /// Reciprocal of the size of that area, in 1/pixels.
    per_px: vec2<f32>,
}

/// Adds the lens flare.
override LENS_FLARE: bool = false;
/// Applies the dirt on the lens.
override LENS_DIRT: bool = false;

@group(0) @binding(0) var<uniform> blooming: BloomMixUniforms;
/// Sum of all levels of the glow.
@group(0) @binding(1) var bloom_glow: texture_2d<f32>;
/// Linear filter, clamp to edge.
@group(0) @binding(2) var bloom_sampler: sampler;
@group(0) @binding(3) var bloom_flare: texture_2d<f32>;
/// Lens dirt texture, stretched over the image.
@group(0) @binding(4) var bloom_dirt: texture_2d<f32>;

/// Adds bloom to scene-referred linear light; alpha is unchanged.
fn bloom(color: vec4<f32>, pixel: vec2<f32>) -> vec4<f32> {
    let uv = (pixel + blooming.begin_px) * blooming.per_px;
    var added = textureSampleLevel(bloom_glow, bloom_sampler, uv, 0.0).rgb * blooming.glow;
    if LENS_FLARE {
        added += textureSampleLevel(bloom_flare, bloom_sampler, uv, 0.0).rgb * blooming.flare;
    }
    if LENS_DIRT {
        added *= textureSampleLevel(bloom_dirt, bloom_sampler, uv, 0.0).rgb * blooming.dirt;
    }
    return vec4<f32>(color.rgb * blooming.picture + added, color.a);
}
