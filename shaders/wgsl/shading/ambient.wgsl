// The environment as a light source, looked up by world-space direction.
//
// With the feature ENVIRONMENT_MAP, lobes read the prefiltered cube; otherwise they use three bands
// of spherical harmonics.

@if(ENVIRONMENT_MAP)
import package::interface::environment::environment_level;
import package::interface::frame::{frame, light_sampler, dfg_table};
import package::lib::dfg::dfg_uv;
import package::lib::environment::rotate_about_y;
import package::lib::image_light::specular_lod;
import package::lib::sh::{irradiance_sh, irradiance_sh2, irradiance_sh5, specular_sh};
import package::shading::quality::{IRRADIANCE_FROM_CUBE, SH_BANDS};

/// Returns the first three bands.
fn three_bands() -> array<vec4<f32>, 9> {
    return array<vec4<f32>, 9>(
        frame.sh[0], frame.sh[1], frame.sh[2], frame.sh[3], frame.sh[4],
        frame.sh[5], frame.sh[6], frame.sh[7], frame.sh[8],
    );
}

/// Returns pre-exposed irradiance / π on a surface with unit normal n.
fn ambient_irradiance(n: vec3<f32>) -> vec3<f32> {
    let d = rotate_about_y(n, frame.environment_rotation);
    // The lobe of roughness 1 equals the cosine lobe, so the last level is irradiance / π.
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

/// Returns pre-exposed radiance, filtered by a lobe of this perceptual roughness around the unit
/// vector `direction`.
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

/// Returns the three channels of the DFG table (lib/dfg.wgsl).
fn directional_albedo(nov: f32, roughness: f32) -> vec3<f32> {
    let size = f32(textureDimensions(dfg_table, 0).x);
    return textureSampleLevel(dfg_table, light_sampler, dfg_uv(nov, roughness, size), 0.0).xyz;
}
