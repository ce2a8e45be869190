// Vignetting: darkening of a lens toward the corners, or a fade to a color.

/// Returns the transmitted share of light, in (0, 1], by the cosine-fourth law cos⁴θ = 1/(1 +
/// tan²θ)², with tan²θ = falloff · radius2. `radius2` is the squared distance from the center, 1 at
/// the corners. A `falloff` of 2^(ev/2) - 1 darkens the corners by `ev` stops.
fn vignette_transmittance(radius2: f32, falloff: f32) -> f32 {
    let spread = 1.0 + falloff * radius2;
    return 1.0 / (spread * spread);
}

/// Share of the picture that is left, in [0, 1], where it fades into a color toward its edges.
/// `from_middle` is where the pixel is, -0.5…0.5 across the picture; `shape` as
/// `layout::EdgeFadeUniforms` makes it: the scale of both axes, that of the horizontal alone, the
/// power that makes corners, and the power of the falloff.
fn edge_share(from_middle: vec2<f32>, shape: vec4<f32>) -> f32 {
    let d = saturate(abs(from_middle) * shape.x * vec2<f32>(shape.y, 1.0));
    let corner = pow(max(d, vec2<f32>(1e-10)), vec2<f32>(shape.z));
    return pow(clamp(1.0 - dot(corner, corner), 1e-10, 1.0), shape.w);
}
