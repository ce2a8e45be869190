// Weights that keep a filter on one surface.

/// Returns the weight of a sample whose surface is `apart_m` away in depth: 1 at zero, 0 from the
/// threshold on; both in m.
fn bilateral_weight(apart_m: f32, threshold_m: f32) -> f32 {
    let share = apart_m / threshold_m;
    return max(1.0 - share * share, 0.0);
}
