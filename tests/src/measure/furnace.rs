//! A white furnace: what a conductor gives back of even light, against a random walk on its surface.

use crate::lookup;
use crate::truth::microsurface::{self, Random};
use renderer::scene::ibl::DfgTable;
use renderer::wgpu::Gpu;
use std::error::Error;

/// Reflectances at normal incidence that are compared.
pub const F0: [f64; 5] = [1.0, 0.9, 0.6, 0.3, 0.04];

/// How far the albedo is off, relative to the walk, over 60 points: six roughnesses by ten angles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    /// The mean of the relative error's magnitude.
    pub mean: f64,
    /// The relative error of the largest magnitude, with its sign.
    pub worst: f64,
}

/// Whether and how light scattered more than once is given back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compensation {
    /// It is lost.
    None,
    /// 1 + f0 (1/green - 1).
    Table,
}

/// Errors for each of [`F0`], from `paths` walks a point.
///
/// # Errors
/// When the device refuses or fails.
pub fn errors(
    gpu: &Gpu,
    table: &DfgTable,
    compensation: Compensation,
    paths: u32,
) -> Result<[Errors; F0.len()], Box<dyn Error>> {
    let mut points = Vec::new();
    for roughness in [0.1, 0.3, 0.5, 0.7, 0.85, 1.0] {
        points.extend((0..10).map(|i| [0.05 + 0.1 * f64::from(i), roughness]));
    }
    let got = lookup::dfg(gpu, table, &points)?;
    let mut random = Random(3);
    let mut errors = [Errors::default(); F0.len()];
    for ([nov, roughness], [red, green, _]) in points.iter().zip(got) {
        let walked = microsurface::albedo(*nov, *roughness, F0, paths, &mut random);
        for ((error, f0), truth) in errors.iter_mut().zip(F0).zip(walked) {
            let factor = match compensation {
                Compensation::None => 1.0,
                Compensation::Table => 1.0 + f0 * (1.0 / green - 1.0),
            };
            let relative = (red + (green - red) * f0) * factor / truth - 1.0;
            error.mean += relative.abs() / points.len() as f64;
            if relative.abs() > error.worst.abs() {
                error.worst = relative;
            }
        }
    }
    Ok(errors)
}
