// Group 1: a glTF metallic-roughness material and its textures.

import package::lib::uv_transform::transform_uv;

/// Where a texture lies on the mesh (KHR_texture_transform), and whether there is one.
/// Mirrored by `layout::TextureMap`.
struct TextureMap {
    /// Columns of the 2×2 matrix rotation · scale.
    x_axis: vec2<f32>,
    y_axis: vec2<f32>,
    offset: vec2<f32>,
    /// Which texture coordinate set of the mesh: 0 or 1.
    uv_set: u32,
    /// 1 where the texture exists; 0 leaves the factor alone and reads nothing.
    present: u32,
}

/// Factors of a material. Mirrored by `layout::MaterialUniforms`.
struct MaterialUniforms {
    /// Linear Rec.709 and alpha (straight, not premultiplied).
    base_color: vec4<f32>,
    /// Emitted radiance, linear Rec.709, emissive strength included.
    emissive: vec3<f32>,
    /// How far `emissive` is nits and meets the exposure (1) or a display value that does
    /// not (0, what most assets mean).
    emissive_exposure_weight: f32,
    /// 0 dielectric … 1 metal.
    metallic: f32,
    /// Perceptual roughness, 0…1.
    roughness: f32,
    /// Factor on x and y of the normal map.
    normal_scale: f32,
    /// How far the occlusion texture counts, 0…1.
    occlusion_strength: f32,
    /// MASK: fragments with less alpha are not there.
    alpha_cutoff: f32,
    /// Reflectance of the dielectric part at normal incidence; 0.04 for an index of 1.5.
    dielectric_f0: f32,
    /// MATERIAL_* bits.
    flags: u32,
    base_color_map: TextureMap,
    metallic_roughness_map: TextureMap,
    normal_map: TextureMap,
    occlusion_map: TextureMap,
    emissive_map: TextureMap,
}

/// Bits of `MaterialUniforms::flags`.
const MATERIAL_UNLIT: u32 = 1u;
const MATERIAL_DOUBLE_SIDED: u32 = 2u;

@group(1) @binding(0) var<uniform> material: MaterialUniforms;
/// sRGB color and straight alpha.
@group(1) @binding(1) var base_color_texture: texture_2d<f32>;
/// Roughness in green, metalness in blue; linear.
@group(1) @binding(2) var metallic_roughness_texture: texture_2d<f32>;
/// Tangent-space normal; linear.
@group(1) @binding(3) var normal_texture: texture_2d<f32>;
/// Occlusion in red; linear.
@group(1) @binding(4) var occlusion_texture: texture_2d<f32>;
/// sRGB color.
@group(1) @binding(5) var emissive_texture: texture_2d<f32>;
@group(1) @binding(6) var base_color_sampler: sampler;
@group(1) @binding(7) var metallic_roughness_sampler: sampler;
@group(1) @binding(8) var normal_sampler: sampler;
@group(1) @binding(9) var occlusion_sampler: sampler;
@group(1) @binding(10) var emissive_sampler: sampler;

/// Texture coordinates of a map; `uv` holds set 0 in xy and set 1 in zw.
fn map_uv(map: TextureMap, uv: vec4<f32>) -> vec2<f32> {
    let chosen = select(uv.xy, uv.zw, map.uv_set == 1u);
    return transform_uv(chosen, map.x_axis, map.y_axis, map.offset);
}

/// Linear base color with straight alpha: factor, texture and vertex color multiplied.
fn base_color(uv: vec4<f32>, vertex_color: vec4<f32>) -> vec4<f32> {
    var color = material.base_color * vertex_color;
    if material.base_color_map.present != 0u {
        let at = map_uv(material.base_color_map, uv);
        color *= textureSample(base_color_texture, base_color_sampler, at);
    }
    return color;
}

/// Metalness in x and perceptual roughness in y.
fn metallic_roughness(uv: vec4<f32>) -> vec2<f32> {
    var values = vec2<f32>(material.metallic, material.roughness);
    if material.metallic_roughness_map.present != 0u {
        let at = map_uv(material.metallic_roughness_map, uv);
        values *= textureSample(metallic_roughness_texture, metallic_roughness_sampler, at).bg;
    }
    return values;
}

/// Share of the ambient light that arrives, 0…1.
fn occlusion(uv: vec4<f32>) -> f32 {
    if material.occlusion_map.present == 0u {
        return 1.0;
    }
    let at = map_uv(material.occlusion_map, uv);
    let texel = textureSample(occlusion_texture, occlusion_sampler, at).r;
    return 1.0 + material.occlusion_strength * (texel - 1.0);
}

/// Emitted radiance before exposure.
fn emission(uv: vec4<f32>) -> vec3<f32> {
    var color = material.emissive;
    if material.emissive_map.present != 0u {
        let at = map_uv(material.emissive_map, uv);
        color *= textureSample(emissive_texture, emissive_sampler, at).rgb;
    }
    return color;
}
