// Outputs of order-independent transparency, which blending sums up.

/// Output of `fs_weighted`.
struct WeightedFragment {
    /// Color and alpha, both times the weight.
    @location(1) accumulated: vec4<f32>,
    /// Transmittance of the surface, which multiplies the target.
    @location(2) transmittance: f32,
}

/// Output of `fs_absorbance`.
struct AbsorbanceFragment {
    @location(1) absorbance: f32,
    /// Absorbance times the first four powers of the warped distance.
    @location(2) moments: vec4<f32>,
}

/// Sum of absorbances in red, read by the second pass of moment-based transparency.
@group(0) @binding(47) var total_absorbance: texture_2d<f32>;
/// Sums of absorbances times the first four powers of the warped distance.
@group(0) @binding(48) var absorbance_moments: texture_2d<f32>;
