// Shadow map lookups that need no texture: biases, coordinates and filter weights.
//
// Shadow maps are reversed-Z like every depth here: 1 nearest the light, 0 farthest, cleared
// to 0, compared with GreaterEqual (lit where the receiver is at least as near as the map).

/// Offset in m to add to a receiver's position along its geometric normal: sin θ · bias,
/// with θ between normal and light and bias = `texels` times the world size of a shadow
/// texel. Zero facing the light, the whole bias edge-on, and never more, where a tangent
/// would grow without limit (hard case 42).
fn normal_offset(normal: vec3<f32>, to_light: vec3<f32>, texel_m: f32, texels: f32) -> vec3<f32> {
    let c = saturate(dot(normal, to_light));
    return normal * (sqrt(saturate(1.0 - c * c)) * texel_m * texels);
}

/// (u, v, depth) in [0, 1]³ inside the map from light clip space: y is flipped because
/// texture rows run downward.
fn shadow_uvz_from_clip(clip: vec4<f32>) -> vec3<f32> {
    let ndc = clip.xyz / clip.w;
    return vec3<f32>(ndc.x * 0.5 + 0.5, 0.5 - ndc.y * 0.5, ndc.z);
}

/// Four bilinear taps that together form a 3×3 tent.
struct TentTaps {
    /// (left, right) u and (top, bottom) v of the taps, in texture coordinates.
    u: vec2<f32>,
    v: vec2<f32>,
    /// Weights of the columns and of the rows; both pairs sum to one.
    column_weight: vec2<f32>,
    row_weight: vec2<f32>,
}

/// Taps of the 3×3 tent centred on `uv` of a map of `size` texels (Castaño, "Shadow Mapping
/// Summary", 2013): column weights 3 - 2s and 1 + 2s, over 4, with s the position of the
/// centre within its texel. The tent spans 3 texels each way, without a step as uv moves.
fn tent_3x3(uv: vec2<f32>, size: vec2<f32>) -> TentTaps {
    let texel = uv * size + 0.5;
    let base = floor(texel) - 0.5;
    let s = texel - floor(texel);
    let low = 3.0 - 2.0 * s;
    let high = 1.0 + 2.0 * s;
    let low_offset = (2.0 - s) / low - 1.0;
    let high_offset = s / high + 1.0;
    return TentTaps(
        vec2<f32>(base.x + low_offset.x, base.x + high_offset.x) / size.x,
        vec2<f32>(base.y + low_offset.y, base.y + high_offset.y) / size.y,
        vec2<f32>(low.x, high.x) * 0.25,
        vec2<f32>(low.y, high.y) * 0.25,
    );
}
