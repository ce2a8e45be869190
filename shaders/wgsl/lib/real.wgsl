// The number that shading computes in: f32, or f16 with the feature HALF.
//
// A half float has eleven bits and ends at 65504; below 6.1e-5 it loses bits, and some devices
// make zero of it. So `real` is for what is bounded by what it is: unit vectors, cosines,
// colors, roughness, and the factors of a BRDF. Positions, distances, coordinates, depth,
// angles of narrow cones, radiance, and the product of D and V stay in f32. Literals take the
// type of what they meet, so one text serves both.

@if(HALF)
enable f16;

@if(HALF)
alias real = f16;
@else
alias real = f32;

/// Two of them.
@if(HALF)
alias real2 = vec2<f16>;
@else
alias real2 = vec2<f32>;

/// Three of them.
@if(HALF)
alias real3 = vec3<f16>;
@else
alias real3 = vec3<f32>;

/// A color from f32: what is more than a half float holds becomes the most that one holds.
@if(HALF)
fn to_real3(color: vec3<f32>) -> real3 {
    return vec3<f16>(clamp(color, vec3<f32>(-65504.0), vec3<f32>(65504.0)));
}

/// In f32 there is nothing to do.
@else
fn to_real3(color: vec3<f32>) -> real3 {
    return color;
}
