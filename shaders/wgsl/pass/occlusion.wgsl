// Ambient occlusion from the depth pyramid: the open part of the hemisphere above a surface, as far
// as the screen shows it.
//
// `fs_sao` is scalable ambient obscurance (lib/sao.wgsl), `fs_gtao` finds horizons in slices
// (lib/gtao.wgsl). Both write visibility, 0…1, to red, and 1 for the background. The other channels
// hold the mean open direction in world space.

import package::interface::frame::frame;
import package::interface::structure::{
    structure, structure_ndc, structure_depth, structure_position, structure_tap,
    structure_tangent, StructureTap,
};
import package::lib::depth_pyramid::pyramid_level;
import package::lib::dither::interleaved_gradient_noise;
import package::lib::cone_trace::cone_slice;
import package::lib::fullscreen::{fullscreen_position, uv_from_clip};
import package::lib::gtao::{
    acos_held, slice_arc, slice_whole, slice_share, slice_bent, sector_bits, slice_turn,
    slice_offset,
};
import package::lib::math::PI;
import package::lib::numerics::normalize_or;
import package::lib::sao::{sao_tap_distance, sao_term, sao_obscurance};
import package::lib::unproject::{Projection, ndc_from_view, view_position, view_z};

/// Cones toward the dominant light. Mirrored by `layout::ConeUniforms`.
struct ConeUniforms {
    /// Length of a cone, in m.
    reach_m: f32,
    /// Tangent of the half angle at the tip.
    tangent: f32,
    /// Maximum distance in front of a cone at which a surface counts as contact, in m.
    contact_m: f32,
    /// Depth bias, in m: for a surface that faces the light, and the addition for one edge-on to
    /// it.
    bias_m: f32,
    slope_bias_m: f32,
    /// Factor on the occlusion.
    intensity: f32,
    /// Number of slices per cone, and number of cones.
    steps: f32,
    rays: f32,
}

/// Settings. Mirrored by `layout::OcclusionUniforms`.
struct OcclusionUniforms {
    projection: Projection,
    /// Maximum distance of occluders, in m.
    radius_m: f32,
    /// Size of the radius in texels of level 0, at a distance of 1 m from the eye.
    radius_texels: f32,
    /// Maximum size of the radius, in texels; limits the size for surfaces close to the eye.
    most_texels: f32,
    /// Height above the tangent plane that occludes nothing, as a fraction of the distance from the
    /// eye.
    bias: f32,
    /// Factor on the obscurance.
    intensity: f32,
    /// Exponent of the visibility.
    power: f32,
    /// Squared sine of the minimum angle above the tangent plane that occludes.
    min_sin2: f32,
    /// Index of the depth pyramid's last level.
    last_level: i32,
    /// Cosine and sine of the angle between taps of the spiral.
    tap_rotation: vec2<f32>,
    /// Number of taps in the spiral.
    taps: f32,
    /// Reciprocal tap spacing, 1 / (taps - ½).
    per_tap: f32,
    /// Number of slices, and of steps on each side of a slice.
    slices: f32,
    steps: f32,
    /// Exponent of the step distribution: values above 1 concentrate steps near the center.
    step_power: f32,
    /// Thickness of occluders behind their front, in m, for the visibility bitmask.
    thickness_m: f32,
    cone: ConeUniforms,
}

@group(0) @binding(22) var<uniform> settings: OcclusionUniforms;

/// Computes normals from the nearer of the two texels on each axis; otherwise from the next texel,
/// which is wrong along edges.
override FINE_NORMALS: bool = true;
/// Places taps at the texel whose depth was read; otherwise on the spiral, as in Filament, which
/// tilts surfaces and darkens open ones by 15 %.
override EXACT_TAPS: bool = true;
/// Gives occluders a finite thickness: the open part is stored as a bitmask, not as one horizon.
override BITMASK: bool = false;
/// Uses Filament's distance falloff of horizons; otherwise they count fully within the radius.
override SMOOTH_FALLOFF: bool = false;
/// Outputs the mean open direction.
override BENT_NORMALS: bool = false;
/// Traces cones toward the dominant light.
override CONE: bool = false;

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    return fullscreen_position(vertex, 0.0);
}

/// Returns the unit normal of a texel's surface, in view space.
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

/// Reads the depth at a point in texels, from a level of the pyramid.
fn tap(at: vec2<f32>, level: i32) -> StructureTap {
    if EXACT_TAPS {
        return structure_tap(at, level, settings.projection);
    }
    let last = vec2<i32>(textureDimensions(structure, level)) - 1;
    let texel = clamp(vec2<i32>(floor(at / f32(1 << u32(level)))), vec2<i32>(0), last);
    let depth = textureLoad(structure, texel, level).r;
    let position = view_position(structure_ndc(at), max(depth, 1e-30), settings.projection);
    return StructureTap(position, depth != 0.0);
}

/// Returns the radius in texels at a position.
fn radius_texels(origin: vec3<f32>) -> f32 {
    let w = settings.projection.depth.z * origin.z + settings.projection.depth.w;
    return min(settings.radius_texels / max(w, 1e-6), settings.most_texels);
}

/// Obscured share of the hemisphere, and the mean open direction in view space, not normalized.
struct Obscured {
    share: f32,
    bent: vec3<f32>,
}

/// Returns the open point above a tap: the tap moved along the normal to the sphere with the radius
/// of the effect.
fn lifted(v: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    let rise = dot(v, normal);
    let rest = settings.radius_m * settings.radius_m - (dot(v, v) - rise * rise);
    return normalize_or(v + normal * (sqrt(max(rest, 0.0)) - rise), normal);
}

/// Computes scalable ambient obscurance.
fn scalable_obscurance(pixel: vec2<f32>, origin: vec3<f32>, normal: vec3<f32>) -> Obscured {
    let noise = interleaved_gradient_noise(pixel, 0u);
    let start = 2.0 * PI * 2.4 * noise;
    var direction = vec2<f32>(cos(start), sin(start));
    let turn = settings.tap_rotation;
    let disc = radius_texels(origin);
    let bias_m = settings.bias * abs(origin.z);
    var sum = 0.0;
    var bent = normal;
    for (var i = 0.0; i < settings.taps; i += 1.0) {
        let away = max(sao_tap_distance(i, noise, settings.per_tap) * disc, 1.0);
        let level = pyramid_level(away, settings.last_level);
        let found = tap(pixel + away * direction, level);
        if found.hit {
            let v = found.position - origin;
            let term = sao_term(v, normal, settings.radius_m, bias_m, settings.min_sin2);
            sum += term;
            if BENT_NORMALS && term <= 0.0 {
                bent += lifted(v, normal);
            }
        }
        direction = vec2<f32>(
            turn.x * direction.x - turn.y * direction.y,
            turn.y * direction.x + turn.x * direction.y,
        );
    }
    return Obscured(sao_obscurance(sum / settings.taps, settings.intensity), bent);
}

/// Slice of the hemisphere.
struct Slice {
    /// Direction toward the viewer, and the perpendicular direction of the slice.
    view: vec3<f32>,
    along: vec3<f32>,
    /// Angle of the normal in the slice.
    n: f32,
}

/// Returns the angle between the view direction and a direction, in a slice.
fn slice_angle(s: Slice, direction: vec3<f32>) -> f32 {
    let cosine = dot(direction, s.view) * inverseSqrt(max(dot(direction, direction), 1e-20));
    return acos_held(cosine) * select(-1.0, 1.0, dot(direction, s.along) >= 0.0);
}

/// Returns true if v (m, relative to the receiver) is an occluder: within the radius and above the
/// tangent plane.
fn rises(v: vec3<f32>, normal: vec3<f32>, bias_m: f32) -> bool {
    let vv = dot(v, v);
    let rise = dot(v, normal);
    return vv < settings.radius_m * settings.radius_m && rise > bias_m
        && rise * rise >= vv * settings.min_sin2;
}

/// Updates the cosine of a horizon with a sample at distance v whose cosine is `found`, both
/// measured from the view direction. With Filament's falloff, distant samples count less, and
/// samples below the horizon lower it slightly to approximate thin occluders.
fn raise_horizon(before: f32, found: f32, v: vec3<f32>) -> f32 {
    if !SMOOTH_FALLOFF {
        return max(before, found);
    }
    let fade = saturate(2.0 * dot(v, v) / (settings.radius_m * settings.radius_m));
    return select(mix(before, found, 0.004), mix(found, before, fade), found > before);
}

/// Returns the angle of a horizon from its cosine, at most `open`.
fn horizon_angle(cosine: f32, open: f32) -> f32 {
    let angle = acos_held(cosine);
    return select(min(angle, open), angle, SMOOTH_FALLOFF);
}

/// Computes obscurance from the horizons of slices.
fn horizon_obscurance(texel: vec2<i32>, origin: vec3<f32>, normal: vec3<f32>) -> Obscured {
    let disc = max(radius_texels(origin), 1.0);
    let bias_m = settings.bias * abs(origin.z);
    let jitter = slice_offset(texel);
    let central = settings.projection.depth.z != 0.0;
    let view = select(vec3<f32>(0.0, 0.0, 1.0), normalize_or(-origin, normal), central);
    var light = 0.0;
    var whole = 0.0;
    var bent = vec3<f32>(0.0);
    for (var i = 0.0; i < settings.slices; i += 1.0) {
        let turn = PI * (i + slice_turn(texel)) / settings.slices;
        let screen = vec2<f32>(cos(turn), sin(turn));
        let direction = vec3<f32>(screen, 0.0);
        var s: Slice;
        s.view = view;
        s.along = normalize_or(direction - dot(direction, view) * view, vec3<f32>(1.0, 0.0, 0.0));
        let laid = vec2<f32>(dot(normal, s.along), dot(normal, view));
        let weight = length(laid);
        s.n = acos_held(laid.y / max(weight, 1e-6)) * select(-1.0, 1.0, laid.x >= 0.0);
        // Cosines of the horizons: on the side of the slice's direction, and on the other.
        var above = -sin(s.n);
        var below = sin(s.n);
        var closed = 0u;
        for (var j = 0.0; j < settings.steps; j += 1.0) {
            var share = (j + jitter) / settings.steps;
            if settings.step_power != 1.0 {
                share = pow(share, settings.step_power);
            }
            let away = max(share * disc, 1.0 + j);
            let level = pyramid_level(away, settings.last_level);
            for (var side = -1.0; side <= 1.0; side += 2.0) {
                // Image rows run downward.
                let at = vec2<f32>(texel) + 0.5 + side * away * vec2<f32>(screen.x, -screen.y);
                let found = tap(at, level);
                let v = found.position - origin;
                if !found.hit || !rises(v, normal, bias_m) {
                    continue;
                }
                if BITMASK {
                    let front = slice_angle(s, v);
                    let from_eye = select(-view, normalize_or(found.position, -view), central);
                    let back = slice_angle(s, v + settings.thickness_m * from_eye);
                    let shares = vec2<f32>(slice_share(front, s.n), slice_share(back, s.n));
                    closed |= sector_bits(min(shares.x, shares.y), max(shares.x, shares.y), jitter);
                } else {
                    let cosine = dot(v, view) * inverseSqrt(max(dot(v, v), 1e-20));
                    if dot(v, s.along) >= 0.0 {
                        above = raise_horizon(above, cosine, v);
                    } else {
                        below = raise_horizon(below, cosine, v);
                    }
                }
            }
        }
        // Sectors need no horizons.
        var high = 0.0;
        var low = 0.0;
        if !BITMASK || BENT_NORMALS {
            high = horizon_angle(above, 0.5 * PI + s.n);
            low = -horizon_angle(below, 0.5 * PI - s.n);
        }
        whole += weight * slice_whole(s.n);
        if BITMASK {
            light += weight * slice_whole(s.n) * f32(32u - countOneBits(closed)) / 32.0;
        } else {
            light += weight * (slice_arc(low, s.n) + slice_arc(high, s.n));
        }
        if BENT_NORMALS {
            let mean = slice_bent(low, high, s.n);
            bent += weight * (mean.x * s.along + mean.y * view);
        }
    }
    // Divides by the unoccluded result of the slices, because a few slices of a tilted surface do
    // not cover exactly its hemisphere.
    let visible = saturate(light / max(whole, 1e-6));
    return Obscured(saturate(settings.intensity * (1.0 - visible)), bent);
}

/// Returns the share of the dominant light that the cones find shadowed.
fn light_obscurance(pixel: vec2<f32>, origin: vec3<f32>, normal: vec3<f32>) -> f32 {
    let cone = settings.cone;
    let w = frame.world_from_view;
    let sun = frame.sun_direction;
    let to_light = vec3<f32>(dot(w[0].xyz, sun), dot(w[1].xyz, sun), dot(w[2].xyz, sun));
    let facing = dot(normal, to_light);
    let p = settings.projection;
    let end = origin + cone.reach_m * to_light;
    // Faces away from the light, or ends behind the eye: nothing to trace.
    if facing < 0.0 || !(p.depth.z * end.z + p.depth.w > 1e-4) {
        return 0.0;
    }
    let size = vec2<f32>(textureDimensions(structure));
    let end_uv = uv_from_clip(ndc_from_view(end, p).xy);
    let way = end_uv * size - pixel;
    let aside = normalize_or(vec3<f32>(way.y, -way.x, 0.0), vec3<f32>(0.0)).xy;
    let bias_m = saturate(1.0 - facing) * cone.slope_bias_m + cone.bias_m;
    var sum = 0.0;
    for (var ray = 1.0; ray <= cone.rays; ray += 1.0) {
        let across = interleaved_gradient_noise(pixel * ray, 0u) * 2.0 - 1.0;
        let start = interleaved_gradient_noise(pixel * ray * vec2<f32>(3.0, 11.0), 0u);
        var most = 0.0;
        for (var i = 0.0; i < cone.steps; i += 1.0) {
            let t = (i + start) / cone.steps;
            let radius_texels = across * cone.tangent * t * length(way);
            let depth = structure_depth(vec2<i32>(floor(pixel + way * t + aside * radius_texels)));
            if depth > 0.0 {
                // The inverse distance is linear on the screen.
                let on_axis = 1.0 / mix(1.0 / origin.z, 1.0 / end.z, t);
                let axis_m = -select(mix(origin.z, end.z, t), on_axis, p.depth.z != 0.0);
                let scene_m = -view_z(depth, p.depth);
                let radius_m = cone.tangent * cone.reach_m * t;
                let filled = cone_slice(axis_m, scene_m, radius_m, across, bias_m, cone.contact_m);
                most = max(most, filled);
            }
        }
        sum += most;
    }
    return sum / cone.rays * cone.intensity;
}

/// Returns the output of both methods: visibility in red, then the mean open direction in world
/// space.
fn finished(pixel: vec2<f32>, origin: vec3<f32>, normal: vec3<f32>, found: Obscured) -> vec4<f32> {
    var share = found.share;
    if CONE {
        share = max(share, light_obscurance(pixel, origin, normal));
    }
    let bent = frame.world_from_view * vec4<f32>(normalize_or(found.bent, normal), 0.0);
    return vec4<f32>(pow(saturate(1.0 - share), settings.power), bent.xyz);
}

@fragment
fn fs_sao(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let texel = vec2<i32>(position.xy);
    let depth = structure_depth(texel);
    if depth == 0.0 {
        return vec4<f32>(1.0, 0.0, 0.0, 0.0);
    }
    let origin = structure_position(texel, depth, settings.projection);
    let normal = normal_of(texel, depth, origin);
    let found = scalable_obscurance(position.xy, origin, normal);
    return finished(position.xy, origin, normal, found);
}

@fragment
fn fs_gtao(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let texel = vec2<i32>(position.xy);
    let depth = structure_depth(texel);
    if depth == 0.0 {
        return vec4<f32>(1.0, 0.0, 0.0, 0.0);
    }
    let origin = structure_position(texel, depth, settings.projection);
    let normal = normal_of(texel, depth, origin);
    return finished(position.xy, origin, normal, horizon_obscurance(texel, origin, normal));
}
