//! Bounding boxes as arrays of coordinates, and which of many lie within planes: arithmetic that compilers turn into SIMD.

use std::ops::Range;
use std::thread;

use glam::{DVec3, DVec4};

use super::bounds::Aabb;

/// Boxes that are tested together: a whole number of registers of any width, and few enough for the first cache.
const BLOCK: usize = 64;
/// Half the size of a box that no plane keeps; times zero it is zero, which is not so for infinity.
const NOWHERE: f32 = -1e30;
/// What f32 may be off by in the sum that is compared, over the largest of its terms: some ten roundings of 2⁻²⁴ each.
const SLACK: f64 = 1.0 / (1 << 20) as f64;
/// Boxes for which another thread is worth starting: testing them takes some ten times as long.
const WORTH_A_THREAD: usize = 1 << 17;

/// Boxes by number, an array a coordinate, in f32 about a point amid them: 24 bytes a box.
#[derive(Clone, Debug, Default)]
pub struct BoxArrays {
    about: DVec3,
    /// The largest coordinate of any finite box, about that point.
    largest_m: f64,
    len: usize,
    /// Middles and half sizes, x, y, z each; padded to whole blocks with boxes that are nowhere.
    middle: [Vec<f32>; 3],
    half: [Vec<f32>; 3],
}

impl BoxArrays {
    /// Those of `bounds`.
    #[must_use]
    pub fn new(bounds: &[Aabb]) -> Self {
        let whole = bounds.iter().filter(|b| is_finite(b)).fold(Aabb::EMPTY, |all, own| all.union(*own));
        let padded = bounds.len().next_multiple_of(BLOCK);
        let mut arrays = Self {
            about: whole.center(),
            largest_m: whole.half_extent().max_element(),
            len: bounds.len(),
            middle: std::array::from_fn(|_| vec![0.0; padded]),
            half: std::array::from_fn(|_| vec![NOWHERE; padded]),
        };
        for (number, bounds) in bounds.iter().enumerate() {
            arrays.set(number, bounds);
        }
        arrays
    }

    /// Replaces a box.
    ///
    /// # Panics
    /// When there is no such box.
    pub fn set(&mut self, number: usize, bounds: &Aabb) {
        assert!(number < self.len, "box {number} of {}", self.len);
        let (middle, half) = match (bounds.is_empty(), is_finite(bounds)) {
            (true, _) => (DVec3::ZERO, DVec3::splat(NOWHERE.into())),
            // Nobody knows where it is: no comparison holds for it, so it is kept.
            (false, false) => (DVec3::NAN, DVec3::ZERO),
            (false, true) => (bounds.center() - self.about, bounds.half_extent()),
        };
        if is_finite(bounds) {
            self.largest_m = self.largest_m.max((middle.abs() + half).max_element());
        }
        for axis in 0..3 {
            self.middle[axis][number] = middle[axis] as f32;
            self.half[axis][number] = half[axis] as f32;
        }
    }

    /// Appends the numbers of the boxes that reach into all half spaces, in order. A plane's half space is where the product
    /// with its normal, of a point seen from `eye`, plus its fourth number is at least zero; normals have length one.
    ///
    /// What is left out certainly lies outside of one plane. What is kept may miss the planes by what f32 cannot tell, a
    /// millionth of the scene's size, and may lie beyond an edge where two of them meet. An empty box is left out, one that
    /// is not finite is kept. Many boxes are tested on as many as `threads` threads.
    pub fn reaching(&self, eye: DVec3, planes: &[DVec4], threads: usize, found: &mut Vec<u32>) {
        let planes: Vec<Half> = planes.iter().map(|plane| self.half_space(eye, *plane)).collect();
        let blocks = self.middle[0].len() / BLOCK;
        let threads = threads.min(self.len / WORTH_A_THREAD).max(1);
        let share = blocks.div_ceil(threads).max(1);
        if threads == 1 {
            self.blocks(0..blocks, &planes, found);
            return;
        }
        let planes = &planes;
        thread::scope(|scope| {
            let others: Vec<_> = (1..threads)
                .map(|i| {
                    scope.spawn(move || {
                        let mut found = Vec::new();
                        self.blocks(i * share..((i + 1) * share).min(blocks), planes, &mut found);
                        found
                    })
                })
                .collect();
            self.blocks(0..share, planes, found);
            for other in others {
                // A thread ends without a result only by a panic of the arithmetic above, which has none.
                found.extend(other.join().unwrap_or_default());
            }
        });
    }

    fn half_space(&self, eye: DVec3, plane: DVec4) -> Half {
        let normal = plane.truncate();
        let w = plane.w + normal.dot(self.about - eye);
        let slack = SLACK * (6.0 * self.largest_m + w.abs());
        Half { normal: normal.to_array().map(|x| x as f32), least: -(w + slack) as f32 }
    }

    fn blocks(&self, blocks: Range<usize>, planes: &[Half], found: &mut Vec<u32>) {
        found.reserve(blocks.len() * BLOCK);
        let [x, y, z] = self.middle.each_ref().map(|axis| axis.as_chunks::<BLOCK>().0);
        let [a, b, c] = self.half.each_ref().map(|axis| axis.as_chunks::<BLOCK>().0);
        for block in blocks {
            let mut outside = [0_u32; BLOCK];
            for Half { normal: [nx, ny, nz], least } in planes {
                let (x, y, z, a, b, c) = (&x[block], &y[block], &z[block], &a[block], &b[block], &c[block]);
                let (ax, ay, az) = (nx.abs(), ny.abs(), nz.abs());
                for i in 0..BLOCK {
                    let nearest = nx * x[i] + ny * y[i] + nz * z[i] + (ax * a[i] + ay * b[i] + az * c[i]);
                    outside[i] |= u32::from(nearest < *least);
                }
            }
            let (mut numbers, mut count) = ([0_u32; BLOCK], 0);
            for (i, outside) in outside.iter().enumerate() {
                numbers[count] = (block * BLOCK + i) as u32;
                count += usize::from(*outside == 0);
            }
            found.extend_from_slice(&numbers[..count]);
        }
    }
}

/// A plane as boxes are compared with it: outside is what reaches less far along the normal.
struct Half {
    normal: [f32; 3],
    least: f32,
}

fn is_finite(bounds: &Aabb) -> bool {
    bounds.min.is_finite() && bounds.max.is_finite()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{Camera, Projection};
    use crate::frustum::Frustum;

    fn random_boxes(count: usize, spread_m: f64, middle: DVec3) -> Vec<Aabb> {
        let mut state = 7_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / (1_u64 << 24) as f64
        };
        let mut vector = || DVec3::new(random(), random(), random());
        (0..count)
            .map(|_| {
                let center = middle + (vector() * 2.0 - 1.0) * spread_m;
                let half = vector() * 0.05 * spread_m;
                Aabb { min: center - half, max: center + half }
            })
            .collect()
    }

    /// Whatever the exact test in f64 keeps is kept, at any distance from the origin, and hardly anything more; on any number
    /// of threads the same.
    #[test]
    fn nothing_that_may_be_seen_is_left_out() -> Result<(), Box<dyn std::error::Error>> {
        for (middle, spread_m) in [(DVec3::ZERO, 20.0), (DVec3::new(1e6, -1e6, 5e5), 300.0), (DVec3::ONE, 1e-3)] {
            let boxes = random_boxes(3000, spread_m, middle);
            let arrays = BoxArrays::new(&boxes);
            for (fov, near) in [(0.3, 0.1), (1.2, 0.001)] {
                let projection = Projection::perspective(fov, near * spread_m);
                let eye = middle + DVec3::new(0.4, 0.1, 0.9) * spread_m;
                let camera = Camera::look_at(eye, middle, DVec3::Y, projection)?;
                let frustum = Frustum::of_camera(&camera, 1.5);
                let mut found = Vec::new();
                arrays.reaching(eye, frustum.planes(), 1, &mut found);
                let exact: Vec<u32> = (0..3000).filter(|i| frustum.may_see(&boxes[*i as usize])).collect();
                assert!(exact.iter().all(|i| found.binary_search(i).is_ok()), "{middle} {fov}");
                assert!(exact.len() > 10 && found.len() <= exact.len() + 2, "{} for {}", found.len(), exact.len());
            }
        }
        let boxes = random_boxes(4 * WORTH_A_THREAD + 77, 20.0, DVec3::ZERO);
        let (arrays, planes) = (BoxArrays::new(&boxes), [DVec4::new(0.6, 0.0, 0.8, 1.0)]);
        let [one, many] = [1, 3].map(|threads| {
            let mut found = vec![9];
            arrays.reaching(DVec3::X, &planes, threads, &mut found);
            found
        });
        assert!(one == many && one.len() > 1000);
        Ok(())
    }

    #[test]
    fn empty_boxes_are_nowhere_and_unknown_ones_everywhere() {
        let unknown = Aabb { min: DVec3::splat(f64::NAN), max: DVec3::ONE };
        let endless = Aabb { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };
        let far = Aabb { min: DVec3::splat(-9.0), max: DVec3::splat(-8.0) };
        let planes = [DVec4::new(1.0, 0.0, 0.0, 0.0), DVec4::new(0.0, 1.0, 0.0, 0.0)];
        let mut arrays = BoxArrays::new(&[Aabb::EMPTY, endless, far]);
        let seen = |arrays: &BoxArrays| {
            let mut found = Vec::new();
            arrays.reaching(DVec3::ZERO, &planes, 1, &mut found);
            found
        };
        assert!(unknown.is_empty() && seen(&arrays) == [1]);
        arrays.set(2, &Aabb { min: DVec3::ONE, max: DVec3::ONE * 2.0 });
        assert_eq!(seen(&arrays), [1, 2]);
    }
}
