//! Damaged files with all kinds of motion: each loads and can be posed, or returns one line, without a panic.

use std::path::Path;

use serde_json::{Value, json};

use super::fixture::{Fixture, png};
use crate::import::load_bytes;
use crate::progress::silent;

/// Returns a skinned and morphed triangle with instances, a light, a camera, variants, both material models, and an
/// animation of all.
fn rich() -> Fixture {
    let mut f = Fixture::triangle();
    let joints = f.array(&[0, 1, 0, 1].repeat(3), 5121, "VEC4", 3);
    let weights = f.floats(4, &[0.25; 12]);
    let up = f.floats(3, &[0.0, 0.0, 1.0].repeat(3));
    let uv = f.floats(2, &[0.5; 6]);
    let primitive = "/meshes/0/primitives/0";
    for (name, accessor) in
        [("JOINTS_0", joints), ("WEIGHTS_0", weights), ("JOINTS_1", joints), ("WEIGHTS_1", weights), ("TEXCOORD_0", uv)]
    {
        f.set(&format!("{primitive}/attributes/{name}"), json!(accessor));
    }
    f.set(&format!("{primitive}/targets"), json!([{"POSITION": up, "NORMAL": up}]));
    f.set(&format!("{primitive}/material"), json!(0));
    let mappings = json!([{"material": 1, "variants": [0]}]);
    f.set(&format!("{primitive}/extensions"), json!({"KHR_materials_variants": {"mappings": mappings}}));
    f.set("/meshes/0/weights", json!([0.5]));
    let view = f.view(&png(1, 1, [9; 4]));
    f.push("images", json!({"bufferView": view, "mimeType": "image/png"}));
    f.push("textures", json!({"source": 0}));
    f.push("materials", json!({"extensions": {"KHR_materials_clearcoat": {"clearcoatTexture": {"index": 0}}}}));
    let gloss = json!({"specularGlossinessTexture": {"index": 0}, "glossinessFactor": 0.5});
    f.push("materials", json!({"extensions": {"KHR_materials_pbrSpecularGlossiness": gloss}}));
    let matrices: Vec<u8> =
        [glam::Mat4::IDENTITY; 2].iter().flat_map(|m| m.to_cols_array()).flat_map(f32::to_le_bytes).collect();
    let matrices = f.array(&matrices, 5126, "MAT4", 2);
    f.push("skins", json!({"joints": [1, 2], "inverseBindMatrices": matrices, "skeleton": 1}));
    let places = f.floats(3, &[1.0; 6]);
    let instances = json!({"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": places, "SCALE": places}}});
    f.json["nodes"] = json!([
        {"mesh": 0, "skin": 0},
        {"children": [2, 3], "translation": [0, 1, 0]},
        {"rotation": [0, 0, 0, 1], "camera": 0},
        {"extensions": {"KHR_lights_punctual": {"light": 0}, "KHR_node_visibility": {"visible": true}}},
        {"mesh": 0, "extensions": instances},
    ]);
    f.set("/scenes/0/nodes", json!([0, 1, 4]));
    f.push("cameras", json!({"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1, "zfar": 9.0}}));
    f.json["extensions"] = json!({
        "KHR_lights_punctual": {"lights": [{"type": "spot", "range": 5.0, "spot": {"outerConeAngle": 0.5}}]},
        "KHR_materials_variants": {"variants": [{"name": "a"}]},
    });
    let times = f.floats(1, &[0.0, 1.0]);
    let numbers = f.floats(1, &[0.25, 0.5]);
    let vectors = f.floats(3, &[0.0, 1.0, 2.0, 2.0, 1.0, 0.5]);
    let turns = f.floats(4, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.6, 0.0, 0.8]);
    let cubic = f.floats(3, &[0.5; 18]);
    let pointer = |text: &str| json!({"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": text}}});
    f.push(
        "animations",
        json!({
            "samplers": [
                {"input": times, "output": numbers},
                {"input": times, "output": vectors, "interpolation": "STEP"},
                {"input": times, "output": turns},
                {"input": times, "output": cubic, "interpolation": "CUBICSPLINE"},
            ],
            "channels": [
                {"sampler": 0, "target": {"node": 0, "path": "weights"}},
                {"sampler": 1, "target": {"node": 1, "path": "translation"}},
                {"sampler": 2, "target": {"node": 2, "path": "rotation"}},
                {"sampler": 3, "target": {"node": 1, "path": "scale"}},
                {"sampler": 0, "target": pointer("/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor")},
                {"sampler": 1, "target": pointer("/materials/0/emissiveFactor")},
                {"sampler": 0, "target": pointer("/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle")},
                {"sampler": 0, "target": pointer("/cameras/0/perspective/znear")},
                {"sampler": 3, "target": pointer("/nodes/4/translation")},
            ],
        }),
    );
    f
}

/// Loads a file and poses it; returns true if both succeed.
fn survive(fixture: &Fixture, what: &str) -> bool {
    let mut scene = match load_bytes(Path::new("fuzz.glb"), &fixture.glb(), &mut silent) {
        Ok(scene) => scene,
        Err(error) => {
            let text = error.to_string();
            assert!(text.starts_with("fuzz.glb") && !text.contains('\n'), "{what}: {text}");
            return false;
        }
    };
    assert_eq!(scene.check(), Ok(()), "{what}");
    (0..scene.motion.animations.len()).all(|animation| match scene.pose(Some(animation), 0.75) {
        Ok(()) => {
            assert_eq!(scene.check(), Ok(()), "{what}");
            true
        }
        Err(error) => {
            let text = error.to_string();
            assert!(text.contains("not finite") || text.contains("from the origin"), "{what}: {text}");
            false
        }
    })
}

#[test]
fn every_value_replaced_by_hostile_ones_never_panics() {
    let fixture = rich();
    let scene = fixture.load().expect("it is sound");
    assert_eq!((scene.motion.animations[0].channels.len(), scene.motion.bodies.len()), (9, 2), "{:?}", scene.warnings);
    assert!(survive(&fixture, "undamaged"));
    let mut pointers = Vec::new();
    for part in ["nodes", "skins", "animations", "meshes", "materials", "extensions"] {
        collect(&fixture.json[part], format!("/{part}"), &mut pointers);
    }
    assert!(pointers.len() > 150);
    let hostile =
        [json!(0), json!(-1), json!(u32::MAX), json!(1e38), json!("/materials/0/"), json!(null), json!([]), json!({})];
    let mut survived = 0;
    for pointer in &pointers {
        for value in &hostile {
            let mut damaged = fixture.clone();
            damaged.set(pointer, value.clone());
            survived += usize::from(survive(&damaged, &format!("{pointer} = {value}")));
        }
    }
    assert!(survived > 300 && survived < pointers.len() * hostile.len() - 300, "{survived}");
}

/// Replaces the floats of every array by invalid values.
#[test]
fn every_array_filled_with_hostile_numbers_never_panics() {
    let fixture = rich();
    let views = fixture.json["bufferViews"].as_array().expect("a list").len();
    for view in 0..views {
        for number in [f32::NAN, f32::INFINITY, f32::MAX, f32::MIN, -0.0, f32::MIN_POSITIVE, -1.0, 3e18] {
            let mut damaged = fixture.clone();
            let part = |key: &str| fixture.json["bufferViews"][view][key].as_u64().expect("a number") as usize;
            let range = part("byteOffset")..part("byteOffset") + part("byteLength");
            for bytes in damaged.bin[range].chunks_exact_mut(4) {
                bytes.copy_from_slice(&number.to_le_bytes());
            }
            survive(&damaged, &format!("view {view} of {number}"));
        }
    }
}

/// Collects the JSON pointers of every value below `value`.
fn collect(value: &Value, at: String, pointers: &mut Vec<String>) {
    let children: Vec<(String, &Value)> = match value {
        Value::Object(members) => members.iter().map(|(key, child)| (key.clone(), child)).collect(),
        Value::Array(all) => all.iter().enumerate().map(|(i, child)| (i.to_string(), child)).collect(),
        _ => return,
    };
    for (key, child) in children {
        let at = format!("{at}/{key}");
        pointers.push(at.clone());
        collect(child, at, pointers);
    }
}
