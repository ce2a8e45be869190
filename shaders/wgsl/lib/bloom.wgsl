// Bloom: threshold and downsampling (Jimenez, "Next Generation Post Processing in Call of Duty:
// Advanced Warfare", 2014; Castaño, "Shadow Mapping Summary", 2013).

/// Maximum glow of a texel: a sixteenth of the largest half float, so that sums over levels stay
/// finite.
const BLOOM_MOST: f32 = 4094.0;

/// Returns the weights of four texels in a row, which sum to 1: a tent of three texels around a
/// position `beyond`, 0…1, past the center of the second.
fn tent_weights(beyond: f32) -> vec4<f32> {
    return vec4<f32>(1.0 - beyond, 2.0 - beyond, 1.0 + beyond, beyond) * 0.25;
}

/// Returns the largest channel.
fn brightest(color: vec3<f32>) -> f32 {
    return max(color.r, max(color.g, color.b));
}

/// Returns the weight of a color in a mean, reduced for bright texels (Karis 2013).
fn firefly_weight(color: vec3<f32>) -> f32 {
    return 1.0 / (1.0 + brightest(color));
}

/// Returns the part of a color that glows. If `hard` is 1, it is the whole color above the
/// threshold; if 0, the excess of each channel. The maximum is 1 / `per_highlight`.
fn glowing(color: vec3<f32>, threshold: f32, hard: f32, per_highlight: f32) -> vec3<f32> {
    let soft = max(color - threshold, vec3<f32>(0.0));
    let above = mix(soft, color * step(threshold, brightest(color)), hard);
    return above / (1.0 + brightest(above) * per_highlight);
}
