// What rays found in the picture, as the color pass reads it: made by pass/reflection.wgsl.
//
// Feature REFLECTIONS: there is such a picture.

import package::interface::frame::light_sampler;
import package::interface::scene::{distance_ahead, pixels_per_m};
import package::lib::refraction::{pyramid_lod, transmission_spread};

/// Pre-exposed radiance times how much it counts in rgb, that in a; a pyramid.
@group(0) @binding(40) var reflections: texture_2d<f32>;
/// Length in m of each pixel's way to what it shows; loaded.
@group(0) @binding(43) var reflection_ways: texture_2d<f32>;

/// What was found for a fragment at `position` (as in @builtin(position)) and `world`, whose lobe
/// has this alpha: radiance times how much it counts in rgb, that in a. A lobe spreads over the
/// way, and is seen from the eye over the way and the distance; a facet turns a mirrored ray by
/// twice its tilt, which is what glass of index 3 would do to one that passes.
fn found_reflection(position: vec4<f32>, world: vec3<f32>, alpha: f32) -> vec4<f32> {
    let uv = position.xy / vec2<f32>(textureDimensions(reflections));
    let way_m = textureLoad(reflection_ways, vec2<i32>(position.xy), 0).r;
    let spread_m = transmission_spread(alpha, 3.0) * way_m;
    let lod = pyramid_lod(spread_m * pixels_per_m(distance_ahead(world) + way_m));
    return textureSampleLevel(reflections, light_sampler, uv, lod);
}
