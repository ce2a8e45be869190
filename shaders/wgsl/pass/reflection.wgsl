// Screen-space reflections: traces each pixel's mirrored ray through the depth pyramid, and reads
// the color of the hit from the previous frame.
//
// The output is radiance times its weight, with the weight in alpha. The weight is 0 if the ray
// hits nothing, leaves the screen, or hits a point that the previous frame did not show. The
// environment provides the rest. A second output holds the length of the ray, which controls the
// blur of rough surfaces.

import package::interface::frame::frame;
import package::interface::material::{TRAIT_UNLIT, material_has, metallic_roughness};
import package::interface::object::Instance;
import package::interface::structure::{
    structure, structure_ndc, structure_depth, structure_position,
};
import package::lib::contact_shadow::contact_fade;
import package::lib::dither::interleaved_gradient_noise;
import package::lib::fullscreen::uv_from_clip;
import package::lib::numerics::{all_finite3, normalize_or};
import package::lib::screen_ray::{
    ray_length_m, share_in_picture, ray_meets, share_at_depth, rises_from_plane, reach_fade,
    roughness_fade,
};
import package::lib::unproject::{Projection, ndc_from_view, view_position, view_z};
import package::shading::vertex::{
    SurfaceVertex, surface_vertex, face_sign, geometric_normal, smooth_normal, shading_normal,
    texture_uv,
};

/// Settings. Mirrored by `layout::ReflectionUniforms`.
struct ReflectionUniforms {
    projection: Projection,
    /// View space of this frame to clip space of the previous frame.
    earlier_clip_from_view: mat4x4<f32>,
    /// Thickness assumed behind visible surfaces, in m.
    thickness_m: f32,
    /// Distance along the ray at which tracing begins, in m.
    bias_m: f32,
    /// Distance along the ray at which tracing ends, in m.
    reach_m: f32,
    /// Distance between steps, in texels.
    stride: f32,
    /// Maximum perceptual roughness that is traced.
    most_roughness: f32,
    /// Exposure of this frame divided by that of the previous frame.
    exposure_ratio: f32,
    /// Number of levels of `depth_bounds`.
    bounds_levels: i32,
}

/// Largest and smallest depth of blocks, written by pass/depth_bounds.wgsl.
@group(0) @binding(39) var depth_bounds: texture_2d<f32>;
@group(0) @binding(22) var<uniform> settings: ReflectionUniforms;
/// Pre-exposed radiance of the previous frame.
@group(0) @binding(41) var earlier: texture_2d<f32>;
/// Linear filter, clamp to edge.
@group(0) @binding(42) var earlier_sampler: sampler;

@vertex
fn vs_main(
    instance: Instance,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) tangent: vec4<f32>,
    @location(3) uv0: vec2<f32>,
    @location(4) uv1: vec2<f32>,
    @location(5) color: vec4<f32>,
) -> SurfaceVertex {
    return surface_vertex(instance, position, normal, tangent, vec4<f32>(uv0, uv1), color);
}

/// Ray on the screen: (x, y) in texels of the depth pyramid and depth at its start, and the
/// difference to its end.
struct PictureRay {
    start: vec3<f32>,
    way: vec3<f32>,
}

/// Returns (x, y) in texels and depth of a view-space position.
fn in_picture(position: vec3<f32>) -> vec3<f32> {
    let ndc = ndc_from_view(position, settings.projection);
    let size = vec2<f32>(textureDimensions(structure));
    return vec3<f32>(uv_from_clip(ndc.xy) * size, ndc.z);
}

/// Returns the view-space position at this share of the ray.
fn place_on(ray: PictureRay, share: f32) -> vec3<f32> {
    let at = ray.start + share * ray.way;
    return view_position(structure_ndc(at.xy), at.z, settings.projection);
}

/// Share of a ray, and whether there is a hit.
struct Meeting {
    share: f32,
    met: bool,
}

/// Finds the hit between two shares of a ray, of which the later is behind the surface. Bisects
/// until both are in the same texel, and interpolates depth there.
fn meeting_between(ray: PictureRay, before: f32, here: f32) -> f32 {
    var low = before;
    var high = here;
    let texels = max(abs(ray.way.x), abs(ray.way.y));
    for (var i = 0; i < 8 && (high - low) * texels > 0.5; i++) {
        let middle = 0.5 * (low + high);
        let at = ray.start + middle * ray.way;
        if structure_depth(vec2<i32>(floor(at.xy))) > at.z {
            high = middle;
        } else {
            low = middle;
        }
    }
    let surface = structure_depth(vec2<i32>(floor(ray.start.xy + high * ray.way.xy)));
    return share_at_depth(surface, ray.start.z, ray.way.z, low, high);
}

/// Traces a ray from `origin`, on a surface with this normal, in view space.
fn follow(ray: PictureRay, origin: vec3<f32>, normal: vec3<f32>, jitter: f32) -> Meeting {
    let size = vec2<f32>(textureDimensions(structure));
    let end = share_in_picture(ray.start.xy, ray.way.xy, size);
    let texels = max(abs(ray.way.x), abs(ray.way.y));
    let step = min(settings.stride / max(texels, 1e-6), end);
    let steps = u32(min(max(size.x, size.y), ceil(end / max(step, 1e-9)))) + 1u;
    let row = settings.projection.depth;
    var before = 0.0;
    var before_z = view_z(ray.start.z, row);
    for (var i = 0u; i < steps; i++) {
        let here = min(step * (f32(i) + 0.5 + jitter), end);
        let at = ray.start + here * ray.way;
        let here_z = view_z(at.z, row);
        let texel = vec2<i32>(min(floor(at.xy), size - 1.0));
        let depth = structure_depth(texel);
        // Depth 0 is not a position (hard case 30).
        if depth > 0.0
            && ray_meets(before_z, here_z, view_z(depth, row), settings.thickness_m) {
            let met = structure_position(texel, depth, settings.projection);
            let over = place_on(ray, here);
            if rises_from_plane(dot(normal, met - origin), dot(normal, over - origin)) {
                return Meeting(meeting_between(ray, before, here), true);
            }
        }
        if here >= end {
            break;
        }
        before = here;
        before_z = here_z;
    }
    return Meeting(1.0, false);
}

/// Block of texels at a place of a ray, and the share at which the ray leaves it.
struct Block {
    index: vec2<i32>,
    leaves: f32,
}

/// Returns the block of a level at a share of a ray. The last block of a side ends at the border.
fn block_at(ray: PictureRay, share: f32, level: i32, size: vec2<i32>) -> Block {
    // At a border, the next block: a thousandth of a texel ahead.
    let ahead = ray.start.xy + share * ray.way.xy + 1e-3 * sign(ray.way.xy);
    let texel = clamp(vec2<i32>(floor(ahead)), vec2<i32>(0), size - 1);
    let shift = vec2<u32>(u32(level));
    var last = size - 1;
    if level > 0 {
        let first = vec2<i32>(textureDimensions(depth_bounds));
        last = max(first >> vec2<u32>(u32(level - 1)), vec2<i32>(1)) - 1;
    }
    let index = min(texel >> shift, last);
    let above = select((index + 1) << shift, size, index == last);
    let border = vec2<f32>(select(index << shift, above, ray.way.xy > vec2<f32>(0.0)));
    let moves = abs(ray.way.xy);
    let away = select(vec2<f32>(1.0), abs(border - ray.start.xy) / moves, moves > vec2<f32>(1e-6));
    return Block(index, min(away.x, away.y));
}

/// Returns true if a ray, between two depths, passes a block in front of its nearest surface or
/// behind its farthest one.
fn passes(nearest: f32, farthest: f32, bounds: vec2<f32>) -> bool {
    if farthest > bounds.x {
        return true;
    }
    let row = settings.projection.depth;
    return view_z(nearest, row) < view_z(bounds.y, row) - settings.thickness_m;
}

/// Traces a ray as `follow` does, through all texels on its way. Blocks of texels that it passes
/// are skipped.
fn follow_in_blocks(ray: PictureRay, origin: vec3<f32>, normal: vec3<f32>) -> Meeting {
    let size = vec2<i32>(textureDimensions(structure));
    let end = share_in_picture(ray.start.xy, ray.way.xy, vec2<f32>(size));
    let row = settings.projection.depth;
    let most = 4 * (size.x + size.y);
    var level = min(1, settings.bounds_levels);
    var share = 0.0;
    for (var i = 0; i < most; i++) {
        let block = block_at(ray, share, level, size);
        let next = min(max(block.leaves, share), end);
        let from_depth = ray.start.z + share * ray.way.z;
        let to_depth = ray.start.z + next * ray.way.z;
        if level > 0 {
            let bounds = textureLoad(depth_bounds, block.index, level - 1).rg;
            if !passes(max(from_depth, to_depth), min(from_depth, to_depth), bounds) {
                level -= 1;
                continue;
            }
        } else {
            let depth = structure_depth(block.index);
            let here_z = view_z(to_depth, row);
            let before_z = view_z(from_depth, row);
            if depth > 0.0
                && ray_meets(before_z, here_z, view_z(depth, row), settings.thickness_m) {
                let met = structure_position(block.index, depth, settings.projection);
                let over = place_on(ray, next);
                if rises_from_plane(dot(normal, met - origin), dot(normal, over - origin)) {
                    let hit = share_at_depth(depth, ray.start.z, ray.way.z, share, next);
                    return Meeting(hit, true);
                }
            }
        }
        if next >= end {
            break;
        }
        share = next;
        level = min(level + 1, settings.bounds_levels);
    }
    return Meeting(1.0, false);
}

/// Result of a pixel's ray.
struct Found {
    /// Radiance times its weight, and the weight.
    @location(0) radiance: vec4<f32>,
    /// Length of the ray in m.
    @location(1) way_m: f32,
}

/// Result without a hit; the length is used when the results of neighbors are blurred.
const NOTHING: Found = Found(vec4<f32>(0.0), 1.0);

/// Returns the color of the previous frame at a view-space position, and its weight.
fn earlier_radiance(place: vec3<f32>) -> vec4<f32> {
    let clip = settings.earlier_clip_from_view * vec4<f32>(place, 1.0);
    if !(clip.w > 1e-6) {
        return vec4<f32>(0.0);
    }
    let uv = uv_from_clip(clip.xy / clip.w);
    let fade = contact_fade(uv);
    let seen = textureSampleLevel(earlier, earlier_sampler, uv, 0.0).rgb;
    // Ignores NaN and infinity of the previous frame.
    if !(fade > 0.0) || !all_finite3(seen) {
        return vec4<f32>(0.0);
    }
    let exposed = min(seen * settings.exposure_ratio, vec3<f32>(65504.0));
    return vec4<f32>(exposed * fade, fade);
}

/// Ray of a fragment.
struct Traced {
    ray: PictureRay,
    origin: vec3<f32>,
    outset: vec3<f32>,
    /// Weight by roughness; 0 if the fragment has no ray.
    weight: f32,
    /// Geometric normal in view space.
    normal: vec3<f32>,
}

/// Returns the mirrored ray of a fragment, in view space.
fn mirrored_ray(vertex: SurfaceVertex, front_facing: bool) -> Traced {
    let geometric = geometric_normal(vertex);
    let side = face_sign(front_facing);
    let normal = shading_normal(vertex, smooth_normal(vertex, geometric, side), side);
    var traced: Traced;
    traced.weight = 0.0;
    let weight = roughness_fade(metallic_roughness(texture_uv(vertex)).y, settings.most_roughness);
    if weight <= 0.0 || material_has(TRAIT_UNLIT) {
        return traced;
    }
    let view_from_world = transpose(mat3x3<f32>(
        frame.world_from_view[0].xyz,
        frame.world_from_view[1].xyz,
        frame.world_from_view[2].xyz,
    ));
    let to_viewer = frame.camera.xyz - frame.camera.w * vertex.world;
    let mirrored = reflect(-normalize_or(to_viewer, normal), normal);
    let along = normalize_or(view_from_world * mirrored, vec3<f32>(0.0, 0.0, -1.0));
    traced.origin = view_from_world * vertex.world;
    traced.outset = traced.origin + settings.bias_m * along;
    traced.normal = view_from_world * geometric;
    let near_z = view_z(1.0, settings.projection.depth);
    let length_m = ray_length_m(traced.outset.z, along.z, near_z, settings.reach_m);
    if !(length_m > 0.0) {
        return traced;
    }
    let start = in_picture(traced.outset);
    traced.ray = PictureRay(start, in_picture(traced.outset + length_m * along) - start);
    traced.weight = weight;
    return traced;
}

/// Returns the radiance at the hit of a ray.
fn found_at(traced: Traced, found: Meeting) -> Found {
    if !found.met {
        return NOTHING;
    }
    let place = place_on(traced.ray, found.share);
    let way_m = distance(traced.outset, place);
    let weight = traced.weight * reach_fade(way_m / settings.reach_m);
    let radiance = earlier_radiance(place) * weight;
    if radiance.a == 0.0 {
        return NOTHING;
    }
    return Found(radiance, min(settings.bias_m + way_m, 65504.0));
}

/// Steps over several texels at a time.
@fragment
fn fs_main(
    vertex: SurfaceVertex,
    @builtin(front_facing) front_facing: bool,
) -> Found {
    let traced = mirrored_ray(vertex, front_facing);
    if traced.weight <= 0.0 {
        return NOTHING;
    }
    let jitter = interleaved_gradient_noise(vertex.position.xy, 0u);
    return found_at(traced, follow(traced.ray, traced.origin, traced.normal, jitter));
}

/// Visits every texel, and skips blocks of texels.
@fragment
fn fs_blocks(
    vertex: SurfaceVertex,
    @builtin(front_facing) front_facing: bool,
) -> Found {
    let traced = mirrored_ray(vertex, front_facing);
    if traced.weight <= 0.0 {
        return NOTHING;
    }
    return found_at(traced, follow_in_blocks(traced.ray, traced.origin, traced.normal));
}
