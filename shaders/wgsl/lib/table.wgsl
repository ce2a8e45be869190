// Coordinates of colors in tables with logarithmic axes.

import package::lib::grading::log_c_from_linear;

/// Returns the coordinates of a linear Rec.709 color in a table with `entries` entries along each
/// axis. LogC from 0 to 1 spans the centers of the first and last texels; brighter colors are
/// clamped.
fn table_coordinates(color: vec3<f32>, entries: f32) -> vec3<f32> {
    let x = saturate(log_c_from_linear(min(color, vec3<f32>(65504.0))));
    return (x * (entries - 1.0) + 0.5) / entries;
}
