// Thin film of a material (KHR_materials_iridescence): textures and lookups.
//
// Used by the color pass with IRIDESCENCE.

@if(IRIDESCENCE)
import package::interface::material::{
    SLOT_IRIDESCENCE, SLOT_IRIDESCENCE_THICKNESS, material, material_has, map_uv,
};

/// Coverage of the surface by the film in red; linear.
@if(IRIDESCENCE)
@group(1) @binding(31) var iridescence_texture: texture_2d<f32>;
@if(IRIDESCENCE)
@group(1) @binding(32) var iridescence_sampler: sampler;
/// Thickness between its two bounds in green; linear.
@if(IRIDESCENCE)
@group(1) @binding(33) var iridescence_thickness_texture: texture_2d<f32>;
@if(IRIDESCENCE)
@group(1) @binding(34) var iridescence_thickness_sampler: sampler;

/// Returns the coverage by the film in x, 0…1, and the film's thickness in nm in y.
@if(IRIDESCENCE)
fn iridescence(uv: vec4<f32>) -> vec2<f32> {
    let film = material.iridescence;
    var values = vec2<f32>(film.factor, film.max_thickness_nm);
    if material_has(SLOT_IRIDESCENCE) {
        let at = map_uv(film.map, uv);
        values.x *= textureSample(iridescence_texture, iridescence_sampler, at).r;
    }
    if material_has(SLOT_IRIDESCENCE_THICKNESS) {
        let at = map_uv(film.thickness_map, uv);
        let share =
            textureSample(iridescence_thickness_texture, iridescence_thickness_sampler, at).g;
        values.y = mix(film.min_thickness_nm, film.max_thickness_nm, share);
    }
    return values;
}
