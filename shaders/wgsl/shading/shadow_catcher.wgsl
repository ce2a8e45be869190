// Shadow catchers: surfaces that are visible only where the sun is in shadow.

import package::interface::material::material;
import package::shading::contact_shadow::contact_visibility;
import package::shading::shadow::{sun_share, sun_visibility};
import package::shading::shadow_map::Receiver;
import package::shading::vertex::SurfaceVertex;

/// Returns the opacity of a shadow catcher: the missing share of sunlight, times its strength.
fn caught_shadow(vertex: SurfaceVertex, geometric: vec3<f32>) -> f32 {
    let slope = vec2<f32>(dpdx(vertex.position.z), dpdy(vertex.position.z));
    let receiver = Receiver(vertex.world, geometric, vertex.position.xy, slope);
    let visible = sun_share(sun_visibility(receiver) * contact_visibility(receiver));
    return (1.0 - visible) * material.catcher_strength;
}
