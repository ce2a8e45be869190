// ACES as computed by Filament: the reference rendering transform with its glow, red modifier and
// desaturation. One rational curve replaces tone scale and display transform, followed by the
// correction for a dim surround (Academy Color Encoding System 1.0, TB-2014). The white of ACES is
// not adapted, so white becomes 252, 246, 237 of 255.

/// Returns the saturation of a color in ACES' AP0 primaries, 0…1, as RRT defines it.
fn aces_saturation(ap0: vec3<f32>) -> f32 {
    let most = max(ap0.x, max(ap0.y, ap0.z));
    let least = min(ap0.x, min(ap0.y, ap0.z));
    return (max(most, 1e-5) - max(least, 1e-5)) / max(most, 1e-2);
}

/// Returns the relative brightness that RRT's glow adds to a dark saturated color of AP0: at most
/// 0.05.
fn aces_glow(ap0: vec3<f32>, saturation: f32) -> f32 {
    let c = ap0;
    let chroma2 = c.z * (c.z - c.y) + c.y * (c.y - c.x) + c.x * (c.x - c.z);
    let brightness = (c.x + c.y + c.z + 1.75 * sqrt(max(chroma2, 0.0))) / 3.0;
    let from_knee = (saturation - 0.4) / 0.2;
    let t = max(1.0 - abs(from_knee * 0.5), 0.0);
    let gain = 0.05 * (0.5 + 0.5 * sign(from_knee) * (1.0 - t * t));
    // Full gain below two thirds of the middle brightness of 0.08, none above twice that.
    return gain * clamp(0.08 / max(brightness, 1e-6) - 0.5, 0.0, 1.0);
}

/// Returns the redness of a hue in AP0: 1 at pure red, 0 from 67.5 degrees on.
fn aces_redness(ap0: vec3<f32>) -> f32 {
    let aside = 1.7320508 * (ap0.y - ap0.z);
    let along = 2.0 * ap0.x - ap0.y - ap0.z;
    // No branch: where conditions read many uniforms, Mesa 22.3's software driver crashes.
    let is_grey = abs(aside) + abs(along) < 1e-20;
    let degrees = atan2(aside, select(along, 1.0, is_grey)) * 57.29577951;
    let weight = smoothstep(0.0, 1.0, 1.0 - abs(2.0 * degrees / 135.0));
    return select(weight * weight, 0.0, is_grey);
}

/// Tone maps scene light to display light, both in Rec.2020; `brightness` is 1, or 1/0.6 for
/// Filament's ACES_LEGACY.
fn tone_aces(color: vec3<f32>, brightness: f32) -> vec3<f32> {
    let c = clamp(color, vec3<f32>(0.0), vec3<f32>(65504.0));
    var ap0 = vec3<f32>(
        dot(c, vec3<f32>(0.66868028, 0.15181768, 0.17716327)),
        dot(c, vec3<f32>(0.04490008, 0.86216027, 0.10190731)),
        dot(c, vec3<f32>(0.0, 0.02782752, 1.05154710)),
    );
    let saturated = aces_saturation(ap0);
    ap0 *= 1.0 + aces_glow(ap0, saturated);
    ap0.x += aces_redness(ap0) * saturated * (0.03 - ap0.x) * 0.18;
    let ap1 = clamp(vec3<f32>(
        dot(ap0, vec3<f32>(1.45143932, -0.23651075, -0.21492857)),
        dot(ap0, vec3<f32>(-0.07655377, 1.17622970, -0.09967593)),
        dot(ap0, vec3<f32>(0.00831615, -0.00603245, 0.99771630)),
    ), vec3<f32>(0.0), vec3<f32>(65504.0));
    let luminance_ap1 = vec3<f32>(0.27222872, 0.67408177, 0.05368952);
    let x = mix(vec3<f32>(dot(ap1, luminance_ap1)), ap1, 0.96) * brightness;
    let fit = (x * (2.785085 * x + 0.107772)) / (x * (2.936045 * x + 0.887122) + 0.806889);
    // Luminance to the power 0.9811 for a dim surround, at constant chromaticity.
    let y = dot(fit, luminance_ap1);
    let dim = fit * pow(max(y, 1e-10), -0.0189);
    let shown = mix(vec3<f32>(dot(dim, luminance_ap1)), dim, 0.93);
    return vec3<f32>(
        dot(shown, vec3<f32>(1.04179970, -0.01073772, -0.00696185)),
        dot(shown, vec3<f32>(-0.00168338, 1.00034870, -0.00140823)),
        dot(shown, vec3<f32>(-0.00521045, -0.02264474, 0.95244412)),
    );
}
