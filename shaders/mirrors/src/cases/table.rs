//! Building blocks of the tables.

use super::case::{Bound, Case, Domain, HalfCase};
use glam::{DVec2, DVec3};

pub(super) const fn bound(absolute: f64, relative: f64) -> Bound {
    Bound { absolute, relative, period: 0.0 }
}

/// A few roundings of f32.
pub(super) const ARITHMETIC: Bound = bound(1e-6, 2e-6);
/// A few roundings of f16.
pub(super) const HALF_ARITHMETIC: Bound = bound(1e-3, 2e-3);
/// A power of a number near one, each of its five roundings counted whole, times a difference.
pub(super) const HALF_FRESNEL: Bound = bound(3e-3, 0.0);
/// Results must be bit-identical.
pub(super) const EXACT: Bound = bound(0.0, 0.0);

pub(super) const SCALAR: &[&str] = &["f32(r)"];
pub(super) const VEC2: &[&str] = &["f32(r.x)", "f32(r.y)"];
pub(super) const VEC3: &[&str] = &["f32(r.x)", "f32(r.y)", "f32(r.z)"];

pub(super) const fn case(
    [file, function]: [&'static str; 2],
    parameters: &'static [Domain],
    call: &'static str,
    results: &'static [&'static str],
    mirror: fn(&[f64]) -> Vec<f64>,
    bound: Bound,
) -> Case {
    Case { file, function, parameters, call, results, mirror, bound, in_half: false, half: None }
}

/// A function with a result of type f32, called with its parameters in order.
pub(super) const fn scalar(
    names: [&'static str; 2],
    parameters: &'static [Domain],
    mirror: fn(&[f64]) -> Vec<f64>,
    bound: Bound,
) -> Case {
    case(names, parameters, "", SCALAR, mirror, bound)
}

/// A function with a result of type vec2, called with its parameters in order.
pub(super) const fn vec2(
    names: [&'static str; 2],
    parameters: &'static [Domain],
    mirror: fn(&[f64]) -> Vec<f64>,
    bound: Bound,
) -> Case {
    case(names, parameters, "", VEC2, mirror, bound)
}

/// A function with a result of type vec3, called with its parameters in order.
pub(super) const fn vec3(
    names: [&'static str; 2],
    parameters: &'static [Domain],
    mirror: fn(&[f64]) -> Vec<f64>,
    bound: Bound,
) -> Case {
    case(names, parameters, "", VEC3, mirror, bound)
}

impl Case {
    /// The case of a function that computes in half floats in the build that does: its bound
    /// there, over the same domain.
    pub(super) const fn half(self, bound: Bound) -> Self {
        self.half_over(self.parameters, bound)
    }

    /// The same over a domain that half floats can represent.
    pub(super) const fn half_over(self, parameters: &'static [Domain], bound: Bound) -> Self {
        Self { half: Some(HalfCase { parameters, bound }), ..self }
    }
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
