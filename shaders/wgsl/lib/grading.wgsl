// Color grading of scene-referred light, before the tone curve: the steps in Filament's order,
// which effect/grade.wgsl puts together. Colors are linear in the working primaries, Rec.2020;
// `weights` are those of luminance there. The logarithm is ARRI's LogC for EI 1000 (ARRI, "ALEXA
// LogC Curve", 2012) without its linear toe.

/// LogC from linear light; negatives count as black, which is 0.0640.
fn log_c_from_linear(color: vec3<f32>) -> vec3<f32> {
    let shifted = 5.555556 * clamp(color, vec3<f32>(0.0), vec3<f32>(1e30)) + 0.047996;
    // 0.244161 · log10 x = 0.244161 · log10 2 · log2 x.
    return 0.07349978 * log2(shifted) + 0.386036;
}

/// Linear light from LogC; below black it is negative, by 0.0086 at most.
fn linear_from_log_c(log_c: vec3<f32>) -> vec3<f32> {
    let shifted = exp2(min((log_c - 0.386036) / 0.07349978, vec3<f32>(60.0)));
    return (shifted - 0.047996) / 5.555556;
}

/// Shares of shadows, midtones and highlights in a color of luminance `y`, together 1: shadows end
/// between the first two of `ranges`, highlights begin between the last two.
fn tonal_shares(y: f32, ranges: vec4<f32>) -> vec3<f32> {
    let shadows = 1.0 - smoothstep(ranges.x, ranges.y, y);
    let highlights = smoothstep(ranges.z, ranges.w, y);
    return vec3<f32>(shadows, 1.0 - shadows - highlights, highlights);
}

/// x to the power p for p > 0, and x itself for x ≤ 0, where `pow` is undefined.
fn positive_power(x: f32, p: f32) -> f32 {
    return select(pow(abs(x), p), x, x <= 0.0);
}

/// (color · slope + offset)^power, channel by channel (ASC Color Decision List, 1.2).
fn slope_offset_power(
    color: vec3<f32>,
    slope: vec3<f32>,
    offset: vec3<f32>,
    power: vec3<f32>,
) -> vec3<f32> {
    let base = color * slope + offset;
    return vec3<f32>(
        positive_power(base.x, power.x),
        positive_power(base.y, power.y),
        positive_power(base.z, power.z),
    );
}

/// Distances from `pivot` times `amount`; 1 changes nothing.
fn contrast_about(color: vec3<f32>, pivot: f32, amount: f32) -> vec3<f32> {
    return (color - pivot) * amount + pivot;
}

/// Distances from the grey of equal luminance times `amount`; 1 changes nothing, 0 is grey.
fn saturation(color: vec3<f32>, weights: vec3<f32>, amount: f32) -> vec3<f32> {
    let grey = vec3<f32>(dot(color, weights));
    return grey + (color - grey) * amount;
}

/// Scales saturation by how red a color is, with a logistic curve of slope 3. It applies all of
/// `amount` if red is much larger than the other channels, half of it to grays, and none if red is
/// much smaller.
fn vibrance(color: vec3<f32>, weights: vec3<f32>, amount: f32) -> vec3<f32> {
    let red = clamp(color.x - max(color.y, color.z), -20.0, 20.0);
    return saturation(color, weights, 1.0 + (amount - 1.0) / (1.0 + exp(-3.0 * red)));
}

/// Evaluates a curve for one channel: a power below `middle`, and a line above it.
fn toe_and_shoulder(x: f32, gamma: f32, middle: f32, scale: f32) -> f32 {
    // No branch: where conditions read many uniforms, Mesa 22.3's software driver crashes.
    let toe = positive_power(x, gamma) / pow(middle, gamma - 1.0);
    return select(scale * (x - middle) + middle, toe, x <= middle);
}

/// Changes a color to the luminance of a tone curve at constant hue (Sobotka, "EVILS", 2021). It
/// keeps the saturation while the result fits, and mixes the rest with white.
fn scale_luminance(color: vec3<f32>, weights: vec3<f32>, luminance_out: f32) -> vec3<f32> {
    let peak = max(color.x, max(color.y, color.z));
    // No branch: where conditions read many uniforms, Mesa 22.3's software driver crashes.
    let ratio = max(color / max(peak, 1e-10), vec3<f32>(0.0));
    let luminance = dot(ratio, weights);
    let reserves = vec3<f32>(1.0) - ratio;
    let missing = max(luminance_out - luminance, 0.0);
    let added = missing / max(dot(reserves, weights), 1e-30);
    let scaled = ratio * ((luminance_out - missing) / max(luminance, 1e-30)) + reserves * added;
    return select(scaled, vec3<f32>(luminance_out), peak <= 1e-10);
}
