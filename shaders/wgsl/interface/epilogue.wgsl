// Socket for point-wise effects, which process a color before it is written.
//
// Passes that compute colors, or read them at the same pixel, call `epilogue` last. This version
// returns the color unchanged. `resolve` replaces this file with a generated one that calls its
// effects in order. Full-screen passes and shading passes therefore share the effects.

/// Returns the color to write. `pixel` is the fragment's position in pixels, as in
/// @builtin(position).
fn epilogue(color: vec4<f32>, pixel: vec2<f32>) -> vec4<f32> {
    return color;
}
