//! The DFG table, evaluated as in shaders, compared with integration over half vectors.

use crate::lookup;
use framegraph_passes::light::ibl::DfgTable;
use framegraph_wgpu::Gpu;
use std::error::Error;
use truth::albedo::{Masking, cloth, ggx};
use truth::microsurface::Random;

/// Errors of the table for n·v above 0.05 and roughness above 0.089.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    /// Largest error of the albedo at f0 = 1 (green).
    pub albedo: f64,
    /// Root mean square error of the albedo.
    pub albedo_rms: f64,
    /// Largest error of the Fresnel part (red).
    pub fresnel: f64,
    /// Largest error of 1/green, which compensates for multiple scattering.
    pub compensation: f64,
    /// Largest error of the cloth albedo (blue).
    pub cloth: f64,
    /// Smallest value of green.
    pub lowest: f64,
}

/// Returns the errors at `count` points in the domain, for a lobe with this masking.
///
/// # Errors
/// The device fails.
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
