// Screen-space ambient occlusion as the color pass reads it; written by pass/occlusion.wgsl.
//
// AMBIENT_OCCLUSION: the texture has full resolution. OCCLUSION_UPSAMPLED: it has lower resolution
// and is upsampled with the depth pyramid, which separates surfaces.

@if(OCCLUSION_UPSAMPLED)
import package::interface::frame::frame;
@if(OCCLUSION_UPSAMPLED)
import package::interface::structure::structure;
@if(OCCLUSION_UPSAMPLED)
import package::lib::bilateral::bilateral_weight;

/// The texture also holds the mean open direction, whose cone occludes reflections.
override BENT_NORMALS: bool = false;

/// Visibility in red, and the mean open direction in world space in the other channels; read
/// without filtering.
@if(AMBIENT_OCCLUSION || OCCLUSION_UPSAMPLED)
@group(0) @binding(21) var ambient_occlusion: texture_2d<f32>;

/// Distance between surfaces in m at which the weight of a texel reaches zero.
@if(OCCLUSION_UPSAMPLED)
const UPSAMPLED_THRESHOLD_M: f32 = 0.05;

/// Returns the screen-space occlusion of a fragment, from `position` as in @builtin(position) and
/// the screen derivatives of its depth.
@if(AMBIENT_OCCLUSION && !OCCLUSION_UPSAMPLED)
fn screen_occlusion(position: vec4<f32>, depth_slope: vec2<f32>) -> vec4<f32> {
    return textureLoad(ambient_occlusion, vec2<i32>(position.xy), 0);
}

/// Returns the four nearest texels with bilinear weights times the nearness of their surfaces to
/// the fragment's plane. If no surface is near, the weights are only bilinear.
@if(OCCLUSION_UPSAMPLED)
fn screen_occlusion(position: vec4<f32>, depth_slope: vec2<f32>) -> vec4<f32> {
    let m = frame.clip_from_world;
    let back = frame.world_from_view[2].xyz;
    let row = vec4<f32>(
        dot(vec3<f32>(m[0].z, m[1].z, m[2].z), back),
        m[3].z,
        dot(vec3<f32>(m[0].w, m[1].w, m[2].w), back),
        m[3].w,
    );
    // Meters per depth, divided by the threshold: the slope of `view_z`. If the far plane is
    // infinite, the square of a tiny depth is 0.
    let ahead = position.z * row.z - row.x;
    let meters = (row.x * row.w - row.y * row.z) / max(ahead * ahead, 1e-30);
    let spread = meters / UPSAMPLED_THRESHOLD_M;
    let size = vec2<f32>(textureDimensions(ambient_occlusion));
    let pixels = frame.viewport_size_px / size;
    let at = position.xy / pixels - 0.5;
    let corner = floor(at);
    let share = at - corner;
    var sum = vec4<f32>(0.0);
    var total = 0.0;
    for (var i = 0u; i < 4u; i++) {
        let step = vec2<f32>(f32(i & 1u), f32(i >> 1u));
        let texel = clamp(corner + step, vec2<f32>(0.0), size - 1.0);
        let depth = textureLoad(structure, vec2<i32>(texel), 0).r;
        let expected = position.z + dot(depth_slope, (texel + 0.5) * pixels - position.xy);
        // The background has depth 0, and is no part of a surface.
        let is_surface = depth > 0.0 && expected > 0.0;
        let nearness = bilateral_weight((depth - expected) * spread, 1.0);
        let near = select(0.0, nearness, is_surface);
        let bilinear = mix(1.0 - share, share, step);
        let weight = bilinear.x * bilinear.y * max(near, 1e-4);
        let found = textureLoad(ambient_occlusion, vec2<i32>(texel), 0);
        sum += weight * select(vec4<f32>(found.r), found, BENT_NORMALS);
        total += weight;
    }
    return sum / max(total, 1e-8);
}
