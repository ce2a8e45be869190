//! The probes, by what their functions are about.

mod color;
mod lens;
mod lobes;
mod picture;
mod screen;
mod shading;
mod shadow;
mod transparency;

use super::probe::{Build, Probe};
use framegraph_shaders::reference::cases::Domain;
use framegraph_shaders::reference::cases::Domain::Values;

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

/// The largest half float.
const MOST: f32 = 65504.0;
/// One exact number.
const NONE: Domain = Values(&[0.0]);
const ONE: Domain = Values(&[1.0]);
/// Cosines: none, less than none, numbers too small for all their bits, more than one (1, 2, 3, 6).
const COSINE: Domain = Values(&[0.0, -0.0, -0.1, 6e-8, 6.1e-5, 1e-4, 0.5, 0.9995, 1.0, 1.000_000_2, 1.0005, 1.002]);
/// Cosines toward the viewer as callers clamp them.
const NOV: Domain = Values(&[1e-4, 0.01, 0.5, 1.0, 1.002]);
/// alpha: the floors of both builds, a tenth, one (4).
const ALPHA: Domain = Values(&[0.007_921, 0.002_025, 0.1, 1.0]);
/// The same, less than the floors, and none.
const LOW_ALPHA: Domain = Values(&[0.007_921, 0.002_025, 4e-4, 0.0, 0.1, 1.0]);
/// Components of vectors that cancel, vanish or are too long (3, 7, 8).
const COMPONENT: Domain = Values(&[0.0, 1.0, -1.0, 0.001, -0.001, 0.6, -0.6, 1.002]);
const SHARE: Domain = Values(&[0.0, 6e-8, 0.04, 0.5, 1.0]);
/// Radiance that a tone curve must survive (47).
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

/// A probe of what lies so far out that shader and mirror need not agree: cancellation, or floors that differ by build.
const fn bounded(
    row: u8,
    function: &'static str,
    parameters: &'static [Domain],
    holds: fn(&[f32], &[f32]) -> bool,
) -> Probe {
    Probe { row, function, build: Build::Both, parameters, holds, mirrored: false }
}

/// Whether every result is a number that a half float holds, and not below zero.
fn in_half(_: &[f32], y: &[f32]) -> bool {
    y.iter().all(|y| (0.0..=MOST).contains(y))
}

/// Whether every result is a share.
fn is_share(_: &[f32], y: &[f32]) -> bool {
    y.iter().all(|y| (0.0..=1.0).contains(y))
}

/// Whether no result is below zero.
fn is_positive(_: &[f32], y: &[f32]) -> bool {
    y.iter().all(|y| *y >= 0.0)
}

/// For probes that ask for finite results and no more.
fn is_any(_: &[f32], _: &[f32]) -> bool {
    true
}

/// Whether the first three results are a vector of length one, but for a thousandth.
fn is_unit(_: &[f32], y: &[f32]) -> bool {
    let length2: f32 = y[..3].iter().map(|c| c * c).sum();
    (length2.sqrt() - 1.0).abs() < 1e-3
}
