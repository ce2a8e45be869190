//! Irradiance from spherical harmonics, compared with integration over the hemisphere.

use super::averaged_map;
use crate::lookup::{self, Mapping};
use framegraph_passes::light::ibl::cache::Cache;
use framegraph_passes::light::ibl::{IblSettings, ImageLight};
use framegraph_scene::environment::{EquirectMap, Sh, ShBands, ShWindow};
use framegraph_scene::{Environment, progress};
use framegraph_wgpu::Gpu;
use glam::DVec3;
use std::error::Error;
use std::f64::consts::{PI, TAU};
use truth::sphere::{directions, irradiance_over_pi};

/// Width of the maps, in texels.
const WIDTH: u32 = 512;

/// An environment with known irradiance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scene {
    /// A sky that is brightest at the horizon, with 0.4 of that above and 0.3 below.
    Sky,
    /// A disc with a radius of 30° and a radiance of 20, on a background of 0.5.
    KeyDisc,
    /// One bright texel on black.
    Sun,
    /// One bright texel, with uniform light of a fifth of its illuminance.
    SunAndAmbient,
}

impl Scene {
    /// All environments.
    pub const ALL: [Self; 4] = [Self::Sky, Self::KeyDisc, Self::Sun, Self::SunAndAmbient];

    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sky => "sky gradient",
            Self::KeyDisc => "30° key disc",
            Self::Sun => "sun delta",
            Self::SunAndAmbient => "sun 100 klx + ambient 20 klx",
        }
    }

    fn axis() -> DVec3 {
        DVec3::new(0.48, 0.6, -0.64)
    }

    fn radiance(self, d: DVec3) -> f64 {
        match self {
            Self::Sky => {
                if d.y > 0.0 {
                    1.0 - 0.6 * d.y
                } else {
                    0.3
                }
            }
            Self::KeyDisc => {
                if d.dot(Self::axis()) > 30.0_f64.to_radians().cos() {
                    20.0
                } else {
                    0.5
                }
            }
            Self::Sun | Self::SunAndAmbient => 0.0,
        }
    }

    /// Returns the map, and the exact irradiance / π.
    fn map_and_truth(self) -> (EquirectMap, Box<dyn Fn(DVec3) -> f64>) {
        let height = WIDTH / 2;
        match self {
            Self::Sky | Self::KeyDisc => (
                averaged_map(WIDTH, |d| self.radiance(d)),
                Box::new(move |n| irradiance_over_pi(n, 160, |d| self.radiance(d))),
            ),
            Self::Sun | Self::SunAndAmbient => {
                let (x, y) = (200, 80);
                let theta = (f64::from(y) + 0.5) / f64::from(height) * PI;
                let phi = ((f64::from(x) + 0.5) / f64::from(WIDTH) - 0.5) * TAU;
                let sun = DVec3::new(theta.sin() * phi.sin(), theta.cos(), -theta.sin() * phi.cos());
                let edge = |y: u32| (f64::from(y) / f64::from(height) * PI).cos();
                let texel_sr = TAU / f64::from(WIDTH) * (edge(y) - edge(y + 1));
                let ambient = if self == Self::Sun { 0.0 } else { 0.2 };
                let mut texels = vec![[(ambient / PI) as f32; 4]; (WIDTH * height) as usize];
                texels[(y * WIDTH + x) as usize] = [((1.0 / texel_sr) + ambient / PI) as f32; 4];
                let truth = move |n: DVec3| (n.dot(sun).max(0.0) + ambient) / PI;
                (EquirectMap::new(WIDTH, height, texels), Box::new(truth))
            }
        }
    }
}

/// Errors of irradiance, relative to its largest value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// Largest difference.
    pub worst: f64,
    /// Smallest value; negative if the harmonics ring.
    pub lowest: f64,
    /// Increase of the mean by clamping at zero.
    pub clamped: f64,
}

/// Returns the errors of a projection at `normals` normals. `spoil` modifies it first: the identity, or an error as a
/// negative control.
pub fn errors(scene: Scene, bands: ShBands, window: ShWindow, normals: u32, spoil: impl Fn(Sh) -> Sh) -> Errors {
    let (map, truth) = scene.map_and_truth();
    let sh = spoil(Sh::project(&map, bands).windowed(window));
    let brightest = sh.dominant_direction().unwrap_or(DVec3::Y);
    let asked = directions(normals).into_iter().chain([brightest, -brightest]);
    summed(asked.map(|n| (sh.irradiance_over_pi_at(n).x, truth(n))))
}

/// Errors of the last level of a prefiltered cube of this size with this many levels, as the device filters it, at `normals`
/// normals.
///
/// # Errors
/// Any error of the device.
pub fn cube_errors(
    gpu: &Gpu,
    scene: Scene,
    [cube_texels, levels]: [u32; 2],
    normals: u32,
) -> Result<Errors, Box<dyn Error>> {
    let (map, truth) = scene.map_and_truth();
    let environment =
        Environment { name: scene.name().to_owned(), map, sun: None, filtered: None, warnings: Vec::new() };
    let settings = IblSettings { cube_texels, levels, ..Default::default() };
    let light = ImageLight::new(gpu, &environment, &settings, &Cache::off(), &mut progress::silent)?;
    let asked: Vec<DVec3> = directions(normals).into_iter().chain([Scene::axis(), -Scene::axis()]).collect();
    let of_lobe: Vec<[f32; 4]> = asked.iter().map(|n| n.as_vec3().extend(1.0).to_array()).collect();
    let got = lookup::specular(gpu, &light, Mapping::Lod, &of_lobe)?;
    Ok(summed(asked.iter().zip(got).map(|(n, [grey, ..])| (grey, truth(*n)))))
}

/// Errors of what was found beside what is exact.
fn summed(found: impl Iterator<Item = (f64, f64)>) -> Errors {
    let (mut worst, mut lowest, mut peak) = (0.0_f64, f64::MAX, 0.0_f64);
    let (mut mean, mut clamped) = (0.0, 0.0);
    for (got, exact) in found {
        worst = worst.max((got - exact).abs());
        lowest = lowest.min(got);
        peak = peak.max(exact);
        mean += got;
        clamped += got.max(0.0) - got;
    }
    Errors { worst: worst / peak, lowest: lowest.min(0.0) / peak, clamped: clamped / mean }
}
