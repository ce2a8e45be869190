//! Points of a domain.

use super::case::Domain;
use glam::DVec3;

/// Hard inputs: zero, subnormal half floats, values that round to one or just above, and the limits of curves and of
/// half floats.
const HARD: [f64; 18] = [
    -1.0,
    -0.5,
    -1e-4,
    -0.0,
    0.0,
    6e-8,
    6.1e-5,
    1e-4,
    0.5,
    0.999_511_718_75,
    0.999_999_94,
    1.0,
    1.000_000_1,
    1.000_976_562_5,
    100.0,
    161.0,
    161.6,
    65504.0,
];

impl Domain {
    /// Returns the number of values per parameter.
    pub const fn width(self) -> usize {
        match self {
            Self::Direction => 3,
            Self::Directions(..) => 6,
            Self::Vector(width, ..) => width,
            _ => 1,
        }
    }

    /// Returns the limits and corners of the domain.
    pub(super) fn specials(self) -> Vec<Vec<f64>> {
        match self {
            Self::Linear(low, high) | Self::Log(low, high) => vec![vec![low], vec![high]],
            Self::Count(n) => (0..n.min(8)).map(|i| vec![f64::from(i)]).collect(),
            Self::Values(list) => list.iter().map(|v| vec![*v]).collect(),
            Self::Direction => {
                let axis = |i: usize, sign: f64| {
                    let mut v = vec![0.0; 3];
                    v[i] = sign;
                    v
                };
                (0..6).map(|i| axis(i % 3, if i < 3 { 1.0 } else { -1.0 })).collect()
            }
            Self::Directions(low, high) => {
                let tilted = |angle: f64| vec![0.0, 0.0, 1.0, angle.sin(), 0.0, angle.cos()];
                vec![tilted(0.0), tilted(low), tilted(high)]
            }
            Self::Vector(width, low, high) => vec![vec![low; width], vec![high; width]],
        }
    }

    /// Returns [`Self::specials`] and the values of [`HARD`] inside the domain.
    pub(super) fn hard(self) -> Vec<Vec<f64>> {
        let mut points = self.specials();
        let within = |low: f64, high: f64| HARD.into_iter().filter(move |x| low <= *x && *x <= high);
        match self {
            Self::Linear(low, high) | Self::Log(low, high) => points.extend(within(low, high).map(|x| vec![x])),
            Self::Vector(width, low, high) => {
                points.extend(within(low, high).map(|x| vec![x; width]));
                // Distinct components, so that errors do not cancel.
                let share = |i: usize| (0.3 + 0.618_034 * i as f64).fract();
                points.push((0..width).map(|i| low + (high - low) * share(i)).collect());
            }
            Self::Direction => {
                points.push(vec![0.6, 0.0, -0.8]);
                points.push(vec![1e-4, 0.0, -0.999_999_995]);
            }
            Self::Count(n) => points.push(vec![f64::from(n - 1)]),
            Self::Values(_) | Self::Directions(..) => {}
        }
        points
    }

    /// Returns a point of the domain from uniform numbers in [0, 1).
    pub(super) fn sample(self, random: &mut impl FnMut() -> f64, out: &mut Vec<f64>) {
        match self {
            Self::Linear(low, high) => out.push(low + (high - low) * random()),
            Self::Log(low, high) => out.push(low * (high / low).powf(random())),
            Self::Count(n) => out.push((random() * f64::from(n)).floor()),
            Self::Values(list) => out.push(list[(random() * list.len() as f64) as usize]),
            Self::Direction => {
                let z: f64 = 2.0 * random() - 1.0;
                let (s, c) = (random() * std::f64::consts::TAU).sin_cos();
                let r = (1.0 - z * z).sqrt();
                out.extend([r * c, r * s, z]);
            }
            Self::Directions(low, high) => {
                let from = out.len();
                Self::Direction.sample(random, out);
                Self::Direction.sample(random, out);
                let n = DVec3::from_slice(&out[from..]);
                // Any direction except n gives a tilt axis.
                let aside = DVec3::from_slice(&out[from + 3..]).reject_from_normalized(n).normalize();
                let (s, c) = (low * (high / low).powf(random())).sin_cos();
                out.truncate(from + 3);
                out.extend((n * c + aside * s).to_array());
            }
            Self::Vector(width, low, high) => {
                out.extend((0..width).map(|_| low + (high - low) * random()));
            }
        }
    }
}

/// SplitMix64 (Steele et al. 2014) as a number in [0, 1).
pub(super) fn splitmix(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}
