// Attenuation of punctual lights, as KHR_lights_punctual specifies it.

import package::lib::math::sq;

/// Minimum squared distance, in m². Closer lights shine as from 1 cm, so that 1/d² stays finite and
/// fits a half float (hard case 16).
const PUNCTUAL_MIN_DISTANCE2: f32 = 1e-4;

/// Returns inverse square falloff times the range window, in 1/m².
///
/// distance2 in m²; inv_range2 = 1/range² in 1/m², zero for unlimited range (the CPU rejects range
/// = 0; hard case 17). window = max(min(1 - (d/range)⁴, 1), 0).
fn distance_attenuation(distance2: f32, inv_range2: f32) -> f32 {
    let window = saturate(1.0 - sq(distance2 * inv_range2));
    return window / max(distance2, PUNCTUAL_MIN_DISTANCE2);
}

/// Returns inverse square falloff times Filament's range window, in 1/m². The window is the square
/// of glTF's and darker near the range. Arguments as in `distance_attenuation`.
fn distance_attenuation_squared(distance2: f32, inv_range2: f32) -> f32 {
    let window = saturate(1.0 - sq(distance2 * inv_range2));
    return window * window / max(distance2, PUNCTUAL_MIN_DISTANCE2);
}

/// Returns the fade factor of punctual lights on a surface far from the eye, as in Filament. It is
/// 1 up to 0.894 of the far distance, 0.5 at 0.949 and 0 beyond. `eye_distance2` in m²; inv_far2 =
/// 1/far² in 1/m².
fn light_far_fade(eye_distance2: f32, inv_far2: f32) -> f32 {
    return saturate(5.0 - 5.0 * (eye_distance2 * inv_far2));
}

/// Returns the cone falloff of a spot light in [0, 1]. `cos_angle` is the cosine between the spot's
/// axis and the direction from the light. The CPU computes scale = 1/max(cos inner - cos outer,
/// 0.001) and offset = -cos outer · scale, so equal angles cannot divide by zero (hard case 18).
fn spot_attenuation(cos_angle: f32, scale: f32, offset: f32) -> f32 {
    return sq(saturate(cos_angle * scale + offset));
}
