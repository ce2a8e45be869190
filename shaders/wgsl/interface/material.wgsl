// Group 1: a glTF metallic-roughness material, its lobes, and their textures.
//
// Slot i of `Material::slots` binds its texture at 1 + 2i and its sampler at 2 + 2i. Textures of a
// lobe exist only with its feature; those of iridescence and diffuse transmission have their own
// files.
//
// With MATERIAL_TABLE, the factors are copied from an array before use, so draws need no bind group
// per material.

import package::interface::material_uniforms::{MaterialUniforms, TextureMap};
import package::lib::normal_map::unpack_normal;
import package::lib::uv_transform::transform_uv;

@if(MATERIAL_TABLE)
@group(1) @binding(0) var<storage, read> materials: array<MaterialUniforms>;
@if(MATERIAL_TABLE)
var<private> material: MaterialUniforms;
@else
@group(1) @binding(0) var<uniform> material: MaterialUniforms;
/// sRGB color and straight alpha.
@group(1) @binding(1) var base_color_texture: texture_2d<f32>;
@group(1) @binding(2) var base_color_sampler: sampler;
/// Roughness in green, metalness in blue; linear.
@group(1) @binding(3) var metallic_roughness_texture: texture_2d<f32>;
@group(1) @binding(4) var metallic_roughness_sampler: sampler;
/// Tangent-space normal; linear.
@group(1) @binding(5) var normal_texture: texture_2d<f32>;
@group(1) @binding(6) var normal_sampler: sampler;
/// Occlusion in red; linear.
@group(1) @binding(7) var occlusion_texture: texture_2d<f32>;
@group(1) @binding(8) var occlusion_sampler: sampler;
/// sRGB color.
@group(1) @binding(9) var emissive_texture: texture_2d<f32>;
@group(1) @binding(10) var emissive_sampler: sampler;
/// Coverage by the coat in red; linear.
@if(CLEAR_COAT)
@group(1) @binding(11) var clear_coat_texture: texture_2d<f32>;
@if(CLEAR_COAT)
@group(1) @binding(12) var clear_coat_sampler: sampler;
/// Roughness of the coat in green; linear.
@if(CLEAR_COAT)
@group(1) @binding(13) var clear_coat_roughness_texture: texture_2d<f32>;
@if(CLEAR_COAT)
@group(1) @binding(14) var clear_coat_roughness_sampler: sampler;
/// Tangent-space normal of the coat; linear.
@if(CLEAR_COAT)
@group(1) @binding(15) var clear_coat_normal_texture: texture_2d<f32>;
@if(CLEAR_COAT)
@group(1) @binding(16) var clear_coat_normal_sampler: sampler;
/// sRGB color.
@if(SHEEN)
@group(1) @binding(17) var sheen_color_texture: texture_2d<f32>;
@if(SHEEN)
@group(1) @binding(18) var sheen_color_sampler: sampler;
/// Perceptual roughness of the sheen in alpha; linear.
@if(SHEEN)
@group(1) @binding(19) var sheen_roughness_texture: texture_2d<f32>;
@if(SHEEN)
@group(1) @binding(20) var sheen_roughness_sampler: sampler;
/// Direction in the tangent plane in red and green, strength in blue; linear.
@if(ANISOTROPY)
@group(1) @binding(21) var anisotropy_texture: texture_2d<f32>;
@if(ANISOTROPY)
@group(1) @binding(22) var anisotropy_sampler: sampler;
/// Transmission in red; linear.
@if(TRANSMISSION)
@group(1) @binding(23) var transmission_texture: texture_2d<f32>;
@if(TRANSMISSION)
@group(1) @binding(24) var transmission_sampler: sampler;
/// Thickness in green; linear.
@if(TRANSMISSION || DIFFUSE_TRANSMISSION)
@group(1) @binding(25) var thickness_texture: texture_2d<f32>;
@if(TRANSMISSION || DIFFUSE_TRANSMISSION)
@group(1) @binding(26) var thickness_sampler: sampler;
/// Factor on the reflection in alpha; linear.
@if(SPECULAR)
@group(1) @binding(27) var specular_texture: texture_2d<f32>;
@if(SPECULAR)
@group(1) @binding(28) var specular_sampler: sampler;
/// sRGB tint of the reflection.
@if(SPECULAR)
@group(1) @binding(29) var specular_color_texture: texture_2d<f32>;
@if(SPECULAR)
@group(1) @binding(30) var specular_color_sampler: sampler;

/// Traits of the material: one bit for each SLOT_* (textures, as in `Material::slots`) and TRAIT_*.
/// Code of absent traits is removed from the shader, because some software drivers do not skip
/// branches.
override MATERIAL_TRAITS: u32 = (1u << TRAIT_UNLIT) - 1u;

const SLOT_BASE_COLOR: u32 = 0u;
const SLOT_METALLIC_ROUGHNESS: u32 = 1u;
const SLOT_NORMAL: u32 = 2u;
const SLOT_OCCLUSION: u32 = 3u;
const SLOT_EMISSIVE: u32 = 4u;
const SLOT_CLEAR_COAT: u32 = 5u;
const SLOT_CLEAR_COAT_ROUGHNESS: u32 = 6u;
const SLOT_CLEAR_COAT_NORMAL: u32 = 7u;
const SLOT_SHEEN_COLOR: u32 = 8u;
const SLOT_SHEEN_ROUGHNESS: u32 = 9u;
const SLOT_ANISOTROPY: u32 = 10u;
const SLOT_TRANSMISSION: u32 = 11u;
const SLOT_THICKNESS: u32 = 12u;
const SLOT_SPECULAR: u32 = 13u;
const SLOT_SPECULAR_COLOR: u32 = 14u;
const SLOT_IRIDESCENCE: u32 = 15u;
const SLOT_IRIDESCENCE_THICKNESS: u32 = 16u;
const SLOT_DIFFUSE_TRANSMISSION: u32 = 17u;
const SLOT_DIFFUSE_TRANSMISSION_COLOR: u32 = 18u;
/// Number of texture slots; the bits of traits follow them.
const SLOT_COUNT: u32 = 19u;
/// The material emits light.
const TRAIT_EMITS: u32 = SLOT_COUNT + 0u;
/// Back faces are drawn and shaded with reversed normals.
const TRAIT_DOUBLE_SIDED: u32 = SLOT_COUNT + 1u;
/// The material is unlit: the base color is shown as it is (KHR_materials_unlit).
const TRAIT_UNLIT: u32 = SLOT_COUNT + 2u;
/// All textures use texture coordinate set 0 without a transform.
const TRAIT_PLAIN_UV: u32 = SLOT_COUNT + 3u;
/// Occlusion is the red channel of the metallic-roughness texture, which is sampled once for both.
const TRAIT_PACKED_OCCLUSION: u32 = SLOT_COUNT + 4u;
/// The mesh consists of lines or points.
const TRAIT_NO_AREA: u32 = SLOT_COUNT + 5u;
/// The base under the clear coat keeps its reflectance in air.
const TRAIT_COAT_KEEPS_F0: u32 = SLOT_COUNT + 6u;
/// The surface is a shadow catcher, visible only where the sun is in shadow.
const TRAIT_SHADOW_CATCHER: u32 = SLOT_COUNT + 7u;

/// Returns true if the material has the texture of a slot, or a trait.
fn material_has(what: u32) -> bool {
    return (MATERIAL_TRAITS & (1u << what)) != 0u;
}

/// Returns the texture coordinates of a map; `uv` holds set 0 in xy and set 1 in zw.
fn map_uv(map: TextureMap, uv: vec4<f32>) -> vec2<f32> {
    if material_has(TRAIT_PLAIN_UV) {
        return uv.xy;
    }
    let chosen = select(uv.xy, uv.zw, map.uv_set == 1u);
    return transform_uv(chosen, map.x_axis, map.y_axis, map.offset);
}

/// Returns the linear base color with straight alpha: factor, texture and vertex color multiplied.
fn base_color(uv: vec4<f32>, vertex_color: vec4<f32>) -> vec4<f32> {
    var color = material.base_color * vertex_color;
    if material_has(SLOT_BASE_COLOR) {
        let at = map_uv(material.base_color_map, uv);
        color *= textureSample(base_color_texture, base_color_sampler, at);
    }
    return color;
}

/// Returns metalness in x and perceptual roughness in y.
fn metallic_roughness(uv: vec4<f32>) -> vec2<f32> {
    var values = vec2<f32>(material.metallic, material.roughness);
    if material_has(SLOT_METALLIC_ROUGHNESS) {
        let at = map_uv(material.metallic_roughness_map, uv);
        values *= textureSample(metallic_roughness_texture, metallic_roughness_sampler, at).bg;
    }
    return values;
}

/// Returns the visibility of ambient light from the occlusion texture, 0…1.
fn occlusion(uv: vec4<f32>) -> f32 {
    if !material_has(SLOT_OCCLUSION) {
        return 1.0;
    }
    var texel: f32;
    if material_has(TRAIT_PACKED_OCCLUSION) {
        let at = map_uv(material.metallic_roughness_map, uv);
        texel = textureSample(metallic_roughness_texture, metallic_roughness_sampler, at).r;
    } else {
        let at = map_uv(material.occlusion_map, uv);
        texel = textureSample(occlusion_texture, occlusion_sampler, at).r;
    }
    return 1.0 + material.occlusion_strength * (texel - 1.0);
}

/// Returns the emitted radiance before exposure.
fn emission(uv: vec4<f32>) -> vec3<f32> {
    var color = material.emissive;
    if material_has(SLOT_EMISSIVE) {
        let at = map_uv(material.emissive_map, uv);
        color *= textureSample(emissive_texture, emissive_sampler, at).rgb;
    }
    return color;
}

/// Returns the coverage by the coat in x, 0…1, and perceptual roughness of the coat in y.
@if(CLEAR_COAT)
fn clear_coat(uv: vec4<f32>) -> vec2<f32> {
    let coat = material.clear_coat;
    var values = vec2<f32>(coat.factor, coat.roughness);
    if material_has(SLOT_CLEAR_COAT) {
        values.x *= textureSample(clear_coat_texture, clear_coat_sampler, map_uv(coat.map, uv)).r;
    }
    if material_has(SLOT_CLEAR_COAT_ROUGHNESS) {
        let at = map_uv(coat.roughness_map, uv);
        values.y *= textureSample(clear_coat_roughness_texture, clear_coat_roughness_sampler, at).g;
    }
    return values;
}

/// Returns the tangent-space normal of the coat, not normalized. Without its own map it is (0, 0,
/// 1), because the coat does not follow the base's normal map.
@if(CLEAR_COAT)
fn clear_coat_tangent_normal(uv: vec4<f32>) -> vec3<f32> {
    let coat = material.clear_coat;
    if !material_has(SLOT_CLEAR_COAT_NORMAL) {
        return vec3<f32>(0.0, 0.0, 1.0);
    }
    let at = map_uv(coat.normal_map, uv);
    let texel = textureSample(clear_coat_normal_texture, clear_coat_normal_sampler, at).xyz;
    return unpack_normal(texel, coat.normal_scale);
}

/// Returns the reflectance of the sheen lobe, linear Rec.709, and its perceptual roughness in w.
@if(SHEEN)
fn sheen(uv: vec4<f32>) -> vec4<f32> {
    let given = material.sheen;
    var values = vec4<f32>(given.color, given.roughness);
    if material_has(SLOT_SHEEN_COLOR) {
        let at = map_uv(given.color_map, uv);
        let texel = textureSample(sheen_color_texture, sheen_color_sampler, at).rgb;
        values *= vec4<f32>(texel, 1.0);
    }
    if material_has(SLOT_SHEEN_ROUGHNESS) {
        let at = map_uv(given.roughness_map, uv);
        values.w *= textureSample(sheen_roughness_texture, sheen_roughness_sampler, at).a;
    }
    return values;
}

/// Returns the unit direction of anisotropy as (tangent, bitangent) components in xy, and the
/// strength in z, 0…1.
@if(ANISOTROPY)
fn anisotropy(uv: vec4<f32>) -> vec3<f32> {
    let given = material.anisotropy;
    var direction = vec2<f32>(1.0, 0.0);
    var strength = given.strength;
    if material_has(SLOT_ANISOTROPY) {
        let at = map_uv(given.map, uv);
        let texel = textureSample(anisotropy_texture, anisotropy_sampler, at).xyz;
        strength *= texel.z;
        let stored = texel.xy * 2.0 - 1.0;
        // Values within an 8-bit step of the middle, such as averages of opposite directions,
        // encode no direction.
        if dot(stored, stored) > 1e-4 {
            direction = normalize(stored);
        }
    }
    let turn = given.rotation;
    let turned = vec2<f32>(
        turn.x * direction.x - turn.y * direction.y,
        turn.y * direction.x + turn.x * direction.y,
    );
    return vec3<f32>(turned, strength);
}

/// Returns the transmission, 0…1.
@if(TRANSMISSION)
fn transmission(uv: vec4<f32>) -> f32 {
    var factor = material.transmission.factor;
    if material_has(SLOT_TRANSMISSION) {
        let at = map_uv(material.transmission.map, uv);
        factor *= textureSample(transmission_texture, transmission_sampler, at).r;
    }
    return factor;
}

/// Returns the thickness of the volume in units of the mesh; 0 is a thin wall.
@if(TRANSMISSION || DIFFUSE_TRANSMISSION)
fn volume_thickness(uv: vec4<f32>) -> f32 {
    var thickness = material.transmission.thickness;
    if material_has(SLOT_THICKNESS) {
        let at = map_uv(material.transmission.thickness_map, uv);
        thickness *= textureSample(thickness_texture, thickness_sampler, at).g;
    }
    return thickness;
}

/// Returns the dielectric reflectance at normal incidence in rgb and at grazing incidence in w
/// (KHR_materials_specular). The tint is limited to full reflection; the factor scales both.
@if(SPECULAR)
fn specular_factors(uv: vec4<f32>) -> vec4<f32> {
    let given = material.specular;
    var color = given.color;
    var factor = given.factor;
    if material_has(SLOT_SPECULAR_COLOR) {
        let at = map_uv(given.color_map, uv);
        color *= textureSample(specular_color_texture, specular_color_sampler, at).rgb;
    }
    if material_has(SLOT_SPECULAR) {
        factor *= textureSample(specular_texture, specular_sampler, map_uv(given.map, uv)).a;
    }
    let f0 = min(material.dielectric_f0 * color, vec3<f32>(1.0));
    return vec4<f32>(f0, 1.0) * factor;
}

@else
fn specular_factors(uv: vec4<f32>) -> vec4<f32> {
    return vec4<f32>(vec3<f32>(material.dielectric_f0), 1.0);
}
