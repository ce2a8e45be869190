//! Depth of field on the CPU in f64, step by step. The device must match it, apart from the rounding of intermediate
//! textures to half floats, which is applied here too.

use crate::bloom::stage::Image;
use framegraph_passes::DofSettings;
use framegraph_passes::effects::depth::structure::Resolution;
use glam::{DVec2, DVec3, DVec4, Vec4Swizzles};
use half::f16;
use std::f64::consts::TAU;

const TILE_PX: usize = 16;
const MAX_PX: f64 = 32.0;
const LEVELS: usize = 4;

/// Texels rounded to half floats, rows from the top.
struct Texels {
    size: [usize; 2],
    texels: Vec<DVec4>,
}

impl Texels {
    fn new(size: [usize; 2], mut texel: impl FnMut(usize, usize) -> DVec4) -> Self {
        let halves = |t: DVec4| DVec4::from_array(t.to_array().map(|x| f16::from_f64(x).to_f64()));
        let places = (0..size[0] * size[1]).map(|i| (i % size[0], i / size[0]));
        Self { size, texels: places.map(|(x, y)| halves(texel(x, y))).collect() }
    }

    /// Returns the nearest texel.
    fn at(&self, x: i64, y: i64) -> DVec4 {
        let [x, y] = [(x, self.size[0]), (y, self.size[1])].map(|(at, side)| at.clamp(0, side as i64 - 1) as usize);
        self.texels[y * self.size[0] + x]
    }

    /// Returns the texel at a point in 0…1.
    fn tap(&self, uv: DVec2) -> DVec4 {
        let at = (uv * self.sides()).floor();
        self.at(at.x as i64, at.y as i64)
    }

    /// Interpolates linearly between texel centers.
    fn linear(&self, uv: DVec2) -> DVec4 {
        let at = uv * self.sides() - 0.5;
        let (first, part) = (at.floor(), at - at.floor());
        let row = |y: i64| self.at(first.x as i64, y).lerp(self.at(first.x as i64 + 1, y), part.x);
        row(first.y as i64).lerp(row(first.y as i64 + 1), part.y)
    }

    fn sides(&self) -> DVec2 {
        DVec2::new(self.size[0] as f64, self.size[1] as f64)
    }
}

/// A picture through a lens. `radius_px` is the circle's radius at infinity, and `per_focus` returns focus distance
/// divided by distance at a pixel.
pub struct Shot<'a> {
    pub image: &'a Image,
    pub per_focus: &'a dyn Fn(i64, i64) -> f64,
    pub radius_px: f64,
    pub settings: &'a DofSettings,
}

impl Shot<'_> {
    pub fn develop(&self) -> Image {
        let size = self.image.size.map(|side| side as usize);
        let texel_px = if self.settings.resolution == Resolution::Half { 2 } else { 1 };
        let mut field = vec![self.field(size.map(|side| side / texel_px), texel_px as i64)];
        while field.len() < LEVELS {
            field.push(halved(&field[field.len() - 1]));
        }
        let tiles = dilated(&tiles(&field[0], TILE_PX / texel_px));
        let gather = Gather { field: &field, tiles: &tiles, texel_px, settings: self.settings };
        let mut gathered = Texels::new(field[0].size, |x, y| gather.texel(x, y));
        if self.settings.median {
            gathered = Texels::new(field[0].size, |x, y| {
                if gather.in_focus(x, y) { DVec4::ZERO } else { median(&gathered, x as i64, y as i64) }
            });
        }
        let combined = Texels::new(size, |x, y| {
            let over =
                gathered.linear((DVec2::new(x as f64, y as f64) + 0.5) / DVec2::new(size[0] as f64, size[1] as f64));
            (over.xyz() + self.image.at(x as i64, y as i64) * (1.0 - over.w)).extend(1.0)
        });
        Image { size: self.image.size, texels: combined.texels.iter().map(|t| t.xyz()).collect() }
    }

    /// Returns radiance, with lower weights for bright pixels, and the radius of the nearest pixel.
    fn field(&self, size: [usize; 2], texel_px: i64) -> Texels {
        Texels::new(size, |x, y| {
            let places = (0..texel_px * texel_px)
                .map(|i| (x as i64 * texel_px + i % texel_px, y as i64 * texel_px + i / texel_px));
            let (mut color, mut whole, mut nearest) = (DVec3::ZERO, 0.0, MAX_PX);
            for (x, y) in places {
                let radius = (self.radius_px * (1.0 - (self.per_focus)(x, y))).clamp(-MAX_PX, MAX_PX);
                nearest = f64::min(nearest, if radius.abs() < 1.0 { 0.0 } else { radius });
                let weight = 1.0 / (1.0 + self.image.at(x, y).max_element());
                color += self.image.at(x, y) * weight;
                whole += weight;
            }
            (color / whole).extend(nearest)
        })
    }
}

fn halved(field: &Texels) -> Texels {
    Texels::new(field.size.map(|side| (side / 2).max(1)), |x, y| {
        let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| field.at(2 * x as i64 + i, 2 * y as i64 + j));
        let color = four.iter().map(|t| t.xyz()).sum::<DVec3>() / 4.0;
        color.extend(four.iter().map(|t| t.w).fold(MAX_PX, f64::min))
    })
}

/// Returns the minimum and maximum radius of each tile.
fn tiles(field: &Texels, side: usize) -> Texels {
    let within = |at: usize, most: usize| at * side..((at + 1) * side).min(most);
    Texels::new(field.size.map(|most| most.div_ceil(side)), |x, y| {
        let (columns, rows) = (within(x, field.size[0]), within(y, field.size[1]));
        let radii =
            rows.flat_map(|y| columns.clone().map(move |x| (x, y))).map(|(x, y)| field.at(x as i64, y as i64).w);
        extremes(radii)
    })
}

fn dilated(tiles: &Texels) -> Texels {
    Texels::new(tiles.size, |x, y| {
        let around = (-2..=2).flat_map(|j| (-2..=2).map(move |i| (x as i64 + i, y as i64 + j)));
        extremes(around.flat_map(|(x, y)| [tiles.at(x, y).x, tiles.at(x, y).y]))
    })
}

fn extremes(radii: impl Iterator<Item = f64>) -> DVec4 {
    let (least, largest) = radii.fold((f64::MAX, f64::MIN), |(least, largest), r| (least.min(r), largest.max(r)));
    DVec4::new(least, largest, 0.0, 0.0)
}

fn median(of: &Texels, x: i64, y: i64) -> DVec4 {
    let nine: Vec<DVec4> = (-1..=1).flat_map(|j| (-1..=1).map(move |i| of.at(x + i, y + j))).collect();
    let middle = |channel: usize| {
        let mut values: Vec<f64> = nine.iter().map(|t| t[channel]).collect();
        values.sort_by(f64::total_cmp);
        values[4]
    };
    DVec4::from_array([0, 1, 2, 3].map(middle))
}

/// Returns Jimenez's interleaved gradient noise of a pixel, for one of 64 frames.
fn noise(pixel: DVec2, frame: f64) -> f64 {
    let p = (pixel + 5.588238 * frame).as_vec2();
    f64::from((52.982_918 * (p.x * 0.067_110_56 + p.y * 0.005_837_15).fract()).fract())
}

/// Returns the density of light in a disc with a radius.
fn density(radius: f64, texel_px: f64) -> f64 {
    1024.0 / (radius * radius).max(2.0 * texel_px)
}

/// Returns how much a disc of a radius covers a pixel, 0…1.
fn reach(radius: f64, distance: f64, texel_px: f64) -> f64 {
    ((radius - distance) / texel_px + 0.5).clamp(0.0, 1.0)
}

fn smoothstep(from: f64, to: f64, x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Weighted sums of color and radius, and the weights.
#[derive(Clone, Copy, Default)]
struct Sum {
    color: DVec3,
    radius: f64,
    weight: f64,
}

impl Sum {
    fn add(&mut self, tap: DVec4, weight: f64) {
        self.color += tap.xyz() * weight;
        self.radius += tap.w.abs() * weight;
        self.weight += weight;
    }

    fn mean(&self) -> (DVec3, f64) {
        let whole = self.weight.max(1e-6);
        (self.color / whole, self.radius / whole)
    }
}

struct Gather<'a> {
    field: &'a [Texels],
    tiles: &'a Texels,
    texel_px: usize,
    settings: &'a DofSettings,
}

impl Gather<'_> {
    fn tile(&self, x: usize, y: usize) -> [f64; 2] {
        let side = TILE_PX / self.texel_px;
        let tile = self.tiles.at((x / side) as i64, (y / side) as i64);
        [tile.x, tile.y]
    }

    fn in_focus(&self, x: usize, y: usize) -> bool {
        self.tile(x, y).iter().all(|radius| radius.abs() < 1.0)
    }

    fn texel(&self, x: usize, y: usize) -> DVec4 {
        if self.in_focus(x, y) {
            return DVec4::ZERO;
        }
        let [least, largest] = self.tile(x, y);
        let pixel = DVec2::new(x as f64, y as f64) + 0.5;
        let jitter = DVec2::from_angle(TAU * noise(pixel, 0.0)) * 0.5 * noise(pixel, 7.0).sqrt();
        let uv = pixel / self.field[0].sides();
        if largest - least <= 0.05 * largest.abs() {
            return self.even(uv, 0.5 * (least.abs() + largest.abs()), jitter);
        }
        let before = if least < 0.0 { self.before(uv, least, jitter) } else { DVec4::ZERO };
        let behind = if largest > 0.0 { self.behind(uv, jitter) } else { DVec4::ZERO };
        before + behind * (1.0 - before.w)
    }

    /// Returns the level for a number of rings, the pixels per texel, and the pixels between rings.
    fn rings(&self, rings: u8, radius: f64) -> (&Texels, f64, f64) {
        let step = radius / (f64::from(rings) - 0.5);
        let level = ((step / self.texel_px as f64).max(1e-6).log2() + 0.5).floor().clamp(0.0, (LEVELS - 1) as f64);
        (&self.field[level as usize], self.texel_px as f64 * level.exp2(), step)
    }

    /// Returns the points of a ring, in units of the ring distance.
    fn ring(ring: u8) -> impl Iterator<Item = DVec2> {
        let count = (8 * u32::from(ring)).max(1);
        let turned = if ring % 2 == 1 { 0.5 } else { 0.0 };
        (0..count).map(move |i| DVec2::from_angle(TAU * (f64::from(i) + turned) / f64::from(count)) * f64::from(ring))
    }

    /// Converts pixels to texture coordinates.
    fn uv(&self, px: DVec2) -> DVec2 {
        px / (self.field[0].sides() * self.texel_px as f64)
    }

    fn even(&self, uv: DVec2, radius: f64, jitter: DVec2) -> DVec4 {
        let (level, _, step) = self.rings(self.settings.rings_even, radius);
        let taps = (0..self.settings.rings_even).flat_map(Self::ring);
        let (mut sum, mut count) = (DVec3::ZERO, 0.0);
        for place in taps {
            sum += level.linear(uv + self.uv((jitter + place) * step)).xyz();
            count += 1.0;
        }
        let opacity = (radius.abs() - 1.0).clamp(0.0, 1.0);
        (sum / count * opacity).extend(opacity)
    }

    fn before(&self, uv: DVec2, least: f64, jitter: DVec2) -> DVec4 {
        let rings = self.settings.rings_before;
        let (level, size, step) = self.rings(rings, -least);
        let (mut front, mut back, mut count) = (Sum::default(), Sum::default(), 0.0);
        for ring in 0..rings {
            let own: Vec<DVec2> = Self::ring(ring).collect();
            // The nearer of two opposite samples counts for both.
            for place in &own[..own.len().div_ceil(2)] {
                let pair = [jitter + *place, jitter - *place].map(|at| level.tap(uv + self.uv(at * step)));
                let nearest = pair[0].w.min(pair[1].w);
                let weight = (-nearest).clamp(0.0, 1.0)
                    * reach(-nearest, (jitter + *place).length() * step, size)
                    * density(nearest, size);
                let farther = ((nearest - least - 2.0) * 0.5).clamp(0.0, 1.0);
                for tap in &pair[..own.len().min(2)] {
                    front.add(*tap, weight * (1.0 - farther));
                    back.add(*tap, weight * farther);
                    count += 1.0;
                }
            }
        }
        let whole = count * density(least * (f64::from(rings) + 0.5) / f64::from(rings), size);
        let [near, far] = [front, back].map(|sum| (sum.weight / whole).clamp(0.0, 1.0));
        let color = front.mean().0 * near + back.mean().0 * far * (1.0 - near);
        color.extend(near + far * (1.0 - near))
    }

    fn behind(&self, uv: DVec2, jitter: DVec2) -> DVec4 {
        let rings = self.settings.rings_behind;
        let radius = self.field[0].tap(uv).w.abs();
        let (level, size, step) = self.rings(rings, radius);
        let mut all = Sum::default();
        for ring in (0..rings).rev() {
            let (mut own, mut farther_taps, mut count) = (Sum::default(), 0.0, 0.0);
            for place in Self::ring(ring) {
                let tap = level.tap(uv + self.uv((jitter + place) * step));
                let behind = if tap.w > 0.0 { 1.0 } else { 0.0 };
                let weight = behind * reach(tap.w.abs(), (jitter + place).length() * step, size) * density(tap.w, size);
                let border = step * (f64::from(ring) + 0.5);
                let farther = if ring == rings - 1 { 0.0 } else { (tap.w.abs() - border + 0.5).clamp(0.0, 1.0) };
                own.add(tap, weight * (1.0 - farther));
                all.add(tap, weight * farther);
                farther_taps += farther;
                count += 1.0;
            }
            let nearer = (all.mean().1 - own.mean().1).clamp(0.0, 1.0);
            let covered = if own.weight > 0.0 { 1.0 - farther_taps / count } else { 0.0 };
            let left = 1.0 - nearer * covered;
            all = Sum {
                color: all.color * left + own.color,
                radius: all.radius * left + own.radius,
                weight: all.weight * left + own.weight,
            };
        }
        let (color, mean) = all.mean();
        let opacity = (mean - 1.0).clamp(0.0, 1.0) * smoothstep(1.0, 2.0, radius);
        let opacity = if all.weight > 0.0 { opacity } else { 0.0 };
        (color * opacity).extend(opacity)
    }
}
