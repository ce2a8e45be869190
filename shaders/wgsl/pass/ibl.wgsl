// Image-based light: converts a panorama to a prefiltered cube, one face and level per draw.
//
// 1. `fs_cube` resamples the panorama into the faces of a cube.
// 2. `fs_mip` halves a level of that cube.
// 3. `fs_prefilter` integrates the lobe of one roughness for each direction, with the split-sum
// assumption that view, normal and reflection directions coincide. A table holds the lobe's sample
// directions. Each sample reads the level whose texels cover about its solid angle (Křivánek and
// Colbert, GPU Gems 3, chapter 20), so 64 samples replace 1000 unfiltered ones.
//
// Radiance is stored relative to a power of two, so that any photometric range fits the small
// floats of the targets. The shader rounds values to the target's format. Devices may truncate
// instead, which darkens small formats by 1 %, and blue most.

import package::lib::cube::{direction_from_cube_uv, cube_solid_angle_weight};
import package::lib::environment::equirect_uv_from_direction;
import package::lib::fullscreen::fullscreen_position;
import package::lib::normal_map::duff_tangent;
import package::lib::quantize::{quantize_rgba16float, quantize_rg11b10ufloat};

/// Settings of a draw. Mirrored by `layout::IblUniforms`.
struct IblUniforms {
    /// Face of the cube, 0…5.
    face: u32,
    /// Width and height of the target in texels.
    size_texels: u32,
    /// `fs_cube`: samples along each side of a texel. `fs_prefilter`: number of table rows in use.
    samples: u32,
    /// `fs_cube`: factor on the panorama. `fs_prefilter`: reciprocal of the sum of the weights.
    scale: f32,
}

/// Sample directions of a lobe around +Z, normalized, in xyz; z is also the weight (cosine to the
/// normal). w is the mip level of the cube. Mirrored by `layout::IblKernelUniforms`.
struct IblKernelUniforms {
    rows: array<vec4<f32>, 4096>,
}

/// True if the target is Rg11b10Ufloat, false if it is Rgba16Float.
override SMALL_FLOATS: bool = false;

@group(0) @binding(0) var<uniform> ibl: IblUniforms;
/// Equirectangular radiance in 32-bit floats; read without filtering, because they may not be
/// filterable.
@group(0) @binding(1) var panorama: texture_2d<f32>;
/// `fs_mip`: only the previous level. `fs_prefilter`: the cube with all its levels.
@group(0) @binding(2) var cube: texture_cube<f32>;
/// Trilinear filter.
@group(0) @binding(3) var cube_sampler: sampler;
@group(0) @binding(4) var<uniform> ibl_kernel: IblKernelUniforms;

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    return fullscreen_position(vertex, 0.0);
}

/// Rounds a color to the target's format.
fn stored(color: vec3<f32>) -> vec4<f32> {
    if SMALL_FLOATS {
        return quantize_rg11b10ufloat(color, false);
    }
    return quantize_rgba16float(vec4<f32>(color, 1.0), false);
}

/// Samples the panorama at uv bilinearly; it wraps in u and clamps in v.
fn panorama_at(uv: vec2<f32>) -> vec3<f32> {
    let size = vec2<i32>(textureDimensions(panorama, 0));
    let at = uv * vec2<f32>(size) - 0.5;
    let low = floor(at);
    let share = at - low;
    let x0 = (i32(low.x) + size.x) % size.x;
    let x1 = (x0 + 1) % size.x;
    let y0 = clamp(i32(low.y), 0, size.y - 1);
    let y1 = clamp(i32(low.y) + 1, 0, size.y - 1);
    let top = mix(
        textureLoad(panorama, vec2<i32>(x0, y0), 0).rgb,
        textureLoad(panorama, vec2<i32>(x1, y0), 0).rgb,
        share.x,
    );
    let bottom = mix(
        textureLoad(panorama, vec2<i32>(x0, y1), 0).rgb,
        textureLoad(panorama, vec2<i32>(x1, y1), 0).rgb,
        share.x,
    );
    return mix(top, bottom, share.y);
}

/// Averages the panorama over a texel of the cube, from a grid of samples.
@fragment
fn fs_cube(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let corner = floor(position.xy);
    let stride = 1.0 / f32(ibl.samples);
    var sum = vec3<f32>(0.0);
    for (var j = 0u; j < ibl.samples; j++) {
        for (var i = 0u; i < ibl.samples; i++) {
            let uv = (corner + (vec2<f32>(f32(i), f32(j)) + 0.5) * stride) / f32(ibl.size_texels);
            let d = normalize(direction_from_cube_uv(ibl.face, uv));
            sum += panorama_at(equirect_uv_from_direction(d));
        }
    }
    return stored(sum * (stride * stride * ibl.scale));
}

/// Averages four texels, weighted by their solid angles. It samples at texel centers, because cubes
/// cannot be loaded from, and OpenGL has no other view of a cube.
@fragment
fn fs_mip(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let corner = 2.0 * floor(position.xy);
    let source_texels = 2.0 * f32(ibl.size_texels);
    var sum = vec4<f32>(0.0);
    for (var i = 0u; i < 4u; i++) {
        let uv = (corner + vec2<f32>(f32(i & 1u), f32(i >> 1u)) + 0.5) / source_texels;
        let weight = cube_solid_angle_weight(uv);
        let d = direction_from_cube_uv(ibl.face, uv);
        let radiance = textureSampleLevel(cube, cube_sampler, d, 0.0).rgb;
        sum += vec4<f32>(radiance, 1.0) * weight;
    }
    return stored(sum.rgb / sum.w);
}

/// Integrates radiance over the lobe around the texel's direction.
@fragment
fn fs_prefilter(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let uv = position.xy / f32(ibl.size_texels);
    let n = normalize(direction_from_cube_uv(ibl.face, uv));
    let t = duff_tangent(n);
    let b = cross(n, t);
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < ibl.samples; i++) {
        let row = ibl_kernel.rows[i];
        let l = t * row.x + b * row.y + n * row.z;
        sum += textureSampleLevel(cube, cube_sampler, l, row.w).rgb * row.z;
    }
    return stored(sum * ibl.scale);
}
