// Screen-space ray tracing: length, steps, hits and weights.
//
// Texture coordinates and stored depth are linear along the screen projection of a ray, for any
// projection. A ray is therefore traced in equal screen steps (McGuire and Mara, "Efficient GPU
// Screen-Space Ray Tracing", 2014). z is in view space: the camera looks along -z.

/// Length in m of a ray that stays behind the near plane, at most `reach_m`; 0 where it starts
/// before that plane. `way_z` is z of its unit direction.
fn ray_length_m(from_z: f32, way_z: f32, near_z: f32, reach_m: f32) -> f32 {
    let left = near_z - from_z;
    if !(left > 0.0) {
        return 0.0;
    }
    return select(reach_m, left / max(way_z, 1e-9), way_z * reach_m > left);
}

/// Share of the way that stays within a picture of `size` texels, 0…1; 0 where it starts outside.
fn share_in_picture(start: vec2<f32>, way: vec2<f32>, size: vec2<f32>) -> f32 {
    if any(start < vec2<f32>(0.0)) || any(start > size) {
        return 0.0;
    }
    let border = select(start, size - start, way > vec2<f32>(0.0));
    let share = border / max(abs(way), vec2<f32>(1e-6));
    return min(min(share.x, share.y), 1.0);
}

/// Returns true if a ray between two values of z meets a surface that is `thickness_m` thick.
fn ray_meets(before_z: f32, here_z: f32, surface_z: f32, thickness_m: f32) -> bool {
    return max(before_z, here_z) >= surface_z - thickness_m
        && min(before_z, here_z) <= surface_z;
}

/// Share of a ray, between two, at which its depth is that of a surface: it starts at depth `start`
/// and changes by `way` to its end. The later one for a ray of one depth.
fn share_at_depth(surface: f32, start: f32, way: f32, low: f32, high: f32) -> f32 {
    if abs(way) < 1e-30 {
        return high;
    }
    return clamp((surface - start) / way, low, high);
}

/// Returns true if the hit is not on the surface that the ray left, which is at or below its
/// tangent plane. `met_m` and `ray_m` are heights above this plane.
fn rises_from_plane(met_m: f32, ray_m: f32) -> bool {
    return ray_m > 0.0 && met_m > 0.5 * ray_m;
}

/// Returns the fade factor of a hit, by the share of the ray's reach; it fades over the last
/// twelfth.
fn reach_fade(share: f32) -> f32 {
    return saturate(12.0 * (1.0 - share));
}

/// Returns the weight of traced reflections at a perceptual roughness: 1 up to three quarters of
/// `most`, 0 from `most` on.
fn roughness_fade(roughness: f32, most: f32) -> f32 {
    return saturate(4.0 * (1.0 - roughness / max(most, 1e-6)));
}
