// KHR_texture_transform.

/// offset + (x_axis y_axis) · uv. The two columns carry scale and rotation; the CPU forms
/// them once per material (`layout::TextureMap::new`).
fn transform_uv(
    uv: vec2<f32>,
    x_axis: vec2<f32>,
    y_axis: vec2<f32>,
    offset: vec2<f32>,
) -> vec2<f32> {
    return offset + x_axis * uv.x + y_axis * uv.y;
}
