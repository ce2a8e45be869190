// Color pass: glTF metal-rough surfaces lit by the sun, punctual lights and the environment.
//
// The shading is Filament's standard model. Lights are photometric; input and output radiance is
// pre-exposed linear Rec.709. src/feature.rs describes the features; shading/quality.wgsl has the
// overrides of presets. `fs_main` ends with the epilogue (interface/epilogue.wgsl). With HALF,
// materials and BRDFs are f16 (lib/real.wgsl); light and positions stay f32.

import package::interface::epilogue::epilogue;
@if(FOG)
import package::interface::fog::in_fog;
import package::interface::frame::frame;
import package::interface::material::{
    material, TRAIT_EMITS, TRAIT_NO_AREA, TRAIT_SHADOW_CATCHER, TRAIT_UNLIT, material_has,
    base_color, metallic_roughness, emission, specular_factors,
};
@if(MATERIAL_TABLE)
import package::interface::material::materials;
import package::interface::object::Instance;
@if(CLEAR_COAT)
import package::interface::material::clear_coat;
@if(CLEAR_COAT && TEXTURED)
import package::interface::material::{SLOT_CLEAR_COAT_NORMAL, clear_coat_tangent_normal};
@if(SHEEN)
import package::interface::material::sheen;
@if(ANISOTROPY)
import package::interface::material::anisotropy;
@if(TRANSMISSION)
import package::interface::material::transmission;
@if(TRANSMISSION || DIFFUSE_TRANSMISSION)
import package::interface::material::volume_thickness;
@if(DIFFUSE_TRANSMISSION)
import package::interface::diffuse_transmission::diffuse_transmission;
@if(ANISOTROPY)
import package::lib::anisotropy::gltf_anisotropic_alpha;
@if(SHEEN)
import package::lib::cloth::sheen_attenuation;
import package::lib::dfg::energy_compensation;
@if(TRANSMISSION)
import package::lib::dfg::specular_albedo;
import package::lib::fresnel::f90_from_f0;
import package::lib::ggx::alpha_from_roughness;
import package::interface::blended::{
    AbsorbanceFragment, WeightedFragment, absorbance_moments, total_absorbance,
};
import package::interface::scene::distance_ahead;
import package::lib::metal_rough::{diffuse_from_base_color, f0_from_base_color};
import package::lib::moment_transparency::{
    absorbance, moment_transmittance, power_moments, warped_distance,
};
import package::lib::numerics::{normalize_or, saturate_half3};
import package::lib::real::{real, real2, real3, to_real3};
import package::lib::standard_surface::{StandardSurface, clamp_nov};
@if(IRIDESCENCE)
import package::lib::thin_film::f0_from_reflectance;
import package::lib::weighted_blending::weighted_color;
import package::shading::ambient::directional_albedo;
import package::shading::contact_shadow::contact_visibility;
import package::shading::direct::reflect_surface;
import package::shading::indirect::{ambient_visibility, reflect_environment, add_layers};
@if(DIFFUSE_TRANSMISSION || SUBSURFACE || CLOTH_SUBSURFACE)
import package::shading::through::is_behind;
@if(DIFFUSE_TRANSMISSION)
import package::shading::through::{translucency_of, far_side};
import package::shading::micro_shadow::micro_visibility;
import package::shading::object_light::takes_sun;
import package::shading::quality::{F90_FADES, PUNCTUAL_COMPENSATION, ROUGHNESS_FLOOR};
import package::shading::roughness::shaded_roughness;
import package::shading::punctual::add_punctual;
import package::shading::shadow::{sun_share, sun_visibility, cascade_tint};
import package::shading::shadow_catcher::caught_shadow;
import package::shading::shadow_map::Receiver;
import package::shading::surface::{Surface, layer_transmittance};
@if(CLEAR_COAT)
import package::shading::surface::{ClearCoat, coated_f0, coated_roughness};
@if(SHEEN)
import package::shading::surface::Sheen;
@if(ANISOTROPY)
import package::shading::surface::{Anisotropy, anisotropy_direction};
@if(IRIDESCENCE)
import package::shading::surface::{film_reflectance, share_below};
@if(IRIDESCENCE)
import package::shading::thin_film::film_of;
@if(TRANSMISSION)
import package::shading::through::refract_scene;
import package::shading::vertex::{
    SurfaceVertex, surface_vertex, face_sign, geometric_normal, smooth_normal, shading_normal,
    texture_uv, vertex_color,
};
@if(STEREO)
import package::shading::vertex::toward_eye;
@if(CLEAR_COAT && TEXTURED)
import package::shading::vertex::mapped_normal;

/// 0 opaque: alpha is one. 1 mask: fragments below the cutoff are discarded, alpha is one. 2 blend:
/// color is premultiplied by alpha (blend One, OneMinusSrcAlpha). After a prepass, masked geometry
/// is drawn as opaque, because its holes are already in the depth.
override ALPHA_MODE: u32 = 0u;

/// Enables the sun; false removes it from the shader.
override SUN: bool = true;

/// True if the material specifies its reflectance at grazing incidence, which then does not fade.
/// A constant instead of an `@if` at its use: all variants must have the same overrides.
@if(SPECULAR)
const F90_IS_GIVEN: bool = true;
@else
const F90_IS_GIVEN: bool = false;

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

/// Returns the clear coat of a fragment.
@if(CLEAR_COAT)
fn coat_of(vertex: SurfaceVertex, smooth_side: vec3<f32>, side: f32, view: vec3<f32>) -> ClearCoat {
    let values = clear_coat(texture_uv(vertex));
    let roughness = shaded_roughness(values.y, smooth_side);
    var normal = smooth_side;
    @if(TEXTURED) {
        if material_has(SLOT_CLEAR_COAT_NORMAL) {
            normal = mapped_normal(vertex, smooth_side, side, clear_coat_tangent_normal(vertex.uv));
        }
    }
    return ClearCoat(
        normal,
        clamp_nov(real(dot(normal, view))),
        real(saturate(values.x)),
        roughness,
        alpha_from_roughness(real(roughness), real(ROUGHNESS_FLOOR)),
    );
}

/// Returns the sheen of a fragment.
@if(SHEEN)
fn sheen_of(uv: vec4<f32>, nov: f32) -> Sheen {
    let values = sheen(uv);
    let color = real3(saturate(values.rgb));
    let roughness = clamp(values.w, ROUGHNESS_FLOOR, 1.0);
    let albedo = real(directional_albedo(nov, roughness).z);
    return Sheen(
        color,
        albedo,
        sheen_attenuation(color, albedo),
        roughness,
        alpha_from_roughness(real(roughness), real(ROUGHNESS_FLOOR)),
    );
}

/// Returns the anisotropy of a fragment whose base has `alpha`.
@if(ANISOTROPY)
fn anisotropy_of(vertex: SurfaceVertex, normal: vec3<f32>, side: f32, alpha: real) -> Anisotropy {
    let values = anisotropy(texture_uv(vertex));
    let tangent = anisotropy_direction(normal, normal * side, vertex.tangent, values.xy);
    let floor = real(ROUGHNESS_FLOOR * ROUGHNESS_FLOOR);
    return Anisotropy(
        tangent,
        cross(normal, tangent),
        gltf_anisotropic_alpha(alpha, real(values.z), floor),
        saturate(values.z),
    );
}

/// Returns the emission of the material, pre-exposed.
fn emitted(uv: vec4<f32>) -> vec3<f32> {
    let exposure = mix(1.0, frame.exposure, material.emissive_exposure_weight);
    return emission(uv) * exposure;
}

/// Returns the lit color of a fragment, pre-exposed.
fn shade(vertex: SurfaceVertex, geometric: vec3<f32>, side: f32, base: vec3<f32>) -> vec3<f32> {
    let uv = texture_uv(vertex);
    let metal_rough = metallic_roughness(uv);
    let metallic = real(saturate(metal_rough.x));
    let smooth_side = smooth_normal(vertex, geometric, side);
    var roughness = shaded_roughness(metal_rough.y, smooth_side);
    let normal = shading_normal(vertex, smooth_side, side);
    @if(STEREO) let to_viewer = toward_eye(vertex);
    @else let to_viewer = frame.camera.xyz - frame.camera.w * vertex.world;
    let view = normalize_or(to_viewer, normal);
    let nov = clamp_nov(real(dot(normal, view)));
    let color = to_real3(base);
    let dielectric = specular_factors(uv);
    var f0 = f0_from_base_color(color, metallic, real3(dielectric.rgb));
    var surface: Surface;
    @if(CLEAR_COAT) {
        surface.coat = coat_of(vertex, smooth_side, side, view);
        let strength = surface.coat.strength;
        f0 = coated_f0(f0, strength);
        roughness = coated_roughness(roughness, surface.coat.roughness, f32(strength));
    }
    let dfg = real2(directional_albedo(f32(nov), roughness).xy);
    var f90 = mix(real(dielectric.w), 1.0, metallic);
    if F90_FADES && !F90_IS_GIVEN {
        f90 = f90_from_f0(f0);
    }
    @if(IRIDESCENCE) {
        surface.film = film_of(uv, f32(nov), f0, base, f32(metallic), dielectric);
        // Ambient light reflects from the film as it does toward the viewer.
        let seen = film_reflectance(surface.film, f32(nov));
        let under = f0_from_reflectance(seen, f32(f90), f32(nov));
        f0 = mix(f0, real3(under), real(surface.film.factor));
    }
    var compensation = real3(1.0);
    if PUNCTUAL_COMPENSATION {
        compensation = energy_compensation(f0, dfg.y);
    }
    var diffuse = diffuse_from_base_color(color, metallic);
    // An index of refraction of 0 is the specular-glossiness model, where Filament takes the
    // reflectance from the diffuse color.
    @if(SPECULAR) {
        let largest = real(max(dielectric.r, max(dielectric.g, dielectric.b)));
        diffuse *= select(real(1.0), 1.0 - largest, material.dielectric_f0 >= 1.0);
    }
    @if(TRANSMISSION || DIFFUSE_TRANSMISSION)
    let thickness_m = volume_thickness(uv) * vertex.scale_m;
    // Transmitted light has the tint of diffuse light and replaces it.
    @if(TRANSMISSION) let transmitted = real(saturate(transmission(uv)));
    @if(TRANSMISSION) let through = diffuse * transmitted;
    @if(TRANSMISSION) diffuse -= through;
    @if(DIFFUSE_TRANSMISSION) {
        let given = diffuse_transmission(uv);
        let share = saturate(given.w);
        var lambert = share * f32(1.0 - metallic);
        @if(TRANSMISSION) lambert *= f32(1.0 - transmitted);
        surface.translucency = translucency_of(given.rgb, lambert, thickness_m);
        diffuse *= real(1.0 - share);
    }
    surface.base = StandardSurface(
        real3(normal),
        alpha_from_roughness(real(roughness), real(ROUGHNESS_FLOOR)),
        real3(view),
        nov,
        diffuse,
        f0,
        f90,
        compensation,
    );
    @if(SHEEN) surface.sheen = sheen_of(uv, f32(nov));
    @if(ANISOTROPY)
    surface.anisotropy = anisotropy_of(vertex, normal, side, surface.base.alpha);

    // Blended surfaces are missing in the depth from which ambient occlusion and reflections come.
    let slope = vec2<f32>(dpdx(vertex.position.z), dpdy(vertex.position.z));
    let on_screen = ALPHA_MODE != 2u;
    let visibility = ambient_visibility(surface.base, uv, vertex.position, slope, on_screen);
    var below = reflect_environment(
        surface, normal, view, roughness, dfg, visibility, vertex.position, vertex.world, on_screen,
    );
    @if(TRANSMISSION && IRIDESCENCE)
    let under = share_below(surface, specular_albedo(f0, f90, dfg));
    @if(TRANSMISSION && !IRIDESCENCE)
    let under = 1.0 - specular_albedo(f0, f90, dfg);
    @if(TRANSMISSION) {
        let alpha = f32(surface.base.alpha);
        below += vec3<f32>(through * under)
            * refract_scene(vertex.world, view, normal, alpha, metal_rough.y, thickness_m);
    }
    var radiance = add_layers(surface, normal, view, below, visibility);
    let receiver = Receiver(vertex.world, geometric, vertex.position.xy, slope);
    if SUN && takes_sun() {
        @if(DIFFUSE_TRANSMISSION || SUBSURFACE || CLOTH_SUBSURFACE)
        let comes_through = is_behind(surface, frame.sun_direction);
        // The back side of an object is in its own shadow. Subsurface scattering ignores shadows
        // there, as in Filament.
        @if(!DIFFUSE_TRANSMISSION && (SUBSURFACE || CLOTH_SUBSURFACE)) {
            if comes_through {
                radiance += frame.sun_illuminance
                    * reflect_surface(surface, real3(frame.sun_direction));
            }
        }
        @if(DIFFUSE_TRANSMISSION) {
            if comes_through {
                let lit = far_side(surface, receiver);
                let sun = frame.sun_illuminance
                    * reflect_surface(surface, real3(frame.sun_direction));
                radiance += sun * sun_share(sun_visibility(lit));
            }
        }
        let sun = frame.sun_illuminance * reflect_surface(surface, real3(frame.sun_direction))
            * micro_visibility(uv, dot(normal, frame.sun_direction));
        @if(DIFFUSE_TRANSMISSION || SUBSURFACE || CLOTH_SUBSURFACE)
        let is_lit = !comes_through && any(sun > vec3<f32>(0.0));
        @else
        let is_lit = any(sun > vec3<f32>(0.0));
        if is_lit {
            let visible = sun_visibility(receiver) * contact_visibility(receiver);
            radiance += sun * sun_share(visible);
        }
    }
    radiance = add_punctual(radiance, surface, receiver);
    radiance *= cascade_tint(vertex.world);
    if material_has(TRAIT_EMITS) {
        radiance += emitted(uv) * layer_transmittance(surface);
    }
    return radiance;
}

/// Returns the premultiplied color of a fragment, with fog.
fn seen_color(vertex: SurfaceVertex, front_facing: bool) -> vec4<f32> {
    @if(MATERIAL_TABLE) material = materials[vertex.material];
    // Derivatives need every lane of the quad, so the discard comes last.
    let geometric = geometric_normal(vertex);
    let base = base_color(texture_uv(vertex), vertex_color(vertex));
    let side = face_sign(front_facing);
    var color = base.rgb;
    if !material_has(TRAIT_UNLIT) {
        color = shade(vertex, geometric, side, base.rgb);
    } else if material_has(TRAIT_NO_AREA) && material_has(TRAIT_EMITS) {
        // Lines and points without normals (glTF 2.0, section 3.9.7).
        color += emitted(texture_uv(vertex));
    }
    var caught = 1.0;
    if material_has(TRAIT_SHADOW_CATCHER) {
        caught = 0.0;
        if SUN {
            caught = caught_shadow(vertex, geometric);
        }
    }
    if ALPHA_MODE == 1u && base.a < material.alpha_cutoff {
        discard;
    }
    let alpha = select(1.0, saturate(base.a), ALPHA_MODE == 2u);
    var seen = vec4<f32>(saturate_half3(color * alpha), alpha);
    if material_has(TRAIT_SHADOW_CATCHER) {
        seen *= caught;
    }
    @if(FOG) seen =
        in_fog(seen, normalize_or(vertex.world, vec3<f32>(0.0, 0.0, 1.0)), length(vertex.world));
    return seen;
}

@fragment
fn fs_main(
    vertex: SurfaceVertex,
    @builtin(front_facing) front_facing: bool,
) -> @location(0) vec4<f32> {
    return epilogue(seen_color(vertex, front_facing), vertex.position.xy);
}

/// Writes weighted blended transparency (lib/weighted_blending.wgsl).
@fragment
fn fs_weighted(
    vertex: SurfaceVertex,
    @builtin(front_facing) front_facing: bool,
) -> WeightedFragment {
    let seen = seen_color(vertex, front_facing);
    let sum = weighted_color(seen, distance_ahead(vertex.world));
    return WeightedFragment(sum, 1.0 - seen.a);
}

/// First pass of moment-based transparency (lib/moment_transparency.wgsl): writes absorbance and
/// its moments, without shading.
@fragment
fn fs_absorbance(vertex: SurfaceVertex) -> AbsorbanceFragment {
    @if(MATERIAL_TABLE) material = materials[vertex.material];
    let alpha = base_color(texture_uv(vertex), vertex_color(vertex)).a;
    let absorbed = absorbance(saturate(alpha));
    let at = warped_distance(distance_ahead(vertex.world), frame.blended.xy);
    return AbsorbanceFragment(absorbed, absorbed * power_moments(at));
}

/// Second pass of moment-based transparency: color and alpha, times the transmittance of surfaces
/// in front.
@fragment
fn fs_moments(
    vertex: SurfaceVertex,
    @builtin(front_facing) front_facing: bool,
) -> @location(3) vec4<f32> {
    let seen = seen_color(vertex, front_facing);
    let at = warped_distance(distance_ahead(vertex.world), frame.blended.xy);
    let texel = vec2<i32>(vertex.position.xy);
    let total = textureLoad(total_absorbance, texel, 0).r;
    let moments = textureLoad(absorbance_moments, texel, 0);
    let bias = frame.blended.zw;
    return seen * moment_transmittance(total, moments, at, bias.x, bias.y);
}
