// Lens flare in the picture's own space (Chapman, "Pseudo Lens Flare", 2017), as Filament has it.

/// 1 at `middle`, falling smoothly to 0 at `reach` on both sides.
fn flare_ring(x: f32, middle: f32, reach: f32) -> f32 {
    let t = min(abs(x - middle) / max(reach, 1e-6), 1.0);
    return 1.0 - t * t * (3.0 - 2.0 * t);
}

/// Where ghost `number` of what is seen at `uv` comes from, in 0…1.
fn ghost_place(uv: vec2<f32>, spacing: f32, number: f32) -> vec2<f32> {
    let mirrored = 1.0 - uv;
    return fract(mirrored + (0.5 - mirrored) * spacing * number);
}

/// Unit vector toward the middle of a picture that is `aspect` times as wide as high, in its own
/// coordinates. Off the middle by a ten-thousandth, where it would have no direction.
fn flare_direction(uv: vec2<f32>, aspect: f32) -> vec2<f32> {
    let v = (0.5001 - uv) * vec2<f32>(aspect, 1.0);
    return v * inverseSqrt(max(dot(v, v), 1e-12)) * vec2<f32>(1.0 / aspect, 1.0);
}

/// Noise of 256 cells a unit, 0.5…1, smooth in between: Filament has a texture of random numbers.
fn starburst_noise(x: f32) -> f32 {
    let at = fract(x) * 256.0 - 0.5;
    let cell = floor(at);
    let hash = fract(sin((vec2<f32>(cell, cell + 1.0) + 256.0) % 256.0 * 12.9898) * 437.585453);
    return 0.5 + 0.5 * mix(hash.x, hash.y, at - cell);
}

/// Share of the flare that is left at `uv`: rays about the middle, which is whole; they turn with
/// the camera.
fn starburst(uv: vec2<f32>, turn: f32) -> f32 {
    let v = uv - 0.5001;
    let d = length(v);
    let angle = acos(clamp(v.x / max(d, 1e-6), -1.0, 1.0));
    let rays = starburst_noise(angle + turn) * starburst_noise(angle - 0.5 * turn);
    return saturate(rays + 1.0 - smoothstep(0.0, 0.3, d));
}
