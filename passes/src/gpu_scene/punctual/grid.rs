//! Froxel grid of a camera: tiles of the picture and slices of distance.
//!
//! Coordinates are those of the view, in meters: right, up, and *ahead* of the eye.

use super::settings::FroxelSettings;
use crate::gpu_scene::shadow_views::FitCamera;
use framegraph_shaders::layout::FroxelUniforms;
use glam::{Vec3, Vec4};

/// Granularity of the side of a tile, in pixels.
const TILE_STEP_PX: u32 = 8;
/// Margin at the sides of froxels in pixels; neighbors overlap by twice this. Interpolation from distant vertices
/// shifts fragments by some hundredths of a pixel.
const SIDE_MARGIN_PX: f64 = 0.5;
/// Margin at the ends of slices, as a fraction of the distance. The logarithm in shaders has a relative error of up to
/// 1e-5.
const END_MARGIN: f64 = 1e-4;

/// Froxel grid of a view.
#[derive(Clone, Debug)]
pub(super) struct FroxelGrid {
    /// Number of tiles across and down, and of slices.
    pub counts: [u32; 3],
    /// Side of a tile in pixels.
    pub tile_px: u32,
    /// Near and far end of each slice, as distances ahead of the eye.
    pub slices: Vec<[f32; 2]>,
    /// Rows from the top.
    pub rows: Vec<Between>,
    /// Columns from the left, in groups of four. Padding columns are empty.
    pub columns: Vec<FourColumns>,
    /// Sides of each column and each row, as [`Between::sides`].
    pub across: Vec<[f32; 2]>,
    /// True for a perspective projection.
    pub is_perspective: bool,
    slice_scale: f32,
    slice_offset: f32,
}

/// Region between two planes that contain one of the view's axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Between {
    /// Unit normals, inward: along the picture's axis and ahead; and offsets, so that the sum is at least 0 inside.
    pub planes: [Vec3; 2],
    /// Positions of the planes, the smaller first: in meters, per meter ahead for a perspective projection.
    pub sides: [f32; 2],
}

/// The planes of four columns, component by component.
#[derive(Clone, Copy, Debug)]
pub(super) struct FourColumns {
    /// Normal along and ahead, and offset, of the left planes, then of the right ones.
    pub planes: [[Vec4; 3]; 2],
}

impl Between {
    /// Creates the region between two positions on the picture's axis, in multiples of half the picture.
    fn new(low: f64, high: f64, half_extent: f64, is_perspective: bool) -> Self {
        let sides = [low * half_extent, high * half_extent];
        let plane = |at: f64, sign: f64| {
            if is_perspective {
                let length = at.hypot(1.0);
                Vec3::new((sign / length) as f32, (-sign * at / length) as f32, 0.0)
            } else {
                Vec3::new(sign as f32, 0.0, (-sign * at) as f32)
            }
        };
        Self { planes: [plane(sides[0], 1.0), plane(sides[1], -1.0)], sides: sides.map(|at| at as f32) }
    }

    /// Returns the distance of a point inside of both planes.
    pub fn inside(&self, along: f32, ahead: f32) -> [f32; 2] {
        self.planes.map(|plane| plane.x * along + plane.y * ahead + plane.z)
    }
}

impl FourColumns {
    fn new(columns: &[Between]) -> Self {
        let nothing = Vec3::new(0.0, 0.0, f32::NEG_INFINITY);
        let plane = |side: usize, component: usize| {
            let of = |i: usize| columns.get(i).map_or(nothing, |column| column.planes[side])[component];
            Vec4::new(of(0), of(1), of(2), of(3))
        };
        Self { planes: [0, 1].map(|side| [0, 1, 2].map(|component| plane(side, component))) }
    }

    /// Returns the distance of a point inside of its columns, from the nearer side of each.
    pub fn inside(&self, along: f32, ahead: f32) -> Vec4 {
        let [left, right] = self.planes.map(|[x, a, offset]| x * along + a * ahead + offset);
        left.min(right)
    }
}

impl FroxelGrid {
    /// Creates the grid of a camera for a picture of this size.
    pub fn new(camera: &FitCamera<'_>, size_px: [u32; 2], settings: &FroxelSettings) -> Self {
        let size_px = size_px.map(|side| side.max(1));
        let (tile_px, tiles) = layout(size_px, settings.tiles);
        let is_perspective = camera.is_perspective();
        let half_extent = camera.half_extent();
        let cut = |axis: usize| -> Vec<Between> {
            let size = f64::from(size_px[axis]);
            let between = |tile: u32| {
                let from = f64::from(tile * tile_px);
                let to = (from + f64::from(tile_px)).min(size);
                let at = |px: f64| 2.0 * px / size - 1.0;
                let [low, high] = [at(from - SIDE_MARGIN_PX), at(to + SIDE_MARGIN_PX)];
                // Rows run downward.
                let [low, high] = if axis == 0 { [low, high] } else { [-high, -low] };
                Between::new(low, high, half_extent[axis], is_perspective)
            };
            (0..tiles[axis]).map(between).collect()
        };
        let (columns, rows) = (cut(0), cut(1));
        let slices = settings.slices.max(1);
        let [near, far] = [settings.near_m, settings.far_m].map(f64::from);
        let log_ratio = if slices > 1 { (far / near).log2() / f64::from(slices - 1) } else { 1.0 };
        let end = |slice: u32| match slice {
            // A perspective camera sees nothing behind the eye.
            0 if is_perspective => 0.0,
            0 => f64::NEG_INFINITY,
            last if last == slices => f64::INFINITY,
            _ => far * ((f64::from(slice) - f64::from(slices)) * log_ratio).exp2(),
        };
        let ends =
            |slice: u32| [(end(slice) * (1.0 - END_MARGIN)) as f32, (end(slice + 1) * (1.0 + END_MARGIN)) as f32];
        Self {
            counts: [tiles[0], tiles[1], slices],
            tile_px,
            slices: (0..slices).map(ends).collect(),
            across: columns.iter().map(|column| column.sides).collect(),
            columns: columns.chunks(4).map(FourColumns::new).collect(),
            rows,
            is_perspective,
            slice_scale: (1.0 / log_ratio) as f32,
            slice_offset: (f64::from(slices) - far.log2() / log_ratio) as f32,
        }
    }

    /// Returns the number of froxels.
    pub fn count(&self) -> usize {
        self.counts.iter().map(|count| *count as usize).product()
    }

    /// Returns the grid in the layout of shaders.
    pub fn uniforms(&self, everywhere: u32) -> FroxelUniforms {
        FroxelUniforms {
            counts: self.counts,
            tiles_per_px: 1.0 / self.tile_px as f32,
            slice_scale: self.slice_scale,
            slice_offset: self.slice_offset,
            everywhere,
            _pad: 0,
        }
    }
}

/// Returns the side of a tile in pixels, and the number of tiles across and down, at most `most`, by Filament's rule.
fn layout(size_px: [u32; 2], most: u32) -> (u32, [u32; 2]) {
    let ratio = f64::from(size_px[0]) / f64::from(size_px[1]);
    let count = |ratio: f64| ((f64::from(most) * ratio).sqrt() as u32).clamp(1, most.max(1));
    let counts = [count(ratio), count(1.0 / ratio)];
    let side = size_px[0].div_ceil(counts[0]).max(size_px[1].div_ceil(counts[1]));
    let side = side.next_multiple_of(TILE_STEP_PX);
    (side, size_px.map(|size| size.div_ceil(side)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_are_as_many_as_may_be() {
        for (size, most, expected) in [
            ([1280, 720], 144, (80, [16, 9])),
            ([1920, 1080], 144, (120, [16, 9])),
            ([3840, 2160], 144, (240, [16, 9])),
            // Filament's own numbers.
            ([1280, 720], 512, (48, [27, 15])),
            ([720, 1280], 144, (80, [9, 16])),
            ([1, 1], 144, (8, [1, 1])),
            ([1, 777], 144, (8, [1, 98])),
            ([100_000, 1], 144, (696, [144, 1])),
            ([640, 360], 1, (640, [1, 1])),
        ] {
            assert_eq!(layout(size, most), expected, "{size:?} {most}");
        }
    }
}
