// Shadow of a dominant light from what the picture shows, by a cone toward it (Doghramachi,
// "Lighting Technology of The Last of Us Part II", 2020).

/// How much of a slice of the cone the picture fills, 0…1. The slice is `radius_m` wide about the
/// cone's axis, which is `axis_m` from the eye; it is looked at `across` (-1…1) of its radius from
/// the axis, where the picture shows something `scene_m` from the eye. Less than `bias_m` fills
/// nothing; what is farther in front of the cone than `contact_m` is taken not to touch it.
fn cone_slice(
    axis_m: f32,
    scene_m: f32,
    radius_m: f32,
    across: f32,
    bias_m: f32,
    contact_m: f32,
) -> f32 {
    let half = radius_m * sqrt(max(1.0 - across * across, 0.0));
    let behind = axis_m + half - scene_m;
    let overlap = saturate((behind - bias_m) / max(2.0 * half, 1e-6));
    return overlap * saturate(1.0 - behind / contact_m);
}
