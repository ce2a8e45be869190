// Image-based light: from a panorama to a cube of prefiltered radiance, a face and level a draw.
//
// 1. `fs_cube` resamples the panorama into the faces of a cube.
// 2. `fs_mip` halves a level of that cube.
// 3. `fs_prefilter` gathers, for each direction, the lobe of one roughness from the cube, with
//    the split-sum assumption that viewer, normal and reflection coincide. The lobe's samples
//    come as a table, the same for every texel: each reads the level whose texels cover about
//    the solid angle it stands for (Křivánek and Colbert, GPU Gems 3, chapter 20), so 64 do
//    what 1000 unfiltered ones would.
//
// Radiance is kept relative to a power of two, so that any photometric range fits the small
// floats of the targets. Values are rounded to the target's format here: left to the device,
// they may be cut off instead, which would dim small formats by 1 %, and blue most.

import package::lib::cube::{direction_from_cube_uv, cube_solid_angle_weight};
import package::lib::environment::equirect_uv_from_direction;
import package::lib::fullscreen::fullscreen_position;
import package::lib::normal_map::duff_tangent;
import package::lib::quantize::{quantize_rgba16float, quantize_rg11b10ufloat};

/// What a draw fills. Mirrored by `layout::IblUniforms`.
struct IblUniforms {
    /// Face of the cube, 0…5.
    face: u32,
    /// Width and height of the target in texels.
    size_texels: u32,
    /// `fs_cube`: samples along each side of a texel. `fs_prefilter`: rows of the table in use.
    samples: u32,
    /// `fs_cube`: factor on the panorama. `fs_prefilter`: one over the sum of the weights.
    scale: f32,
}

/// Directions of a lobe about +Z, normalized, in xyz; z is also the weight (the cosine to the
/// normal). w is the level of the cube to read. Mirrored by `layout::IblKernelUniforms`.
struct IblKernelUniforms {
    rows: array<vec4<f32>, 4096>,
}

/// True where the target is Rg11b10Ufloat, false where it is Rgba16Float.
override SMALL_FLOATS: bool = false;

@group(0) @binding(0) var<uniform> ibl: IblUniforms;
/// Equirectangular radiance, 32-bit floats: only loaded, since those may not be filterable.
@group(0) @binding(1) var panorama: texture_2d<f32>;
/// `fs_mip`: the level above, alone. `fs_prefilter`: the cube with all its levels.
@group(0) @binding(2) var cube: texture_cube<f32>;
/// Trilinear filter.
@group(0) @binding(3) var cube_sampler: sampler;
@group(0) @binding(4) var<uniform> ibl_kernel: IblKernelUniforms;

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    return fullscreen_position(vertex, 0.0);
}

/// What the target will hold.
fn stored(color: vec3<f32>) -> vec4<f32> {
    if SMALL_FLOATS {
        return quantize_rg11b10ufloat(color, false);
    }
    return quantize_rgba16float(vec4<f32>(color, 1.0), false);
}

/// The panorama at uv, bilinearly filtered; it goes around in u and ends in v.
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

/// The mean of the panorama over a texel of the cube, from a grid of samples.
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

/// The mean of four texels, weighted by their solid angles. They are sampled at their centres: a
/// cube cannot be loaded from, and OpenGL has no other view of it.
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

/// Radiance gathered by the lobe about the texel's direction.
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
