// Contrast-adaptive sharpening of a texel by its four neighbors.
//
// RCAS of AMD's FidelityFX Super Resolution 1.0 (2021). It subtracts as much of the neighbors as
// keeps all channels in 0…1, and at most 3/16 of each neighbor.

/// Maximum share that is subtracted of a neighbor.
const MAX_SHARPENED: f32 = 0.1875;

/// Sharpens a texel by its four neighbors; `strength` is 0…1. Channels above 1 are unchanged.
fn sharpened(
    middle: vec3<f32>,
    up: vec3<f32>,
    left: vec3<f32>,
    right: vec3<f32>,
    down: vec3<f32>,
    strength: f32,
) -> vec3<f32> {
    let least = min(min(up, left), min(right, down));
    let most = max(max(up, left), max(right, down));
    let to_black = min(least, middle) / max(4.0 * most, vec3<f32>(1e-5));
    let to_white = (1.0 - max(most, middle)) / min(4.0 * least - 4.0, vec3<f32>(-1e-5));
    let lobes = max(-to_black, to_white);
    let lobe = clamp(max(lobes.x, max(lobes.y, lobes.z)), -MAX_SHARPENED, 0.0) * strength;
    return (middle + lobe * (up + left + right + down)) / (1.0 + 4.0 * lobe);
}
