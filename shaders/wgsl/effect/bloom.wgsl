// Effect: what glows is laid over the picture, with lens flare, as it comes through a dirty lens.

/// Settings of `bloom`. Mirrored by `layout::BloomMixUniforms`.
struct BloomMixUniforms {
    /// What of the glow is added.
    glow: f32,
    /// What of the picture is left.
    picture: f32,
    /// What of the flare is added.
    flare: f32,
    /// Factor on the dirt.
    dirt: f32,
    /// Where in what the glow spans the picture begins, in pixels.
    begin_px: vec2<f32>,
    /// One over the size of what the glow spans, in 1/pixels.
    per_px: vec2<f32>,
}

/// There is lens flare.
override LENS_FLARE: bool = false;
/// There is dirt on the lens.
override LENS_DIRT: bool = false;

@group(0) @binding(0) var<uniform> blooming: BloomMixUniforms;
/// All levels of what glows, added up.
@group(0) @binding(1) var bloom_glow: texture_2d<f32>;
/// Linear filter, clamp to edge.
@group(0) @binding(2) var bloom_sampler: sampler;
@group(0) @binding(3) var bloom_flare: texture_2d<f32>;
/// What dirt on the lens lets light up, over the whole picture.
@group(0) @binding(4) var bloom_dirt: texture_2d<f32>;

/// Scene-referred linear light; alpha stays.
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
