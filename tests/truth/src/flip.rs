//! FLIP, an image difference metric: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild, "FLIP: A
//! Difference Evaluator for Alternating Images", HPG 2020; for display light. Existing crates bind the original in C++,
//! which a Rust-only build cannot include.

use glam::{DMat3, DVec3};
use std::f64::consts::PI;

/// Pixels per degree on the authors' desk: a 4K monitor 0.7 m wide at 0.7 m.
pub const PIXELS_PER_DEGREE: f64 = 67.0;

/// The contrast sensitivity of the eye as sums of Gaussians √(π/b) a exp(−π² d²/b), d in degrees (section 4.1.1): luminance,
/// red–green, blue–yellow.
const SENSITIVITY: [&[(f64, f64)]; 3] = [&[(1.0, 0.0047)], &[(1.0, 0.0053)], &[(34.1, 0.04), (13.5, 0.025)]];
/// Exponents of the color and the feature difference.
const QC: f64 = 0.7;
const QF: f64 = 0.5;
/// Share of the color difference range that is compressed, and its image.
const PC: f64 = 0.4;
const PT: f64 = 0.95;
/// Width of the edges that are detected, in degrees.
const FEATURE_DEG: f64 = 0.082;

/// One channel of a picture.
type Plane = Vec<f32>;

/// Returns the difference of every pixel, 0 (none) to 1, for two pictures of sRGB-encoded light in 0…1.
///
/// # Panics
/// The number of pixels does not match the size.
pub fn flip(ours: &[[f32; 3]], reference: &[[f32; 3]], size: [u32; 2], pixels_per_degree: f64) -> Vec<f32> {
    let [width, height] = size.map(|side| side as usize);
    assert!(ours.len() == width * height && reference.len() == ours.len());
    let (one, two) = std::thread::scope(|scope| {
        let other = scope.spawn(|| Perceived::of(ours, width, pixels_per_degree));
        let reference = Perceived::of(reference, width, pixels_per_degree);
        (other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)), reference)
    });
    let largest = hyab(hunt([0.0, 1.0, 0.0]), hunt([0.0, 0.0, 1.0])).powf(QC);
    let color = |i: usize| {
        let apart = hyab(one.lab[i], two.lab[i]).powf(QC);
        let knee = PC * largest;
        if apart < knee { PT / knee * apart } else { PT + (apart - knee) / (largest - knee) * (1.0 - PT) }
    };
    let feature = |i: usize| {
        let edges = (one.edges[i] - two.edges[i]).abs();
        let points = (one.points[i] - two.points[i]).abs();
        (f64::from(edges.max(points)) * std::f64::consts::FRAC_1_SQRT_2).powf(QF)
    };
    (0..ours.len()).map(|i| color(i).powf(1.0 - feature(i)) as f32).collect()
}

/// A picture as perceived by the eye.
struct Perceived {
    /// Hunt-adjusted L*a*b*, blurred by the eye.
    lab: Vec<[f64; 3]>,
    /// Strength of edges and of points in luminance.
    edges: Plane,
    points: Plane,
}

impl Perceived {
    fn of(encoded: &[[f32; 3]], width: usize, pixels_per_degree: f64) -> Self {
        let opponent: Vec<[f64; 3]> =
            encoded.iter().map(|rgb| opponent(xyz_from_linear(rgb.map(|c| linear(f64::from(c)))))).collect();
        let radius = (3.0 * (0.04 / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil() as i32;
        let blurred: [Plane; 3] = std::array::from_fn(|channel| {
            let plane: Plane = opponent.iter().map(|texel| texel[channel] as f32).collect();
            blur(&plane, width, SENSITIVITY[channel], radius, pixels_per_degree)
        });
        let linear_from_xyz = DMat3::from_cols_array_2d(&XYZ).transpose().inverse();
        let lab = (0..encoded.len())
            .map(|i| {
                let xyz = xyz_from_opponent(std::array::from_fn(|c| f64::from(blurred[c][i])));
                hunt((linear_from_xyz * DVec3::from_array(xyz)).to_array().map(|c| c.clamp(0.0, 1.0)))
            })
            .collect();
        let light: Plane = opponent.iter().map(|[y, ..]| ((y + 16.0) / 116.0) as f32).collect();
        let (edges, points) = features(&light, width, pixels_per_degree);
        Self { lab, edges, points }
    }
}

/// Convolves with a sum of separable Gaussians whose weights sum to 1.
fn blur(plane: &Plane, width: usize, gaussians: &[(f64, f64)], radius: i32, pixels_per_degree: f64) -> Plane {
    let kernels: Vec<(f64, Vec<f64>)> = gaussians
        .iter()
        .map(|(a, b)| {
            let at = |x: i32| (-PI * PI * (f64::from(x) / pixels_per_degree).powi(2) / b).exp();
            (a * (PI / b).sqrt(), (-radius..=radius).map(at).collect())
        })
        .collect();
    let sum = |kernel: &[f64]| kernel.iter().sum::<f64>();
    let total: f64 = kernels.iter().map(|(scale, kernel)| scale * sum(kernel) * sum(kernel)).sum();
    let mut out = vec![0.0; plane.len()];
    for (scale, kernel) in &kernels {
        let across: Vec<f32> = kernel.iter().map(|k| *k as f32).collect();
        let down: Vec<f32> = kernel.iter().map(|k| (*k * scale / total) as f32).collect();
        let part = columns(&rows(plane, width, &across), width, &down);
        out.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
    }
    out
}

/// Returns the magnitudes of first and second derivatives with Gaussians of an edge's width.
fn features(light: &Plane, width: usize, pixels_per_degree: f64) -> (Plane, Plane) {
    let deviation = 0.5 * FEATURE_DEG * pixels_per_degree;
    let radius = (3.0 * deviation).ceil() as i32;
    let places = || (-radius..=radius).map(f64::from);
    let bell = |x: f64| (-x * x / (2.0 * deviation * deviation)).exp();
    let whole: f64 = places().map(bell).sum();
    let smooth: Vec<f32> = places().map(|x| (bell(x) / whole) as f32).collect();
    let edge = balanced(places().map(|x| -x * bell(x)).collect());
    let point = balanced(places().map(|x| (x * x / (deviation * deviation) - 1.0) * bell(x)).collect());
    let smooth_rows = rows(light, width, &smooth);
    let strength = |kernel: &[f32]| -> Plane {
        let across = columns(&rows(light, width, kernel), width, &smooth);
        let down = columns(&smooth_rows, width, kernel);
        across.into_iter().zip(down).map(|(x, y)| x.hypot(y)).collect()
    };
    (strength(&edge), strength(&point))
}

/// Normalizes a kernel: positive weights sum to 1, negative ones to -1.
fn balanced(kernel: Vec<f64>) -> Vec<f32> {
    let sum = |sign: f64| kernel.iter().map(|k| (k * sign).max(0.0)).sum::<f64>();
    let (up, down) = (sum(1.0), sum(-1.0));
    kernel.iter().map(|k| if *k > 0.0 { k / up } else { k / down } as f32).collect()
}

/// Convolves along rows, with the border repeated.
fn rows(plane: &Plane, width: usize, kernel: &[f32]) -> Plane {
    let radius = kernel.len() / 2;
    let mut out = vec![0.0; plane.len()];
    let mut padded = vec![0.0; width + 2 * radius];
    for (row, out) in plane.chunks_exact(width).zip(out.chunks_exact_mut(width)) {
        padded[..radius].fill(row[0]);
        padded[radius..radius + width].copy_from_slice(row);
        padded[radius + width..].fill(row[width - 1]);
        for (tap, weight) in kernel.iter().enumerate() {
            add(out, &padded[tap..tap + width], *weight);
        }
    }
    out
}

/// Convolves along columns, with the border repeated.
fn columns(plane: &Plane, width: usize, kernel: &[f32]) -> Plane {
    let (radius, height) = (kernel.len() / 2, plane.len() / width);
    let mut out = vec![0.0; plane.len()];
    for (y, out) in out.chunks_exact_mut(width).enumerate() {
        for (tap, weight) in kernel.iter().enumerate() {
            let from = (y + tap).saturating_sub(radius).min(height - 1);
            add(out, &plane[from * width..(from + 1) * width], *weight);
        }
    }
    out
}

/// Adds weighted pixels, the most expensive part of FLIP.
fn add(out: &mut [f32], texels: &[f32], weight: f32) {
    out.iter_mut().zip(texels).for_each(|(sum, texel)| *sum += texel * weight);
}

fn linear(encoded: f64) -> f64 {
    let c = encoded.clamp(0.0, 1.0);
    if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

/// Linear Rec.709 to CIE XYZ, D65, from the exact fractions of the primaries.
const XYZ: [[f64; 3]; 3] = [
    [10_135_552.0 / 24_577_794.0, 8_788_810.0 / 24_577_794.0, 4_435_075.0 / 24_577_794.0],
    [2_613_072.0 / 12_288_897.0, 8_788_810.0 / 12_288_897.0, 887_015.0 / 12_288_897.0],
    [1_425_312.0 / 73_733_382.0, 8_788_810.0 / 73_733_382.0, 70_074_185.0 / 73_733_382.0],
];

fn xyz_from_linear(rgb: [f64; 3]) -> [f64; 3] {
    XYZ.map(|row| row[0] * rgb[0] + row[1] * rgb[1] + row[2] * rgb[2])
}

/// XYZ of linear (1, 1, 1).
const WHITE: [f64; 3] =
    [XYZ[0][0] + XYZ[0][1] + XYZ[0][2], XYZ[1][0] + XYZ[1][1] + XYZ[1][2], XYZ[2][0] + XYZ[2][1] + XYZ[2][2]];

/// Converts to Y, C red–green and C blue–yellow: L*a*b* without cube roots.
fn opponent(xyz: [f64; 3]) -> [f64; 3] {
    let [xn, yn, zn] = WHITE;
    let [x, y, z] = [xyz[0] / xn, xyz[1] / yn, xyz[2] / zn];
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

fn xyz_from_opponent([l, a, b]: [f64; 3]) -> [f64; 3] {
    let [xn, yn, zn] = WHITE;
    let y = (l + 16.0) / 116.0;
    [(y + a / 500.0) * xn, y * yn, (y - b / 200.0) * zn]
}

/// Converts linear Rec.709 to L*a*b*, with chroma reduced in dark areas.
fn hunt(rgb: [f64; 3]) -> [f64; 3] {
    let xyz = xyz_from_linear(rgb);
    let [x, y, z] = std::array::from_fn(|i| {
        let t = xyz[i] / WHITE[i];
        let knee = 6.0_f64 / 29.0;
        if t > knee.powi(3) { t.cbrt() } else { t / (3.0 * knee * knee) + 4.0 / 29.0 }
    });
    let l = 116.0 * y - 16.0;
    [l, 0.01 * l * 500.0 * (x - y), 0.01 * l * 200.0 * (y - z)]
}

fn hyab(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_pictures_do_not_differ_and_green_differs_most_from_blue() {
        let (green, blue) = (vec![[0.0, 1.0, 0.0]; 64], vec![[0.0, 0.0, 1.0]; 64]);
        assert!(flip(&green, &green, [8, 8], PIXELS_PER_DEGREE).iter().all(|d| *d == 0.0));
        assert!(flip(&green, &blue, [8, 8], PIXELS_PER_DEGREE).iter().all(|d| (d - 1.0).abs() < 1e-4));
    }

    /// The reference implementation (flip-evaluator 1.7 of the Python package index) gives the same value for these two
    /// pictures.
    #[test]
    fn a_pattern_differs_as_the_original_says() {
        let picture = |shift: u32| -> Vec<[f32; 3]> {
            let codes = |i: u32| {
                let (x, y) = (i % 48 + shift, i / 48);
                [(x * 5) % 256, ((x / 6 + y / 4) % 2) * 180 + 20, (x * y + 3 * shift) % 256]
            };
            (0..48 * 32).map(|i| codes(i).map(|c| c as f32 / 255.0)).collect()
        };
        let found = flip(&picture(1), &picture(0), [48, 32], PIXELS_PER_DEGREE);
        let mean = found.iter().map(|d| f64::from(*d)).sum::<f64>() / found.len() as f64;
        assert!((mean - ORIGINAL).abs() < 1e-4, "{mean}");
    }

    /// Value for the pattern above at 67 pixels per degree.
    const ORIGINAL: f64 = 0.330_472;
}
