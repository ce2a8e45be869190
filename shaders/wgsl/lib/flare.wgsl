// Screen-space lens flare (Chapman, "Pseudo Lens Flare", 2017), as in Filament.

/// 1 at `middle`, falling smoothly to 0 at `reach` on both sides.
fn flare_ring(x: f32, middle: f32, reach: f32) -> f32 {
    let t = min(abs(x - middle) / max(reach, 1e-6), 1.0);
    return 1.0 - t * t * (3.0 - 2.0 * t);
}

/// Returns the source position of ghost `number` at `uv`, in 0…1.
fn ghost_place(uv: vec2<f32>, spacing: f32, number: f32) -> vec2<f32> {
    let mirrored = 1.0 - uv;
    return fract(mirrored + (0.5 - mirrored) * spacing * number);
}

/// Returns the unit vector toward the center of an image with this aspect ratio, in texture
/// coordinates. An offset of 1e-4 avoids the zero vector at the center.
fn flare_direction(uv: vec2<f32>, aspect: f32) -> vec2<f32> {
    let v = (0.5001 - uv) * vec2<f32>(aspect, 1.0);
    return v * inverseSqrt(max(dot(v, v), 1e-12)) * vec2<f32>(1.0 / aspect, 1.0);
}

/// Returns noise with 256 cells per unit, 0.5…1, smooth in between; Filament uses a noise texture.
fn starburst_noise(x: f32) -> f32 {
    let at = fract(x) * 256.0 - 0.5;
    let cell = floor(at);
    let hash = fract(sin((vec2<f32>(cell, cell + 1.0) + 256.0) % 256.0 * 12.9898) * 437.585453);
    return 0.5 + 0.5 * mix(hash.x, hash.y, at - cell);
}

/// Returns the share of the flare that remains at `uv`: star rays around the center, which rotate
/// with the camera.
fn starburst(uv: vec2<f32>, turn: f32) -> f32 {
    let v = uv - 0.5001;
    let d = length(v);
    let angle = acos(clamp(v.x / max(d, 1e-6), -1.0, 1.0));
    let rays = starburst_noise(angle + turn) * starburst_noise(angle - 0.5 * turn);
    return saturate(rays + 1.0 - smoothstep(0.0, 0.3, d));
}
