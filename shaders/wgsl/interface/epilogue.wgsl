// The socket for point-wise effects: what becomes of a color before it is written.
//
// A pass that makes colors, or reads them at the same pixel, calls `epilogue` last. As it
// stands here the color goes on unchanged; `resolve_with` puts a generated text in the place of
// this module, which calls the effects it is given one after the other. So a full-screen pass
// and the end of a shading pass are made of the same functions.

/// The color to write. `pixel` is the fragment's position in pixels, as in
/// @builtin(position).
fn epilogue(color: vec4<f32>, pixel: vec2<f32>) -> vec4<f32> {
    return color;
}
