//! What a camera sees, cut into tiles of the picture and slices of distance.
//!
//! Coordinates are the view's: to the right, up, and *ahead* of the eye, in meters.

use super::settings::FroxelSettings;
use crate::gpu_scene::shadow_views::FitCamera;
use framegraph_shaders::layout::FroxelUniforms;
use glam::{Vec3, Vec4};

/// Tiles are whole multiples of so many pixels a side.
const TILE_STEP_PX: u32 = 8;
/// Froxels overlap by twice this at their sides, in pixels: where a fragment is, is rounded on the way from its vertices, and
/// a triangle of a hundred meters that passes the eye at one is off by some hundredths of a pixel.
const SIDE_MARGIN_PX: f64 = 0.5;
/// And by this share of the distance at the ends of slices, of which the logarithm in shaders is off by up to 1e-5.
const END_MARGIN: f64 = 1e-4;

/// The froxels of a view.
#[derive(Clone, Debug)]
pub(super) struct FroxelGrid {
    /// Tiles across and down, and slices.
    pub counts: [u32; 3],
    /// Side of a tile in pixels.
    pub tile_px: u32,
    /// Distances ahead of the eye at which a slice begins and ends.
    pub slices: Vec<[f32; 2]>,
    /// From the top.
    pub rows: Vec<Between>,
    /// Four from the left in each; what is beyond the last contains nothing.
    pub columns: Vec<FourColumns>,
    /// The sides of each column and of each row, as [`Between::sides`].
    pub across: Vec<[f32; 2]>,
    /// Rays diverge.
    pub is_perspective: bool,
    slice_scale: f32,
    slice_offset: f32,
}

/// What lies between two planes that contain one of the view's axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Between {
    /// The planes' unit normals, inward: along the picture's axis and ahead; and offsets, so that the sum is at least 0 inside.
    pub planes: [Vec3; 2],
    /// Where the planes are: meters aside, for each meter ahead where rays diverge; the lesser first.
    pub sides: [f32; 2],
}

/// The planes of four columns, component by component.
#[derive(Clone, Copy, Debug)]
pub(super) struct FourColumns {
    /// Along, ahead, offset of the left planes, then of the right ones.
    pub planes: [[Vec4; 3]; 2],
}

impl Between {
    /// Between two places on the picture's axis, in multiples of half the picture.
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

    /// How far inside of both planes a place is.
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

    /// How far inside of its columns a place is, at the nearer side of each.
    pub fn inside(&self, along: f32, ahead: f32) -> Vec4 {
        let [left, right] = self.planes.map(|[x, a, offset]| x * along + a * ahead + offset);
        left.min(right)
    }
}

impl FroxelGrid {
    /// The froxels of a camera's picture of this size.
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
            // Nothing is seen behind the eye from which rays diverge.
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

    /// How many froxels there are.
    pub fn count(&self) -> usize {
        self.counts.iter().map(|count| *count as usize).product()
    }

    /// What shaders read of it.
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

/// Side of a tile in pixels, and how many tiles there are across and down: at most `most`, squares, by Filament's rule.
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
            // Filament's own number.
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
