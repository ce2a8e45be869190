//! Building blocks of the tables.

use super::{Bound, Case, Domain};
use glam::{DVec2, DVec3};

pub(super) const fn bound(absolute: f64, relative: f64) -> Bound {
    Bound { absolute, relative, period: 0.0 }
}

/// A few roundings of f32.
pub(super) const ARITHMETIC: Bound = bound(1e-6, 2e-6);
/// The same bits.
pub(super) const EXACT: Bound = bound(0.0, 0.0);

pub(super) const SCALAR: &[&str] = &["f32(r)"];
pub(super) const VEC2: &[&str] = &["f32(r.x)", "f32(r.y)"];
pub(super) const VEC3: &[&str] = &["f32(r.x)", "f32(r.y)", "f32(r.z)"];
pub(super) const BOOL: &[&str] = &["f32(r)"];

pub(super) const fn case(
    [file, function]: [&'static str; 2],
    parameters: &'static [Domain],
    call: &'static str,
    results: &'static [&'static str],
    mirror: fn(&[f64]) -> Vec<f64>,
    bound: Bound,
) -> Case {
    Case { file, function, parameters, call, results, mirror, bound }
}

pub(super) fn v2(x: &[f64], at: usize) -> DVec2 {
    DVec2::new(x[at], x[at + 1])
}

pub(super) fn v3(x: &[f64], at: usize) -> DVec3 {
    DVec3::new(x[at], x[at + 1], x[at + 2])
}

pub(super) fn out2(v: DVec2) -> Vec<f64> {
    v.to_array().to_vec()
}

pub(super) fn out3(v: DVec3) -> Vec<f64> {
    v.to_array().to_vec()
}
