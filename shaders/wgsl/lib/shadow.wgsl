// Shadow map lookups that need no texture: biases, coordinates, filter weights, penumbrae.
//
// Shadow maps are reversed-Z: 1 nearest the light, 0 farthest, cleared to 0. The comparison is
// GreaterEqual: lit if the receiver is at least as near as the map.

/// Returns the offset in m along the receiver's geometric normal that keeps a kernel on the lit
/// side of the receiver's plane. `right` and `up` are the axes of the map, with the reach of the
/// kernel in m as length; `scale` multiplies the reach. The offset is zero facing the light and the
/// whole reach edge-on, where a tangent would be unlimited (hard case 42).
fn normal_offset(
    normal: vec3<f32>,
    right: vec3<f32>,
    up: vec3<f32>,
    scale: vec2<f32>,
) -> vec3<f32> {
    return normal * dot(abs(vec2<f32>(dot(normal, right), dot(normal, up))), scale);
}

/// Returns (u, v, depth) in [0, 1]³ from light clip space; y is flipped because texture rows run
/// downward.
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

/// Returns the taps of the 3×3 tent centered on `uv` in a map of `size` texels (Castaño, "Shadow
/// Mapping Summary", 2013). Column weights are 3 - 2s and 1 + 2s, over 4, with s the position in
/// the texel. The tent spans 3 texels and changes continuously with uv.
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

/// Returns depth per texture coordinate along a receiver's plane, from the change of (u, v, depth)
/// along two directions in it. 0 for edge-on planes (hard case 42).
fn receiver_plane_slope(a: vec3<f32>, b: vec3<f32>) -> vec2<f32> {
    let det = a.x * b.y - a.y * b.x;
    if abs(det) <= 1e-3 * length(a.xy) * length(b.xy) {
        return vec2<f32>(0.0);
    }
    return vec2<f32>(a.z * b.y - b.z * a.y, b.z * a.x - a.z * b.x) / det;
}

/// Returns tap `index` of `count` on a Vogel disc of unit radius (Vogel, "A better way to construct
/// the sunflower head", 1979), rotated by `turn` radians.
fn vogel_tap(index: u32, count: u32, turn: f32) -> vec2<f32> {
    let radius = sqrt((f32(index) + 0.5) / f32(count));
    let angle = f32(index) * 2.3999632 + turn;
    return vec2<f32>(cos(angle), sin(angle)) * radius;
}

/// Returns the share of taps in shadow with increased contrast: a steeper smoothstep, 0 to 1.
fn hardened_kernel(share: f32) -> f32 {
    let x = 2.0 * share - 1.0;
    let s = sign(x);
    let far = 1.0 - s * x;
    return 0.5 * (s - s * far * far * far) + 0.5;
}

/// Returns the distance from blocker to receiver over that from the map's near end to the blocker,
/// for linear reversed depths. Limited for a blocker at the near end (hard case 43).
fn penumbra_ratio_parallel(receiver: f32, blocker: f32) -> f32 {
    return max(blocker - receiver, 0.0) / max(1.0 - blocker, 1e-4);
}

/// Returns the distance from blocker to receiver over that from the light to the blocker, for
/// reversed depths of a perspective with this near / (far - near).
fn penumbra_ratio_perspective(receiver: f32, blocker: f32, near_over_range: f32) -> f32 {
    let ratio = (near_over_range + blocker) / max(near_over_range + receiver, 1e-7);
    return max(ratio - 1.0, 0.0);
}

/// Returns the cascade at a distance ahead of the eye: the number of cascade ends below it.
fn cascade_at(ahead_m: f32, far_ends: vec4<f32>) -> u32 {
    let beyond = vec4<f32>(far_ends < vec4<f32>(ahead_m));
    return u32(dot(beyond, vec4<f32>(1.0)));
}

/// Returns the sun's visibility, faded to one over the last tenth of the shadow distance.
fn faded_visibility(visibility: f32, ahead_m: f32, inv_far2: f32) -> f32 {
    let share = saturate(5.0 - 5.0 * ahead_m * ahead_m * inv_far2);
    return 1.0 - (1.0 - visibility) * share;
}

/// Returns the visibility of a light with this shadow strength, 0…1: one at strength zero,
/// unchanged at strength one.
fn weakened_visibility(visibility: f32, strength: f32) -> f32 {
    return visibility * strength + (1.0 - strength);
}

/// Returns the cube face that a direction points to: +x, -x, +y, -y, +z, -z. Ties go to the first,
/// so that all fragments of an edge agree (hard case 46).
fn cube_face_of(direction: vec3<f32>) -> u32 {
    let a = abs(direction);
    if a.x >= a.y && a.x >= a.z {
        return select(1u, 0u, direction.x >= 0.0);
    }
    if a.y >= a.z {
        return select(3u, 2u, direction.y >= 0.0);
    }
    return select(5u, 4u, direction.z >= 0.0);
}
