//! Vertex streams: modes, component types, sparse accessors, generated normals and tangents.

use glam::{Vec2, Vec3, Vec4};
use serde_json::json;

use super::fixture::Fixture;

#[test]
fn both_containers_give_the_same_triangle() {
    let fixture = Fixture::triangle();
    let scene = fixture.load().expect("a good file");
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    assert_eq!(scene.name, "fixture");
    let mesh = &scene.meshes[0];
    assert_eq!(mesh.positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(mesh.normals, [Vec3::Z; 3]);
    assert_eq!(mesh.indices, [0, 1, 2]);
    assert!(mesh.tangents.is_empty() && mesh.uv0.is_empty() && mesh.colors.is_empty());
    let text =
        super::super::load_bytes(std::path::Path::new("fixture.gltf"), &fixture.gltf(), &mut crate::progress::silent)
            .expect("a good file");
    assert_eq!(text.meshes, scene.meshes);
    assert_eq!(text.instances, scene.instances);
}

#[test]
fn every_index_type_and_none_at_all() {
    let bytes = [0_u8, 1, 2];
    let words: Vec<u8> = [0_u32, 1, 2].iter().flat_map(|v| v.to_le_bytes()).collect();
    for (data, component) in [(&bytes[..], 5121), (&words, 5125)] {
        let mut fixture = Fixture::triangle();
        let indices = fixture.array(data, component, "SCALAR", 3);
        fixture.set("/meshes/0/primitives/0/indices", json!(indices));
        assert_eq!(fixture.load().expect("a good file").meshes[0].indices, [0, 1, 2]);
    }
    let mut fixture = Fixture::triangle();
    let primitive = fixture.json.pointer_mut("/meshes/0/primitives/0").expect("there");
    primitive.as_object_mut().expect("an object").remove("indices");
    assert_eq!(fixture.load().expect("a good file").meshes[0].indices, [0, 1, 2]);
}

/// A strip of squares with scattered triangles is reordered, with vertices in order of use, unless file order is
/// requested or visible.
#[test]
fn triangles_are_ordered_where_their_order_does_not_show() {
    let squares = 40_u16;
    let corners: Vec<f32> = (0..2 * squares + 2).flat_map(|i| [f32::from(i / 2), f32::from(i % 2), 0.0]).collect();
    let indices: Vec<u16> = (0..2 * squares)
        .map(|i| i * 37 % (2 * squares))
        .flat_map(|t| match t % 2 {
            0 => [t, t + 2, t + 1],
            _ => [t, t + 1, t + 2],
        })
        .collect();
    let load = |alpha: &str, keep_order| {
        let mut fixture = Fixture::new();
        let (position, numbers) = (fixture.floats(3, &corners), fixture.shorts(&indices));
        let normal = fixture.floats(3, &[0.0, 0.0, 1.0].repeat(corners.len() / 3));
        let material = fixture.push("materials", json!({"alphaMode": alpha}));
        let attributes = json!({"POSITION": position, "NORMAL": normal});
        fixture.primitive(json!({"attributes": attributes, "indices": numbers, "material": material}));
        let options = crate::LoadOptions { keep_order, ..crate::LoadOptions::default() };
        let path = std::path::Path::new("fixture.glb");
        let scene = super::super::load_bytes_with(path, &fixture.glb(), &options, &mut crate::progress::silent);
        scene.expect("a good file").meshes.remove(0)
    };
    let file: Vec<u32> = indices.iter().map(|i| u32::from(*i)).collect();
    for (alpha, keep_order) in [("BLEND", false), ("OPAQUE", true), ("MASK", true)] {
        assert_eq!(load(alpha, keep_order).indices, file, "{alpha}, {keep_order}");
    }
    for alpha in ["OPAQUE", "MASK"] {
        let (mesh, kept) = (load(alpha, false), load(alpha, true));
        let [before, after] = [&kept, &mesh].map(crate::geometry::shaded_vertices);
        assert!(after == kept.vertex_count() && before > 2 * after, "{before} to {after} vertices, {alpha}");
        let area = |m: &crate::Mesh| {
            let cross = |t: [usize; 3]| {
                let [a, b, c] = t.map(|i| m.positions[i]);
                (b - a).cross(c - a).z
            };
            m.triangles().map(cross).sum::<f32>()
        };
        assert_eq!(
            (area(&mesh), mesh.bounds),
            (2.0 * f32::from(squares), kept.bounds),
            "every triangle faces as it did"
        );
    }
}

/// A square as list, strip and fan gives the same two triangles up to rotation, with the same winding.
#[test]
fn strips_and_fans_face_the_same_way_as_lists() {
    let corners = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0];
    for (mode, indices) in [(4, &[0_u16, 1, 2, 2, 1, 3][..]), (5, &[0, 1, 2, 3]), (6, &[0, 1, 3, 2])] {
        let mut fixture = Fixture::new();
        let position = fixture.floats(3, &corners);
        let indices = fixture.shorts(indices);
        let attributes = json!({"POSITION": position});
        fixture.primitive(json!({"attributes": attributes, "indices": indices, "mode": mode}));
        let scene = fixture.load().expect("a good file");
        let mesh = &scene.meshes[0];
        assert_eq!(mesh.triangle_count(), 2, "mode {mode}");
        // The computed flat normals reveal the winding.
        assert!(mesh.normals.iter().all(|n| *n == Vec3::Z), "mode {mode}");
        assert_eq!(mesh.vertex_count(), 4, "coplanar corners stay shared");
    }
}

/// A sparse accessor with and without a base, and a non-sparse one without data: zeros.
#[test]
fn sparse_accessors_replace_elements() {
    for with_base in [true, false] {
        let mut fixture = Fixture::triangle();
        let indices = fixture.view(&[2, 0]);
        let values: Vec<u8> = [0.0_f32, 5.0, 0.0].iter().flat_map(|v| v.to_le_bytes()).collect();
        let values = fixture.view(&values);
        let sparse = json!({
            "count": 1,
            "indices": {"bufferView": indices, "componentType": 5121},
            "values": {"bufferView": values},
        });
        fixture.set("/accessors/0/sparse", sparse);
        if !with_base {
            let accessor = fixture.json.pointer_mut("/accessors/0").expect("there");
            accessor.as_object_mut().expect("an object").remove("bufferView");
        }
        let scene = fixture.load().expect("a good file");
        let middle = if with_base { Vec3::X } else { Vec3::ZERO };
        assert_eq!(scene.meshes[0].positions, [Vec3::ZERO, middle, Vec3::Y * 5.0]);
    }
}

/// Quantized positions, normals and colors, normalized or not, strided and offset.
#[test]
fn integer_components_and_strides() {
    let mut fixture = Fixture::new();
    // i8 positions, not normalized, every 4 bytes, beginning at byte 4.
    let position = fixture.array(&[9, 9, 9, 9, 0, 0, 0, 9, 2, 0, 0, 9, 0, 254, 0], 5120, "VEC3", 3);
    fixture.set(&format!("/accessors/{position}/byteOffset"), json!(4));
    fixture.set("/bufferViews/0/byteStride", json!(4));
    let normal = fixture.array(&[0, 0, 127, 0, 0, 129, 0, 128, 0], 5120, "VEC3", 3);
    fixture.set(&format!("/accessors/{normal}/normalized"), json!(true));
    let shorts: Vec<u8> = [0_u16, 65535, 32768, 0, 0, 65535].iter().flat_map(|v| v.to_le_bytes()).collect();
    let uv = fixture.array(&shorts, 5123, "VEC2", 3);
    fixture.set(&format!("/accessors/{uv}/normalized"), json!(true));
    let color = fixture.array(&[255, 0, 51].repeat(3), 5121, "VEC3", 3);
    fixture.set(&format!("/accessors/{color}/normalized"), json!(true));
    let attributes = json!({"POSITION": position, "NORMAL": normal, "TEXCOORD_1": uv, "COLOR_0": color});
    fixture.primitive(json!({"attributes": attributes}));
    fixture.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    let scene = fixture.load().expect("a good file");
    let mesh = &scene.meshes[0];
    assert_eq!(mesh.positions, [Vec3::ZERO, Vec3::X * 2.0, Vec3::Y * -2.0]);
    assert_eq!(mesh.normals, [Vec3::Z, Vec3::NEG_Z, Vec3::NEG_Y]);
    assert!(mesh.uv0.is_empty());
    assert_eq!(mesh.uv1[0], Vec2::Y);
    assert!((mesh.uv1[1].x - 0.5).abs() < 1e-4);
    assert_eq!(mesh.colors, [Vec4::new(1.0, 0.0, 0.2, 1.0); 3]);
}

/// A material with a normal map generates tangents; the same geometry without one does not. Two primitives of equal
/// geometry share a mesh.
#[test]
fn tangents_are_made_where_a_normal_map_needs_them() {
    let mut fixture = Fixture::triangle();
    let uv = fixture.floats(2, &[0.0, 1.0, 1.0, 1.0, 0.0, 0.0]);
    fixture.set("/meshes/0/primitives/0/attributes/TEXCOORD_0", json!(uv));
    let image = fixture.view(&super::fixture::png(1, 1, [128, 128, 255, 255]));
    fixture.push("images", json!({"bufferView": image, "mimeType": "image/png"}));
    fixture.push("textures", json!({"source": 0}));
    fixture.push("materials", json!({"normalTexture": {"index": 0, "scale": 0.5}}));
    fixture.push("materials", json!({}));
    let mut primitive = fixture.json["meshes"][0]["primitives"][0].clone();
    for material in [0, 1, 1] {
        primitive["material"] = json!(material);
        fixture.primitive(primitive.clone());
    }
    let scene = fixture.load().expect("a good file");
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    // The first primitive has no material; it and the two with material 1 share a mesh.
    assert_eq!((scene.meshes.len(), scene.instances.len()), (2, 4));
    assert!(scene.meshes[0].tangents.is_empty());
    // u increases along +x, v along −y: the bitangent, against increasing v, is +y.
    assert_eq!(scene.meshes[1].tangents, [Vec4::new(1.0, 0.0, 0.0, 1.0); 3]);
    assert_eq!(scene.materials[1].normal_scale, 0.5);
}

#[test]
fn given_tangents_are_kept_and_repaired() {
    let mut fixture = Fixture::triangle();
    let good = [0.0, 2.0, 0.0, -1.0];
    let tangents: Vec<f32> = [good, good, [0.0, 0.0, 1.0, 1.0]].concat();
    let tangent = fixture.floats(4, &tangents);
    fixture.set("/meshes/0/primitives/0/attributes/TANGENT", json!(tangent));
    let scene = fixture.load().expect("a good file");
    assert_eq!(scene.meshes[0].tangents[0], Vec4::new(0.0, 1.0, 0.0, -1.0));
    assert!(scene.warnings[0].contains("1 unusable tangents"), "{:?}", scene.warnings);
}

/// Degenerate triangles have no flat normal.
#[test]
fn flat_normals_leave_out_triangles_without_area() {
    let mut fixture = Fixture::new();
    let position = fixture.floats(3, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 2.0, 0.0, 0.0]);
    let indices = fixture.shorts(&[0, 1, 2, 0, 1, 3]);
    fixture.primitive(json!({"attributes": {"POSITION": position}, "indices": indices}));
    let scene = fixture.load().expect("a good file");
    assert_eq!(scene.meshes[0].triangle_count(), 1);
    assert!(scene.warnings[0].contains("1 triangles without area"), "{:?}", scene.warnings);
}
