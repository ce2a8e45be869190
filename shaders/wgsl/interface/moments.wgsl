// What blended surfaces absorb, and where: read by the second pass of moment-based transparency.

/// The sum of absorbances in red.
@group(0) @binding(47) var total_absorbance: texture_2d<f32>;
/// The sums of absorbances times the first four powers of warped distance.
@group(0) @binding(48) var absorbance_moments: texture_2d<f32>;
