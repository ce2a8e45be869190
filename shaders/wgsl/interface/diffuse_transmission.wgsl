// Diffuse transmission of a material (KHR_materials_diffuse_transmission): textures and lookups.
//
// Used by the color pass with DIFFUSE_TRANSMISSION.

@if(DIFFUSE_TRANSMISSION)
import package::interface::material::{
    SLOT_DIFFUSE_TRANSMISSION, SLOT_DIFFUSE_TRANSMISSION_COLOR, material, material_has, map_uv,
};

/// Share of the scattered light that leaves through the back, in alpha; linear.
@if(DIFFUSE_TRANSMISSION)
@group(1) @binding(35) var diffuse_transmission_texture: texture_2d<f32>;
@if(DIFFUSE_TRANSMISSION)
@group(1) @binding(36) var diffuse_transmission_sampler: sampler;
/// sRGB color.
@if(DIFFUSE_TRANSMISSION)
@group(1) @binding(37) var diffuse_transmission_color_texture: texture_2d<f32>;
@if(DIFFUSE_TRANSMISSION)
@group(1) @binding(38) var diffuse_transmission_color_sampler: sampler;

/// Returns the albedo of the light that leaves through the back, linear Rec.709, and in w its share
/// of the scattered light, 0…1.
@if(DIFFUSE_TRANSMISSION)
fn diffuse_transmission(uv: vec4<f32>) -> vec4<f32> {
    let given = material.diffuse_transmission;
    var values = vec4<f32>(given.color, given.factor);
    if material_has(SLOT_DIFFUSE_TRANSMISSION) {
        let at = map_uv(given.map, uv);
        values.w *=
            textureSample(diffuse_transmission_texture, diffuse_transmission_sampler, at).a;
    }
    if material_has(SLOT_DIFFUSE_TRANSMISSION_COLOR) {
        let at = map_uv(given.color_map, uv);
        let texel = textureSample(
            diffuse_transmission_color_texture,
            diffuse_transmission_color_sampler,
            at,
        ).rgb;
        values *= vec4<f32>(texel, 1.0);
    }
    return values;
}
