// The environment as light: what is bound of it, looked up by a direction in the world.
//
// Feature ENVIRONMENT_MAP: lobes read the prefiltered cube; without it they see what three
// bands of spherical harmonics show.

@if(ENVIRONMENT_MAP)
import package::interface::environment::environment_level;
import package::interface::frame::{frame, light_sampler, dfg_table};
import package::lib::dfg::dfg_uv;
import package::lib::environment::rotate_about_y;
import package::lib::image_light::specular_lod;
import package::lib::sh::{irradiance_sh, irradiance_sh2, irradiance_sh5, specular_sh};
import package::shading::quality::{IRRADIANCE_FROM_CUBE, SH_BANDS};

/// The first three bands.
fn three_bands() -> array<vec4<f32>, 9> {
    return array<vec4<f32>, 9>(
        frame.sh[0], frame.sh[1], frame.sh[2], frame.sh[3], frame.sh[4],
        frame.sh[5], frame.sh[6], frame.sh[7], frame.sh[8],
    );
}

/// Pre-exposed irradiance / π on a surface of unit normal n.
fn ambient_irradiance(n: vec3<f32>) -> vec3<f32> {
    let d = rotate_about_y(n, frame.environment_rotation);
    // The lobe of roughness 1 about n is the cosine's, so the last level is irradiance / π.
    @if(ENVIRONMENT_MAP)
    if IRRADIANCE_FROM_CUBE {
        return environment_level(d, frame.roughness_one_lod);
    }
    if SH_BANDS == 2u {
        let two = array<vec4<f32>, 4>(frame.sh[0], frame.sh[1], frame.sh[2], frame.sh[3]);
        return irradiance_sh2(two, d);
    }
    if SH_BANDS == 5u {
        return irradiance_sh5(frame.sh, d);
    }
    return irradiance_sh(three_bands(), d);
}

/// Pre-exposed radiance that a lobe of that perceptual roughness about the unit vector
/// `direction` gathers.
@if(ENVIRONMENT_MAP)
fn ambient_radiance(direction: vec3<f32>, roughness: f32) -> vec3<f32> {
    let d = rotate_about_y(direction, frame.environment_rotation);
    let lod = specular_lod(roughness, frame.roughness_one_lod);
    return environment_level(d, lod);
}

@else
fn ambient_radiance(direction: vec3<f32>, roughness: f32) -> vec3<f32> {
    let d = rotate_about_y(direction, frame.environment_rotation);
    return specular_sh(three_bands(), d, roughness * roughness);
}

/// The DFG table's three channels (lib/dfg.wgsl).
fn directional_albedo(nov: f32, roughness: f32) -> vec3<f32> {
    let size = f32(textureDimensions(dfg_table, 0).x);
    return textureSampleLevel(dfg_table, light_sampler, dfg_uv(nov, roughness, size), 0.0).xyz;
}
