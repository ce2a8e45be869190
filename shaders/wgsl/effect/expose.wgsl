// Effect: exposure compensation.

/// Settings of `expose`. Mirrored by `layout::ExposureUniforms`.
struct ExposureUniforms {
    /// Factor on the pre-exposed color: 2^(exposure compensation in EV).
    @size(16) scale: f32,
}

@group(0) @binding(0) var<uniform> exposing: ExposureUniforms;

/// Scales scene-referred linear light; alpha is unchanged.
fn expose(color: vec4<f32>, pixel: vec2<f32>) -> vec4<f32> {
    return vec4<f32>(color.rgb * exposing.scale, color.a);
}
