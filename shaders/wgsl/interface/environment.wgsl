// Prefiltered environment. It has its own file because both surfaces and fog read it.

import package::interface::frame::{frame, specular_map, light_sampler};
import package::lib::rgbm::linear_from_rgbm;

/// True if the specular cube is RGBM encoded instead of floating-point.
override ENVIRONMENT_RGBM: bool = false;

/// Returns pre-exposed radiance of the specular cube in direction d of the environment, at a mip
/// level.
fn environment_level(d: vec3<f32>, lod: f32) -> vec3<f32> {
    let texel = textureSampleLevel(specular_map, light_sampler, d, lod);
    var radiance = texel.rgb;
    if ENVIRONMENT_RGBM {
        radiance = linear_from_rgbm(texel);
    }
    return radiance * frame.specular_scale;
}
