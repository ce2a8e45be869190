// The prefiltered environment as texels hold it. Its own file, since surfaces and fog read it.

import package::interface::frame::{frame, specular_map, light_sampler};
import package::lib::rgbm::linear_from_rgbm;

/// Texels of the specular cube are RGBM codes instead of floats.
override ENVIRONMENT_RGBM: bool = false;

/// Pre-exposed radiance of the specular cube in the direction d of the environment, at a level.
fn environment_level(d: vec3<f32>, lod: f32) -> vec3<f32> {
    let texel = textureSampleLevel(specular_map, light_sampler, d, lod);
    var radiance = texel.rgb;
    if ENVIRONMENT_RGBM {
        radiance = linear_from_rgbm(texel);
    }
    return radiance * frame.specular_scale;
}
