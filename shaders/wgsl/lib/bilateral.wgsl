// Weights that keep a filter on one surface.

/// Weight of a sample whose surface is so far apart: 1 where it is the same, 0 from the threshold
/// on; both in m.
fn bilateral_weight(apart_m: f32, threshold_m: f32) -> f32 {
    let share = apart_m / threshold_m;
    return max(1.0 - share * share, 0.0);
}
