//! Vertex faults that the importer repairs, with one warning per kind.

use glam::{Vec2, Vec3, Vec4};
use serde_json::json;

use super::fixture::Fixture;
use crate::Scene;
use crate::mesh::Mesh;

const NAN: f32 = f32::NAN;

/// A tent of two triangles of 1 and 3 m², which share an edge: both use vertices 0 and 1.
fn tent(normals: [[f32; 3]; 4]) -> Fixture {
    let mut fixture = Fixture::new();
    let positions = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 3.0]];
    let position = fixture.floats(3, positions.as_flattened());
    let normal = fixture.floats(3, normals.as_flattened());
    let indices = fixture.shorts(&[0, 1, 2, 1, 0, 3]);
    let primitive = json!({"attributes": {"POSITION": position, "NORMAL": normal}, "indices": indices});
    fixture.primitive(primitive);
    fixture
}

fn attribute(fixture: &mut Fixture, name: &str, width: usize, numbers: &[f32]) {
    let accessor = fixture.floats(width, numbers);
    fixture.set(&format!("/meshes/0/primitives/0/attributes/{name}"), json!(accessor));
}

fn loaded(fixture: &Fixture) -> Scene {
    fixture.load().expect("it is repaired")
}

/// Returns the vertex of a mesh at a position, since reordering may have moved it.
fn vertex(mesh: &Mesh, place: [f32; 3]) -> usize {
    mesh.positions.iter().position(|p| *p == Vec3::from_array(place)).expect("it is there")
}

#[track_caller]
fn one_warning(scene: &Scene, text: &str) {
    assert!(scene.warnings.len() == 1 && scene.warnings[0].ends_with(text), "{text}: {:?}", scene.warnings);
}

/// Triangles of 1 m² facing +z and 3 m² facing +y meet in vertex 0: its normal is (0, 3, 1) / √10.
#[test]
fn normals_without_direction_are_recomputed_by_area() {
    let up = [0.0, 0.0, 5.0];
    for bad in [[0.0; 3], [1e-9, 0.0, 0.0], [NAN, 0.0, 1.0], [f32::INFINITY, 0.0, 0.0]] {
        let scene = loaded(&tent([bad, up, bad, up]));
        one_warning(&scene, "mesh 0 primitive 0: 2 normals have no direction; they were recomputed from the triangles");
        let mesh = &scene.meshes[0];
        let normal = |place| mesh.normals[vertex(mesh, place)];
        let truth = Vec3::new(0.0, 3.0, 1.0) / 10.0_f32.sqrt();
        assert!((normal([0.0; 3]) - truth).length() < 1e-6, "{bad:?}: {}", normal([0.0; 3]));
        assert!((normal([0.0, 1.0, 0.0]) - Vec3::Z).length() < 1e-6);
        assert_eq!(normal([2.0, 0.0, 0.0]), Vec3::Z, "a usable one is normalized");
    }
}

#[test]
fn a_vertex_without_triangles_still_gets_a_normal() {
    let mut fixture = tent([[0.0; 3]; 4]);
    let indices = fixture.shorts(&[0, 1, 2]);
    fixture.set("/meshes/0/primitives/0/indices", json!(indices));
    assert!(loaded(&fixture).meshes[0].normals.iter().all(|normal| normal.is_normalized()));
}

#[test]
fn unusable_tangents_are_replaced() {
    let mut fixture = tent([[0.0, 0.0, 1.0]; 4]);
    let good = [0.0, 1.0, 0.0, -1.0];
    let numbers = [[NAN, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0], [0.0, 0.0, 0.0, -1.0], good];
    attribute(&mut fixture, "TANGENT", 4, numbers.as_flattened());
    let scene = loaded(&fixture);
    one_warning(&scene, "mesh 0 primitive 0: 3 unusable tangents were replaced");
    let mesh = &scene.meshes[0];
    for (tangent, normal) in mesh.tangents.iter().zip(&mesh.normals) {
        assert!(tangent.truncate().is_normalized() && tangent.truncate().dot(*normal).abs() < 1e-6, "{tangent}");
        assert_eq!(tangent.w.abs(), 1.0);
    }
    assert_eq!(mesh.tangents[vertex(mesh, [0.0, 0.0, 3.0])], Vec4::from_array(good));
}

#[test]
fn coordinates_and_colors_that_are_no_numbers_become_zero() {
    let mut fixture = tent([[0.0, 0.0, 1.0]; 4]);
    attribute(&mut fixture, "TEXCOORD_0", 2, &[0.5, 0.25, NAN, 0.5, 0.5, f32::INFINITY, 0.75, 1.0]);
    attribute(&mut fixture, "TEXCOORD_1", 2, &[0.5, 0.25, 0.5, 0.5, 0.5, NAN, 0.75, 1.0]);
    let colors = [[0.1, 0.2, 0.3, 0.4], [NAN, 0.2, f32::NEG_INFINITY, 0.4], [0.5; 4], [0.6, 0.6, 0.6, NAN]];
    attribute(&mut fixture, "COLOR_0", 4, colors.as_flattened());
    let scene = loaded(&fixture);
    let mesh = &scene.meshes[0];
    let at = |place| vertex(mesh, place);
    let [a, b, c, d] = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 3.0]].map(at);
    assert_eq!(
        [a, b, c, d].map(|i| mesh.uv0[i]),
        [[0.5, 0.25], [0.0, 0.0], [0.0, 0.0], [0.75, 1.0]].map(Vec2::from_array)
    );
    assert_eq!(
        [a, b, c, d].map(|i| mesh.uv1[i]),
        [[0.5, 0.25], [0.5, 0.5], [0.0, 0.0], [0.75, 1.0]].map(Vec2::from_array)
    );
    let truth = [[0.1, 0.2, 0.3, 0.4], [0.0, 0.2, 0.0, 0.4], [0.5; 4], [0.6, 0.6, 0.6, 0.0]];
    assert_eq!([a, b, c, d].map(|i| mesh.colors[i]), truth.map(Vec4::from_array));
    let lines = scene.warnings.join("\n");
    assert_eq!(scene.warnings.len(), 2, "{lines}");
    assert!(
        lines.contains("mesh 0 primitive 0 and one other place: 3 texture coordinates are not finite; (0, 0)"),
        "{lines}"
    );
    assert!(lines.contains("mesh 0 primitive 0: 2 vertex colors are not finite; 0 is used"), "{lines}");
}

/// The triangle, bent by two joints of which the second is 1 above, with weights of both joints for each vertex.
fn skinned(weights: [[f32; 2]; 3]) -> Fixture {
    let mut fixture = Fixture::triangle();
    let joints = fixture.array(&[0, 1, 0, 0].repeat(3), 5121, "VEC4", 3);
    let numbers: Vec<f32> = weights.iter().flat_map(|[a, b]| [*a, *b, 0.0, 0.0]).collect();
    attribute(&mut fixture, "WEIGHTS_0", 4, &numbers);
    fixture.set("/meshes/0/primitives/0/attributes/JOINTS_0", json!(joints));
    fixture.set("/scenes/0/nodes", json!([0, 1, 2])).set("/nodes/0/skin", json!(0));
    fixture.push("nodes", json!({}));
    fixture.push("nodes", json!({"translation": [0, 0, 1]}));
    fixture.push("skins", json!({"joints": [1, 2]}));
    fixture
}

/// Returns the height of each vertex, which is its weight of the second joint.
fn heights(scene: &Scene) -> [f64; 3] {
    let (mesh, world) = (&scene.meshes[0], scene.instances[0].world_from_model);
    let places = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    places.map(|[x, y]| {
        let is_at = |p: &glam::DVec3| (p.x - x).abs() + (p.y - y).abs() < 1e-3;
        let all = mesh.positions.iter().map(|p| world.transform_point3(p.as_dvec3()));
        all.filter(is_at).map(|p| p.z).next().expect("vertices move along z only")
    })
}

#[test]
fn weights_are_normalized() {
    let close = |scene: &Scene, truth: [f64; 3]| {
        let own = heights(scene);
        assert!(own.iter().zip(truth).all(|(a, b)| (a - b).abs() < 1e-6), "{own:?} {truth:?}");
    };
    let warning =
        |count: usize| format!("the skin weights of {count} vertices do not add up to 1; they were normalized");
    // Sums of 2, 0.5 and 1; then negative, missing and unusable weights, which assign the vertex to the first joint.
    let scene = loaded(&skinned([[0.5, 1.5], [0.25, 0.25], [0.0, 1.0]]));
    close(&scene, [0.75, 0.5, 1.0]);
    one_warning(&scene, &warning(2));
    let scene = loaded(&skinned([[-1.0, 0.5], [0.0, 0.0], [NAN, f32::INFINITY]]));
    close(&scene, [1.0, 0.0, 0.0]);
    one_warning(&scene, &warning(3));
    // Rounding to 8 bits is no fault.
    let scene = loaded(&skinned([[0.501, 0.501], [0.75, 0.248], [1.0, 0.0]]));
    close(&scene, [0.5, 0.248 / 0.998, 0.0]);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

/// Fifty primitives with the same two faults cause two warnings.
#[test]
fn faults_of_many_primitives_are_one_warning_a_kind() {
    let mut fixture = tent([[0.0; 3], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0; 3]]);
    attribute(&mut fixture, "TEXCOORD_0", 2, &[NAN; 8]);
    let primitive = fixture.json["meshes"][0]["primitives"][0].clone();
    for number in 0..49 {
        let mut next = primitive.clone();
        // Separate accessors, otherwise the geometry would be shared.
        let view = fixture.json["accessors"][0].clone();
        next["attributes"]["POSITION"] = json!(fixture.push("accessors", view));
        next["extras"] = json!(number);
        fixture.primitive(next);
    }
    let lines = fixture.warnings();
    assert_eq!(lines.lines().count(), 2, "{lines}");
    assert!(lines.contains("mesh 0 primitive 0 and 49 other places: 100 normals have no direction"), "{lines}");
    assert!(
        lines.contains("mesh 0 primitive 0 and 49 other places: 200 texture coordinates are not finite"),
        "{lines}"
    );
}

/// A buffer without URI in a file without binary chunk reads as zeros. A warning is issued only if something reads it.
#[test]
fn absent_buffers_are_zeros_where_they_are_read() {
    let mut fixture = tent([[0.0, 0.0, 1.0]; 4]);
    let bytes = fixture.bin.len();
    fixture.json["buffers"] = json!([{"byteLength": bytes}, {"byteLength": 64}, {"byteLength": 1_u64 << 60}]);
    assert_eq!(fixture.warnings(), "", "nothing reads them");
    let view = fixture.push("bufferViews", json!({"buffer": 1, "byteLength": 64}));
    let accessor = json!({"bufferView": view, "componentType": 5126, "type": "VEC4", "count": 4});
    let accessor = fixture.push("accessors", accessor);
    fixture.set("/meshes/0/primitives/0/attributes/COLOR_0", json!(accessor));
    let scene = loaded(&fixture);
    assert_eq!(scene.meshes[0].colors, [Vec4::ZERO; 4]);
    one_warning(&scene, "buffer 1: the buffer has neither a URI nor a binary chunk; zeros are read from it");
    // A length above the memory budget fails without allocation.
    fixture.set(&format!("/bufferViews/{view}/buffer"), json!(2));
    assert!(fixture.error().contains("buffer 2: "), "{}", fixture.error());
    // Nothing is read beyond the stated length.
    fixture.set(&format!("/bufferViews/{view}/buffer"), json!(1));
    fixture.set(&format!("/bufferViews/{view}/byteLength"), json!(65));
    assert!(fixture.error().contains("covers 65 bytes"), "{}", fixture.error());
}

/// Channels with keys at equal times are skipped, others are kept.
#[test]
fn channels_whose_times_are_all_zero_are_left_out() {
    let mut fixture = Fixture::triangle();
    let zeros = fixture.push("accessors", json!({"componentType": 5126, "type": "SCALAR", "count": 2}));
    let times = fixture.floats(1, &[0.0, 1.0]);
    let ways = fixture.floats(3, &[0.0, 0.0, 0.0, 2.0, 0.0, 0.0]);
    fixture.push(
        "animations",
        json!({"samplers": [{"input": zeros, "output": ways}, {"input": times, "output": ways}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "scale"}},
                {"sampler": 1, "target": {"node": 0, "path": "translation"}}]}),
    );
    let scene = loaded(&fixture);
    assert_eq!(scene.motion.animations[0].channels.len(), 1);
    one_warning(&scene, "animation 0 channel 0: key 1 is at 0 s, not after key 0 at 0 s; the channel is left out");
}
