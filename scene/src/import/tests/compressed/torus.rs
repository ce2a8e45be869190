//! The torus.

use glam::{DVec3, Vec2, Vec4};

use super::{bytes, ordered};
use crate::Scene;

/// A vertex in world axes.
struct Vertex {
    /// Number in the uncompressed file.
    number: usize,
    position: DVec3,
    normal: DVec3,
    uv: Vec2,
    color: Vec4,
}

/// Vertices and triangles of a scene with one instance.
struct Torus {
    vertices: Vec<Vertex>,
    /// Vertex numbers, the smallest first, and sorted: file order does not matter.
    triangles: Vec<[usize; 3]>,
}

/// Identifies vertices by the number in red and green or, if colors are inexact, by their order.
fn torus(scene: &Scene, by_color: bool) -> Torus {
    let [instance] = &scene.instances[..] else { panic!("{} instances", scene.instances.len()) };
    let mesh = &scene.meshes[instance.mesh.index()];
    let vertex = |i: usize| {
        let [red, green] = [mesh.colors[i].x, mesh.colors[i].y].map(|c| (c * 255.0).round() as usize);
        let normal = instance.world_from_model.transform_vector3(mesh.normals[i].as_dvec3());
        Vertex {
            number: if by_color { red + 256 * green } else { i },
            position: instance.world_from_model.transform_point3(mesh.positions[i].as_dvec3()),
            normal: normal.normalize(),
            uv: mesh.uv0[i],
            color: mesh.colors[i],
        }
    };
    let vertices: Vec<Vertex> = (0..mesh.positions.len()).map(vertex).collect();
    let number = |corner: u32| vertices[corner as usize].number;
    let mut triangles: Vec<[usize; 3]> = Vec::new();
    for t in mesh.indices.chunks_exact(3) {
        let mut corners = [number(t[0]), number(t[1]), number(t[2])];
        let least = (0..3).min_by_key(|i| corners[*i]).expect("three corners");
        corners.rotate_left(least);
        triangles.push(corners);
    }
    triangles.sort_unstable();
    Torus { vertices, triangles }
}

/// Maximum errors: of a coordinate in meters, a normal, a texture coordinate, and a color channel.
struct Errors {
    position: f64,
    normal: f64,
    uv: f64,
    color: f64,
}

/// Returns half a step of a quantization with this number of bits over a range.
fn half_step(range: f64, bits: i32) -> f64 {
    range / (2f64.powi(bits) - 1.0) / 2.0
}

/// Returns the error of a normal whose octahedral coordinates have an error of `e` each: √6·e on the octahedron, whose
/// points are at least 1/√3 from its center.
fn octahedral(e: f64) -> f64 {
    18f64.sqrt() * e
}

/// Compares a file with the uncompressed one.
#[track_caller]
fn compare(name: &str, by_color: bool, allowed: &Errors) {
    let raw = torus(&ordered(&bytes("raw"), "raw"), true);
    let found = torus(&ordered(&bytes(name), name), by_color);
    assert_eq!((raw.vertices.len(), raw.triangles.len()), (561, 1024));
    assert!(raw.vertices.iter().enumerate().all(|(place, vertex)| place == vertex.number));
    assert!(raw.triangles == found.triangles, "{name}: other triangles");
    let mut most = [0f64; 4];
    for vertex in &found.vertices {
        let truth = &raw.vertices[vertex.number];
        let errors = [
            (vertex.position - truth.position).abs().max_element(),
            (vertex.normal - truth.normal).length(),
            (vertex.uv - truth.uv).abs().max_element().into(),
            (vertex.color - truth.color).abs().max_element().into(),
        ];
        most = std::array::from_fn(|i| most[i].max(errors[i]));
    }
    let Errors { position, normal, uv, color } = *allowed;
    for (i, allowed) in [position, normal, uv, color].into_iter().enumerate() {
        let what = ["positions", "normals", "texture coordinates", "colors"][i];
        // f32 rounding, if anything is rounded.
        let allowed = if allowed == 0.0 { 0.0 } else { allowed + 1e-6 };
        assert!(most[i] <= allowed, "{name}: {what} are {:.3e} off, over {allowed:.3e}", most[i]);
        // An error far below the bound would make the bound useless.
        assert!(most[i] >= allowed / 12.0, "{name}: {what} are {:.3e} off, far below {allowed:.3e}", most[i]);
    }
}

/// Width of the torus, over which positions are quantized.
const RANGE_M: f64 = 2.8;
const EXACT: Errors = Errors { position: 0.0, normal: 0.0, uv: 0.0, color: 0.0 };
const FINE_BITS: [i32; 3] = [14, 10, 12];

/// Returns the errors of Draco: positions are quantized over the longest side, and normals to an octahedron of 2^bits −
/// 2 steps from −1 to 1.
fn draco([position, normal, uv]: [i32; 3]) -> Errors {
    Errors {
        position: half_step(RANGE_M, position),
        normal: octahedral(1.0 / (2f64.powi(normal) - 2.0)),
        uv: half_step(1.0, uv),
        color: 0.0,
    }
}

#[test]
fn draco_edgebreaker_comes_back() {
    for speed in [0, 5, 10] {
        compare(&format!("draco_edgebreaker_{speed}"), true, &draco(FINE_BITS));
    }
}

#[test]
fn draco_sequential_comes_back() {
    compare("draco_sequential", true, &draco(FINE_BITS));
}

#[test]
fn draco_of_few_bits_comes_back() {
    compare("draco_coarse", true, &draco([8, 6, 7]));
}

#[test]
fn draco_without_quantization_is_exact() {
    compare("draco_lossless", true, &EXACT);
}

#[test]
fn draco_of_an_older_bitstream_comes_back() {
    compare("draco_bitstream_2_1", true, &draco(FINE_BITS));
}

#[test]
fn draco_of_gltf_transform_comes_back() {
    compare("transform_draco", true, &draco(FINE_BITS));
}

#[test]
fn meshopt_without_filters_is_exact() {
    compare("meshopt_v0", true, &EXACT);
    compare("meshopt_v1", true, &EXACT);
}

/// Returns half a step of a float with a mantissa of `bits`, sign included, for values up to 2^`exponent`.
fn exponential(exponent: i32, bits: i32) -> f64 {
    2f64.powi(exponent - (bits - 1)) / 2.0
}

/// Returns half a step of a signed number with this number of bits for −1 to 1.
fn half_signed(bits: i32) -> f64 {
    0.5 / (2f64.powi(bits - 1) - 1.0)
}

#[test]
fn meshopt_filters_come_back() {
    // Positions are below 2, texture coordinates below 1.
    let (position, uv) = (exponential(1, 16), exponential(0, 12));
    // An octahedron of 8 bits; each component of the vector is rounded to 8 bits again.
    let normal = octahedral(half_signed(8)) + 3f64.sqrt() * half_signed(8);
    // Red is the rounded sum of three numbers, each rounded to a step.
    let color = |bits: i32| 4.0 * half_step(1.0, bits);
    compare("meshopt_filters_v0", true, &Errors { position, normal, uv, color: 0.0 });
    compare("meshopt_filters_v1", false, &Errors { position, normal, uv, color: color(8) });
    let normal = octahedral(half_signed(12));
    compare("meshopt_filters_wide", false, &Errors { position, normal, uv, color: color(12) });
}

#[test]
fn quantized_files_come_back() {
    let normal = 2.0 * 3f64.sqrt() * half_signed(8);
    compare("quantized", true, &Errors { position: 1.5 * half_signed(16), normal, uv: half_step(1.0, 16), color: 0.0 });
}

/// Default settings of the program: positions of 14 bits, normals of 8, texture coordinates of 12, stored in 16.
#[test]
fn meshopt_of_gltf_transform_comes_back() {
    let normal = octahedral(half_signed(8)) + 3f64.sqrt() * half_signed(8);
    // Rounded to the bits, then truncated to 16 bits.
    let position = half_step(RANGE_M, 14) + RANGE_M * half_signed(16);
    let uv = half_step(1.0, 12) + 2.0 * half_step(1.0, 16);
    let allowed = Errors { position, normal, uv, color: 0.0 };
    compare("transform_meshopt", true, &allowed);
}
