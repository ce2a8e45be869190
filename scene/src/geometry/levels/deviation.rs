//! Distance of a level of detail from its mesh.

use super::super::order::Fans;
use super::fan::MAX_CORNERS;
use super::stream::Stream;
use super::tree::Tree;
use crate::mesh::Mesh;
use glam::{DVec3, Vec3, Vec4};

/// Maximum number of edge midpoints that are sampled; of more edges, every n-th is.
const MAX_EDGES: usize = 1 << 19;

/// Returns the maximum distance in meters between a mesh and triangles over its vertices, or `None` if it reaches
/// `most`. Samples are removed vertices and edge midpoints of the mesh, each compared with its nearest triangle.
///
/// Attribute differences count as the distance to the nearest place where the mesh or the triangle has the sample's
/// attribute. No sampled texture, highlight or color border is thus displaced by more than the result. At a seam, the
/// triangle with the smaller displacement counts.
pub(super) fn deviation(mesh: &Mesh, indices: &[u32], streams: &[Stream<'_>], most: f32) -> Option<f32> {
    let corners: Vec<[u32; 3]> = indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
    let places: Vec<_> = corners.iter().map(|t| t.map(|vertex| mesh.positions[vertex as usize])).collect();
    let fans = Fans::new(&mesh.indices, mesh.vertex_count());
    let level = Level { mesh, fans, tree: Tree::new(&places), corners, places, streams };
    // Unused vertices are not compared.
    let mut gone = vec![false; mesh.vertex_count()];
    mesh.indices.iter().for_each(|vertex| gone[*vertex as usize] = true);
    indices.iter().for_each(|vertex| gone[*vertex as usize] = false);
    let gone = (0..).zip(gone).filter_map(|(vertex, gone)| gone.then_some([vertex; 2]));
    let mut edges: Vec<[u32; 2]> = Vec::with_capacity(mesh.indices.len());
    for t in mesh.indices.chunks_exact(3) {
        edges.extend([[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]].map(|[a, b]| [a.min(b), a.max(b)]));
    }
    edges.sort_unstable();
    edges.dedup();
    let step = edges.len().div_ceil(MAX_EDGES).max(1);
    let (mut worst, mut open) = (0.0, Vec::new());
    for ends in gone.chain(edges.into_iter().step_by(step)) {
        worst = level.off(ends, [worst, most], &mut open).max(worst);
        if worst >= most {
            return None;
        }
    }
    Some(worst)
}

/// Triangles over the vertices of a mesh.
struct Level<'a> {
    mesh: &'a Mesh,
    /// Original triangles around each vertex.
    fans: Fans,
    corners: Vec<[u32; 3]>,
    places: Vec<[Vec3; 3]>,
    tree: Tree,
    streams: &'a [Stream<'a>],
}

const SIDES: [(usize, usize); 3] = [(0, 1), (1, 2), (2, 0)];

impl Level<'_> {
    /// Returns the displacement of the midpoint of two vertices. Exits early: a result up to `limits[0]` or from
    /// `limits[1]` is only a bound.
    fn off(&self, ends: [u32; 2], limits: [f32; 2], open: &mut Vec<u32>) -> f32 {
        let [a, b] = ends.map(|end| self.mesh.positions[end as usize]);
        let place = 0.5 * (a + b);
        self.tree.least(place, limits, open, |triangle, least| {
            let places = self.places[triangle as usize];
            let shares = nearest_shares(places, place);
            let shift = |most: f32, stream: &Stream<'_>| {
                if most < least { most.max(self.shift(stream, (ends, place), triangle, shares)) } else { most }
            };
            self.streams.iter().fold(weighted(places, shares).distance(place), shift)
        })
    }

    /// Returns the distance by which an attribute is displaced at a place between two vertices, compared with a
    /// triangle.
    fn shift(&self, stream: &Stream<'_>, (ends, place): ([u32; 2], Vec3), triangle: u32, shares: Vec3) -> f32 {
        let unit = |value: Vec4| if stream.unit { value.normalize_or_zero() } else { value };
        let values = self.corners[triangle as usize].map(|vertex| stream.of(vertex));
        let [a, b] = ends.map(|end| stream.of(end));
        let off = unit(weighted(values, shares)).distance(unit(0.5 * (a + b))) - stream.unseen;
        if off <= 0.0 {
            return 0.0;
        }
        let length = |a: u32, b: u32| self.mesh.positions[a as usize].distance(self.mesh.positions[b as usize]);
        // Displacement along the edge itself, by the rate of change along it.
        let mut least = off * length(ends[0], ends[1]) / a.distance(b);
        if least.is_nan() {
            least = f32::INFINITY;
        }
        // Displacement within the triangle, if the attribute changes that much there.
        let places = self.places[triangle as usize];
        for (a, b) in SIDES.into_iter().filter(|(a, b)| values[*a].distance(values[*b]) >= off) {
            least = least.min(off * places[a].distance(places[b]) / values[a].distance(values[b]));
        }
        // Displacement around the ends: on an adjacent edge with enough change, or by the overall rate of change of
        // adjacent edges.
        for end in ends {
            let (from, [mut changed, mut gone]) = (place.distance(self.mesh.positions[end as usize]), [0.0; 2]);
            let about = self.fans.of(end).iter().take(MAX_CORNERS);
            let about = about.flat_map(|triangle| &self.mesh.indices[3 * *triangle as usize..][..3]);
            for other in about.filter(|other| **other != end) {
                let (change, length) = (stream.of(end).distance(stream.of(*other)), length(end, *other));
                (changed, gone) = (changed + change, gone + length);
                if change >= off {
                    least = least.min(from + length * off / change);
                }
            }
            if changed > 0.0 {
                least = least.min(from.max(off * gone / changed));
            }
        }
        least
    }
}

/// Interpolates three values with barycentric weights.
fn weighted<T: std::ops::Mul<f32, Output = T> + std::ops::Add<Output = T>>([a, b, c]: [T; 3], shares: Vec3) -> T {
    a * shares.x + b * shares.y + c * shares.z
}

/// Returns the barycentric coordinates of the triangle's point nearest to `place` (C. Ericson, "Real-Time Collision
/// Detection", 2005, 5.1.5).
fn nearest_shares(corners: [Vec3; 3], place: Vec3) -> Vec3 {
    let [a, b, c, place] = [corners[0], corners[1], corners[2], place].map(Vec3::as_dvec3);
    let (ab, ac) = (b - a, c - a);
    let along = |from: DVec3| (ab.dot(place - from), ac.dot(place - from));
    let ((d1, d2), (d3, d4), (d5, d6)) = (along(a), along(b), along(c));
    if d1 <= 0.0 && d2 <= 0.0 {
        return Vec3::X;
    }
    if d3 >= 0.0 && d4 <= d3 {
        return Vec3::Y;
    }
    if d6 >= 0.0 && d5 <= d6 {
        return Vec3::Z;
    }
    let (of_a, of_b, of_c) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    let part = |part: f64, whole: f64| if whole > 0.0 { (part / whole).clamp(0.0, 1.0) } else { 0.0 };
    let shares = if of_c <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let t = part(d1, d1 - d3);
        DVec3::new(1.0 - t, t, 0.0)
    } else if of_b <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let t = part(d2, d2 - d6);
        DVec3::new(1.0 - t, 0.0, t)
    } else if of_a <= 0.0 && d4 >= d3 && d5 >= d6 {
        let t = part(d4 - d3, (d4 - d3) + (d5 - d6));
        DVec3::new(0.0, 1.0 - t, t)
    } else {
        let whole = of_a + of_b + of_c;
        let (v, w) = (part(of_b, whole), part(of_c, whole));
        DVec3::new((1.0 - v - w).max(0.0), v, w)
    };
    shares.as_vec3()
}
