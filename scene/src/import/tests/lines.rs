//! Lines and points: modes, counts, and materials.

use glam::{DVec3, Vec3, Vec4};
use serde_json::{Value, json};

use super::fixture::{Fixture, png};
use crate::mesh::Topology;
use crate::{AlphaMode, Material, Scene};

/// Returns four vertices in the plane z = 0, drawn in `mode`: by `indices`, or in order.
fn drawn(mode: u32, indices: Option<&[u16]>, more: &[(&str, usize)]) -> Fixture {
    let mut fixture = Fixture::new();
    let position = fixture.floats(3, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0]);
    let mut primitive = json!({"attributes": {"POSITION": position}, "mode": mode});
    for (name, width) in more {
        let unit: Vec<f32> = (0..*width).map(|i| if i == *width - 1 { 1.0 } else { 0.0 }).collect();
        // A normal along z; a tangent along x with a sign.
        let values = if *width == 4 { vec![1.0, 0.0, 0.0, 1.0] } else { unit };
        primitive["attributes"][name] = json!(fixture.floats(*width, &values.repeat(4)));
    }
    if let Some(indices) = indices {
        primitive["indices"] = json!(fixture.shorts(indices));
    }
    fixture.primitive(primitive);
    fixture
}

fn loaded(fixture: &Fixture) -> Scene {
    fixture.load().expect("a good file")
}

/// Section 3.7.2.1: vertices joined by each mode, with and without indices.
#[test]
fn every_mode_becomes_a_list() {
    let (points, lines) = (Topology::Points, Topology::Lines);
    for (mode, indices, topology, list) in [
        (0, None, points, &[0, 1, 2, 3][..]),
        (0, Some(&[2_u16, 2, 0][..]), points, &[2, 2, 0]),
        (1, None, lines, &[0, 1, 2, 3]),
        (1, Some(&[3, 0, 1, 1, 1, 2]), lines, &[3, 0, 1, 2]),
        (2, None, lines, &[0, 1, 1, 2, 2, 3, 3, 0]),
        (2, Some(&[1, 3]), lines, &[1, 3, 3, 1]),
        (3, None, lines, &[0, 1, 1, 2, 2, 3]),
        (3, Some(&[3, 1]), lines, &[3, 1]),
    ] {
        let scene = loaded(&drawn(mode, indices, &[]));
        let mesh = &scene.meshes[0];
        assert_eq!((mesh.topology, mesh.indices.as_slice()), (topology, list), "mode {mode}, {indices:?}");
        assert!(mesh.normals.is_empty() && scene.warnings.is_empty(), "{:?}", scene.warnings);
        assert_eq!((scene.instances.len(), scene.triangle_count()), (1, 0));
        assert_eq!((mesh.bounds.max.x, mesh.bounds.max.z), (1.0, 0.0));
    }
}

#[test]
fn primitives_of_too_few_vertices_are_left_out_with_a_warning() {
    for (mode, indices, word) in [(1, &[2_u16, 2][..], "no line"), (2, &[1], "no line"), (3, &[1], "no line")] {
        let scene = loaded(&drawn(mode, Some(indices), &[]));
        assert!(scene.instances.is_empty());
        let said = |word| scene.warnings.iter().any(|warning: &String| warning.contains(word));
        assert!(said(word) && said("the scene draws nothing"), "mode {mode}: {:?}", scene.warnings);
    }
    let odd = drawn(1, Some(&[0, 1, 2]), &[]);
    assert!(odd.warnings().contains("mesh 0 primitive 0: 1 indices at the end make no whole triangle or line"));
    assert_eq!(loaded(&odd).meshes[0].indices, [0, 1]);
}

/// Returns a material with every property that section 3.9.7 affects.
fn with_material(mut fixture: Fixture, extensions: &Value) -> Material {
    let image = fixture.view(&png(1, 1, [128, 128, 255, 255]));
    fixture.push("images", json!({"bufferView": image, "mimeType": "image/png"}));
    fixture.push("textures", json!({"source": 0}));
    fixture.push(
        "materials",
        json!({
            "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0.125, 0.75], "metallicFactor": 0.25},
            "normalTexture": {"index": 0},
            "emissiveFactor": [0.5, 1.0, 0.25],
            "alphaMode": "BLEND",
            "extensions": extensions,
        }),
    );
    fixture.set("/meshes/0/primitives/0/material", json!(0));
    let scene = loaded(&fixture);
    scene.materials[scene.instances[0].material.index()].clone()
}

/// Section 3.9.7: without normals base color and emission, without tangents no normal map, and with both everything.
#[test]
fn streams_decide_how_lines_and_points_are_lit() {
    let coat = json!({"KHR_materials_clearcoat": {"clearcoatFactor": 1.0, "clearcoatNormalTexture": {"index": 0}}});
    for mode in [0, 1, 2, 3] {
        let bare = with_material(drawn(mode, None, &[]), &coat);
        assert!(bare.unlit && bare.slots().into_iter().flatten().count() == 0 && bare.lobes().is_empty(), "{bare:?}");
        assert_eq!((bare.base_color, bare.alpha), (Vec4::new(0.5, 0.25, 0.125, 0.75), AlphaMode::Blend));
        assert_eq!(bare.emissive, Vec3::new(0.5, 1.0, 0.25));
        let lit = with_material(drawn(mode, None, &[("NORMAL", 3)]), &coat);
        assert!(!lit.unlit && lit.metallic == 0.25 && lit.emissive == bare.emissive);
        assert!(lit.normal_texture.is_none() && lit.clear_coat.is_some_and(|coat| coat.normal_texture.is_none()));
        let mapped = with_material(drawn(mode, None, &[("NORMAL", 3), ("TANGENT", 4)]), &coat);
        assert!(mapped.normal_texture.is_some() && mapped.clear_coat.is_some_and(|coat| coat.normal_texture.is_some()));
        // KHR_materials_unlit shows only the base color.
        let unlit = with_material(drawn(mode, None, &[]), &json!({"KHR_materials_unlit": {}}));
        assert!(unlit.unlit && unlit.emissive == Vec3::ZERO, "{unlit:?}");
    }
}

/// Triangles keep the material, and lines of equal streams share a variant of it.
#[test]
fn forms_of_materials_are_made_once() {
    let mut fixture = drawn(1, None, &[]);
    fixture.push("materials", json!({"pbrMetallicRoughness": {"roughnessFactor": 0.5}}));
    fixture.set("/meshes/0/primitives/0/material", json!(0));
    let lines = fixture.json["meshes"][0]["primitives"][0].clone();
    for (mode, indices) in [(3, json!(null)), (4, json!(fixture.shorts(&[0, 1, 2])))] {
        let mut primitive = lines.clone();
        primitive["mode"] = json!(mode);
        if indices.is_number() {
            primitive["indices"] = indices;
        }
        fixture.primitive(primitive);
    }
    let scene = loaded(&fixture);
    let materials: Vec<usize> = scene.instances.iter().map(|instance| instance.material.index()).collect();
    assert_eq!((materials[0] == materials[1], materials[0] == materials[2]), (true, false));
    assert!(!scene.materials[materials[2]].unlit && scene.materials[materials[0]].unlit);
    assert_eq!(scene.materials.len(), 2);
}

/// Joints move lines and points like triangles, with and without normals.
#[test]
fn skins_move_lines_and_points() {
    for (mode, streams) in [(0, &[][..]), (1, &[]), (3, &[("NORMAL", 3)])] {
        let mut fixture = drawn(mode, None, streams);
        let joints = fixture.array(&[0_u8; 16], 5121, "VEC4", 4);
        let weights = fixture.floats(4, &[1.0, 0.0, 0.0, 0.0].repeat(4));
        fixture.set("/meshes/0/primitives/0/attributes/JOINTS_0", json!(joints));
        fixture.set("/meshes/0/primitives/0/attributes/WEIGHTS_0", json!(weights));
        fixture.push("skins", json!({"joints": [1]}));
        fixture.set("/nodes/0/skin", json!(0));
        fixture.push("nodes", json!({"translation": [0.0, 0.0, 5.0], "scale": [2.0, 2.0, 2.0]}));
        fixture.set("/scenes/0/nodes", json!([0, 1]));
        // Loading applies the rest pose.
        let scene = loaded(&fixture);
        assert_eq!(scene.motion.bodies.len(), 1, "mode {mode}");
        let bounds = scene.instances[0].bounds;
        assert_eq!((bounds.min, bounds.max), (DVec3::Z * 5.0, DVec3::new(2.0, 2.0, 5.0)), "mode {mode}");
    }
}
