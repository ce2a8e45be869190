// Fog whose density falls exponentially with height: optical depth of a ray (Wenzel, "Real-time
// Atmospheric Effects in Games", 2006), and opacity.

/// Maximum exponent to which density is evaluated along a ray: e⁴⁰ is opaque.
const FOG_MOST_EXPONENT: f32 = 40.0;
/// Limit below which the mean decay uses a series, because 1 - e^-x loses precision (hard case 53).
const FOG_SERIES: f32 = 0.01;

/// Returns the mean of e^(-x t) for t in 0…1.
fn mean_decay(x: f32) -> f32 {
    let series = 1.0 - x * (0.5 - x * (1.0 / 6.0 - x / 24.0));
    let small = abs(x) < FOG_SERIES;
    let decay = exp(-clamp(x, -FOG_MOST_EXPONENT, FOG_MOST_EXPONENT));
    return select((1.0 - decay) / select(x, 1.0, small), series, small);
}

/// Returns the optical depth, at least 0, of a ray of `way_m` whose first `start_m` are clear.
/// `density` (1/m) is the density at the eye. It changes by e^-decay over the whole ray. If `exact`
/// is 1, the mean density is that of the fogged part; if 0, that of the whole ray, as in Filament.
fn fog_optical_depth(density: f32, decay: f32, start_m: f32, way_m: f32, exact: f32) -> f32 {
    let clear = exact * saturate(start_m / max(way_m, 1e-6));
    let reached = exp(-clamp(decay * clear, -FOG_MOST_EXPONENT, FOG_MOST_EXPONENT));
    let within = density * max(way_m - start_m, 0.0);
    return within * min(reached * mean_decay(decay * (1.0 - clear)), 1e20);
}

/// Returns the opacity of fog with this optical depth, 0…`most`.
fn fog_opacity(optical_depth: f32, most: f32) -> f32 {
    return min(1.0 - exp(-optical_depth), most);
}

/// Returns the share of sunlight that fog scatters toward the eye, from the cosine between ray and
/// sun direction. `size` is above 0; larger values give a smaller glow.
fn fog_glow(cos_to_sun: f32, size: f32) -> f32 {
    return pow(saturate(cos_to_sun), size);
}
