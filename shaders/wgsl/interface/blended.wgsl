// What passes over blended surfaces in any order add up.

/// What `fs_weighted` adds up.
struct WeightedFragment {
    /// Color and alpha, both times the weight.
    @location(1) accumulated: vec4<f32>,
    /// What the surface lets through: blending multiplies the target by it.
    @location(2) transmittance: f32,
}

/// What `fs_absorbance` adds up.
struct AbsorbanceFragment {
    @location(1) absorbance: f32,
    /// Absorbance times the first four powers of the warped distance.
    @location(2) moments: vec4<f32>,
}

/// The sum of absorbances in red, read by the second pass of moment-based transparency.
@group(0) @binding(47) var total_absorbance: texture_2d<f32>;
/// The sums of absorbances times the first four powers of warped distance.
@group(0) @binding(48) var absorbance_moments: texture_2d<f32>;
