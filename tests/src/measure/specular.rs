//! The prefiltered cube, evaluated as in shaders, compared with integration of the lobe over directions.

use super::averaged_map;
use crate::lookup::{self, Mapping};
use framegraph_passes::light::ibl::cache::Cache;
use framegraph_passes::light::ibl::{IblSettings, ImageLight};
use framegraph_scene::{Environment, progress};
use framegraph_wgpu::Gpu;
use glam::DVec3;
use std::error::Error;
use truth::lobe::{gathered, gathered_of_disc};

/// A gray environment with one feature, and a line of directions across it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Feature {
    /// Bright on one side of a plane.
    Edge,
    /// A bright disc with an angular radius in degrees.
    Disc(f64),
    /// Uniform radiance.
    Uniform,
}

impl Feature {
    fn axis() -> DVec3 {
        // A direction away from the cube's axes, within one of its faces.
        DVec3::new(0.36, 0.48, 0.8)
    }

    /// Returns the radiance from a direction.
    pub fn radiance(self, d: DVec3) -> f64 {
        let bright = match self {
            Self::Edge => d.dot(Self::axis()) > 0.0,
            Self::Disc(radius) => d.dot(Self::axis()) > radius.to_radians().cos(),
            Self::Uniform => true,
        };
        f64::from(u8::from(bright))
    }

    /// Returns the name in tables.
    pub fn name(self) -> String {
        match self {
            Self::Edge => "step edge".into(),
            Self::Disc(radius) => format!("disc of radius {radius}°"),
            Self::Uniform => "uniform".into(),
        }
    }

    /// Returns an odd number of directions across the feature, from its center outward on both sides.
    fn directions(self, count: i32) -> Vec<DVec3> {
        let axis = Self::axis();
        let aside = axis.cross(DVec3::new(0.6, -0.64, 0.48)).normalize();
        let middle = if self == Self::Edge { aside } else { axis };
        let toward = if self == Self::Edge { axis } else { aside };
        let angle = |i: i32| (f64::from(i) / f64::from(count / 2) - 1.0).powi(3) * 60.0_f64.to_radians();
        (0..count).map(angle).map(|a| middle * a.cos() + toward * a.sin()).collect()
    }
}

/// Creates the light of a feature from a panorama of `width` texels, as a cube with a given size and number of levels.
///
/// # Errors
/// The device fails.
pub fn light_of(
    gpu: &Gpu,
    feature: Feature,
    width: u32,
    [cube_texels, levels]: [u32; 2],
) -> Result<ImageLight, Box<dyn Error>> {
    let map = averaged_map(width, |d| feature.radiance(d));
    let environment = Environment { name: feature.name(), map, sun: None, filtered: None, warnings: Vec::new() };
    let settings = IblSettings { cube_texels, levels, ..Default::default() };
    Ok(ImageLight::new(gpu, &environment, &settings, &Cache::off(), &mut progress::silent)?)
}

/// Errors relative to the largest value across the feature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// Largest difference.
    pub worst: f64,
    /// Root mean square over the directions.
    pub rms: f64,
}

/// Returns the errors at one roughness, for `count` (odd) directions across the feature.
///
/// # Errors
/// The device fails.
pub fn errors(
    gpu: &Gpu,
    light: &ImageLight,
    feature: Feature,
    roughness: f64,
    mapping: Mapping,
    count: i32,
) -> Result<Errors, Box<dyn Error>> {
    let directions = feature.directions(count);
    let asked: Vec<[f32; 4]> = directions.iter().map(|d| d.as_vec3().extend(roughness as f32).to_array()).collect();
    let got = lookup::specular(gpu, light, mapping, &asked)?;
    let (mut worst, mut peak, mut squares) = (0.0_f64, 0.0_f64, 0.0);
    for (d, [got, ..]) in directions.iter().zip(got) {
        let exact = match feature {
            Feature::Disc(radius) => gathered_of_disc(*d, roughness, Feature::axis(), radius.to_radians()),
            _ => gathered(*d, roughness, |l| DVec3::splat(feature.radiance(l))).x,
        };
        worst = worst.max((got - exact).abs());
        squares += (got - exact).powi(2);
        peak = peak.max(exact);
    }
    Ok(Errors { worst: worst / peak, rms: (squares / directions.len() as f64).sqrt() / peak })
}
