//! Ambient occlusion of shapes with an analytic solution: the cosine-weighted share of unoccluded rays of a limited
//! length.

use std::f64::consts::PI;

/// Returns the visibility on the floor of a corner of two infinite perpendicular planes, `distance_m` from the other
/// plane. Surfaces beyond `radius_m` do not occlude. Projected along the normal, the hemisphere is a disc whose area is
/// the cosine-weighted solid angle; the wall covers a segment of it.
pub fn corner(distance_m: f64, radius_m: f64) -> f64 {
    let chord = (distance_m / radius_m).clamp(0.0, 1.0);
    1.0 - (chord.acos() - chord * (1.0 - chord * chord).sqrt()) / PI
}

/// Returns the angle in radians by which the mean unoccluded direction leans away from the wall, from a cosine-weighted
/// sum over a grid.
pub fn corner_lean(distance_m: f64, radius_m: f64) -> f64 {
    let (rings, spokes) = (200, 400);
    let [mut along, mut up] = [0.0; 2];
    for ring in 0..rings {
        let radius = ((f64::from(ring) + 0.5) / f64::from(rings)).sqrt();
        for spoke in 0..spokes {
            let x = radius * (2.0 * PI * (f64::from(spoke) + 0.5) / f64::from(spokes)).cos();
            if x * radius_m < distance_m {
                along -= x;
                up += (1.0 - radius * radius).sqrt();
            }
        }
    }
    along.atan2(up)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares with a grid of directions.
    #[test]
    fn the_corner_is_what_counting_directions_gives() {
        for distance_m in [0.0, 0.02, 0.05, 0.1, 0.2, 0.29, 0.4] {
            let (rings, spokes) = (400, 800);
            let mut open = 0.0;
            for ring in 0..rings {
                // Rings of equal cosine-weighted solid angle.
                let radius = ((f64::from(ring) + 0.5) / f64::from(rings)).sqrt();
                for spoke in 0..spokes {
                    let x = radius * (2.0 * PI * (f64::from(spoke) + 0.5) / f64::from(spokes)).cos();
                    let hit = x > 0.0 && distance_m / x <= 0.3;
                    open += f64::from(u8::from(!hit));
                }
            }
            let counted = open / f64::from(rings * spokes);
            assert!((corner(distance_m, 0.3) - counted).abs() < 2e-3, "{distance_m}: {counted}");
        }
        for (distance_m, known) in [(0.05, 0.606), (0.1, 0.707), (0.2, 0.890)] {
            assert!((corner(distance_m, 0.3) - known).abs() < 1.5e-3, "{distance_m}: {}", corner(distance_m, 0.3));
        }
    }
}
