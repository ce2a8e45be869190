// Fog whose density falls exponentially with height: how much of it a ray goes through (Wenzel,
// "Real-time Atmospheric Effects in Games", 2006), and how much it hides.

/// Exponent up to which density is followed along a ray, either way: e⁴⁰ hides everything.
const FOG_MOST_EXPONENT: f32 = 40.0;
/// Below it the mean of a decay is a series: 1 - e^-x loses its digits there (hard case 53).
const FOG_SERIES: f32 = 0.01;

/// Mean of e^(-x t) over t in 0…1.
fn mean_decay(x: f32) -> f32 {
    let series = 1.0 - x * (0.5 - x * (1.0 / 6.0 - x / 24.0));
    let small = abs(x) < FOG_SERIES;
    let decay = exp(-clamp(x, -FOG_MOST_EXPONENT, FOG_MOST_EXPONENT));
    return select((1.0 - decay) / select(x, 1.0, small), series, small);
}

/// Optical depth, 0 or more, of a ray of `way_m` whose first `start_m` are clear. `density` (1/m)
/// is that at the eye, which falls by e^-decay over the whole way (or grows, with a negative one).
/// The mean density is that of what is not clear where `exact` is 1, and that of the whole way, as
/// Filament has it, where it is 0.
fn fog_optical_depth(density: f32, decay: f32, start_m: f32, way_m: f32, exact: f32) -> f32 {
    let clear = exact * saturate(start_m / max(way_m, 1e-6));
    let reached = exp(-clamp(decay * clear, -FOG_MOST_EXPONENT, FOG_MOST_EXPONENT));
    let within = density * max(way_m - start_m, 0.0);
    return within * min(reached * mean_decay(decay * (1.0 - clear)), 1e20);
}

/// Share of what is behind fog of that optical depth that it hides, 0…`most`.
fn fog_opacity(optical_depth: f32, most: f32) -> f32 {
    return min(1.0 - exp(-optical_depth), most);
}

/// Share of the sun's light that fog scatters toward the eye, from the cosine between the ray and
/// the direction toward the sun; `size` above 0, more is a smaller glow.
fn fog_glow(cos_to_sun: f32, size: f32) -> f32 {
    return pow(saturate(cos_to_sun), size);
}
