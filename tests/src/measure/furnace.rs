//! White furnace test: albedo of conductors under uniform light, compared with a random walk on their microsurface.

use super::cards::{Card, Wall};
use crate::lookup;
use framegraph_passes::Shading;
use framegraph_passes::light::ibl::DfgTable;
use framegraph_scene::{Environment, Material};
use framegraph_wgpu::Gpu;
use glam::{DVec3, Vec3};
use std::error::Error;
use truth::microsurface::{self, Random};

/// Tested reflectances at normal incidence.
pub const F0: [f64; 5] = [1.0, 0.9, 0.6, 0.3, 0.04];

/// Relative error of the albedo over 60 points: six roughnesses by ten angles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    /// Mean absolute relative error.
    pub mean: f64,
    /// Largest relative error by magnitude, with its sign.
    pub worst: f64,
}

/// Compensation for multiple scattering.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compensation {
    /// No compensation.
    None,
    /// Factor 1 + f0 (1/green - 1).
    Table,
}

/// Returns the errors for each value of [`F0`], from `paths` random walks per point.
///
/// # Errors
/// The device fails.
pub fn errors(
    gpu: &Gpu,
    table: &DfgTable,
    compensation: Compensation,
    paths: u32,
) -> Result<[Errors; F0.len()], Box<dyn Error>> {
    let points = points();
    let got = lookup::dfg(gpu, table, &points)?;
    let reflected = got.into_iter().map(|[red, green, _]| {
        F0.map(|f0| {
            let factor = match compensation {
                Compensation::None => 1.0,
                Compensation::Table => 1.0 + f0 * (1.0 / green - 1.0),
            };
            (red + (green - red) * f0) * factor
        })
    });
    Ok(against(&truth(paths), reflected))
}

/// Returns the errors of cards rendered by the color pass under a uniform environment of 1 nit. `truth` is the result
/// of [`truth()`].
///
/// # Errors
/// The device fails.
pub fn frame_errors(
    gpu: &Gpu,
    shading: &Shading,
    truth: &[[f64; F0.len()]],
) -> Result<[Errors; F0.len()], Box<dyn Error>> {
    let metal = |f0: f64, roughness: f64| Material::metal("furnace", Vec3::splat(f0 as f32), roughness as f32);
    let points = points();
    let card = |[nov, roughness]: [f64; 2]| F0.map(|f0| Card { material: metal(f0, roughness), nov });
    let wall = Wall { cards: points.iter().copied().flat_map(card).collect(), ..Wall::default() };
    let seen = wall.render(gpu, &Environment::uniform(DVec3::ONE)?, shading)?;
    let reflected = seen.chunks_exact(F0.len()).map(|cards| std::array::from_fn(|i| cards[i].nits.x));
    Ok(against(truth, reflected))
}

/// Returns pairs of n·v and roughness: six roughnesses by ten angles.
fn points() -> Vec<[f64; 2]> {
    let angles = |roughness: f64| (0..10).map(move |i| [0.05 + 0.1 * f64::from(i), roughness]);
    [0.1, 0.3, 0.5, 0.7, 0.85, 1.0].into_iter().flat_map(angles).collect()
}

/// Returns the albedo of conductors for each value of [`F0`] at each point, by `paths` random walks.
pub fn truth(paths: u32) -> Vec<[f64; F0.len()]> {
    let mut random = Random(3);
    let walked = |[nov, roughness]: [f64; 2]| microsurface::albedo(nov, roughness, F0, paths, &mut random);
    points().into_iter().map(walked).collect()
}

fn against(truth: &[[f64; F0.len()]], reflected: impl Iterator<Item = [f64; F0.len()]>) -> [Errors; F0.len()] {
    let mut errors = [Errors::default(); F0.len()];
    for (truth, reflected) in truth.iter().zip(reflected) {
        for (index, error) in errors.iter_mut().enumerate() {
            let relative = reflected[index] / truth[index] - 1.0;
            error.mean += relative.abs() / points().len() as f64;
            if relative.abs() > error.worst.abs() {
                error.worst = relative;
            }
        }
    }
    errors
}
