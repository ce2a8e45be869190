// Lens flare: ghosts and a halo of bright parts. `fs_flare` draws them, and `fs_blur` blurs along
// one axis; the second blur also applies star rays.

import package::lib::flare::{flare_ring, ghost_place, flare_direction, starburst};
import package::lib::fullscreen::{fullscreen_position, uv_from_clip};

/// Settings. Mirrored by `layout::FlareUniforms`.
struct FlareUniforms {
    /// Aspect ratio, width over height.
    aspect: f32,
    /// Chromatic aberration: distance between red and blue, as a fraction of the image size.
    aberration: f32,
    /// Number of ghosts.
    ghosts: f32,
    /// Distance between ghosts, as a fraction of the distance to the center.
    ghost_spacing: f32,
    /// Brightness threshold of ghosts.
    ghost_threshold: f32,
    /// Radius of the halo, as a fraction of the height.
    halo_radius: f32,
    /// Thickness of the halo, as a fraction of the height; 0 for no halo.
    halo_thickness: f32,
    /// Brightness threshold of the halo.
    halo_threshold: f32,
    /// Step of the blur, in texels.
    axis: vec2<f32>,
    /// Rotation of the star rays.
    turn: f32,
    /// 1: draws star rays. 0: leaves the flare unchanged.
    rays: f32,
    /// Scale and offset from coordinates of the bloom texture to coordinates of the area in which
    /// the flare is centered.
    span_scale: vec2<f32>,
    span_offset: vec2<f32>,
}

/// Number of taps on each side.
const FLARE_REACH: i32 = 4;
/// Standard deviation of the blur, in texels.
const FLARE_SIGMA: f32 = 1.6666667;

@group(0) @binding(0) var<uniform> flare: FlareUniforms;
/// Bloom texture, or the flare before it is blurred.
@group(0) @binding(1) var glow: texture_2d<f32>;
/// Linear filter, clamp to edge.
@group(0) @binding(2) var glow_sampler: sampler;

struct FlareVertex {
    @builtin(position) position: vec4<f32>,
    @location(0) uv: vec2<f32>,
}

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> FlareVertex {
    let position = fullscreen_position(vertex, 0.0);
    return FlareVertex(position, uv_from_clip(position.xy));
}

/// Converts coordinates of the bloom texture to coordinates of the flare's area.
fn to_span(uv: vec2<f32>) -> vec2<f32> {
    return uv * flare.span_scale + flare.span_offset;
}

/// Returns the glow at coordinates of the flare's area.
fn glow_at(uv: vec2<f32>) -> vec3<f32> {
    let at = (uv - flare.span_offset) / flare.span_scale;
    return textureSampleLevel(glow, glow_sampler, at, 0.0).rgb;
}

/// Returns the glow above the threshold, at most 1, with chromatic aberration.
fn parted(uv: vec2<f32>, threshold: f32) -> vec3<f32> {
    let d = flare_direction(uv, 1.0) * flare.aberration;
    let color = vec3<f32>(glow_at(uv + d).r, glow_at(uv).g, glow_at(uv - d).b);
    return saturate(color - threshold);
}

@fragment
fn fs_flare(vertex: FlareVertex) -> @location(0) vec4<f32> {
    let uv = to_span(vertex.uv);
    var color = vec3<f32>(0.0);
    for (var i = 0.0; i < flare.ghosts; i += 1.0) {
        color += parted(ghost_place(uv, flare.ghost_spacing, i), flare.ghost_threshold);
    }
    let direction = flare_direction(uv, flare.aspect);
    let halo = parted(uv + direction * flare.halo_radius, flare.halo_threshold);
    let d = length((uv - 0.5) * vec2<f32>(flare.aspect, 1.0));
    let ring = flare_ring(d, flare.halo_radius, flare.halo_thickness);
    return vec4<f32>(color + halo * ring * step(1e-6, flare.halo_thickness), 1.0);
}

@fragment
fn fs_blur(vertex: FlareVertex) -> @location(0) vec4<f32> {
    let one = flare.axis / vec2<f32>(textureDimensions(glow, 0));
    var sum = vec3<f32>(0.0);
    var whole = 0.0;
    for (var i = -FLARE_REACH; i <= FLARE_REACH; i++) {
        let x = f32(i) / FLARE_SIGMA;
        let weight = exp(-0.5 * x * x);
        sum += weight * textureSampleLevel(glow, glow_sampler, vertex.uv + f32(i) * one, 0.0).rgb;
        whole += weight;
    }
    let left = mix(1.0, starburst(to_span(vertex.uv), flare.turn), flare.rays);
    return vec4<f32>(sum / whole * left, 1.0);
}
