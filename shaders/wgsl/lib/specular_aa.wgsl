// Specular antialiasing: roughness widened by how much the normal varies within a pixel.
//
// Kaplanyan, Hill, Patney, Lefohn, "Filtering Distributions of Normals for Shading
// Antialiasing", 2016; Tokuyoshi and Kaplanyan, "Improved Geometric Specular Antialiasing",
// 2019. The derivatives of the normal give the variance of a Gaussian of slopes, which adds to
// the lobe's own alpha². Isotropic: on a cylinder it dims the highlight more than it should.

/// Returns the filtered perceptual roughness. `dndx` and `dndy` are screen derivatives of the
/// world-space unit normal before the normal map. `variance` is the assumed pixel footprint (0.15 …
/// 0.25), `threshold` the maximum increase of alpha² (0.18 … 0.2).
fn normal_filtering(
    roughness: f32,
    dndx: vec3<f32>,
    dndy: vec3<f32>,
    variance: f32,
    threshold: f32,
) -> f32 {
    let sigma2 = variance * (dot(dndx, dndx) + dot(dndy, dndy));
    let alpha = roughness * roughness;
    let widened = saturate(alpha * alpha + min(2.0 * sigma2, threshold));
    return sqrt(sqrt(widened));
}
