//! Prediction of the time and error of an option on scenes that were not measured.
//!
//! Features of a scene and view are computed on the CPU. A linear model of their logarithms is fitted to training
//! scenes by ridge regression, and judged on other scenes.

use super::facts::random::random_case;
use super::facts::{Drawn, Easel, every_effect};
use framegraph_passes::effects::depth::structure::Resolution;
use framegraph_passes::gpu_scene::shadow_views::ShadowSettings;
use framegraph_passes::{OcclusionSettings, Settings};
use framegraph_scene::{LightKind, Scene};
use framegraph_wgpu::Gpu;
use serde::{Deserialize, Serialize};
use std::error::Error;

/// Number of features, with the constant.
pub const FEATURES: usize = 9;

/// Returns the features of a view: 1, covered share of the picture, depth complexity, and logarithms of triangles, pixels
/// and lights; then mean roughness, mean reflectance and the share of textured or transmissive materials. Instances
/// count as spheres about their bounds.
pub fn features(scene: &Scene, size_px: [u32; 2]) -> [f64; FEATURES] {
    let camera = scene.default_camera(f64::from(size_px[0]) / f64::from(size_px[1]));
    let share = |bounds: framegraph_scene::Aabb| {
        let (radius, away) = (bounds.half_extent().length(), (bounds.center() - camera.eye).length());
        (radius / (0.4 * away.max(radius))).powi(2).min(1.0)
    };
    let shares: Vec<f64> = scene.instances.iter().map(|instance| share(instance.bounds)).collect();
    let covered = 1.0 - shares.iter().map(|share| 1.0 - share).product::<f64>();
    let used = scene.instances.iter().map(|instance| &scene.materials[instance.material.index()]);
    let used: Vec<_> = used.collect();
    let mean = |of: &dyn Fn(&framegraph_scene::Material) -> f64| {
        used.iter().map(|material| of(material)).sum::<f64>() / used.len().max(1) as f64
    };
    let suns = scene.lights.iter().filter(|light| matches!(light.kind, LightKind::Directional { .. })).count();
    let pixels = f64::from(size_px[0] * size_px[1]);
    [
        1.0,
        covered,
        shares.iter().sum(),
        (1.0 + scene.triangle_count() as f64).ln(),
        pixels.ln(),
        (1.0 + scene.lights.len() as f64).ln() + suns as f64,
        mean(&|material| material.roughness.into()),
        mean(&|material| f64::from(material.metallic) * f64::from(material.base_color.truncate().max_element())),
        mean(&|material| f64::from(u8::from(material.transmission.is_some() || material.unlit))),
    ]
}

/// Measurement of one option on one scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// Number of the random scene.
    pub scene: u64,
    /// Picture size in pixels.
    pub size_px: [u32; 2],
    /// Name of the option.
    pub option: String,
    /// Features of the view.
    pub features: [f64; FEATURES],
    /// Least time of the frame, in ms.
    pub ms: f64,
    /// Root mean square difference from the reference, in 8-bit steps.
    pub steps: f64,
}

/// Name of an option, and the change of the reference.
type Reduced = (&'static str, fn(&mut Settings));

/// The predicted options. The first is the reference.
pub const OPTIONS: [Reduced; 5] = [
    ("reference", |_| {}),
    ("1 sample", |settings| settings.samples = 1),
    ("no sun shadows", |settings| settings.shadows = None),
    ("no ambient occlusion", |settings| settings.occlusion = None),
    ("ambient occlusion at half size", |settings| {
        settings.occlusion = Some(OcclusionSettings { resolution: Resolution::Half, ..OcclusionSettings::SAO });
    }),
];

fn reference() -> Settings {
    let shadows = ShadowSettings { cascades: 2, local_maps: 0, contact: None, ..ShadowSettings::texels(256) };
    Settings { reflections: None, glass_layers: 1, shadows: Some(shadows), ..every_effect() }
}

/// Draws all options of one scene at one size: two untimed and five timed frames each.
///
/// # Errors
/// The device fails.
pub fn measure(gpu: &Gpu, easel: &mut Easel, scene: u64, size_px: [u32; 2]) -> Result<Vec<Sample>, Box<dyn Error>> {
    let mut case = random_case(scene, 0);
    case.asked = Settings { blended: true, ..reference().for_scene(&case.scene, size_px) };
    (case.size_px, case.ev100) = (size_px, 11.0);
    let features = features(&case.scene, size_px);
    let mut drawn = Drawn::new(gpu, case)?;
    let (mut samples, mut truth) = (Vec::new(), Vec::new());
    for (name, reduce) in OPTIONS {
        let mut settings = drawn.case.asked;
        reduce(&mut settings);
        drawn.frames(easel, &settings, size_px, 2)?;
        let (picture, _, ms) = drawn.frames(easel, &settings, size_px, 5)?;
        if truth.is_empty() {
            truth.clone_from(&picture);
        }
        let squares = picture.iter().zip(&truth).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2)).sum::<f64>();
        let steps = (squares / (0.75 * picture.len() as f64)).sqrt();
        samples.push(Sample { scene, size_px, option: name.to_owned(), features, ms, steps });
    }
    Ok(samples)
}

/// Returns the weights `w` that minimize `Σ (w·x − y)² + λ |w|²`, without a penalty on the first weight. Solves the normal
/// equations by Gaussian elimination with pivoting.
pub fn ridge(rows: &[([f64; FEATURES], f64)], lambda: f64) -> [f64; FEATURES] {
    let mut matrix = [[0.0; FEATURES + 1]; FEATURES];
    for (x, y) in rows {
        for i in 0..FEATURES {
            (0..FEATURES).for_each(|j| matrix[i][j] += x[i] * x[j]);
            matrix[i][FEATURES] += x[i] * y;
        }
    }
    (0..FEATURES).for_each(|i| matrix[i][i] += if i == 0 { 1e-9 } else { lambda });
    for column in 0..FEATURES {
        let pivot = (column..FEATURES).max_by(|a, b| matrix[*a][column].abs().total_cmp(&matrix[*b][column].abs()));
        matrix.swap(column, pivot.unwrap_or(column));
        let own = matrix[column];
        for (_, values) in matrix.iter_mut().enumerate().filter(|(row, _)| *row != column) {
            let factor = values[column] / own[column];
            values.iter_mut().zip(own).for_each(|(value, own)| *value -= factor * own);
        }
    }
    std::array::from_fn(|i| matrix[i][FEATURES] / matrix[i][i])
}

/// Prediction errors of one option on held-out scenes.
#[derive(Clone, Debug, PartialEq)]
pub struct Judged {
    /// Name of the option.
    pub option: String,
    /// Median and 95th percentile of the relative error of times.
    pub ms: [f64; 2],
    /// Median and 95th percentile of the error of errors, relative to the measured value plus half a step.
    pub steps: [f64; 2],
}

/// Fits each option to the scenes whose number is not a multiple of 3, and judges it on the others.
pub fn judged(samples: &[Sample]) -> Vec<Judged> {
    let of = |name: &str| {
        let own: Vec<_> = samples.iter().filter(|sample| sample.option == name).collect();
        let errors = |value: fn(&Sample) -> f64, floor: f64| {
            let row = |sample: &&&Sample| (sample.features, (value(sample) + floor).ln());
            let rows: Vec<_> = own.iter().filter(|sample| sample.scene % 3 != 0).map(|sample| row(&sample)).collect();
            let weights = ridge(&rows, 0.1);
            let off = |sample: &&Sample| {
                let predicted = weights.iter().zip(sample.features).map(|(w, x)| w * x).sum::<f64>().exp();
                (predicted / (value(sample) + floor) - 1.0).abs()
            };
            let mut found: Vec<f64> = own.iter().filter(|sample| sample.scene % 3 == 0).map(off).collect();
            found.sort_by(f64::total_cmp);
            let at = |share: f64| found.get((share * (found.len().max(1) - 1) as f64) as usize).copied();
            [at(0.5), at(0.95)].map(|value| value.unwrap_or(f64::NAN))
        };
        Judged { option: name.to_owned(), ms: errors(|s| s.ms, 0.0), steps: errors(|s| s.steps, 0.5) }
    };
    OPTIONS.iter().map(|(name, _)| of(name)).collect()
}
