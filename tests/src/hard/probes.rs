//! Probes by topic of the function.

mod color;
mod lens;
mod lobes;
mod picture;
mod screen;
mod shading;
mod shadow;
mod transparency;

use super::probe::{Build, Probe};
use framegraph_shader_mirrors::cases::Domain;
use framegraph_shader_mirrors::cases::Domain::Values;

pub(super) const ALL: [&[Probe]; 8] = [
    shading::PROBES,
    lobes::PROBES,
    lens::PROBES,
    screen::PROBES,
    shadow::PROBES,
    picture::PROBES,
    color::PROBES,
    transparency::PROBES,
];

/// Largest finite half float.
const MOST: f32 = 65504.0;
/// Zero.
const NONE: Domain = Values(&[0.0]);
const ONE: Domain = Values(&[1.0]);
/// Cosines: zero, negative, denormal, above one (rows 1, 2, 3, 6).
const COSINE: Domain = Values(&[0.0, -0.0, -0.1, 6e-8, 6.1e-5, 1e-4, 0.5, 0.9995, 1.0, 1.000_000_2, 1.0005, 1.002]);
/// Cosines toward the viewer, clamped as by callers.
const NOV: Domain = Values(&[1e-4, 0.01, 0.5, 1.0, 1.002]);
/// Alpha: the minimum of both builds, a tenth, one (row 4).
const ALPHA: Domain = Values(&[0.007_921, 0.002_025, 0.1, 1.0]);
/// Alpha below the minimum of both builds, and zero.
const LOW_ALPHA: Domain = Values(&[0.007_921, 0.002_025, 4e-4, 0.0, 0.1, 1.0]);
/// Components of vectors that cancel, vanish or are longer than 1 (rows 3, 7, 8).
const COMPONENT: Domain = Values(&[0.0, 1.0, -1.0, 0.001, -0.001, 0.6, -0.6, 1.002]);
const SHARE: Domain = Values(&[0.0, 6e-8, 0.04, 0.5, 1.0]);
/// Radiance that a tone curve must handle (row 47).
const RADIANCE: Domain =
    Values(&[-0.2, 0.0, -0.0, 0.18, 160.0, 161.6, 65504.0, 1e19, 1.2e19, f64::INFINITY, f64::NEG_INFINITY, f64::NAN]);

const fn both(
    row: u8,
    function: &'static str,
    parameters: &'static [Domain],
    holds: fn(&[f32], &[f32]) -> bool,
) -> Probe {
    Probe { row, function, build: Build::Both, parameters, holds, mirrored: true }
}

/// A probe whose inputs are so extreme that shader and mirror may differ: cancellation, or limits that depend on the
/// build.
const fn bounded(
    row: u8,
    function: &'static str,
    parameters: &'static [Domain],
    holds: fn(&[f32], &[f32]) -> bool,
) -> Probe {
    Probe { row, function, build: Build::Both, parameters, holds, mirrored: false }
}

/// Returns true if every result is non-negative and representable as a half float.
fn in_half(_: &[f32], y: &[f32]) -> bool {
    y.iter().all(|y| (0.0..=MOST).contains(y))
}

/// Returns true if every result is within 0…1.
fn is_share(_: &[f32], y: &[f32]) -> bool {
    y.iter().all(|y| (0.0..=1.0).contains(y))
}

/// Returns true if no result is negative.
fn is_positive(_: &[f32], y: &[f32]) -> bool {
    y.iter().all(|y| *y >= 0.0)
}

/// Accepts any result, for probes that only require finite values.
fn is_any(_: &[f32], _: &[f32]) -> bool {
    true
}

/// Returns true if the first three results are a unit vector, to within 0.001.
fn is_unit(_: &[f32], y: &[f32]) -> bool {
    let length2: f32 = y[..3].iter().map(|c| c * c).sum();
    (length2.sqrt() - 1.0).abs() < 1e-3
}
