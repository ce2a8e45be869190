//! Where one cascade ends and the next begins.

use super::settings::{MAX_CASCADES, Splits};

/// Far ends of `count` cascades between two distances, in meters, ascending; the last is `far_m`.
pub(crate) fn far_ends(splits: Splits, count: usize, near_m: f64, far_m: f64) -> Vec<f64> {
    let count = count.clamp(1, MAX_CASCADES);
    let range = far_m - near_m;
    // A parallel camera may begin behind the eye, where there is no ratio of distances.
    let ratio = (far_m / near_m.max(1e-3 * far_m.abs()).max(1e-6)).max(1.0);
    let uniform = |part: f64| near_m + range * part;
    let logarithmic = |part: f64| (far_m / ratio.powf(1.0 - part)).clamp(near_m, far_m);
    let mut ends: Vec<f64> = (1..count)
        .map(|i| {
            let part = i as f64 / count as f64;
            match splits {
                Splits::At(shares) => uniform(shares[i - 1]),
                Splits::Uniform => uniform(part),
                Splits::Logarithmic => logarithmic(part),
                Splits::Practical(lambda) => {
                    let lambda = lambda.clamp(0.0, 1.0);
                    lambda * logarithmic(part) + (1.0 - lambda) * uniform(part)
                }
            }
        })
        .collect();
    ends.push(far_m);
    for i in 1..ends.len() {
        ends[i] = ends[i].max(ends[i - 1]);
    }
    ends
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: &[f64], b: &[f64]) -> bool {
        a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9 * b.abs().max(1.0))
    }

    #[test]
    fn splits_are_those_of_filaments_helpers() {
        assert!(near(&far_ends(Splits::At([0.125, 0.25, 0.5]), 4, 0.0, 80.0), &[10.0, 20.0, 40.0, 80.0]));
        assert!(near(&far_ends(Splits::Uniform, 4, 0.0, 80.0), &[20.0, 40.0, 60.0, 80.0]));
        assert!(near(&far_ends(Splits::Logarithmic, 3, 0.1, 100.0), &[1.0, 10.0, 100.0]));
        assert!(near(&far_ends(Splits::Practical(0.5), 2, 1.0, 100.0), &[0.5 * (10.0 + 50.5), 100.0]));
        assert!(near(&far_ends(Splits::Logarithmic, 1, 1.0, 7.0), &[7.0]));
    }

    #[test]
    fn ranges_of_no_length_and_behind_the_eye_stay_finite() {
        for (near_m, far_m) in [(1.0, 1.0), (-5.0, 3.0), (0.0, 0.0), (0.0, 10.0)] {
            for splits in [Splits::Uniform, Splits::Logarithmic, Splits::Practical(0.8), Splits::At([0.1, 0.2, 0.3])] {
                let ends = far_ends(splits, 4, near_m, far_m);
                assert!(ends.iter().all(|e| e.is_finite()) && ends.is_sorted() && ends[3] == far_m, "{ends:?}");
            }
        }
    }
}
