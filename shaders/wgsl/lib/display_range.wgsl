// A color for each stop of brightness, to see how much range a picture uses.

/// Color of a whole number of stops from -5 about 18 % grey: black, blues, cyan at grey, greens
/// above, yellow, red, magenta, white at ten.
fn display_range_color(index: u32) -> vec3<f32> {
    switch index {
        case 0u: { return vec3<f32>(0.0, 0.0, 0.0); }
        case 1u: { return vec3<f32>(0.0, 0.0, 0.1647); }
        case 2u: { return vec3<f32>(0.0, 0.0, 0.3647); }
        case 3u: { return vec3<f32>(0.0, 0.0, 0.6647); }
        case 4u: { return vec3<f32>(0.0, 0.0, 0.9647); }
        case 5u: { return vec3<f32>(0.0, 0.9255, 0.9255); }
        case 6u: { return vec3<f32>(0.0, 0.5647, 0.0); }
        case 7u: { return vec3<f32>(0.0, 0.7843, 0.0); }
        case 8u: { return vec3<f32>(1.0, 1.0, 0.0); }
        case 9u: { return vec3<f32>(0.90588, 0.75294, 0.0); }
        case 10u: { return vec3<f32>(1.0, 0.5647, 0.0); }
        case 11u: { return vec3<f32>(1.0, 0.0, 0.0); }
        case 12u: { return vec3<f32>(0.8392, 0.0, 0.0); }
        case 13u: { return vec3<f32>(1.0, 0.0, 1.0); }
        case 14u: { return vec3<f32>(0.6, 0.3333, 0.7882); }
        default: { return vec3<f32>(1.0, 1.0, 1.0); }
    }
}

/// The color of the stop that the luminance of a Rec.2020 color is at, in Rec.2020.
fn tone_display_range(color: vec3<f32>) -> vec3<f32> {
    let y = dot(color, vec3<f32>(0.2627002, 0.6779981, 0.0593017));
    let stop = clamp(log2(clamp(y, 1e-10, 65504.0) / 0.18) + 5.0, 0.0, 15.0);
    let below = floor(stop);
    let index = u32(below);
    return mix(display_range_color(index), display_range_color(index + 1u), stop - below);
}
