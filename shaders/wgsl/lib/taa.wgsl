// The arithmetic of temporal anti-aliasing, apart from the texture reads.
//
// Filament's (Karis, "High Quality Temporal Supersampling", SIGGRAPH 2014; Salvi, "An Excursion in
// Temporal Supersampling", GDC 2016), safe where a neighborhood is even (hard case 51). Colors are
// radiance times exposure, from 0 to 65504.

/// Luma and the two chromas of a color: sums and differences that a shift undoes exactly.
fn ycocg_from_rgb(c: vec3<f32>) -> vec3<f32> {
    let even = 0.5 * (c.x + c.z);
    return vec3<f32>(0.5 * (even + c.y), 0.5 * (c.x - c.z), 0.5 * (c.y - even));
}

/// The color of luma and chromas.
fn rgb_from_ycocg(c: vec3<f32>) -> vec3<f32> {
    let even = c.x - c.z;
    return vec3<f32>(even + c.y, c.x + c.z, even - c.y);
}

/// A color whose brightest channel is less than 1, in which a bright sample does not outweigh its
/// dark neighbors.
fn compress_range(c: vec3<f32>) -> vec3<f32> {
    return c / (1.0 + max(c.x, max(c.y, c.z)));
}

/// Undoes `compress_range`, at most 65504 times.
fn expand_range(c: vec3<f32>) -> vec3<f32> {
    return c / max(1.0 - max(c.x, max(c.y, c.z)), 1.0 / 65504.0);
}

/// Deviation of five samples of this sum and sum of squares; rounding makes no variance negative.
fn deviation_of_five(sum: vec3<f32>, squares: vec3<f32>) -> vec3<f32> {
    let mean = 0.2 * sum;
    return sqrt(max(0.2 * squares - mean * mean, vec3<f32>(0.0)));
}

/// Returns the share of the way from `start` to `end` at which a box begins: 0 inside it, 1 if the
/// line misses it. Zero length along an axis counts as 1e-5.
fn share_to_box(start: vec3<f32>, end: vec3<f32>, low: vec3<f32>, high: vec3<f32>) -> f32 {
    let way = end - start;
    let safe = select(way, vec3<f32>(1e-5), abs(way) < vec3<f32>(1e-5));
    let entry = min((high - start) / safe, (low - start) / safe);
    return clamp(max(entry.x, max(entry.y, entry.z)), 0.0, 1.0);
}

/// Returns a factor on the weight of this frame that reduces flicker: 1 if its brightness equals
/// that of the history (Lottes).
fn steadiness(luma: f32, earlier_luma: f32) -> f32 {
    let alike = 1.0 - abs(luma - earlier_luma) / (0.001 + max(luma, earlier_luma));
    return alike * alike;
}

/// Weights of four texels in a row about a place `f` of the way from the second to the third:
/// Catmull-Rom's spline.
fn catmull_rom(f: f32) -> vec4<f32> {
    let f2 = f * f;
    let f3 = f2 * f;
    let first = f2 - 0.5 * (f3 + f);
    let second = 1.5 * f3 - 2.5 * f2 + 1.0;
    let last = 0.5 * (f3 - f2);
    return vec4<f32>(first, second, 1.0 - first - second - last, last);
}
