//! KHR_animation_pointer: a pointer changes only its property, and the rest pose restores it.

mod attached;
mod emission;
mod lobes;
mod materials;

use serde_json::{Value, json};

use super::fixture::{Fixture, png};
use crate::Scene;

/// Returns the triangle with texture coordinates, a material and a texture.
fn with_material(material: Value) -> Fixture {
    let mut fixture = Fixture::triangle();
    let uv = fixture.floats(2, &[0.0; 6]);
    fixture.set("/meshes/0/primitives/0/attributes/TEXCOORD_0", json!(uv));
    fixture.set("/meshes/0/primitives/0/material", json!(0));
    let view = fixture.view(&png(1, 1, [255; 4]));
    fixture.push("images", json!({"bufferView": view, "mimeType": "image/png"}));
    fixture.push("textures", json!({"source": 0}));
    fixture.push("materials", material);
    fixture
}

/// Appends a channel to animation 0 that changes a property from the first value at 0 s to the second at 2 s.
fn animate(fixture: &mut Fixture, pointer: &str, keys: [&[f32]; 2]) {
    if fixture.json["animations"].is_null() {
        fixture.push("animations", json!({"samplers": [], "channels": []}));
    }
    let times = fixture.floats(1, &[0.0, 2.0]);
    let width = keys[0].len();
    let values = fixture.floats(if width > 4 { 1 } else { width }, &keys.concat());
    let animation = &mut fixture.json["animations"][0];
    let samplers = animation["samplers"].as_array_mut().expect("a list");
    samplers.push(json!({"input": times, "output": values}));
    let sampler = samplers.len() - 1;
    let target = json!({"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": pointer}}});
    animation["channels"].as_array_mut().expect("a list").push(json!({"sampler": sampler, "target": target}));
    fixture.json["extensionsUsed"] = json!(["KHR_animation_pointer"]);
    fixture.json["extensionsRequired"] = json!(["KHR_animation_pointer"]);
}

fn loaded(fixture: &Fixture) -> Scene {
    let scene = fixture.load().expect("it is sound");
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    scene
}

fn posed(fixture: &Fixture, time_s: f64) -> Scene {
    let mut scene = loaded(fixture);
    scene.pose(Some(0), time_s).expect("it can be posed");
    assert_eq!(scene.check(), Ok(()));
    scene
}

/// Pointers move nodes like core channels.
#[test]
fn nodes_move_by_pointers_as_by_paths() {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let rows: [(&str, [&[f32]; 2]); 4] = [
        ("translation", [&[1.0, 2.0, 3.0], &[-1.0, 4.0, 0.0]]),
        ("rotation", [&[0.0, 0.0, 0.0, 1.0], &[0.0, half, 0.0, half]]),
        ("scale", [&[1.0, 1.0, 1.0], &[3.0, 0.5, 2.0]]),
        ("weights", [&[0.0, 1.0], &[1.0, 0.5]]),
    ];
    for (path, keys) in rows {
        let mut fixture = Fixture::triangle();
        let up = fixture.floats(3, &[0.0, 0.0, 1.0].repeat(3));
        let aside = fixture.floats(3, &[2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        fixture.set("/meshes/0/primitives/0/targets", json!([{"POSITION": up}, {"POSITION": aside}]));
        animate(&mut fixture, &format!("/nodes/0/{path}"), keys);
        if path == "weights" {
            let values = fixture.floats(1, &keys.concat());
            fixture.set("/animations/0/samplers/0/output", json!(values));
        }
        let mut plain = fixture.clone();
        plain.set("/animations/0/channels/0/target", json!({"node": 0, "path": path}));
        let rest = loaded(&fixture);
        for time_s in [0.0, 0.5, 1.75, 9.0] {
            let (by_pointer, by_path) = (posed(&fixture, time_s), posed(&plain, time_s));
            assert_eq!((&by_pointer.instances, &by_pointer.meshes), (&by_path.instances, &by_path.meshes), "{path}");
        }
        let moved = posed(&fixture, 1.0);
        assert!(moved.instances != rest.instances || moved.meshes != rest.meshes, "{path} moves something");
    }
}

#[test]
fn what_cannot_be_animated_is_warned_of_and_left_out() {
    let mut fixture = with_material(json!({}));
    fixture.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "point"}]}});
    let pointers = [
        "/materials/0/doubleSided",
        "/materials/0/alphaMode",
        "/materials/0/extensions/KHR_materials_unknown/factor",
        "/materials/0/pbrMetallicRoughness/baseColorTexture/index",
        "/materials/0/emissiveTexture/extensions/KHR_texture_transform/texCoord",
        "/materials/9/alphaCutoff",
        "/materials/-1/alphaCutoff",
        "materials/0/alphaCutoff",
        "/nodes/0/extensions/KHR_node_visibility/visible",
        "/nodes/0/matrix",
        "/nodes/9/translation",
        "/cameras/0/perspective/yfov",
        "/cameras/0/perspective/aspectRatio",
        "/extensions/KHR_lights_punctual/lights/0/type",
        "/extensions/KHR_lights_punctual/lights/1/intensity",
        "/meshes/0/weights/0",
        "/",
        "",
    ];
    for pointer in pointers {
        animate(&mut fixture, pointer, [&[0.0], &[1.0]]);
    }
    animate(&mut fixture, "/materials/0/pbrMetallicRoughness/roughnessFactor", [&[0.0], &[1.0]]);
    let scene = fixture.load().expect("it loads");
    assert_eq!(scene.warnings.len(), pointers.len(), "{:#?}", scene.warnings);
    for (channel, (line, pointer)) in scene.warnings.iter().zip(pointers).enumerate() {
        let truth = format!("animation 0 channel {channel}: the property {pointer:?} cannot be animated");
        assert!(line.contains(&truth), "{line}");
    }
    assert_eq!(scene.motion.animations[0].channels.len(), 1);
}

/// Unused materials, lights and cameras are not in the scene.
#[test]
fn objects_that_the_scene_does_not_use_are_quietly_left_out() {
    let mut fixture = with_material(json!({}));
    fixture.push("materials", json!({}));
    fixture.push("cameras", json!({"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}));
    fixture.push("nodes", json!({}));
    fixture.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "point"}]}});
    animate(&mut fixture, "/materials/1/alphaCutoff", [&[0.0], &[1.0]]);
    animate(&mut fixture, "/cameras/0/perspective/yfov", [&[0.5], &[1.0]]);
    animate(&mut fixture, "/extensions/KHR_lights_punctual/lights/0/intensity", [&[0.5], &[1.0]]);
    animate(&mut fixture, "/nodes/1/scale", [&[1.0, 1.0, 1.0], &[2.0, 2.0, 2.0]]);
    assert!(loaded(&fixture).motion.animations[0].channels.is_empty());
}

/// An output of the wrong width disables the channel.
#[test]
fn outputs_must_have_the_width_of_their_property() {
    let mut fixture = with_material(json!({}));
    animate(&mut fixture, "/materials/0/pbrMetallicRoughness/baseColorFactor", [&[0.0; 3], &[1.0; 3]]);
    let lines = fixture.warnings();
    assert!(lines.contains("its output has 6 numbers, and its 2 keys need 8; the channel is left out"), "{lines}");
}
