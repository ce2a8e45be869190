// Contact shadows of the sun: traces a short ray through the depth pyramid.
//
// Requires the feature CONTACT_SHADOWS; without it there are no contact shadows.

import package::interface::frame::frame;
import package::interface::shadow::shadow;
import package::lib::contact_shadow::{contact_hides, contact_fade};
import package::lib::dither::interleaved_gradient_noise;
import package::lib::fullscreen::uv_from_clip;
import package::shading::object_light::receives_shadows;
import package::shading::shadow_map::Receiver;

/// Reversed depth of the visible surfaces, at the size of the picture. Bound as an unfilterable
/// float.
@if(CONTACT_SHADOWS)
@group(0) @binding(44) var contact_depth: texture_2d<f32>;

/// Number of steps of the ray.
override CONTACT_STEPS: u32 = 8u;

/// Returns (u, v, depth) on the screen.
fn screen_uvz(clip: vec4<f32>) -> vec3<f32> {
    return vec3<f32>(uv_from_clip(clip.xy / clip.w), clip.z / clip.w);
}

/// Returns the visibility of the sun past nearby surfaces, 0…1. The ray advances in equal steps on
/// the screen; the depth tolerance is that of a step toward the viewer. A texel holds the depth of
/// its center, so the ray's depth is evaluated there, along the slope of the receiver. The
/// receiver's own surface and its texel therefore cast no shadow.
@if(CONTACT_SHADOWS)
fn contact_visibility(receiver: Receiver) -> f32 {
    if !receives_shadows() {
        return 1.0;
    }
    let way = frame.sun_direction * shadow.contact_m;
    let ahead = frame.world_from_view[2].xyz * shadow.contact_m;
    let start_clip = frame.clip_from_world * vec4<f32>(receiver.world, 1.0);
    let end_clip = start_clip + frame.clip_from_world * vec4<f32>(way, 0.0);
    let nearer_clip = start_clip + frame.clip_from_world * vec4<f32>(ahead, 0.0);
    // Rays that pass the eye cannot be traced.
    if min(start_clip.w, min(end_clip.w, nearer_clip.w)) <= 0.0 {
        return 1.0;
    }
    let start = screen_uvz(start_clip);
    let ray = screen_uvz(end_clip) - start;
    let step = 1.0 / f32(max(CONTACT_STEPS, 1u));
    let tolerance = abs(nearer_clip.z / nearer_clip.w - start.z) * step;
    let size = vec2<f32>(textureDimensions(contact_depth));
    let pixels = frame.viewport_size_px / size;
    let own = vec2<i32>(receiver.pixel / pixels);
    var t = step * (interleaved_gradient_noise(receiver.pixel, 0u) + 0.5);
    for (var i = 0u; i < CONTACT_STEPS; i++) {
        let at = start + ray * t;
        let texel = vec2<i32>(clamp(at.xy * size, vec2<f32>(0.0), size - 1.0));
        let aside = (vec2<f32>(texel) + 0.5) * pixels - at.xy * frame.viewport_size_px;
        let depth = at.z + dot(receiver.slope, aside);
        let hides = contact_hides(textureLoad(contact_depth, texel, 0).r, depth, tolerance);
        if hides && any(texel != own) {
            return 1.0 - contact_fade(at.xy);
        }
        t += step;
    }
    return 1.0;
}

@else
fn contact_visibility(receiver: Receiver) -> f32 {
    return 1.0;
}
