use super::*;
use crate::bounds::Aabb;
use crate::geometry::{cuboid, plane, sphere, torus};
use glam::{Vec2, Vec3, Vec4};
use std::collections::BTreeMap;

const BARE: ReadStreams = ReadStreams { tangents: false, uv_texels: [0.0; 2] };
const PAINTED: ReadStreams = ReadStreams { tangents: false, uv_texels: [1024.0, 0.0] };

fn triangles(level: &MeshLevel) -> usize {
    level.indices.len() / 3
}

/// Returns the mesh of a level's triangles.
fn of(mesh: &Mesh, level: &MeshLevel) -> Mesh {
    Mesh { indices: level.indices.clone(), levels: Vec::new(), ..mesh.clone() }
}

/// Counts the traversals of each edge by the positions of its ends; on a closed surface each edge is traversed once per
/// direction.
fn edges(mesh: &Mesh) -> BTreeMap<[[i64; 3]; 2], i32> {
    let mut found = BTreeMap::new();
    // Poles and seams of a surface of revolution differ by rounding.
    let place = |i: usize| (mesh.positions[i] * 1e5).round().as_i64vec3().to_array();
    for [a, b, c] in mesh.triangles().map(|triangle| triangle.map(place)) {
        [[a, b], [b, c], [c, a]].into_iter().for_each(|edge| *found.entry(edge).or_insert(0) += 1);
    }
    found
}

/// Closed surfaces stay closed and do not fold. Each level has about half the triangles of the previous one, and errors
/// increase.
#[test]
fn closed_surfaces_stay_closed() {
    for (mesh, read) in
        [(sphere(1.0, 48, 24), BARE), (sphere(1.0, 48, 24), PAINTED), (torus(1.0, 0.3, 48, 24), PAINTED)]
    {
        let (levels, mut before) = (levels_of_detail(&mesh, read), mesh.triangle_count());
        assert!(levels.len() >= 3, "{}", levels.len());
        let mut error_m = 0.0;
        for level in &levels {
            let (own, count) = (of(&mesh, level), triangles(level));
            own.check().expect("a mesh");
            assert!(count * 10 <= before * 6 && level.error_m >= error_m, "{count} of {before}: {}", level.error_m);
            (before, error_m) = (count, level.error_m);
            let found = edges(&own);
            let open = found.iter().filter(|([a, b], times)| **times != 1 || found.get(&[*b, *a]) != Some(&1)).count();
            assert_eq!(open, 0, "of {count} triangles");
            for [a, b, c] in own.triangles() {
                let [a, b, c] = [a, b, c].map(|i| own.positions[i]);
                let facing = (b - a).cross(c - a).normalize().dot(nearest_normal(&mesh, (a + b + c) / 3.0));
                assert!(facing > -0.25, "of {count} triangles {a} {b} {c} is folded: {facing}");
            }
        }
    }
}

fn nearest_normal(mesh: &Mesh, at: Vec3) -> Vec3 {
    let nearest = (0..mesh.vertex_count())
        .min_by(|i, j| mesh.positions[*i].distance_squared(at).total_cmp(&mesh.positions[*j].distance_squared(at)));
    nearest.map_or(Vec3::ZERO, |i| mesh.normals[i])
}

/// Compares the error of a level with its actual distance from the ball, and with that of a uniform mesh of as many
/// triangles.
#[test]
fn a_ball_is_as_near_as_is_said() {
    let mesh = sphere(1.0, 64, 32);
    let levels = levels_of_detail(&mesh, BARE);
    let whole = farthest_from_ball(&mesh);
    for level in &levels {
        let (off, count) = (farthest_from_ball(&of(&mesh, level)), triangles(level) as f32);
        // The mesh itself deviates from the ball, and places between the samples may deviate slightly more.
        assert!(off <= 1.1 * level.error_m + whole, "{count}: {off} of {}", level.error_m);
        // Equal triangles have edges of √(4 A / √3), and a circumradius of the edge over √3.
        let even = 4.0 * std::f32::consts::PI / count * 4.0 / 3.0_f32.sqrt() / 6.0;
        assert!(level.error_m < 5.0 * even, "{count}: {} of {even}", level.error_m);
    }
}

fn farthest_from_ball(mesh: &Mesh) -> f32 {
    let places = (0..=12).flat_map(|i| (0..=12 - i).map(move |j| (i as f32 / 12.0, j as f32 / 12.0)));
    let depth = |[a, b, c]: [usize; 3]| {
        let [a, b, c] = [a, b, c].map(|i| mesh.positions[i]);
        places.clone().map(|(u, v)| 1.0 - (a + (b - a) * u + (c - a) * v).length()).fold(0.0, f32::max)
    };
    mesh.triangles().map(depth).fold(0.0, f32::max)
}

/// Flat ground needs few triangles and keeps its border.
#[test]
fn flat_ground_keeps_its_border() {
    let mesh = plane(Vec2::new(4.0, 2.0), 24, Vec2::ONE);
    for read in [BARE, PAINTED] {
        let levels = levels_of_detail(&mesh, read);
        let last = levels.last().expect("levels");
        assert!(triangles(last) < 64 && last.error_m < 1e-4, "{} {}", triangles(last), last.error_m);
        let area = |mesh: &Mesh| {
            let twice = |[a, b, c]: [usize; 3]| {
                let [a, b, c] = [a, b, c].map(|i| mesh.positions[i].as_dvec3());
                (b - a).cross(c - a).y
            };
            0.5 * mesh.triangles().map(twice).sum::<f64>()
        };
        let (found, whole) = (area(&of(&mesh, last)), area(&mesh));
        assert!((found - whole).abs() < 1e-4, "{found} of {whole}");
    }
}

/// Distorted texture coordinates, colors or normals on flat ground: compares the error of a level with displacements at
/// the mesh's vertices.
#[test]
fn what_vertices_have_is_displaced_no_farther_than_is_said() {
    let flat = plane(Vec2::splat(2.0), 32, Vec2::ONE);
    let mut bent = flat.clone();
    bent.uv0.iter_mut().zip(&flat.positions).for_each(|(uv, p)| uv.x += 0.05 * (6.0 * p.z).sin());
    let mut colored = flat.clone();
    let stripes = |p: &Vec3| Vec4::splat(0.5 + 0.4 * (5.0 * p.x).sin());
    colored.colors = flat.positions.iter().map(stripes).collect();
    let mut bumped = flat.clone();
    let bump = |(n, p): (&mut Vec3, &Vec3)| *n = Vec3::new(0.3 * (8.0 * p.x).sin(), 1.0, 0.0).normalize();
    bumped.normals.iter_mut().zip(&flat.positions).for_each(bump);
    type Of = fn(&Mesh, usize) -> Vec4;
    let cases: [(&str, &Mesh, Of); 3] = [
        ("bent", &bent, |mesh, i| mesh.uv0[i].extend(0.0).extend(0.0)),
        ("colored", &colored, |mesh, i| mesh.colors[i]),
        ("bumped", &bumped, |mesh, i| mesh.normals[i].extend(0.0)),
    ];
    for (name, mesh, of_vertex) in cases {
        let (levels, mut here) = (levels_of_detail(mesh, PAINTED), 0.0_f32);
        for level in &levels {
            for vertex in (0..mesh.vertex_count()).step_by(197) {
                let off = |by: Vec3| {
                    (at(mesh, level, mesh.positions[vertex] + by, of_vertex) - of_vertex(mesh, vertex)).length()
                };
                let ring =
                    |r: f32| (0..8).map(move |i| Vec3::new((0.8 * i as f32).cos(), 0.0, (0.8 * i as f32).sin()) * r);
                let about = [0.5, 1.0].into_iter().flat_map(|share| ring(share * level.error_m));
                let least = about.map(off).fold(off(Vec3::ZERO), f32::min);
                // Change of colors, 4 per meter, between the sampled places.
                assert!(least < 0.06, "{name}: {least} at the least within {} m", level.error_m);
                here = here.max(off(Vec3::ZERO));
            }
        }
        let last = levels.last().map_or((0, 0.0), |level| (triangles(level), level.error_m));
        assert!(levels.len() >= 2 && here > 0.002 && last.1 > 0.003, "{name}: {here} off, {last:?}");
    }
    let coarsest = |mesh: &Mesh, read| levels_of_detail(mesh, read).last().map_or(1.0, |level| level.error_m);
    assert!(coarsest(&bent, BARE) < 1e-5, "nobody reads the texture");
    assert!(coarsest(&flat, PAINTED) < 1e-5, "it is not bent");
}

/// Evaluates the level of flat ground at a place, in the triangle that contains it.
fn at(mesh: &Mesh, level: &MeshLevel, place: Vec3, of: impl Fn(&Mesh, usize) -> Vec4) -> Vec4 {
    let shares = |t: &[u32]| {
        let [a, b, c] = [0, 1, 2].map(|i| mesh.positions[t[i] as usize]);
        let area = |a: Vec3, b: Vec3, c: Vec3| (b - a).cross(c - a).y;
        Vec3::new(area(place, b, c), area(a, place, c), area(a, b, place)) / area(a, b, c)
    };
    let inside = |t: &&[u32]| shares(t).min_element();
    let triangle = level.indices.chunks_exact(3).max_by(|a, b| inside(a).total_cmp(&inside(b))).expect("triangles");
    let shares = shares(triangle).to_array();
    shares.into_iter().zip(triangle).map(|(share, i)| share * of(mesh, *i as usize)).sum()
}

/// The texture restarts in the middle, where vertices are duplicated; no triangle has corners of both halves.
#[test]
fn seams_stay() {
    let half = plane(Vec2::ONE, 24, Vec2::ONE);
    let (mut mesh, count) = (half.clone(), half.vertex_count() as u32);
    mesh.positions.extend(half.positions.iter().map(|p| *p + Vec3::X));
    mesh.normals.extend(&half.normals);
    mesh.tangents.extend(&half.tangents);
    mesh.uv0.extend(half.uv0.iter().map(|uv| *uv * 3.0 + 7.0));
    mesh.indices.extend(half.indices.iter().map(|i| i + count));
    mesh.bounds = Aabb::from_points(&mesh.positions);
    let levels = levels_of_detail(&mesh, PAINTED);
    let last = levels.last().expect("levels");
    assert!(triangles(last) < 64 && last.error_m < 1e-5, "{} {}", triangles(last), last.error_m);
    let mixed = last.indices.chunks_exact(3).filter(|t| t.iter().any(|i| *i < count) && t.iter().any(|i| *i >= count));
    assert_eq!(mixed.count(), 0);
    // If no texture is read, the halves are merged.
    assert!(triangles(levels_of_detail(&mesh, BARE).last().expect("levels")) <= triangles(last));
}

/// A face of 1 m with an edge beveled by 0.1 mm. Without the bevel the shading of the whole face changes, so the error
/// must not be just the width of the bevel.
#[test]
fn a_bevel_that_is_left_out_counts_for_the_face() {
    let place = |x: f32, y: f32| Vec3::new(x, y, 0.0);
    let mut mesh = Mesh {
        positions: vec![
            place(0.0, 0.0),
            place(1.0, 0.0),
            place(1.0, 1.0),
            place(0.0, 1.0),
            place(1.0001, 0.0),
            place(1.0001, 1.0),
        ],
        normals: vec![Vec3::Z, Vec3::Z, Vec3::Z, Vec3::Z, Vec3::X, Vec3::X],
        indices: vec![0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2],
        ..Mesh::default()
    };
    mesh.bounds = Aabb::from_points(&mesh.positions);
    let off = |indices: &[u32], most| deviation(&mesh, indices, &streams(&mesh, BARE), most);
    assert_eq!(off(&mesh.indices, 9.0), Some(0.0));
    assert!(
        off(&[0, 4, 5, 0, 5, 3], 9.0).is_some_and(|off| off > 0.3 && off < 1.5),
        "{:?}",
        off(&[0, 4, 5, 0, 5, 3], 9.0)
    );
    assert_eq!(off(&[0, 4, 5, 0, 5, 3], 0.2), None);
}

/// Vertices are duplicated at places of opposite bitangents, as in the middle of a mirrored texture. No triangle has
/// corners of both sides.
#[test]
fn the_sides_of_bitangents_are_kept_apart() {
    let mut mesh = plane(Vec2::splat(2.0), 24, Vec2::ONE);
    let count = mesh.vertex_count() as u32;
    let right = |t: &[u32]| t.iter().map(|i| mesh.positions[*i as usize].x).sum::<f32>() > 0.0;
    let moved = |t: &[u32]| if right(t) { t.iter().map(|i| i + count).collect::<Vec<_>>() } else { t.to_vec() };
    mesh.indices = mesh.indices.chunks_exact(3).flat_map(moved).collect();
    mesh.gather_vertices(&(0..2 * count).map(|i| i % count).collect::<Vec<_>>());
    mesh.uv0.iter_mut().for_each(|uv| uv.x = (uv.x - 0.5).abs());
    mesh.tangents[count as usize..].iter_mut().for_each(|tangent| tangent.w *= -1.0);
    let levels = levels_of_detail(&mesh, ReadStreams { tangents: true, ..PAINTED });
    assert!(levels.len() > 2, "{}", levels.len());
    for level in &levels {
        let both = |t: &&[u32]| t.iter().any(|i| *i < count) && t.iter().any(|i| *i >= count);
        assert_eq!(level.indices.chunks_exact(3).filter(both).count(), 0);
    }
}

/// Leaves, half of which could be removed without displacing the others.
#[test]
fn leaves_do_not_go_one_by_one() {
    let mut tree = Mesh::default();
    for i in 0..400_u32 {
        let at = |step: u32| (i.wrapping_mul(step) % 397) as f32 / 397.0;
        let (at, size) = (Vec3::new(at(7919), at(104_729), at(31)), 0.02 + 0.03 * at(17));
        tree.positions.extend([at, at + size * Vec3::X, at + size * Vec3::Y]);
        tree.normals.extend([Vec3::Z; 3]);
        tree.indices.extend([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    tree.bounds = Aabb::from_points(&tree.positions);
    assert_eq!(levels_of_detail(&tree, BARE), []);
}

/// The tip of a cone has more triangles than the limit: it is kept, and the rest is simplified at normal speed.
#[test]
fn a_tip_of_many_triangles_stays() {
    let count = 1_000_u32;
    let mut cone = Mesh { positions: vec![Vec3::Y], normals: vec![Vec3::Y], ..Mesh::default() };
    for i in 0..count {
        let (sin, cos) = (std::f32::consts::TAU * i as f32 / count as f32).sin_cos();
        cone.positions.push(Vec3::new(cos, 0.0, -sin));
        cone.normals.push(Vec3::new(cos, 1.0, -sin).normalize());
        cone.indices.extend([0, 1 + i, 1 + (i + 1) % count]);
    }
    cone.bounds = Aabb::from_points(&cone.positions);
    let levels = levels_of_detail(&cone, BARE);
    assert!(levels.len() >= 4 && levels.iter().all(|level| level.indices.contains(&0)), "{}", levels.len());
    let last = &levels[levels.len() - 1];
    assert!(triangles(last) < 200 && last.error_m < 0.05, "{} {}", triangles(last), last.error_m);
}

#[test]
fn few_triangles_and_what_moves_have_no_levels() {
    assert_eq!(levels_of_detail(&cuboid(Vec3::ONE), PAINTED), []);
    assert_eq!(levels_of_detail(&Mesh::default(), PAINTED), []);
    let moves = Some(Box::new(crate::moves::Moves::default()));
    assert_eq!(levels_of_detail(&Mesh { moves, ..sphere(1.0, 48, 24) }, BARE), []);
    // Many triangles without shared vertices.
    let mut heap = Mesh::default();
    for i in 0..600_u32 {
        let at = Vec3::new((i % 20) as f32, (i / 20 % 20) as f32, (i / 400) as f32);
        heap.positions.extend([at, at + 0.5 * Vec3::X, at + 0.5 * Vec3::Y]);
        heap.normals.extend([Vec3::Z; 3]);
        heap.indices.extend([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    heap.bounds = Aabb::from_points(&heap.positions);
    assert_eq!(levels_of_detail(&heap, BARE), []);
}
