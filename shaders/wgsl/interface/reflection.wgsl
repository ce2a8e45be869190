// Screen-space reflections as the color pass reads them; written by pass/reflection.wgsl.
//
// Used with the feature REFLECTIONS.

import package::interface::frame::light_sampler;
import package::interface::scene::{distance_ahead, pixels_per_m};
import package::lib::refraction::{pyramid_lod, transmission_spread};

/// Pre-exposed radiance times its weight in rgb, the weight in a; a mip pyramid.
@group(0) @binding(40) var reflections: texture_2d<f32>;
/// Ray length of each pixel in m; read without filtering.
@group(0) @binding(43) var reflection_hit_distance: texture_2d<f32>;

/// Returns radiance times its weight in rgb and the weight in a, for a fragment at `position` (as
/// in @builtin(position)) and `world` with a lobe of this alpha. The blur is the lobe's spread over
/// the ray, seen from the eye. A facet turns a mirrored ray by twice its tilt, like refraction at
/// index 3.
fn found_reflection(position: vec4<f32>, world: vec3<f32>, alpha: f32) -> vec4<f32> {
    let uv = position.xy / vec2<f32>(textureDimensions(reflections));
    let way_m = textureLoad(reflection_hit_distance, vec2<i32>(position.xy), 0).r;
    let spread_m = transmission_spread(alpha, 3.0) * way_m;
    let lod = pyramid_lod(spread_m * pixels_per_m(distance_ahead(world) + way_m));
    return textureSampleLevel(reflections, light_sampler, uv, lod);
}
