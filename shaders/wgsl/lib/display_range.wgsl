// False colors: one color per stop of brightness, to show the dynamic range of an image.

/// Colors of whole numbers of stops from -5 about 18 % grey: black, blues, cyan at grey, greens
/// above, yellow, red, magenta, white at ten.
const STOPS: array<vec3<f32>, 16> = array<vec3<f32>, 16>(
    vec3<f32>(0.0, 0.0, 0.0),
    vec3<f32>(0.0, 0.0, 0.1647),
    vec3<f32>(0.0, 0.0, 0.3647),
    vec3<f32>(0.0, 0.0, 0.6647),
    vec3<f32>(0.0, 0.0, 0.9647),
    vec3<f32>(0.0, 0.9255, 0.9255),
    vec3<f32>(0.0, 0.5647, 0.0),
    vec3<f32>(0.0, 0.7843, 0.0),
    vec3<f32>(1.0, 1.0, 0.0),
    vec3<f32>(0.90588, 0.75294, 0.0),
    vec3<f32>(1.0, 0.5647, 0.0),
    vec3<f32>(1.0, 0.0, 0.0),
    vec3<f32>(0.8392, 0.0, 0.0),
    vec3<f32>(1.0, 0.0, 1.0),
    vec3<f32>(0.6, 0.3333, 0.7882),
    vec3<f32>(1.0, 1.0, 1.0),
);

/// Color of a whole number of stops from -5 about 18 % grey; the last for all above.
fn display_range_color(index: u32) -> vec3<f32> {
    // No branch: where conditions read many uniforms, Mesa 22.3's software driver crashes.
    var stops = STOPS;
    return stops[min(index, 15u)];
}

/// The color of the stop that the luminance of a Rec.2020 color is at, in Rec.2020.
fn tone_display_range(color: vec3<f32>) -> vec3<f32> {
    let y = dot(color, vec3<f32>(0.2627002, 0.6779981, 0.0593017));
    let stop = clamp(log2(clamp(y, 1e-10, 65504.0) / 0.18) + 5.0, 0.0, 15.0);
    let below = floor(stop);
    let index = u32(below);
    return mix(display_range_color(index), display_range_color(index + 1u), stop - below);
}
