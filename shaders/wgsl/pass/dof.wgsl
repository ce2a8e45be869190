// Depth of field: a gather over the circle of confusion, in the same steps as Filament.
//
// `fs_coc` adds the radius to the radiance, and `fs_level` halves both. `fs_tiles` finds the range
// of radii in each tile, and `fs_dilate` the range that may reach into it. `fs_gather` gathers
// out-of-focus light, `fs_median` removes noise, and `fs_combine` composites the result over the
// image.

import package::lib::dither::interleaved_gradient_noise;
import package::lib::dof::{
    COC_IN_FOCUS, inverse_distance, coc_radius, coc_opacity, coc_reaches, coc_density, ring_level,
};
import package::lib::fullscreen::{fullscreen_position, uv_from_clip};
import package::lib::math::PI;

/// Settings. Mirrored by `layout::DofUniforms`.
struct DofUniforms {
    /// Coefficients of z and w in clip space, see lib/unproject.wgsl.
    depth_row: vec4<f32>,
    /// Maximum radius in front of and behind the focus plane, in pixels.
    most_px: vec2<f32>,
    /// Reciprocal of the image size, in 1/pixels.
    per_px: vec2<f32>,
    /// Focus distance, in m.
    focus_m: f32,
    /// Diameter of the circle of confusion at infinity, in pixels.
    scale_px: f32,
    /// Width and height of a tile, in texels of the gather.
    tile_texels: f32,
    /// Number of the last mip level.
    last_level: f32,
}

/// Pixels of the image per texel of the gather: 1 or 2.
override TEXEL_PX: f32 = 1.0;
/// Number of rings of taps in the foreground, in the background, and for a constant radius.
override RINGS_BEFORE: f32 = 5.0;
override RINGS_BEHIND: f32 = 5.0;
override RINGS_EVEN: f32 = 5.0;

@group(0) @binding(0) var<uniform> dof: DofUniforms;
/// Pre-exposed radiance, single-sampled.
@group(0) @binding(1) var hdr: texture_2d<f32>;
/// Reversed depth, of the same size as the radiance.
@group(0) @binding(2) var scene_depth: texture_2d<f32>;
/// Radiance, and the radius in alpha: all levels, or the previous level.
@group(0) @binding(3) var field: texture_2d<f32>;
/// Linear filter, clamp to edge.
@group(0) @binding(4) var field_sampler: sampler;
/// Minimum and maximum radius of a tile.
@group(0) @binding(5) var tiles: texture_2d<f32>;
/// Gathered color, multiplied by its opacity; opacity in alpha.
@group(0) @binding(6) var gathered: texture_2d<f32>;

struct DofVertex {
    @builtin(position) position: vec4<f32>,
    @location(0) uv: vec2<f32>,
}

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> DofVertex {
    let position = fullscreen_position(vertex, 0.0);
    return DofVertex(position, uv_from_clip(position.xy));
}

fn brightness(color: vec3<f32>) -> f32 {
    return max(color.r, max(color.g, color.b));
}

/// Computes radiance and radius. At half size, the nearest of four pixels counts, and bright texels
/// have less weight.
@fragment
fn fs_coc(vertex: DofVertex) -> @location(0) vec4<f32> {
    let side = i32(TEXEL_PX);
    let last = vec2<i32>(textureDimensions(hdr, 0)) - 1;
    var nearest = dof.most_px.y;
    var sum = vec3<f32>(0.0);
    var whole = 0.0;
    for (var i = 0; i < side * side; i++) {
        let at = min(vec2<i32>(vertex.position.xy) * side + vec2<i32>(i % side, i / side), last);
        let per_m = inverse_distance(textureLoad(scene_depth, at, 0).r, dof.depth_row);
        nearest = min(nearest, coc_radius(per_m, dof.focus_m, dof.scale_px, dof.most_px));
        let color = textureLoad(hdr, at, 0).rgb;
        let weight = 1.0 / (1.0 + brightness(color));
        sum += color * weight;
        whole += weight;
    }
    return vec4<f32>(sum / whole, nearest);
}

@fragment
fn fs_level(vertex: DofVertex) -> @location(0) vec4<f32> {
    let last = vec2<i32>(textureDimensions(field, 0)) - 1;
    var color = vec3<f32>(0.0);
    var nearest = dof.most_px.y;
    for (var i = 0; i < 4; i++) {
        let at = min(vec2<i32>(vertex.position.xy) * 2 + vec2<i32>(i % 2, i / 2), last);
        let texel = textureLoad(field, at, 0);
        color += texel.rgb * 0.25;
        nearest = min(nearest, texel.a);
    }
    return vec4<f32>(color, nearest);
}

@fragment
fn fs_tiles(vertex: DofVertex) -> @location(0) vec4<f32> {
    let side = i32(dof.tile_texels);
    let first = vec2<i32>(vertex.position.xy) * side;
    let end = min(first + side, vec2<i32>(textureDimensions(field, 0)));
    var least = dof.most_px.y;
    var largest = -dof.most_px.x;
    for (var y = first.y; y < end.y; y++) {
        for (var x = first.x; x < end.x; x++) {
            let radius = textureLoad(field, vec2<i32>(x, y), 0).a;
            least = min(least, radius);
            largest = max(largest, radius);
        }
    }
    return vec4<f32>(least, largest, 0.0, 0.0);
}

/// Searches two tiles of 16 pixels in each direction: circles have a radius of up to 32.
@fragment
fn fs_dilate(vertex: DofVertex) -> @location(0) vec4<f32> {
    let last = vec2<i32>(textureDimensions(tiles, 0)) - 1;
    let middle = vec2<i32>(vertex.position.xy);
    var found = textureLoad(tiles, middle, 0).rg;
    for (var i = 0; i < 25; i++) {
        let at = clamp(middle + vec2<i32>(i % 5 - 2, i / 5 - 2), vec2<i32>(0), last);
        let other = textureLoad(tiles, at, 0).rg;
        found = vec2<f32>(min(found.x, other.x), max(found.y, other.y));
    }
    return vec4<f32>(found, 0.0, 0.0);
}

/// Returns the radii that may reach a texel of the gather.
fn tile_of(position: vec2<f32>) -> vec2<f32> {
    return textureLoad(tiles, vec2<i32>(position / dof.tile_texels), 0).rg;
}

fn in_focus(tile: vec2<f32>) -> bool {
    return max(abs(tile.x), abs(tile.y)) < COC_IN_FOCUS;
}

fn tap(uv: vec2<f32>, level: i32) -> vec4<f32> {
    let size = vec2<i32>(textureDimensions(field, level));
    let at = clamp(vec2<i32>(floor(uv * vec2<f32>(size))), vec2<i32>(0), size - 1);
    return textureLoad(field, at, level);
}

fn level_of(rings: f32, radius_px: f32) -> i32 {
    return i32(min(ring_level(rings, radius_px / TEXEL_PX), dof.last_level));
}

/// Returns tap `number` of ring `ring`, starting at 1, in units of rings. Each ring has eight more
/// taps, and every second ring is rotated.
fn on_ring(ring: f32, number: f32) -> vec2<f32> {
    let angle = (number + 0.5 * (ring % 2.0)) * (2.0 * PI / (8.0 * ring));
    return ring * vec2<f32>(cos(angle), sin(angle));
}

/// Gathers with equal weights within one radius.
fn gather_even(uv: vec2<f32>, radius: f32, noise: vec2<f32>) -> vec4<f32> {
    let rings = RINGS_EVEN;
    let level = f32(level_of(rings, radius));
    let step = dof.per_px * (radius / (rings - 0.5));
    var sum = textureSampleLevel(field, field_sampler, uv + noise * step, level).rgb;
    var count = 1.0;
    for (var ring = 1.0; ring < rings; ring += 1.0) {
        for (var i = 0.0; i < 8.0 * ring; i += 1.0) {
            let at = uv + (noise + on_ring(ring, i)) * step;
            sum += textureSampleLevel(field, field_sampler, at, level).rgb;
        }
        count += 8.0 * ring;
    }
    let opacity = coc_opacity(radius);
    return vec4<f32>(sum / count * opacity, opacity);
}

/// Gathers the foreground as two layers, the nearer over the other. The nearer of two opposite taps
/// counts for both, as a guess of the hidden part.
fn gather_before(uv: vec2<f32>, tile: vec2<f32>, noise: vec2<f32>) -> vec4<f32> {
    let rings = RINGS_BEFORE;
    let radius = -tile.x;
    let level = level_of(rings, radius);
    let size = TEXEL_PX * exp2(f32(level));
    let step = radius / (rings - 0.5);
    var front = vec4<f32>(0.0);
    var back = vec4<f32>(0.0);
    var count = 0.0;
    for (var ring = 0.0; ring < rings; ring += 1.0) {
        let pairs = max(4.0 * ring, 1.0);
        for (var i = 0.0; i < pairs; i += 1.0) {
            let d = select(on_ring(ring, i), vec2<f32>(0.0), ring == 0.0);
            let a = tap(uv + (noise + d) * step * dof.per_px, level);
            let b = tap(uv + (noise - d) * step * dof.per_px, level);
            let nearest = min(a.a, b.a);
            let own = saturate(-nearest);
            let reaches = coc_reaches(-nearest, length(noise + d) * step, size);
            let weight = own * reaches * coc_density(nearest, size);
            let behind = weight * saturate((nearest - tile.x - 2.0) * 0.5);
            let taps = select(2.0, 1.0, ring == 0.0);
            let mean = vec4<f32>((a.rgb + b.rgb) * 0.5, 1.0) * taps;
            front += mean * (weight - behind);
            back += mean * behind;
            count += taps;
        }
    }
    let whole = count * coc_density(radius * (rings + 0.5) / rings, size);
    let opacity = saturate(vec2<f32>(front.a, back.a) / whole);
    let near = front.rgb / max(front.a, 1e-6) * opacity.x;
    let far = back.rgb / max(back.a, 1e-6) * opacity.y;
    return vec4<f32>(near + far * (1.0 - opacity.x), 1.0 - (1.0 - opacity.x) * (1.0 - opacity.y));
}

/// Sums over the taps of one ring: radiance times weight, weight, radius times weight, and the
/// number of taps that reach farther.
struct Ring {
    color: vec3<f32>,
    weight: f32,
    radius: f32,
    farther: f32,
}

/// Gathers the background from the outer ring inward. A ring hides the rings behind it by its
/// nearness and its coverage.
fn gather_behind(uv: vec2<f32>, noise: vec2<f32>) -> vec4<f32> {
    let rings = RINGS_BEHIND;
    let radius = abs(tap(uv, 0).a);
    let level = level_of(rings, radius);
    let size = TEXEL_PX * exp2(f32(level));
    let step = radius / (rings - 0.5);
    var all = Ring(vec3<f32>(0.0), 0.0, 0.0, 0.0);
    for (var index = 0.0; index < rings; index += 1.0) {
        let ring = rings - 1.0 - index;
        let border = step * (ring + 0.5);
        let count = max(8.0 * ring, 1.0);
        var own = Ring(vec3<f32>(0.0), 0.0, 0.0, 0.0);
        for (var i = 0.0; i < count; i += 1.0) {
            let d = select(on_ring(ring, i), vec2<f32>(0.0), ring == 0.0);
            let found = tap(uv + (noise + d) * step * dof.per_px, level);
            let reaches = coc_reaches(abs(found.a), length(noise + d) * step, size);
            let weight = step_above(found.a) * reaches * coc_density(found.a, size);
            let farther = saturate(abs(found.a) - border + 0.5) * select(1.0, 0.0, index == 0.0);
            own.color += found.rgb * (weight * (1.0 - farther));
            own.weight += weight * (1.0 - farther);
            own.radius += abs(found.a) * weight * (1.0 - farther);
            own.farther += farther;
            all.color += found.rgb * (weight * farther);
            all.weight += weight * farther;
            all.radius += abs(found.a) * weight * farther;
        }
        let nearer = all.radius / max(all.weight, 1e-6) - own.radius / max(own.weight, 1e-6);
        let hidden = (1.0 - own.farther / count) * saturate(nearer) * step_above(own.weight);
        let left = 1.0 - hidden;
        all.color = all.color * left + own.color;
        all.weight = all.weight * left + own.weight;
        all.radius = all.radius * left + own.radius;
    }
    let mean = all.radius / max(all.weight, 1e-6);
    let seen = smoothstep(COC_IN_FOCUS, 2.0, radius);
    let opacity = coc_opacity(mean) * seen * step_above(all.weight);
    return vec4<f32>(all.color / max(all.weight, 1e-6) * opacity, opacity);
}

/// Returns 1 for x > 0, otherwise 0.
fn step_above(x: f32) -> f32 {
    return select(0.0, 1.0, x > 0.0);
}

@fragment
fn fs_gather(vertex: DofVertex) -> @location(0) vec4<f32> {
    let tile = tile_of(vertex.position.xy);
    if in_focus(tile) {
        return vec4<f32>(0.0);
    }
    let pixel = vertex.position.xy;
    let angle = interleaved_gradient_noise(pixel, 0u) * 2.0 * PI;
    let reach = 0.5 * sqrt(interleaved_gradient_noise(pixel, 7u));
    let noise = reach * vec2<f32>(cos(angle), sin(angle));
    if tile.y - tile.x <= abs(tile.y) * 0.05 {
        return gather_even(vertex.uv, 0.5 * (abs(tile.x) + abs(tile.y)), noise);
    }
    var before = vec4<f32>(0.0);
    var behind = vec4<f32>(0.0);
    if tile.x < 0.0 {
        before = gather_before(vertex.uv, tile, noise);
    }
    if tile.y > 0.0 {
        behind = gather_behind(vertex.uv, noise);
    }
    return before + (1.0 - before.a) * behind;
}

/// Sorts two values, channel by channel.
fn sort(v: ptr<function, array<vec4<f32>, 9>>, a: u32, b: u32) {
    let least = min((*v)[a], (*v)[b]);
    (*v)[b] = max((*v)[a], (*v)[b]);
    (*v)[a] = least;
}

/// Returns the median of 3×3 texels, per channel (Devillard's network of 19 exchanges).
@fragment
fn fs_median(vertex: DofVertex) -> @location(0) vec4<f32> {
    if in_focus(tile_of(vertex.position.xy)) {
        return vec4<f32>(0.0);
    }
    let last = vec2<i32>(textureDimensions(gathered, 0)) - 1;
    var v: array<vec4<f32>, 9>;
    for (var i = 0; i < 9; i++) {
        let at = vec2<i32>(vertex.position.xy) + vec2<i32>(i % 3 - 1, i / 3 - 1);
        v[i] = textureLoad(gathered, clamp(at, vec2<i32>(0), last), 0);
    }
    sort(&v, 1u, 2u);
    sort(&v, 4u, 5u);
    sort(&v, 7u, 8u);
    sort(&v, 0u, 1u);
    sort(&v, 3u, 4u);
    sort(&v, 6u, 7u);
    sort(&v, 1u, 2u);
    sort(&v, 4u, 5u);
    sort(&v, 7u, 8u);
    sort(&v, 0u, 3u);
    sort(&v, 5u, 8u);
    sort(&v, 4u, 7u);
    sort(&v, 3u, 6u);
    sort(&v, 1u, 4u);
    sort(&v, 2u, 5u);
    sort(&v, 4u, 7u);
    sort(&v, 4u, 2u);
    sort(&v, 6u, 4u);
    sort(&v, 4u, 2u);
    return v[4];
}

/// Composites the gathered light over the image.
@fragment
fn fs_combine(vertex: DofVertex) -> @location(0) vec4<f32> {
    let color = textureLoad(hdr, vec2<i32>(vertex.position.xy), 0);
    let over = textureSampleLevel(gathered, field_sampler, vertex.uv, 0.0);
    return vec4<f32>(over.rgb + (1.0 - over.a) * color.rgb, color.a);
}
