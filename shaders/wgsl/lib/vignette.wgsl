// Vignetting: how much light a lens loses toward the corners of the picture.

/// Share of the light that arrives, in (0, 1]: the cosine-fourth law of natural vignetting,
/// cos⁴θ = 1/(1 + tan²θ)², with tan²θ = falloff · radius2. `radius2` is the squared distance
/// from the middle of the picture, 1 at the corners; so a `falloff` of 2^(ev/2) - 1 darkens
/// the corners by `ev` stops, and 0 changes nothing.
fn vignette_transmittance(radius2: f32, falloff: f32) -> f32 {
    let spread = 1.0 + falloff * radius2;
    return 1.0 / (spread * spread);
}
