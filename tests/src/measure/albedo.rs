//! The DFG table, looked up as shaders do, against a grid of half vectors.

use crate::lookup;
use framegraph_passes::ibl::DfgTable;
use framegraph_wgpu::Gpu;
use std::error::Error;
use truth::albedo::{Masking, cloth, ggx};
use truth::microsurface::Random;

/// How far the table is off, over points with n·v above 0.05 and roughness above 0.089.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    /// The largest error of the albedo at f0 = 1 (green).
    pub albedo: f64,
    /// Root mean square of it.
    pub albedo_rms: f64,
    /// The largest error of the Fresnel part (red).
    pub fresnel: f64,
    /// The largest error of 1/green, which compensates for multiple scattering.
    pub compensation: f64,
    /// The largest error of the cloth's albedo (blue).
    pub cloth: f64,
    /// The lowest green.
    pub lowest: f64,
}

/// Errors at `count` points thrown over the domain, against the lobe with this masking.
///
/// # Errors
/// When the device refuses or fails.
pub fn errors(gpu: &Gpu, table: &DfgTable, masking: Masking, count: usize) -> Result<Errors, Box<dyn Error>> {
    let mut random = Random(11);
    let points: Vec<[f64; 2]> =
        (0..count).map(|_| [0.05 + 0.95 * random.uniform(), 0.089 + 0.911 * random.uniform()]).collect();
    let got = lookup::dfg(gpu, table, &points)?;
    let mut errors = Errors { lowest: f64::MAX, ..Default::default() };
    for ([nov, roughness], [red, green, blue]) in points.into_iter().zip(got) {
        let [fresnel, albedo] = ggx(nov, roughness, masking);
        errors.albedo = errors.albedo.max((green - albedo).abs());
        errors.albedo_rms += (green - albedo).powi(2);
        errors.fresnel = errors.fresnel.max((red - fresnel).abs());
        errors.compensation = errors.compensation.max((1.0 / green - 1.0 / albedo).abs());
        errors.cloth = errors.cloth.max((blue - cloth(nov, roughness)).abs());
        errors.lowest = errors.lowest.min(green);
    }
    errors.albedo_rms = (errors.albedo_rms / count as f64).sqrt();
    Ok(errors)
}
