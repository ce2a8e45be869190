//! Techniques of fits, sampling and curves that replace expensive terms.

use super::{Choice, Technique, formula, number};
use crate::lab::technique::Measured;
use crate::lookup::Mapping;
use crate::measure::albedo;
use crate::measure::specular::{Feature, errors, light_of};
use framegraph_passes::light::ibl::cache::Cache;
use framegraph_passes::light::ibl::{DfgSettings, DfgTable};
use framegraph_scene::progress;
use framegraph_shader_mirrors::dfg::Visibility;
use framegraph_shader_mirrors::environment::specular_dominant_direction;
use framegraph_wgpu::Gpu;
use glam::DVec3;
use std::f64::consts::{PI, TAU};
use truth::albedo::{Masking, ggx};
use truth::lobe::{gathered, gathered_of_disc};
use truth::microsurface::Random;
use truth::sphere::frame;

pub(super) fn techniques() -> Vec<Technique> {
    vec![diffuse(), table_fit(), prefilter_samples(), split_sum()]
}

/// Returns root mean square and mean of differences.
fn off(apart: &[f64]) -> Measured {
    let count = apart.len() as f64;
    let error = (apart.iter().map(|d| d * d).sum::<f64>() / count).sqrt();
    Measured { bias: Some(apart.iter().sum::<f64>() / count), ..Measured::exact(error) }
}

fn diffuse() -> Technique {
    /// Returns π times Burley's diffuse lobe, with his perceptual roughness.
    fn burley(nov: f64, nol: f64, loh: f64, roughness: f64) -> f64 {
        let f90 = 0.5 + 2.0 * roughness * loh * loh;
        let to = |cosine: f64| 1.0 + (f90 - 1.0) * (1.0 - cosine).powi(5);
        to(nov) * to(nol)
    }
    /// Returns the albedo of white under uniform light minus one, over 10 angles and 10 roughnesses.
    fn furnace(lobe: fn(f64, f64, f64, f64) -> f64) -> Vec<f64> {
        let albedo = |nov: f64, roughness: f64| {
            let view = DVec3::new((1.0 - nov * nov).sqrt(), 0.0, nov);
            // Points are uniform in the disc below the hemisphere, which gives cosine weighting.
            let at = |i: u32| {
                let (radius2, turn) = ((f64::from(i / 64) + 0.5) / 64.0, (f64::from(i % 64) + 0.5) / 64.0 * TAU);
                let light =
                    DVec3::new(radius2.sqrt() * turn.cos(), radius2.sqrt() * turn.sin(), (1.0 - radius2).sqrt());
                lobe(nov, light.z, light.dot((light + view).normalize()), roughness)
            };
            (0..4096).map(at).sum::<f64>() / 4096.0
        };
        let grid = (0..100).map(|i| (0.05 + 0.1 * f64::from(i % 10), f64::from(i / 10) / 9.0));
        grid.map(|(nov, roughness)| albedo(nov, roughness) - 1.0).collect()
    }
    let choices = vec![
        number("Lambert", |_: &Gpu| Ok(off(&furnace(|_, _, _, _| 1.0))))
            .counted("fd_lambert", false)
            .found_in(|_| true),
        number("Burley", |_: &Gpu| Ok(off(&furnace(burley)))),
    ];
    let what = "Diffuse lobe: albedo of white under uniform light, over angles and roughnesses.";
    formula("diffuse", what, "an albedo of 1.", "albedo, RMS", choices)
}

fn table_fit() -> Technique {
    /// Returns Karis's fit for mobile GPUs at f0 = 1.
    fn karis(nov: f64, roughness: f64) -> f64 {
        let r = [1.0 - roughness, 0.0425 - 0.0275 * roughness, 1.04 - 0.572 * roughness, 0.022 * roughness - 0.04];
        let a004 = (r[0] * r[0]).min((-9.28 * nov).exp2()) * r[0] + r[1];
        (-1.04 * a004 + r[2]) + (1.04 * a004 + r[3])
    }
    let table = |gpu: &Gpu| {
        let settings = DfgSettings { texels: 64, visibility: Visibility::Exact };
        let table = DfgTable::new(gpu, settings, &Cache::off(), &mut progress::silent)?;
        Ok(Measured::exact(albedo::errors(gpu, &table, Masking::Smith, 300)?.albedo_rms))
    };
    let fit = |_: &Gpu| {
        let grid = (0..200).map(|i| (0.05 + 0.1 * f64::from(i % 10), 0.089 + 0.911 * f64::from(i / 10) / 19.0));
        let apart = grid.map(|(nov, roughness)| karis(nov, roughness) - ggx(nov, roughness, Masking::Smith)[1]);
        Ok(off(&apart.collect::<Vec<_>>()))
    };
    let choices =
        vec![number("a table of 64² texels", table).found_in(|_| true), number("Karis's fit for phones", fit)];
    let what = "Directional albedo at f0 = 1 from a table or from a fit. The fit was made for another masking function and for dielectrics.";
    formula("table-fit", what, "the lobe's integral by quadrature.", "albedo, RMS", choices)
}

fn prefilter_samples() -> Technique {
    const ROUGHNESS: f64 = 0.4;
    const DISC: f64 = 3.0;
    // Directions are importance sampled from the lobe, with equal view, normal and reflection.
    let plain = |samples: u32| {
        number(&format!("{samples} samples by importance"), move |_: &Gpu| {
            let axis = DVec3::new(0.36, 0.48, 0.8);
            let truth = gathered_of_disc(axis, ROUGHNESS, axis, DISC.to_radians());
            let (t, b) = frame(axis);
            let alpha2 = ROUGHNESS.powi(4);
            let mut random = Random(11);
            let mut estimate = || {
                let (mut sum, mut weights) = (0.0, 0.0);
                for _ in 0..samples {
                    let (u, turn) = (random.uniform(), TAU * random.uniform());
                    let cos2 = (1.0 - u) / (1.0 + (alpha2 - 1.0) * u);
                    let (cos, sin) = (cos2.sqrt(), (1.0 - cos2).max(0.0).sqrt());
                    let half = t * (sin * turn.cos()) + b * (sin * turn.sin()) + axis * cos;
                    let light = 2.0 * cos * half - axis;
                    let nol = light.dot(axis).max(0.0);
                    sum += nol * Feature::Disc(DISC).radiance(light);
                    weights += nol;
                }
                sum / weights / truth - 1.0
            };
            let errors: Vec<f64> = (0..256).map(|_| estimate()).collect();
            Ok(off(&errors))
        })
    };
    let kernel = number("the frame's kernel over reduced levels", |gpu: &Gpu| {
        let feature = Feature::Disc(DISC);
        let light = light_of(gpu, feature, 1024, [256, 7])?;
        Ok(Measured::exact(errors(gpu, &light, feature, ROUGHNESS, Mapping::Lod, 21)?.rms))
    });
    let choices = vec![plain(16), plain(64), plain(256), plain(1024), kernel.found_in(|_| true)];
    let what = "Light of a disc of 3° prefiltered at roughness 0.4, relative to the peak. Samples are compared at the peak, where the error is mostly noise. The kernel is compared across the disc, where it is mostly interpolation between levels.";
    formula("prefilter-samples", what, "the lobe's integral by quadrature.", "share of the peak, RMS", choices)
}

fn split_sum() -> Technique {
    /// Returns the radiance of a sky that is brighter toward x.
    fn sky(d: DVec3) -> f64 {
        1.0 + d.x
    }
    /// Returns the light that a metal with f0 = 1 and normal z reflects toward a viewer, by integrating half vectors.
    fn exact(nov: f64, roughness: f64) -> f64 {
        let view = DVec3::new((1.0 - nov * nov).sqrt(), 0.0, nov);
        let alpha2 = roughness.powi(4);
        let tail = |c: f64| (alpha2 * (1.0 - c * c) + c * c).sqrt();
        let (rows, columns) = (200, 128);
        let mut sum = 0.0;
        for row in 0..rows {
            let u = (f64::from(row) + 0.5) / f64::from(rows);
            let (sin, cos) = (0.5 * PI * u.powi(4)).sin_cos();
            let area = sin * 2.0 * PI * u.powi(3) / f64::from(rows) * TAU / f64::from(columns);
            for column in 0..columns {
                let (s, c) = ((f64::from(column) + 0.5) / f64::from(columns) * TAU).sin_cos();
                let half = DVec3::new(sin * c, sin * s, cos);
                let voh = view.dot(half);
                let light = 2.0 * voh * half - view;
                if voh > 0.0 && light.z > 0.0 {
                    let d = alpha2 / (PI * (1.0 - half.z * half.z * (1.0 - alpha2)).powi(2));
                    let v = 0.5 / (light.z * tail(nov) + nov * tail(light.z));
                    sum += d * v * light.z * sky(light) * area * 4.0 * voh;
                }
            }
        }
        sum
    }
    let along = |name: &str, direction: fn(DVec3, DVec3, f64) -> DVec3| {
        number(name, move |_: &Gpu| {
            let grid = (0..25).map(|i| (0.1 + 0.2 * f64::from(i % 5), 0.2 + 0.2 * f64::from(i / 5)));
            let apart = grid.map(|(nov, roughness)| {
                let mirrored = DVec3::new(-(1.0 - nov * nov).sqrt(), 0.0, nov);
                let toward = direction(DVec3::Z, mirrored, roughness * roughness).normalize();
                let first = gathered(toward, roughness, |l| DVec3::splat(sky(l))).x;
                first * ggx(nov, roughness, Masking::Smith)[1] / exact(nov, roughness) - 1.0
            });
            Ok(off(&apart.collect::<Vec<_>>()))
        })
    };
    let choices: Vec<Choice> = vec![
        along("along the reflection", |_, r, _| r),
        along("toward the normal by alpha², Filament's", specular_dominant_direction).found_in(|_| true),
        along("toward the normal by alpha", |n, r, alpha| r + (n - r) * alpha),
        along("along the normal", |n, _, _| n),
    ];
    let what = "Lookup direction in the prefiltered environment, under light that increases to one side, over roughness 0.2 … 1 and angles: relative error of a white metal.";
    formula("split-sum-direction", what, "the lobe's integral by quadrature.", "share, RMS", choices)
}
