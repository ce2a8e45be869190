//! Animation curves.

use glam::DQuat;

/// Interpolation between two keyframes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// Value of the earlier keyframe.
    Step,
    /// Linear; spherical along the shorter arc for rotations.
    Linear,
    /// Cubic Hermite spline of values and tangents.
    Cubic,
}

/// Keyframes over time. Times outside of the keyframes are clamped to the first or last value.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Times of the keyframes in seconds, ascending, at least one.
    pub times_s: Vec<f64>,
    /// Numbers per value, at least one.
    pub width: usize,
    /// Values of the keyframes. A cubic has three per keyframe: in-tangent, value, out-tangent.
    pub values: Vec<f64>,
    /// Interpolation between keyframes.
    pub interpolation: Interpolation,
}

impl Curve {
    /// Returns the time of the last keyframe, in seconds.
    #[must_use]
    pub fn end_s(&self) -> f64 {
        self.times_s.last().copied().unwrap_or(0.0)
    }

    /// Returns the number of values per keyframe.
    pub(crate) const fn parts(interpolation: Interpolation) -> usize {
        if matches!(interpolation, Interpolation::Cubic) { 3 } else { 1 }
    }

    /// Returns the value or a tangent of a keyframe.
    fn key(&self, key: usize, part: usize) -> &[f64] {
        let first = (key * Self::parts(self.interpolation) + part) * self.width;
        &self.values[first..first + self.width]
    }

    /// Returns the two keyframes around a time, and the position between them from 0 to 1.
    fn place(&self, time_s: f64) -> (usize, usize, f64) {
        let after = self.times_s.partition_point(|key_s| *key_s <= time_s);
        let (first, second) = (after.saturating_sub(1), after.min(self.times_s.len() - 1));
        let way_s = self.times_s[second] - self.times_s[first];
        (first, second, if way_s > 0.0 { ((time_s - self.times_s[first]) / way_s).clamp(0.0, 1.0) } else { 0.0 })
    }

    /// Returns the value at a time in seconds.
    #[must_use]
    pub fn at(&self, time_s: f64) -> Vec<f64> {
        let (first, second, share) = self.place(time_s);
        match self.interpolation {
            Interpolation::Step => self.key(first, 0).to_vec(),
            Interpolation::Linear => {
                let pairs = self.key(first, 0).iter().zip(self.key(second, 0));
                pairs.map(|(a, b)| a + share * (b - a)).collect()
            }
            Interpolation::Cubic => {
                let way_s = self.times_s[second] - self.times_s[first];
                let (square, cube) = (share * share, share * share * share);
                let from = 2.0 * cube - 3.0 * square + 1.0;
                let [leaving, arriving] = [cube - 2.0 * square + share, cube - square].map(|weight| weight * way_s);
                let number = |i: usize| {
                    from * self.key(first, 1)[i]
                        + leaving * self.key(first, 2)[i]
                        + (1.0 - from) * self.key(second, 1)[i]
                        + arriving * self.key(second, 0)[i]
                };
                (0..self.width).map(number).collect()
            }
        }
    }

    /// Returns the rotation at a time in seconds as a unit quaternion; values must be quaternions.
    #[must_use]
    pub fn rotation_at(&self, time_s: f64) -> DQuat {
        let turned = |numbers: &[f64]| DQuat::from_slice(numbers);
        let rotation = if self.interpolation == Interpolation::Linear {
            let (first, second, share) = self.place(time_s);
            turned(self.key(first, 0)).normalize().slerp(turned(self.key(second, 0)).normalize(), share)
        } else {
            turned(&self.at(time_s))
        };
        // A cubic may pass through zero.
        if rotation.length() > 1e-9 { rotation.normalize() } else { DQuat::IDENTITY }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4};

    fn curve(interpolation: Interpolation, width: usize, values: &[f64]) -> Curve {
        Curve { times_s: vec![1.0, 2.0, 4.0], width, values: values.to_vec(), interpolation }
    }

    #[test]
    fn steps_and_lines_hold_beyond_their_ends() {
        let values = [0.0, 10.0, -2.0];
        let at = |interpolation, time_s| curve(interpolation, 1, &values).at(time_s)[0];
        let times = [0.0, 1.0, 1.5, 2.0, 3.0, 4.0, 9.0];
        assert_eq!(times.map(|t| at(Interpolation::Step, t)), [0.0, 0.0, 0.0, 10.0, 10.0, -2.0, -2.0]);
        assert_eq!(times.map(|t| at(Interpolation::Linear, t)), [0.0, 0.0, 5.0, 10.0, 4.0, -2.0, -2.0]);
        let one = Curve { times_s: vec![3.0], width: 2, values: vec![5.0, 6.0], interpolation: Interpolation::Linear };
        assert_eq!([one.at(0.0), one.at(7.0)], [[5.0, 6.0], [5.0, 6.0]]);
    }

    /// Hermite form: tangents are per second, so the cubic of a line is that line, even if keyframes are two seconds
    /// apart.
    #[test]
    fn cubics_follow_their_tangents() {
        let line = curve(Interpolation::Cubic, 1, &[3.0, 1.0, 3.0, 3.0, 4.0, 3.0, 3.0, 10.0, 3.0]);
        for time_s in [1.0, 1.3, 2.0, 2.5, 3.9, 4.0] {
            assert!((line.at(time_s)[0] - (1.0 + 3.0 * (time_s - 1.0))).abs() < 1e-12, "{time_s}");
        }
        let still = curve(Interpolation::Cubic, 1, &[0.0, 0.0, 0.0, 0.0, 8.0, 0.0, 0.0, 8.0, 0.0]);
        assert_eq!([still.at(1.5)[0], still.at(1.25)[0]], [4.0, 1.25]);
    }

    /// Rotations follow the shorter arc at a constant speed, independent of quaternion signs.
    #[test]
    fn rotations_take_the_shorter_arc() {
        let quarter = [0.0, FRAC_1_SQRT_2, 0.0, FRAC_1_SQRT_2];
        for sign in [1.0, -1.0] {
            let mut values = vec![0.0, 0.0, 0.0, 1.0];
            values.extend(quarter.map(|x| sign * x).iter().chain(&quarter));
            let halfway = curve(Interpolation::Linear, 4, &values).rotation_at(1.5);
            assert!(halfway.angle_between(DQuat::from_rotation_y(FRAC_PI_4)) < 1e-7, "{halfway}");
        }
    }
}
