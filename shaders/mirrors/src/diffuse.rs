//! Mirror of `wgsl/lib/diffuse.wgsl`.

use super::math::PI;

/// Evaluates Lambert's BRDF for an albedo of one, in 1/sr.
pub fn fd_lambert() -> f64 {
    1.0 / PI
}

/// Evaluates Lambert's transmission times cosine for an albedo of one, in 1/sr.
pub fn fd_transmitted(nol: f64) -> f64 {
    (-nol).clamp(0.0, 1.0) / PI
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_furnace_is_one() {
        // ∫ cos over the hemisphere is π.
        let n = 1000;
        let sum: f64 = (0..n)
            .map(|i| {
                let theta = (f64::from(i) + 0.5) / f64::from(n) * 0.5 * PI;
                fd_lambert() * theta.cos() * 2.0 * PI * theta.sin() * 0.5 * PI / f64::from(n)
            })
            .sum();
        assert!((sum - 1.0).abs() < 1e-6, "midpoint rule: {sum}");
    }
}
