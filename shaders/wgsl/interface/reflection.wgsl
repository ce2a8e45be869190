// What rays found in the picture, as the color pass reads it: made by pass/reflection.wgsl.
//
// Feature REFLECTIONS: there is such a picture.

import package::interface::frame::light_sampler;
import package::interface::scene::{distance_ahead, pixels_per_m};
import package::lib::refraction::pyramid_lod;

/// Pre-exposed radiance times how much it counts in rgb, that in a; a pyramid.
@group(0) @binding(40) var reflections: texture_2d<f32>;

/// How far a lobe of alpha 1 is spread over what it reflects, in m, wherever that is: Filament's
/// measure, right for what is about half a meter away.
const SPREAD_M: f32 = 1.0;

/// What was found for a fragment at `position` (as in @builtin(position)) and `world`, whose lobe
/// has this alpha: radiance times how much it counts in rgb, that in a.
fn found_reflection(position: vec4<f32>, world: vec3<f32>, alpha: f32) -> vec4<f32> {
    let uv = position.xy / vec2<f32>(textureDimensions(reflections));
    let lod = pyramid_lod(alpha * SPREAD_M * pixels_per_m(distance_ahead(world)));
    return textureSampleLevel(reflections, light_sampler, uv, lod);
}
