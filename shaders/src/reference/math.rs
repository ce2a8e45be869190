//! Mirror of `wgsl/lib/math.wgsl`.

pub use std::f64::consts::PI;

/// Returns x².
pub fn sq(x: f64) -> f64 {
    x * x
}

/// Returns x⁵.
pub fn pow5(x: f64) -> f64 {
    x.powi(5)
}

/// Clamps x to [0, 1], like WGSL's `saturate`.
pub fn saturate(x: f64) -> f64 {
    x.clamp(0.0, 1.0)
}

/// Interpolates from a at t = 0 to b at t = 1, like WGSL's `mix`.
pub fn mix(a: f64, b: f64, t: f64) -> f64 {
    a + (b - a) * t
}

/// Evaluates a cubic step from 0 at `low` to 1 at `high`, like WGSL's `smoothstep`.
pub fn smoothstep(low: f64, high: f64, x: f64) -> f64 {
    let t = saturate((x - low) / (high - low));
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers() {
        assert_eq!(sq(-3.0), 9.0);
        assert_eq!((pow5(2.0), pow5(-1.0), pow5(0.0)), (32.0, -1.0, 0.0));
    }
}
