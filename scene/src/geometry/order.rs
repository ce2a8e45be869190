//! Triangle and vertex order for faster drawing.
//!
//! Triangles that share vertices follow each other, for the post-transform vertex cache. Parts that face outward come
//! first, to reduce overdraw. Vertices are stored in the order of their use. Tipsify: P. Sander, D. Nehab, J. Barczak,
//! "Fast Triangle Reordering for Vertex Locality and Reduced Overdraw", SIGGRAPH 2007.

use glam::Vec3;

use crate::mesh::Mesh;

/// Size of the modeled FIFO vertex cache, as on the smallest GPUs.
const CACHE: u32 = 16;
/// Maximum increase of shaded vertices, relative to the average of the mesh, at which a part is split off.
const PART_MORE: f64 = 1.05;
/// Maximum increase of shaded vertices of the whole mesh at which parts are sorted.
const WHOLE_MORE: f64 = 1.1;

/// Returns the number of vertex shader invocations for `mesh` with a cache of 16 vertices. The maximum is three per
/// triangle; the optimum for large meshes is half per triangle.
#[must_use]
pub fn shaded_vertices(mesh: &Mesh) -> usize {
    misses(&mesh.indices, &mut Cache::new(mesh.vertex_count()))
}

/// Reorders the triangles of `mesh`, and its vertices by first use, if this reduces vertex shader invocations. Unused
/// vertices are then removed. Lines and points keep their order. The surface is unchanged, but blended or coplanar
/// triangles may be drawn in another order.
pub fn order_for_drawing(mesh: &mut Mesh) {
    if !mesh.has_area() {
        return;
    }
    let order = drawn_order(mesh, &mesh.indices);
    if order != mesh.indices {
        let (indices, source) = first_uses(&order, mesh.vertex_count());
        mesh.indices = indices;
        mesh.gather_vertices(&source);
    }
}

/// Returns triangles over the vertices of `mesh` in another order, if this reduces vertex shader invocations.
pub(super) fn drawn_order(mesh: &Mesh, indices: &[u32]) -> Vec<u32> {
    let count = mesh.vertex_count();
    let shaded = |indices: &[u32]| misses(indices, &mut Cache::new(count));
    let before = shaded(indices);
    if before <= first_uses(indices, count).1.len() {
        return indices.to_vec();
    }
    let (local, clusters) = by_locality(indices, count);
    let after = shaded(&local);
    if after >= before {
        return indices.to_vec();
    }
    let sorted = outward_first(mesh, &local, &clusters);
    let fair = shaded(&sorted) as f64 <= (after as f64 * WHOLE_MORE).min(before as f64);
    if fair { sorted } else { local }
}

/// FIFO vertex cache; stores the insertion count at which each vertex was inserted.
struct Cache {
    entered: Vec<u32>,
    clock: u32,
}

impl Cache {
    fn new(vertices: usize) -> Self {
        Self { entered: vec![0; vertices], clock: CACHE + 1 }
    }

    fn age(&self, vertex: u32) -> u32 {
        self.clock - self.entered[vertex as usize]
    }

    /// Returns true if the vertex was not in the cache, and inserts it.
    fn misses(&mut self, vertex: u32) -> bool {
        let missed = self.age(vertex) > CACHE;
        if missed {
            self.entered[vertex as usize] = self.clock;
            self.clock += 1;
        }
        missed
    }

    /// Empties the cache.
    fn clear(&mut self) {
        self.clock += CACHE + 1;
    }
}

fn misses(indices: &[u32], cache: &mut Cache) -> usize {
    indices.iter().filter(|vertex| cache.misses(**vertex)).count()
}

/// Renumbers vertices by first use; returns the indices and the old number of each vertex.
fn first_uses(indices: &[u32], vertices: usize) -> (Vec<u32>, Vec<u32>) {
    let (mut number, mut source) = (vec![u32::MAX; vertices], Vec::new());
    let of = |vertex: &u32| {
        let own = &mut number[*vertex as usize];
        if *own == u32::MAX {
            *own = source.len() as u32;
            source.push(*vertex);
        }
        *own
    };
    (indices.iter().map(of).collect(), source)
}

/// Triangles of each vertex, in one array.
pub(super) struct Fans {
    first: Vec<u32>,
    triangles: Vec<u32>,
}

impl Fans {
    pub fn new(indices: &[u32], vertices: usize) -> Self {
        let mut first = vec![0_u32; vertices + 1];
        indices.iter().for_each(|vertex| first[*vertex as usize + 1] += 1);
        for vertex in 0..vertices {
            first[vertex + 1] += first[vertex];
        }
        let (mut next, mut triangles) = (first.clone(), vec![0; indices.len()]);
        for (corner, vertex) in indices.iter().enumerate() {
            triangles[next[*vertex as usize] as usize] = (corner / 3) as u32;
            next[*vertex as usize] += 1;
        }
        Self { first, triangles }
    }

    pub fn of(&self, vertex: u32) -> &[u32] {
        &self.triangles[self.first[vertex as usize] as usize..self.first[vertex as usize + 1] as usize]
    }
}

/// Returns indices in which triangles around a vertex follow each other, and the first triangles of parts that share no
/// cached vertices.
fn by_locality(indices: &[u32], vertices: usize) -> (Vec<u32>, Vec<usize>) {
    let fans = Fans::new(indices, vertices);
    let mut left: Vec<u32> = (0..vertices as u32).map(|vertex| fans.of(vertex).len() as u32).collect();
    let (mut done, mut cache) = (vec![false; indices.len() / 3], Cache::new(vertices));
    let (mut order, mut clusters) = (Vec::with_capacity(indices.len()), Vec::new());
    let (mut recent, mut around, mut cursor) = (Vec::new(), Vec::new(), 0);
    let mut center = None;
    loop {
        let fan = match center.or_else(|| lately_used(&mut recent, &left)) {
            Some(fan) => fan,
            None => match (cursor..vertices).find(|vertex| left[*vertex] > 0) {
                Some(vertex) => {
                    (cursor, _) = (vertex, clusters.push(order.len() / 3));
                    vertex as u32
                }
                None => return (order, clusters),
            },
        };
        around.clear();
        for triangle in fans.of(fan).iter().map(|triangle| *triangle as usize) {
            if std::mem::replace(&mut done[triangle], true) {
                continue;
            }
            for vertex in &indices[3 * triangle..3 * triangle + 3] {
                order.push(*vertex);
                recent.push(*vertex);
                around.push(*vertex);
                left[*vertex as usize] -= 1;
                cache.misses(*vertex);
            }
        }
        // The oldest vertex that stays cached while its triangles are drawn; otherwise any vertex with triangles.
        let priority = |vertex: &u32| match cache.age(*vertex) {
            age if age + 2 * left[*vertex as usize] <= CACHE => age,
            _ => 0,
        };
        center = around.iter().copied().filter(|vertex| left[*vertex as usize] > 0).max_by_key(priority);
    }
}

/// Returns the last used vertex that still has triangles.
fn lately_used(recent: &mut Vec<u32>, left: &[u32]) -> Option<u32> {
    while let Some(vertex) = recent.pop() {
        if left[vertex as usize] > 0 {
            return Some(vertex);
        }
    }
    None
}

/// Sorts parts so that those facing away from the mesh center come first. A part is split where its shaded vertices per
/// triangle are about those of the whole part.
fn outward_first(mesh: &Mesh, indices: &[u32], clusters: &[usize]) -> Vec<u32> {
    let mut cache = Cache::new(mesh.vertex_count());
    let mut parts: Vec<&[u32]> = Vec::new();
    let ends = clusters[1..].iter().copied().chain([indices.len() / 3]);
    for (start, end) in clusters.iter().copied().zip(ends) {
        let whole = &indices[3 * start..3 * end];
        cache.clear();
        let most = PART_MORE * misses(whole, &mut cache) as f64 / (end - start) as f64;
        cache.clear();
        let (mut first, mut missed) = (0, 0);
        for (at, triangle) in whole.chunks_exact(3).enumerate() {
            missed += misses(triangle, &mut cache);
            if missed as f64 <= most * (at + 1 - first) as f64 {
                parts.push(&whole[3 * first..3 * at + 3]);
                cache.clear();
                (first, missed) = (at + 1, 0);
            }
        }
        parts.push(&whole[3 * first..]);
    }
    let middle = shape(mesh, indices).0;
    let outward = |part: &&[u32]| {
        let (center, normal) = shape(mesh, part);
        (center - middle).dot(normal)
    };
    let mut keyed: Vec<(f32, &[u32])> = parts.into_iter().map(|part| (outward(&part), part)).collect();
    keyed.sort_by(|a, b| b.0.total_cmp(&a.0));
    keyed.into_iter().flat_map(|(_, part)| part).copied().collect()
}

/// Returns the area-weighted center of the triangles, and their mean direction.
fn shape(mesh: &Mesh, indices: &[u32]) -> (Vec3, Vec3) {
    let (mut center, mut normal, mut area) = (Vec3::ZERO, Vec3::ZERO, 0.0);
    for triangle in indices.chunks_exact(3) {
        let [a, b, c] = [0, 1, 2].map(|corner| mesh.positions[triangle[corner] as usize]);
        let cross = (b - a).cross(c - a);
        center += (a + b + c) / 3.0 * cross.length();
        normal += cross;
        area += cross.length();
    }
    (center / area.max(f32::MIN_POSITIVE), normal.normalize_or_zero())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{cuboid, plane, sphere};
    use glam::Vec2;

    /// Returns the mesh with its triangles in steps of `step`, which is coprime to their number.
    fn shuffled(mesh: &Mesh, step: usize) -> Mesh {
        let count = mesh.triangle_count();
        let at = |i: usize| i * step % count;
        let indices = (0..count).flat_map(|i| mesh.indices[3 * at(i)..3 * at(i) + 3].to_vec()).collect();
        Mesh { indices, ..mesh.clone() }
    }

    /// Returns the triangles by their corner data, in a fixed order.
    fn surface(mesh: &Mesh) -> Vec<[[u32; 8]; 3]> {
        let corner = |i: usize| {
            let (p, n, uv) = (mesh.positions[i], mesh.normals[i], mesh.uv0[i]);
            [p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y].map(f32::to_bits)
        };
        let mut all: Vec<_> = mesh.triangles().map(|triangle| triangle.map(corner)).collect();
        all.sort_unstable();
        all
    }

    #[test]
    fn a_shuffled_grid_shades_a_third_of_the_vertices() {
        let mut mesh = shuffled(&plane(Vec2::ONE, 40, Vec2::ONE), 1979);
        let (before, triangles) = (mesh.clone(), mesh.triangle_count());
        assert!(shaded_vertices(&before) > 5 * triangles / 2, "{}", shaded_vertices(&before));
        order_for_drawing(&mut mesh);
        let after = shaded_vertices(&mesh);
        // The paper states 0.6 to 0.75 for this cache size; 0.5 would be one invocation per vertex.
        assert!(after < 3 * triangles / 4, "{after} of {triangles} triangles");
        assert_eq!(surface(&mesh), surface(&before), "the surface is the same, corner by corner");
        mesh.check().expect("a mesh");
        assert_eq!(
            first_uses(&mesh.indices, mesh.vertex_count()).0,
            mesh.indices,
            "vertices lie in the order of their use"
        );
    }

    #[test]
    fn what_is_as_good_as_can_be_is_left_alone() {
        for mesh in [cuboid(Vec3::ONE), plane(Vec2::ONE, 1, Vec2::ONE), Mesh::default()] {
            let mut own = mesh.clone();
            order_for_drawing(&mut own);
            assert_eq!(own, mesh);
        }
    }

    #[test]
    fn unused_vertices_go_and_what_is_ordered_stays() {
        let mut mesh = shuffled(&sphere(1.0, 24, 12), 101);
        let used = first_uses(&mesh.indices, mesh.vertex_count()).1.len();
        let far = 3;
        for _ in 0..far {
            mesh.positions.push(Vec3::X);
            mesh.normals.push(Vec3::X);
            mesh.tangents.push(glam::Vec4::ONE);
            mesh.uv0.push(Vec2::ONE);
        }
        order_for_drawing(&mut mesh);
        assert_eq!(mesh.vertex_count(), used);
        let once = mesh.clone();
        order_for_drawing(&mut mesh);
        assert!(shaded_vertices(&mesh) <= shaded_vertices(&once));
    }

    /// A ball in a ball, the inner one first: outer triangles are drawn before those they occlude.
    #[test]
    fn what_faces_outward_comes_first() {
        let (inner, outer) = (sphere(0.3, 48, 24), sphere(1.0, 48, 24));
        let mut mesh = inner.clone();
        let base = inner.vertex_count() as u32;
        mesh.positions.extend(&outer.positions);
        mesh.normals.extend(&outer.normals);
        mesh.tangents.extend(&outer.tangents);
        mesh.uv0.extend(&outer.uv0);
        mesh.indices.extend(outer.indices.iter().map(|i| i + base));
        let mut mesh = shuffled(&mesh, 101);
        order_for_drawing(&mut mesh);
        let radius = |range: &[u32]| {
            range.iter().map(|i| mesh.positions[*i as usize].length()).sum::<f32>() / range.len() as f32
        };
        let (first, last) = mesh.indices.split_at(mesh.indices.len() / 2);
        assert!(radius(first) > 2.0 * radius(last), "{} {}", radius(first), radius(last));
    }
}
