// Reflection of the environment by a surface with all its lobes.

@if(AMBIENT_OCCLUSION || OCCLUSION_UPSAMPLED)
import package::interface::ambient_occlusion::screen_occlusion;
import package::interface::ambient_occlusion::BENT_NORMALS;
import package::interface::material::{SLOT_OCCLUSION, material_has, occlusion};
@if(SUBSURFACE || CLOTH_SUBSURFACE)
import package::interface::material::material;
@if(REFLECTIONS)
import package::interface::reflection::found_reflection;
@if(ANISOTROPY)
import package::lib::anisotropy::anisotropic_bent_normal;
import package::lib::dfg::{specular_albedo, energy_compensation};
import package::lib::environment::specular_dominant_direction;
@if(CLEAR_COAT)
import package::lib::fresnel::f_schlick_scalar;
import package::lib::numerics::normalize_or;
import package::lib::occlusion::{
    gtao_multi_bounce, specular_occlusion, specular_occlusion_cones,
};
import package::lib::real::{real, real2};
@if(CLOTH_SUBSURFACE)
import package::lib::real::real3;
import package::lib::standard_surface::StandardSurface;
@if(SUBSURFACE)
import package::lib::subsurface::{subsurface_ambient, subsurface_roughness};
@if(CLOTH_SUBSURFACE)
import package::lib::subsurface::{cloth_tint, wrapped_cosine};
import package::shading::ambient::{ambient_irradiance, ambient_radiance};
import package::shading::quality::{
    ENERGY_COMPENSATION, MULTI_BOUNCE_OCCLUSION, SPECULAR_OCCLUSION,
};
import package::shading::surface::Surface;
@if(IRIDESCENCE)
import package::shading::surface::share_below;

/// Visibility of ambient light: the share that arrives, 1 without occlusion.
struct AmbientVisibility {
    /// Visibility for the Lambert layer.
    diffuse: vec3<f32>,
    /// Visibility for the GGX layer.
    specular: vec3<f32>,
    /// Visibility of the cosine-weighted hemisphere, 0…1.
    ambient: f32,
}

/// True if screen-space ambient occlusion is read.
@if(AMBIENT_OCCLUSION || OCCLUSION_UPSAMPLED)
const SCREEN_OCCLUSION: bool = true;
@else
const SCREEN_OCCLUSION: bool = false;

/// Returns the visibility for a specular lobe, from the visibility `ambient` of the cosine-weighted
/// hemisphere.
fn specular_visibility(nov: f32, ambient: f32, alpha: f32) -> f32 {
    if SPECULAR_OCCLUSION {
        return specular_occlusion(nov, ambient, alpha);
    }
    return 1.0;
}

/// Returns the lower of the occlusion texture and, if `on_screen`, screen-space occlusion. Quality
/// overrides select the terms. Position and slope of depth are as in `screen_occlusion`.
fn ambient_visibility(
    s: StandardSurface,
    uv: vec4<f32>,
    position: vec4<f32>,
    depth_slope: vec2<f32>,
    on_screen: bool,
) -> AmbientVisibility {
    var ambient = 1.0;
    if material_has(SLOT_OCCLUSION) {
        ambient = saturate(occlusion(uv));
    }
    var around = vec4<f32>(1.0, 0.0, 0.0, 0.0);
    @if(AMBIENT_OCCLUSION || OCCLUSION_UPSAMPLED) {
        if on_screen {
            around = screen_occlusion(position, depth_slope);
            ambient = min(ambient, saturate(around.x));
        }
    }
    if !material_has(SLOT_OCCLUSION) && !SCREEN_OCCLUSION {
        return AmbientVisibility(vec3<f32>(1.0), vec3<f32>(1.0), 1.0);
    }
    var specular = specular_visibility(f32(s.nov), ambient, f32(s.alpha));
    if SPECULAR_OCCLUSION && BENT_NORMALS && on_screen {
        let normal = vec3<f32>(s.normal);
        let open = normalize_or(around.yzw, normal);
        let r = reflect(-vec3<f32>(s.view), normal);
        // The minimum of both, as in Filament: cones do not apply to mirrors.
        specular = min(specular, specular_occlusion_cones(open, r, ambient, f32(s.alpha)));
    }
    var visible = AmbientVisibility(vec3<f32>(ambient), vec3<f32>(specular), ambient);
    if MULTI_BOUNCE_OCCLUSION {
        visible.diffuse = gtao_multi_bounce(ambient, vec3<f32>(s.diffuse));
        visible.specular = gtao_multi_bounce(specular, vec3<f32>(s.f0));
    }
    // Uses select instead of a branch. Branches on a uniform and a texel may crash Mesa 22.3's
    // software driver.
    let open = ambient == 1.0;
    visible.diffuse = select(visible.diffuse, vec3<f32>(1.0), open);
    visible.specular = select(visible.specular, vec3<f32>(1.0), open);
    return visible;
}

/// Returns the radiance that the base reflects. `normal` and `view` are in f32, because mirrors
/// show their rounding. If `on_screen`, screen-space reflections replace the environment by their
/// weight, without occlusion. `position` is as in @builtin(position); `world` is the fragment's
/// position.
fn reflect_environment(
    s: Surface,
    normal: vec3<f32>,
    view: vec3<f32>,
    roughness: f32,
    dfg: real2,
    visibility: AmbientVisibility,
    position: vec4<f32>,
    world: vec3<f32>,
    on_screen: bool,
) -> vec3<f32> {
    let albedo = specular_albedo(s.base.f0, s.base.f90, dfg);
    // The environment is filtered for isotropic lobes; a bent normal approximates anisotropy.
    @if(ANISOTROPY)
    let bent = anisotropic_bent_normal(
        normal,
        s.anisotropy.bitangent,
        view,
        s.anisotropy.strength,
        roughness,
    );
    @if(ANISOTROPY)
    let axis = normalize_or(bent, normal);
    @else
    let axis = normal;
    let r = reflect(-view, axis);
    let dominant = specular_dominant_direction(normal, r, f32(s.base.alpha));
    var compensation = vec3<f32>(1.0);
    if ENERGY_COMPENSATION {
        compensation = vec3<f32>(energy_compensation(s.base.f0, dfg.y));
    }
    let around = ambient_radiance(normalize_or(dominant, normal), roughness);
    var specular = vec3<f32>(albedo) * around * compensation * visibility.specular;
    @if(REFLECTIONS) {
        if on_screen {
            let found = found_reflection(position, world, f32(s.base.alpha));
            specular = specular * (1.0 - found.a) + vec3<f32>(albedo) * found.rgb * compensation;
        }
    }
    @if(IRIDESCENCE)
    let below = share_below(s, albedo);
    @else
    let below = 1.0 - albedo;
    @if(CLOTH_SUBSURFACE)
    let scattered = vec3<f32>(s.base.diffuse * below * wrapped_cosine(s.base.nov)
        * cloth_tint(real3(material.subsurface.cloth_color), s.base.nov));
    @else
    let scattered = vec3<f32>(s.base.diffuse * below);
    let diffuse = scattered * ambient_irradiance(normal);
    // Not occluded, as in Filament.
    @if(SUBSURFACE) {
        let given = material.subsurface;
        let through = subsurface_roughness(f32(s.base.alpha), given.thickness);
        let light = ambient_irradiance(normal) + ambient_radiance(-view, through);
        specular += given.color * light * subsurface_ambient(given.thickness);
    }
    // Occlusion of the front also applies to light from behind.
    @if(DIFFUSE_TRANSMISSION)
    specular += vec3<f32>(s.translucency.color * below) * ambient_irradiance(-normal)
        * visibility.diffuse;
    return diffuse * visibility.diffuse + specular;
}

/// Returns the radiance of the surface: `below`, attenuated by sheen and clear coat, plus their
/// reflection of the environment.
fn add_layers(
    s: Surface,
    normal: vec3<f32>,
    view: vec3<f32>,
    below: vec3<f32>,
    visibility: AmbientVisibility,
) -> vec3<f32> {
    var radiance = below;
    @if(SHEEN) {
        let r = reflect(-view, normal);
        let visible = specular_visibility(f32(s.base.nov), visibility.ambient, f32(s.sheen.alpha));
        let reflected = ambient_radiance(r, s.sheen.roughness) * (f32(s.sheen.albedo) * visible);
        radiance = radiance * f32(s.sheen.attenuation) + vec3<f32>(s.sheen.color) * reflected;
    }
    @if(CLEAR_COAT) {
        let coat = s.coat;
        let fresnel = f32(f_schlick_scalar(0.04, 1.0, coat.nov) * coat.strength);
        let visible = specular_visibility(f32(coat.nov), visibility.ambient, f32(coat.alpha));
        let reflected = ambient_radiance(reflect(-view, coat.normal), coat.roughness);
        radiance = radiance * (1.0 - fresnel) + reflected * (fresnel * visible);
    }
    return radiance;
}
