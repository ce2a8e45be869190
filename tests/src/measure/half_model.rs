//! Model of half-float arithmetic on the CPU, operation by operation, with or without denormals below 6.1e-5.
//!
//! It repeats the terms of `lib/ggx.wgsl` in the shader's order of operations. It models the shader and is not a
//! reference.

use framegraph_shader_mirrors::quantize::quantize_mantissa;
use glam::DVec3;

/// Smallest normal half float.
const SMALLEST_NORMAL: f64 = 1.0 / 16384.0;
/// Largest finite half float.
const LARGEST: f64 = 65504.0;

/// Rounding of a device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfModel {
    /// True if denormals become zero.
    pub flush: bool,
    /// Factor on squared values: 64 in the shader; 1 shows the error without it.
    pub scale: f64,
}

impl HalfModel {
    /// Rounds to a half float.
    pub fn round(self, x: f64) -> f64 {
        if !x.is_finite() {
            return x;
        }
        let rounded = quantize_mantissa(x, 10, false);
        if rounded.abs() > LARGEST {
            return f64::INFINITY.copysign(x);
        }
        if self.flush && rounded.abs() < SMALLEST_NORMAL { 0.0_f64.copysign(x) } else { rounded }
    }

    fn product(self, a: f64, b: f64) -> f64 {
        self.round(a * b)
    }

    fn sum(self, a: f64, b: f64) -> f64 {
        self.round(a + b)
    }

    fn dot(self, a: DVec3, b: DVec3) -> f64 {
        let xy = self.sum(self.product(a.x, b.x), self.product(a.y, b.y));
        self.sum(xy, self.product(a.z, b.z))
    }

    fn cross(self, a: DVec3, b: DVec3) -> DVec3 {
        let minor = |p, q, r, s| self.sum(self.product(p, q), -self.product(r, s));
        DVec3::new(minor(a.y, b.z, a.z, b.y), minor(a.z, b.x, a.x, b.z), minor(a.x, b.y, a.y, b.x))
    }

    /// Models `d_ggx_cross` in half floats.
    pub fn d_ggx_cross(self, n: DVec3, h: DVec3, noh: f64, alpha: f64) -> f64 {
        let scale2 = self.scale * self.scale;
        let sine = self.cross(n, h).to_array().map(|x| self.product(self.scale, x));
        let sine = DVec3::from_array(sine);
        let sine2 = if noh <= 0.0 { scale2 } else { self.dot(sine, sine) };
        let a = self.product(noh.clamp(0.0, 1.0), self.product(self.scale, alpha));
        let q = self.sum(sine2, self.product(a, a)).max(self.round(scale2 * 6.27e-5));
        let k = self.round(self.product(scale2, alpha) / q).min(453.5);
        self.round(k * k / std::f64::consts::PI)
    }

    /// Models `pow5` in half floats.
    pub fn pow5(self, x: f64) -> f64 {
        let x2 = self.product(x, x);
        self.product(self.product(x2, x2), x)
    }

    /// Models `f_schlick_scalar` in half floats.
    pub fn f_schlick_scalar(self, f0: f64, f90: f64, voh: f64) -> f64 {
        let rise = self.pow5(self.sum(1.0, -voh.clamp(0.0, 1.0)));
        self.sum(f0, self.product(self.sum(f90, -f0), rise))
    }

    /// Models `v_kelemen` in half floats.
    pub fn v_kelemen(self, loh: f64) -> f64 {
        let v = self.round(0.5 / loh.max(self.round(0.001_974_842)));
        self.product(v, v)
    }

    /// Models `v_neubelt` in half floats.
    pub fn v_neubelt(self, nov: f64, nol: f64) -> f64 {
        let covered = self.sum(self.sum(nol, nov), -self.product(nol, nov));
        self.round(0.25 / covered.max(self.round(6.2e-5)))
    }

    /// Models one channel of `energy_compensation` in half floats.
    pub fn energy_compensation(self, f0: f64, dfg_y: f64) -> f64 {
        let lost = self.sum(self.round(1.0 / dfg_y.clamp(self.round(0.3), 1.0)), -1.0);
        self.sum(1.0, self.product(f0, lost))
    }

    /// Models `clamp_nov` in half floats.
    pub fn clamp_nov(self, nov: f64) -> f64 {
        nov.max(self.round(1e-4))
    }

    /// Models `v_smith_ggx_correlated_fast` in half floats.
    pub fn v_smith_ggx_correlated_fast(self, nov: f64, nol: f64, alpha: f64) -> f64 {
        let l = self.product(self.scale, nol);
        let both = self.product(self.product(2.0, l), nov);
        let either = self.sum(l, self.product(self.scale, nov));
        let lambda = self.sum(self.product(both, self.sum(1.0, -alpha)), self.product(either, alpha));
        self.round(0.5 * self.scale / lambda.max(self.round(self.scale * 7.7e-6)))
    }

    /// Models `v_smith_ggx_correlated` in half floats.
    pub fn v_smith_ggx_correlated(self, nov: f64, nol: f64, alpha: f64) -> f64 {
        let (a2, a) = (self.product(alpha, alpha), self.product(self.scale, alpha));
        let root = |c: f64| {
            let c = self.product(self.scale, c);
            let squared = self.product(self.sum(c, -self.product(a2, c)), c);
            self.round(self.sum(squared, self.product(a, a)).sqrt())
        };
        let lambda_v = self.product(nol, root(nov));
        let lambda_l = self.product(nov, root(nol));
        self.round(0.5 * self.scale / self.sum(lambda_v, lambda_l).max(self.round(self.scale * 7.7e-6)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_half_floats() {
        let [keep, flush] = [false, true].map(|flush| HalfModel { flush, scale: 64.0 });
        assert_eq!((keep.sum(2048.0, 1.0), keep.product(65504.0, 2.0)), (2048.0, f64::INFINITY));
        assert_eq!((keep.round(6.0e-8), keep.round(2.0e-8)), (0.5_f64.powi(24), 0.0));
        assert_eq!((flush.round(6.0e-5), flush.round(SMALLEST_NORMAL)), (0.0, SMALLEST_NORMAL));
        assert!(flush.round(-6.0e-5).is_sign_negative() && keep.round(f64::NAN).is_nan());
    }
}
