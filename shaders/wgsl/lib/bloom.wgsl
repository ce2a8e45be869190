// Bloom: what of a picture glows, and how it is made smaller (Jimenez, "Next Generation Post
// Processing in Call of Duty: Advanced Warfare", 2014; Castaño, "Shadow Mapping Summary", 2013).

/// The most that one texel glows with: a sixteenth of the largest half float, so that sums over
/// levels stay finite.
const BLOOM_MOST: f32 = 4094.0;

/// Weights of four texels in a row, which add up to 1: a tent of three texels about a place that
/// is `beyond`, 0…1, past the middle of the second.
fn tent_weights(beyond: f32) -> vec4<f32> {
    return vec4<f32>(1.0 - beyond, 2.0 - beyond, 1.0 + beyond, beyond) * 0.25;
}

/// The largest channel.
fn brightest(color: vec3<f32>) -> f32 {
    return max(color.r, max(color.g, color.b));
}

/// Weight of a color in a mean that one bright texel does not rule (Karis 2013).
fn firefly_weight(color: vec3<f32>) -> f32 {
    return 1.0 / (1.0 + brightest(color));
}

/// What of a color glows. Where `hard` is 1, all of it from the threshold on; where it is 0, what
/// is above the threshold, channel by channel. Bright glow nears 1 / `per_highlight`.
fn glowing(color: vec3<f32>, threshold: f32, hard: f32, per_highlight: f32) -> vec3<f32> {
    let soft = max(color - threshold, vec3<f32>(0.0));
    let above = mix(soft, color * step(threshold, brightest(color)), hard);
    return above / (1.0 + brightest(above) * per_highlight);
}
