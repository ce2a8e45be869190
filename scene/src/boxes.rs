//! Bounding boxes as arrays of coordinates, tested against planes with arithmetic that compilers vectorize.

use std::ops::Range;

use glam::{DVec3, DVec4};

use super::bounds::Aabb;

/// Boxes per block: a multiple of every SIMD width, and small enough for the L1 cache.
pub(crate) const BLOCK: usize = 64;
/// Half size of a padding box, which every plane rejects. Finite, since infinity times zero is NaN.
const NOWHERE: f32 = -1e30;
/// Relative f32 rounding error of the compared sum, about ten roundings of 2⁻²⁴ each.
const SLACK: f64 = 1.0 / (1 << 20) as f64;
/// Minimum number of boxes for which waking another thread pays off; testing that many takes about ten times as long.
const WORTH_A_THREAD: usize = 1 << 15;

/// Bounding boxes in f32 relative to a common center, one array per coordinate: 24 bytes a box.
/// Each block of 64 boxes has an enclosing box. Blocks of spatially close boxes are therefore accepted or rejected as a
/// whole.
#[derive(Clone, Debug, Default)]
pub struct BoxArrays {
    about: DVec3,
    /// Largest absolute coordinate of a finite box, relative to the common center.
    largest_m: f64,
    len: usize,
    /// Centers and half sizes, each as x, y, z; padded to whole blocks with boxes that every plane rejects.
    middle: [Vec<f32>; 3],
    half: [Vec<f32>; 3],
    blocks: Vec<Block>,
}

/// Enclosing box of a block.
#[derive(Clone, Copy, Debug)]
struct Block {
    /// NaN if a box of the block is not finite, so that no comparison decides for the block.
    middle: [f32; 3],
    half: [f32; 3],
    /// True if the block has neither empty boxes nor padding, so that it can be accepted as a whole.
    full: bool,
}

/// Result of testing a block against planes.
enum Seen {
    All,
    None,
    Some,
}

impl BoxArrays {
    /// Builds the arrays from `bounds`.
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
            blocks: vec![Block { middle: [0.0; 3], half: [NOWHERE; 3], full: false }; padded / BLOCK],
        };
        arrays.replace(bounds.iter().enumerate());
        arrays
    }

    /// Replaces the boxes with these numbers; fastest in ascending order.
    ///
    /// # Panics
    /// If a number is out of range.
    pub fn replace<'a>(&mut self, boxes: impl Iterator<Item = (usize, &'a Aabb)>) {
        let mut touched = None;
        for (number, bounds) in boxes {
            self.set(number, bounds);
            let block = Some(number / BLOCK);
            if touched != block {
                touched.into_iter().for_each(|block| self.enclose(block));
                touched = block;
            }
        }
        touched.into_iter().for_each(|block| self.enclose(block));
    }

    /// Recomputes the enclosing box of a block.
    fn enclose(&mut self, block: usize) {
        let range = block * BLOCK..(block + 1) * BLOCK;
        let mut own = Block { middle: [0.0; 3], half: [NOWHERE; 3], full: true };
        for axis in 0..3 {
            let (mut low, mut high, mut finite) = (f32::INFINITY, f32::NEG_INFINITY, true);
            for (middle, half) in self.middle[axis][range.clone()].iter().zip(&self.half[axis][range.clone()]) {
                finite &= middle.is_finite();
                let is_box = *half >= 0.0;
                own.full &= is_box;
                if is_box {
                    (low, high) = (low.min(middle - half), high.max(middle + half));
                }
            }
            if !finite {
                own.middle[axis] = f32::NAN;
                own.half[axis] = 0.0;
            } else if low <= high {
                own.middle[axis] = 0.5 * low + 0.5 * high;
                own.half[axis] = (high - own.middle[axis]).max(own.middle[axis] - low);
            }
        }
        self.blocks[block] = own;
    }

    fn set(&mut self, number: usize, bounds: &Aabb) {
        assert!(number < self.len, "box {number} of {}", self.len);
        let (middle, half) = match (bounds.is_empty(), is_finite(bounds)) {
            (true, _) => (DVec3::ZERO, DVec3::splat(NOWHERE.into())),
            // The position is unknown: NaN fails every comparison, so the block is kept.
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

    /// Appends the numbers of the boxes that intersect all half spaces, in ascending order. A point p lies in the half
    /// space of a plane if dot(p − `eye`, normal) plus the fourth component is at least zero. Normals must have unit
    /// length.
    ///
    /// The test is conservative. Boxes within f32 rounding of a plane (a millionth of the scene's size) are kept, as
    /// are boxes beyond an edge where two planes meet. Empty boxes are rejected and non-finite boxes are kept. Large
    /// sets are also tested on the threads of `pool`.
    pub fn reaching(&self, eye: DVec3, planes: &[DVec4], pool: Option<&rayon::ThreadPool>, found: &mut Vec<u32>) {
        let planes: Vec<Half> = planes.iter().map(|plane| self.half_space(eye, *plane)).collect();
        let threads = pool.map_or(1, |pool| pool.current_num_threads() + 1).min(self.len / WORTH_A_THREAD);
        let Some(pool) = pool.filter(|_| threads > 1) else {
            return test(self, 0..self.blocks.len(), &planes, found, None);
        };
        let share = self.blocks.len().div_ceil(threads);
        let mut others = vec![Vec::new(); threads - 1];
        pool.in_place_scope(|scope| {
            let planes = &planes;
            for (i, found) in (1..).zip(&mut others) {
                scope.spawn(move |_| {
                    test(self, i * share..((i + 1) * share).min(self.blocks.len()), planes, found, None);
                });
            }
            test(self, 0..share, planes, found, None);
        });
        others.iter().for_each(|other| found.extend_from_slice(other));
    }

    /// Appends the results of [`reaching`](Self::reaching) in two lists: numbers of blocks of 64 consecutive boxes that
    /// intersect all half spaces as a whole, and numbers of boxes in other blocks. Both are ascending.
    pub(crate) fn reaching_blocks(&self, eye: DVec3, planes: &[DVec4], blocks: &mut Vec<u32>, boxes: &mut Vec<u32>) {
        let planes: Vec<Half> = planes.iter().map(|plane| self.half_space(eye, *plane)).collect();
        test(self, 0..self.blocks.len(), &planes, boxes, Some(blocks));
    }

    fn half_space(&self, eye: DVec3, plane: DVec4) -> Half {
        let normal = plane.truncate();
        let w = plane.w + normal.dot(self.about - eye);
        let slack = SLACK * (6.0 * self.largest_m + w.abs());
        Half { normal: normal.to_array().map(|x| x as f32), least: -(w + slack) as f32 }
    }
}

/// Version of [`test_portable`] that is also compiled for AVX2, which tests eight boxes at once; selected at run time.
/// Products and sums are not fused, so both versions return equal results.
#[multiversion::multiversion(targets("x86_64+avx2"))]
fn test(arrays: &BoxArrays, blocks: Range<usize>, planes: &[Half], found: &mut Vec<u32>, whole: Option<&mut Vec<u32>>) {
    test_portable(arrays, blocks, planes, found, whole);
}

/// Appends the numbers of the boxes of `blocks` that intersect all half spaces. Appends blocks that do as a whole to
/// `whole` instead if it exists.
#[inline(always)]
fn test_portable(
    arrays: &BoxArrays,
    blocks: Range<usize>,
    planes: &[Half],
    found: &mut Vec<u32>,
    mut whole: Option<&mut Vec<u32>>,
) {
    if whole.is_none() {
        found.reserve(blocks.len() * BLOCK);
    }
    let [x, y, z] = arrays.middle.each_ref().map(|axis| axis.as_chunks::<BLOCK>().0);
    let [a, b, c] = arrays.half.each_ref().map(|axis| axis.as_chunks::<BLOCK>().0);
    for block in blocks {
        match arrays.blocks[block].seen(planes) {
            Seen::None => continue,
            Seen::All => {
                if let Some(whole) = &mut whole {
                    whole.push(block as u32);
                    continue;
                }
                found.extend((block * BLOCK) as u32..((block + 1) * BLOCK) as u32);
                continue;
            }
            Seen::Some => {}
        }
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

impl Block {
    /// Classifies a block by its enclosing box: all boxes inside, all outside, or undecided.
    #[inline(always)]
    fn seen(&self, planes: &[Half]) -> Seen {
        let mut all = self.full;
        for Half { normal, least } in planes {
            let (mut middle, mut reach) = (0.0, 0.0);
            for (normal, (center, half)) in normal.iter().zip(self.middle.iter().zip(&self.half)) {
                middle += normal * center;
                reach += normal.abs() * half;
            }
            if middle + reach < *least {
                return Seen::None;
            }
            all &= middle - reach >= *least;
        }
        if all { Seen::All } else { Seen::Some }
    }
}

/// Plane in the form used by the test: a box is outside if it does not reach the plane along the normal.
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

    /// Keeps every box that the exact f64 test keeps, at any distance from the origin, and few others. The result does
    /// not depend on the number of threads.
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
                arrays.reaching(eye, frustum.planes(), None, &mut found);
                let exact: Vec<u32> = (0..3000).filter(|i| frustum.may_see(&boxes[*i as usize])).collect();
                assert!(exact.iter().all(|i| found.binary_search(i).is_ok()), "{middle} {fov}");
                assert!(exact.len() > 10 && found.len() <= exact.len() + 2, "{} for {}", found.len(), exact.len());
            }
        }
        let boxes = random_boxes(4 * WORTH_A_THREAD + 77, 20.0, DVec3::ZERO);
        let (arrays, planes) = (BoxArrays::new(&boxes), [DVec4::new(0.6, 0.0, 0.8, 1.0)]);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build()?;
        let [one, many] = [None, Some(&pool)].map(|pool| {
            let mut found = vec![9];
            arrays.reaching(DVec3::X, &planes, pool, &mut found);
            found
        });
        assert!(one == many && one.len() > 1000);
        Ok(())
    }

    /// SIMD and portable versions return equal results. (On processors without AVX2 both are the portable one.)
    #[test]
    fn wide_registers_find_the_same() {
        let boxes = random_boxes(9 * BLOCK + 5, 20.0, DVec3::ONE);
        let arrays = BoxArrays::new(&boxes);
        let planes: Vec<Half> = [DVec4::new(0.6, 0.0, 0.8, 1.0), DVec4::new(0.0, -1.0, 0.0, 2.0)]
            .map(|plane| arrays.half_space(DVec3::X, plane))
            .into();
        let [mut own, mut portable] = [Vec::new(), Vec::new()];
        test(&arrays, 0..arrays.blocks.len(), &planes, &mut own, None);
        test_portable(&arrays, 0..arrays.blocks.len(), &planes, &mut portable, None);
        assert!(own == portable && own.len() > 100 && own.len() < boxes.len() - 100, "{}", own.len());
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
            arrays.reaching(DVec3::ZERO, &planes, None, &mut found);
            found
        };
        assert!(unknown.is_empty() && seen(&arrays) == [1]);
        let near = Aabb { min: DVec3::ONE, max: DVec3::ONE * 2.0 };
        arrays.replace([(2, &near)].into_iter());
        assert_eq!(seen(&arrays), [1, 2]);
        // Between blocks that are accepted and rejected as a whole.
        for (other, kept) in [(near, 191), (far, 1)] {
            let mut boxes = [other; 192];
            (boxes[70], boxes[71]) = (Aabb::EMPTY, endless);
            assert_eq!(seen(&BoxArrays::new(&boxes)).len(), kept);
        }
    }

    /// Accepting or rejecting whole blocks gives the result of testing each box. For comparison, boxes are shuffled so
    /// that no block can be decided as a whole.
    #[test]
    fn blocks_settle_what_boxes_would() -> Result<(), Box<dyn std::error::Error>> {
        let count = 64 * 64;
        let row = |i: usize| {
            // Tiles of 8 × 8.
            let [x, y] = [i % 8 + i / 64 % 8 * 8, i / 8 % 8 + i / 512 * 8];
            let at = DVec3::new(x as f64, y as f64, 0.3 * (i % 7) as f64);
            Aabb { min: at, max: at + 0.5 }
        };
        let boxes: Vec<Aabb> = (0..count).map(row).collect();
        let stride = 1237;
        let mixed: Vec<Aabb> = (0..count).map(|i| boxes[i * stride % count]).collect();
        let (mut apart, together) = (BoxArrays::new(&boxes), BoxArrays::new(&mixed));
        let mut settled = [0; 3];
        for turn in 0..40 {
            let eye = DVec3::new(30.0 + f64::from(turn), 31.0, 9.0 - 0.2 * f64::from(turn));
            let toward = DVec3::new(f64::from(turn * 13 % 64), f64::from(turn * 29 % 64), 0.0);
            let camera = Camera::look_at(eye, toward, DVec3::Y, Projection::perspective(0.9, 0.1))?;
            let frustum = Frustum::of_camera(&camera, 1.5);
            let (mut one, mut other) = (Vec::new(), Vec::new());
            apart.reaching(eye, frustum.planes(), None, &mut one);
            let (mut blocks, mut boxes) = (Vec::new(), Vec::new());
            apart.reaching_blocks(eye, frustum.planes(), &mut blocks, &mut boxes);
            boxes.extend(blocks.iter().flat_map(|block| block * 64..(block + 1) * 64));
            boxes.sort_unstable();
            assert_eq!(boxes, one);
            together.reaching(eye, frustum.planes(), None, &mut other);
            other.iter_mut().for_each(|i| *i = (*i as usize * stride % count) as u32);
            other.sort_unstable();
            assert!(one == other && one.len() > 10, "{} and {} boxes", one.len(), other.len());
            let planes: Vec<_> = frustum.planes().iter().map(|plane| apart.half_space(eye, *plane)).collect();
            for block in &apart.blocks {
                settled[block.seen(&planes) as usize] += 1;
            }
        }
        assert!(settled.iter().all(|count| *count > 100), "{settled:?}");
        // Moving a box updates the bounds of its block.
        let away = Aabb { min: DVec3::splat(900.0), max: DVec3::splat(901.0) };
        apart.replace((0..count).map(|i| (i, &away)));
        let fresh = BoxArrays::new(&vec![away; count]);
        assert!(apart.blocks.iter().all(|block| block.middle[0] > 900.0 - 64.0) && fresh.blocks[0].full);
        Ok(())
    }
}
