//! Mesh simplification by collapsing edges, the least change first.
//!
//! Uses quadric error metrics (M. Garland, P. Heckbert, "Surface Simplification Using Quadric Error Metrics", SIGGRAPH
//! 1997). Half-edge collapses neither move nor add vertices, so that all levels of a mesh share its vertices (L.
//! Kobbelt, S. Campagna, H.-P. Seidel, "A General Framework for Mesh Decimation", Graphics Interface 1998). Vertices at
//! one position are one point of the surface. If their attributes differ, the point is on a seam; seams and borders are
//! preserved.

use super::fan::{Corner, Fan, MAX_CORNERS, Spoke};
use super::quadric::{Quadric, Shift};
use super::stream::Stream;
use crate::bounds::Aabb;
use crate::mesh::Mesh;
use glam::DVec3;
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};
use std::hash::Hash;

/// Weight of the perpendicular planes on borders and seams, relative to the square of the edge length. Planes of the
/// surface are weighted by area, so the result does not depend on tessellation.
const BORDER_WEIGHT: f64 = 1.0;
/// Weight of the distance that a point moves, relative to its fourth power. On flat surfaces it prefers short edges.
const MOVED_WEIGHT: f64 = 1e-6;
/// Cosine of the maximum rotation of a triangle's normal.
const MAX_TURN: f64 = 0.5;
/// Minimum ratio of a triangle's height to its longest side; narrower triangles are slivers and only accepted if they
/// were slivers before.
const LEAST_WIDTH: f64 = 0.05;

/// Surface during simplification.
pub(super) struct Collapse {
    /// Vertex positions relative to the center of the mesh.
    positions: Vec<DVec3>,
    /// Point of each vertex: the first vertex at its position.
    point: Vec<u32>,
    /// Attributes of vertices: `width` numbers each.
    values: Vec<f64>,
    width: usize,
    /// Attribute quadric of each vertex: the part that depends on position alone. The shifts of each attribute number
    /// follow.
    of_values: Vec<Quadric>,
    shifts: Vec<Shift>,
    /// Geometric quadric of each point.
    quadrics: Vec<Quadric>,
    /// Triangles around each point.
    about: Vec<Vec<u32>>,
    /// Number of changes to the surroundings of each point.
    changed: Vec<u32>,
    /// Candidate collapses, the cheapest first; entries with an old change count are obsolete.
    candidates: BinaryHeap<Reverse<Candidate>>,
    /// Triangles; `None` if removed.
    triangles: Vec<Option<[u32; 3]>>,
    /// Initial normal of each triangle.
    facing: Vec<DVec3>,
    left: usize,
}

/// Tolerance for equal positions, relative to the mesh radius.
const SAME_PLACE: f64 = 1e-6;

/// Returns, for each key, the index of the first equal key.
fn firsts<K: Hash + Eq>(keys: impl Iterator<Item = K>) -> Vec<u32> {
    let mut first = HashMap::new();
    (0..).zip(keys).map(|(i, key)| *first.entry(key).or_insert(i)).collect()
}

/// Candidate collapse. The cost comes first, as the bits of a non-negative float, which sort like the float. The point,
/// the other end of the edge, and the point's change count follow.
type Candidate = (u64, u32, u32, u32);

impl Collapse {
    /// Prepares the surface of `mesh`. `used` bounds the vertices that triangles use.
    pub fn new(mesh: &Mesh, streams: &[Stream<'_>], used: &Aabb) -> Self {
        let middle = used.center();
        // Vertices at one position form a point, and those with equal attributes are merged.
        let grid = SAME_PLACE * used.radius().max(f64::MIN_POSITIVE);
        let place = |i: usize| ((mesh.positions[i].as_dvec3() - middle) / grid).round().as_i64vec3();
        let numbers = |i: usize| streams.iter().flat_map(move |s| (s.of(i as u32) / s.unseen).round().to_array());
        let point = firsts((0..mesh.vertex_count()).map(place));
        let one =
            firsts((0..mesh.vertex_count()).map(|i| (place(i), numbers(i).map(|x| x as i64).collect::<Vec<_>>())));
        let (count, width) = (mesh.vertex_count(), streams.iter().map(|stream| stream.width).sum());
        let of_vertex = |vertex| streams.iter().flat_map(move |s| s.of(vertex).to_array().into_iter().take(s.width));
        let mut own = Self {
            values: (0..count as u32).flat_map(of_vertex).map(f64::from).collect(),
            width,
            of_values: vec![Quadric::NONE; count],
            shifts: vec![Shift::NONE; count * width],
            positions: mesh.positions.iter().map(|p| p.as_dvec3() - middle).collect(),
            quadrics: vec![Quadric::NONE; count],
            about: vec![Vec::new(); count],
            changed: vec![0; count],
            candidates: BinaryHeap::new(),
            triangles: Vec::with_capacity(mesh.triangle_count()),
            facing: Vec::with_capacity(mesh.triangle_count()),
            left: 0,
            point,
        };
        for triangle in mesh.triangles() {
            let [a, b, c] = triangle.map(|vertex| own.point[vertex]);
            if a != b && b != c && c != a {
                let number = own.triangles.len() as u32;
                [a, b, c].into_iter().for_each(|point| own.about[point as usize].push(number));
                let [a, b, c] = triangle.map(|vertex| own.positions[vertex]);
                own.facing.push((b - a).cross(c - a).normalize_or_zero());
                own.triangles.push(Some(triangle.map(|vertex| one[vertex])));
            }
        }
        own.left = own.triangles.len();
        own.measure_values(streams, used.radius());
        let mut fans = [Fan::default(), Fan::default()];
        (0..count as u32).for_each(|hub| own.quadrics[hub as usize] = own.planes(hub, &mut fans[0]));
        (0..count as u32).for_each(|hub| own.consider(hub, &mut fans));
        own
    }

    /// Returns the number of remaining triangles.
    pub fn left(&self) -> usize {
        self.left
    }

    /// Returns the remaining triangles as vertex indices.
    pub fn indices(&self) -> Vec<u32> {
        self.triangles.iter().flatten().flatten().copied().collect()
    }

    /// Collapses edges until `target` triangles are left; stops earlier if the surface would tear or fold.
    pub fn reduce(&mut self, target: usize) {
        let mut fans = [Fan::default(), Fan::default()];
        while self.left > target {
            let Some(Reverse((_, hub, rim, changed))) = self.candidates.pop() else { return };
            if self.changed[hub as usize] != changed {
                continue;
            }
            let [fan, other] = &mut fans;
            self.fill(hub, fan);
            self.fill(rim, other);
            let spoke = fan.spokes.iter().find(|spoke| spoke.rim == rim);
            match spoke.filter(|spoke| fan.stays_whole(spoke, other)) {
                Some(spoke) => self.go(hub, spoke),
                // The surroundings of the other end have changed.
                None => {
                    self.consider(hub, &mut fans);
                    continue;
                }
            }
            let around: Vec<u32> = fan.spokes.iter().map(|spoke| spoke.rim).collect();
            for point in around {
                self.changed[point as usize] += 1;
                self.consider(point, &mut fans);
            }
        }
    }

    /// Collapses an edge: moves a point to its other end.
    fn go(&mut self, hub: u32, edge: &Spoke) {
        let rim = edge.rim as usize;
        self.quadrics[rim] = self.quadrics[rim].plus(self.quadrics[hub as usize]);
        self.changed[hub as usize] += 1;
        for [from, to] in edge.pairs().map(|pair| pair.map(|vertex| vertex as usize)) {
            self.of_values[to] = self.of_values[to].plus(self.of_values[from]);
            for number in 0..self.width {
                let (from, to) = (from * self.width + number, to * self.width + number);
                self.shifts[to] = self.shifts[to].plus(self.shifts[from]);
            }
        }
        for number in std::mem::take(&mut self.about[hub as usize]) {
            let Some(triangle) = &mut self.triangles[number as usize] else { continue };
            let points = triangle.map(|vertex| self.point[vertex as usize]);
            if points.contains(&edge.rim) {
                points.iter().for_each(|point| self.about[*point as usize].retain(|other| *other != number));
                self.triangles[number as usize] = None;
                self.left -= 1;
                continue;
            }
            for vertex in triangle.iter_mut().filter(|vertex| self.point[**vertex as usize] == hub) {
                *vertex = edge.pairs().find(|[from, _]| from == vertex).map_or(*vertex, |[_, to]| to);
            }
            self.about[rim].push(number);
        }
    }

    /// Adds the cheapest collapse of a point to the candidates.
    fn consider(&mut self, hub: u32, [fan, other]: &mut [Fan; 2]) {
        self.fill(hub, fan);
        let (here, mut best) = (self.positions[hub as usize], None);
        for edge in fan.spokes.iter().filter(|edge| fan.may_go(edge)) {
            let there = self.positions[edge.rim as usize];
            let sum = self.quadrics[hub as usize].plus(self.quadrics[edge.rim as usize]).at(there).max(0.0);
            let sum = sum + edge.pairs().map(|pair| self.shifted(pair, there)).sum::<f64>();
            let cost = (sum + MOVED_WEIGHT * there.distance_squared(here).powi(2)).to_bits();
            if best.is_none_or(|(least, _)| cost < least) && !self.folds(hub, fan, edge.rim) {
                self.fill(edge.rim, other);
                if fan.stays_whole(edge, other) {
                    best = Some((cost, edge.rim));
                }
            }
        }
        self.candidates.extend(best.map(|(cost, rim)| Reverse((cost, hub, rim, self.changed[hub as usize]))));
    }

    /// Returns the sum of squared attribute displacements if a vertex merges into another.
    fn shifted(&self, [from, to]: [u32; 2], there: DVec3) -> f64 {
        let numbers = |vertex: u32| vertex as usize * self.width..(vertex as usize + 1) * self.width;
        let pairs = self.shifts[numbers(from)].iter().zip(&self.shifts[numbers(to)]).zip(&self.values[numbers(to)]);
        let of_places = self.of_values[from as usize].plus(self.of_values[to as usize]).at(there);
        pairs.fold(of_places, |sum, ((a, b), value)| sum + a.plus(*b).at(there, *value)).max(0.0)
    }

    /// Computes the rate of change of attributes around each point.
    fn measure_values(&mut self, streams: &[Stream<'_>], radius_m: f64) {
        let Self { positions, values, width, of_values, shifts, .. } = self;
        let least = streams.iter().flat_map(|stream| {
            std::iter::repeat_n(f64::from(stream.unseen) / radius_m.max(f64::MIN_POSITIVE), stream.width)
        });
        let least: Vec<f64> = least.collect();
        for triangle in self.triangles.iter().flatten() {
            let corners = triangle.map(|vertex| positions[vertex as usize]);
            for (number, least) in least.iter().enumerate() {
                let place = |vertex: u32| vertex as usize * *width + number;
                let (shift, quadric) = Shift::of_triangle(corners, triangle.map(|v| values[place(v)]), *least);
                for vertex in triangle {
                    shifts[place(*vertex)] = shifts[place(*vertex)].plus(shift);
                    of_values[*vertex as usize] = of_values[*vertex as usize].plus(quadric);
                }
            }
        }
    }

    /// Returns true if moving the point to `rim` would rotate a triangle too far or make it a sliver.
    fn folds(&self, hub: u32, fan: &Fan, rim: u32) -> bool {
        let at = |vertex: u32| self.positions[vertex as usize];
        // Normal of the triangle, and the ratio of its height to its longest side.
        let shape = |[apex, next, last]: [DVec3; 3]| {
            let normal = (next - apex).cross(last - apex);
            let sides = [next - apex, last - apex, next - last].map(DVec3::length_squared);
            (normal, normal.length() / sides.into_iter().fold(0.0, f64::max))
        };
        let stays = |(corner, _): &(&Corner, &u32)| corner.iter().all(|vertex| self.point[*vertex as usize] != rim);
        fan.corners.iter().zip(&self.about[hub as usize]).filter(stays).any(|(corner, number)| {
            let [apex, next, last] = corner.map(at);
            let (_, width) = shape([apex, next, last]);
            let ((normal, then), facing) = (shape([at(rim), next, last]), self.facing[*number as usize]);
            let turned = facing != DVec3::ZERO && normal.dot(facing) < MAX_TURN * normal.length();
            turned || then < LEAST_WIDTH.min(0.5 * width) || normal == DVec3::ZERO
        })
    }

    /// Returns the quadric of a point: planes of its triangles, and perpendicular planes on borders and seams.
    fn planes(&self, hub: u32, fan: &mut Fan) -> Quadric {
        self.fill(hub, fan);
        let here = self.positions[hub as usize];
        let normal = |corner: &Corner| {
            let [a, b, c] = corner.map(|vertex| self.positions[vertex as usize]);
            (b - a).cross(c - a)
        };
        let plane = |normal: DVec3, weight: f64| Quadric::of_plane(normal.normalize_or_zero(), here, weight);
        let about = self.about[hub as usize].iter().filter_map(|number| self.triangles[*number as usize].as_ref());
        let surface = about.map(normal).map(|normal| plane(normal, 0.5 * normal.length()));
        let bounds = fan.spokes.iter().filter(|spoke| spoke.is_border() || spoke.is_seam()).flat_map(|spoke| {
            let along = self.positions[spoke.rim as usize] - here;
            let beside = |corner: &&Corner| corner.iter().any(|vertex| self.point[*vertex as usize] == spoke.rim);
            let upright = move |corner| plane(along.cross(normal(corner)), BORDER_WEIGHT * along.length_squared());
            fan.corners.iter().filter(beside).map(upright)
        });
        surface.chain(bounds).fold(Quadric::NONE, Quadric::plus)
    }

    fn fill(&self, hub: u32, fan: &mut Fan) {
        let corner = |vertices: [u32; 3]| {
            let at = vertices.iter().position(|vertex| self.point[*vertex as usize] == hub).unwrap_or(0);
            [0, 1, 2].map(|step| vertices[(at + step) % 3])
        };
        let about = &self.about[hub as usize];
        let about = if about.len() > MAX_CORNERS { &[][..] } else { about };
        let about = about.iter().filter_map(|number| self.triangles[*number as usize]);
        fan.fill(about.map(corner), &self.point);
    }
}
