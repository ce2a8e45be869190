// Color grading of scene-referred light, before the tone curve.
//
// The order is Filament's: white balance in linear light, slope, offset, power and contrast in
// a logarithm, vibrance and saturation in linear light. The logarithm is ARRI's LogC for EI
// 1000 (ARRI, "ALEXA LogC Curve", 2012) without its linear toe.

import package::lib::luminance::luminance;

/// LogC of 18 % grey: what contrast leaves where it is.
const LOG_C_GREY: f32 = 0.39100703;

/// LogC from linear light; negatives count as black.
fn log_c_from_linear(color: vec3<f32>) -> vec3<f32> {
    let shifted = 5.555556 * max(color, vec3<f32>(0.0)) + 0.047996;
    // 0.244161 · log10 x = 0.244161 · log10 2 · log2 x.
    return 0.07349978 * log2(shifted) + 0.386036;
}

/// Linear light from LogC; never negative.
fn linear_from_log_c(log_c: vec3<f32>) -> vec3<f32> {
    let shifted = exp2((log_c - 0.386036) / 0.07349978);
    return max((shifted - 0.047996) / 5.555556, vec3<f32>(0.0));
}

/// x to the power p for p > 0, and 0 for x ≤ 0, where `pow` is undefined.
fn positive_power(x: f32, p: f32) -> f32 {
    if x <= 0.0 {
        return 0.0;
    }
    return pow(x, p);
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
fn saturation(color: vec3<f32>, amount: f32) -> vec3<f32> {
    let grey = vec3<f32>(luminance(color));
    return grey + (color - grey) * amount;
}

/// Saturation that spares reds, and with them skin: the amount falls back to 1 as red exceeds
/// the other channels, by a logistic curve of slope 3.
fn vibrance(color: vec3<f32>, amount: f32) -> vec3<f32> {
    let red = color.x - max(color.y, color.z);
    return saturation(color, 1.0 + (amount - 1.0) / (1.0 + exp(3.0 * clamp(red, -20.0, 20.0))));
}
