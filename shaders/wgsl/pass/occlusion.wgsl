// Ambient occlusion from the structure of the scene: what of the hemisphere over a surface is
// open, as far as the picture shows it.
//
// `fs_sao` is scalable ambient obscurance (lib/sao.wgsl). Both give visibility, 0…1, in red; 1
// where there is nothing.

import package::interface::structure::{
    structure, structure_ndc, structure_depth, structure_position, structure_tap,
    structure_tangent, StructureTap,
};
import package::lib::depth_pyramid::pyramid_level;
import package::lib::dither::interleaved_gradient_noise;
import package::lib::fullscreen::fullscreen_position;
import package::lib::math::PI;
import package::lib::numerics::normalize_or;
import package::lib::sao::{sao_tap_distance, sao_term, sao_visibility};
import package::lib::unproject::{Projection, view_position};

/// Settings. Mirrored by `layout::OcclusionUniforms`.
struct OcclusionUniforms {
    projection: Projection,
    /// How far occluders count, in m.
    radius_m: f32,
    /// Texels of level 0 that the radius spans a meter ahead of the eye.
    radius_texels: f32,
    /// The most texels that the radius may span: what is before the eye would span the picture.
    most_texels: f32,
    /// Rise over the tangent plane that occludes nothing, a share of the distance from the eye.
    bias: f32,
    /// Factor on what is obscured.
    intensity: f32,
    /// Exponent of visibility.
    power: f32,
    /// Squared sine of the least angle over the tangent plane that occludes.
    min_sin2: f32,
    /// Number of the structure's last level.
    last_level: i32,
    /// Cosine and sine of the angle from tap to tap of the spiral.
    tap_rotation: vec2<f32>,
    /// Taps of the spiral.
    taps: f32,
    /// 1 / (taps - ½).
    per_tap: f32,
}

@group(0) @binding(0) var<uniform> settings: OcclusionUniforms;

/// Normals from the nearer of two texels each side; else from the next texel of each axis, which
/// is wrong along edges.
override FINE_NORMALS: bool = true;
/// A tap is where its depth was found; else where the spiral points, as Filament has it, which
/// tilts surfaces and takes 15 % from open ones.
override EXACT_TAPS: bool = true;

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    return fullscreen_position(vertex, 0.0);
}

/// Unit normal of what a texel shows, in view space.
fn normal_of(texel: vec2<i32>, depth: f32, origin: vec3<f32>) -> vec3<f32> {
    let x = vec2<i32>(1, 0);
    let y = vec2<i32>(0, 1);
    var right = vec3<f32>(0.0);
    var down = vec3<f32>(0.0);
    if FINE_NORMALS {
        right = structure_tangent(texel, x, depth, origin, settings.projection);
        down = structure_tangent(texel, y, depth, origin, settings.projection);
    } else {
        let next_x = max(structure_depth(texel + x), 1e-30);
        let next_y = max(structure_depth(texel + y), 1e-30);
        right = structure_position(texel + x, next_x, settings.projection) - origin;
        down = structure_position(texel + y, next_y, settings.projection) - origin;
    }
    return normalize_or(cross(down, right), vec3<f32>(0.0, 0.0, 1.0));
}

/// What is at a point in texels, `away` texels from where it is seen from.
fn tap(at: vec2<f32>, away: f32) -> StructureTap {
    let level = pyramid_level(away, settings.last_level);
    if EXACT_TAPS {
        return structure_tap(at, level, settings.projection);
    }
    let last = vec2<i32>(textureDimensions(structure, level)) - 1;
    let texel = clamp(vec2<i32>(floor(at / f32(1 << u32(level)))), vec2<i32>(0), last);
    let depth = textureLoad(structure, texel, level).r;
    let position = view_position(structure_ndc(at), max(depth, 1e-30), settings.projection);
    return StructureTap(position, depth != 0.0);
}

/// Texels that the radius spans at a position.
fn radius_texels(origin: vec3<f32>) -> f32 {
    let w = settings.projection.depth.z * origin.z + settings.projection.depth.w;
    return min(settings.radius_texels / max(w, 1e-6), settings.most_texels);
}

/// Visibility by scalable ambient obscurance.
fn scalable_obscurance(pixel: vec2<f32>, origin: vec3<f32>, normal: vec3<f32>) -> f32 {
    let noise = interleaved_gradient_noise(pixel, 0u);
    let start = 2.0 * PI * 2.4 * noise;
    var direction = vec2<f32>(cos(start), sin(start));
    let turn = settings.tap_rotation;
    let disc = radius_texels(origin);
    let bias_m = settings.bias * abs(origin.z);
    var sum = 0.0;
    for (var i = 0.0; i < settings.taps; i += 1.0) {
        let away = max(sao_tap_distance(i, noise, settings.per_tap) * disc, 1.0);
        let found = tap(pixel + away * direction, away);
        if found.hit {
            let v = found.position - origin;
            sum += sao_term(v, normal, settings.radius_m, bias_m, settings.min_sin2);
        }
        direction = vec2<f32>(
            turn.x * direction.x - turn.y * direction.y,
            turn.y * direction.x + turn.x * direction.y,
        );
    }
    return sao_visibility(sum / settings.taps, settings.intensity, settings.power);
}

@fragment
fn fs_sao(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let texel = vec2<i32>(position.xy);
    let depth = structure_depth(texel);
    if depth == 0.0 {
        return vec4<f32>(1.0);
    }
    let origin = structure_position(texel, depth, settings.projection);
    let normal = normal_of(texel, depth, origin);
    return vec4<f32>(scalable_obscurance(position.xy, origin, normal));
}
