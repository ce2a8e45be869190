// Shadow of a dominant light from screen-space depth, by a cone toward it (Doghramachi, "Lighting
// Technology of The Last of Us Part II", 2020).

/// Returns the share of a cone slice that the visible surface fills, 0…1. The slice has radius
/// `radius_m` and its axis is `axis_m` from the eye. The sample is at `across` (-1…1) of the radius
/// from the axis, with the surface `scene_m` from the eye. Less than `bias_m` counts as empty;
/// surfaces more than `contact_m` in front of the cone are ignored.
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
