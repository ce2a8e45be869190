//! EXT_mesh_gpu_instancing and KHR_node_visibility.

use glam::{DMat4, DQuat, DVec3};
use serde_json::{Value, json};

use super::fixture::Fixture;
use crate::Scene;

/// Returns the triangle on a node at (0, 5, 0), scaled by three, with the instances of `attributes`.
fn instanced(attributes: impl FnOnce(&mut Fixture) -> Value) -> Fixture {
    let mut fixture = Fixture::triangle();
    let attributes = attributes(&mut fixture);
    fixture.set("/nodes/0/translation", json!([0, 5, 0])).set("/nodes/0/scale", json!([3, 3, 3]));
    fixture.set("/nodes/0/extensions", json!({"EXT_mesh_gpu_instancing": {"attributes": attributes}}));
    fixture.json["extensionsUsed"] = json!(["EXT_mesh_gpu_instancing"]);
    fixture.json["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    fixture
}

fn loaded(fixture: &Fixture) -> Scene {
    let scene = fixture.load().expect("it is sound");
    assert_eq!(scene.meshes.len(), 1, "instances share a mesh");
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    scene
}

#[track_caller]
fn assert_close(matrix: DMat4, truth: DMat4, tolerance: f64) {
    let off = (matrix - truth).to_cols_array().into_iter().map(f64::abs).fold(0.0, f64::max);
    assert!(off <= tolerance, "{off:e}: {matrix} {truth}");
}

const PLACES: [f32; 6] = [1.0, 2.0, 3.0, -4.0, 0.0, 0.5];
const SIZES: [f32; 6] = [1.0, 2.0, 3.0, 0.5, 0.25, -1.0];
const TURNS: [f32; 8] = [0.0, 0.6, 0.0, 0.8, 0.5, 0.5, 0.5, 0.5];

/// Every combination of the three attributes; missing ones are the identity.
#[test]
fn instances_are_placed_by_what_they_have() {
    for has in 1..8_u32 {
        let [has_t, has_r, has_s] = [1, 2, 4].map(|bit| has & bit != 0);
        let mut fixture = instanced(|f| {
            let mut attributes = json!({});
            for (is_there, name, width, numbers) in
                [(has_t, "TRANSLATION", 3, &PLACES[..]), (has_r, "ROTATION", 4, &TURNS), (has_s, "SCALE", 3, &SIZES)]
            {
                if is_there {
                    attributes[name] = json!(f.floats(width, numbers));
                }
            }
            attributes["_ID"] = json!(f.floats(1, &[1.0, 2.0]));
            attributes
        });
        let scene = loaded(&fixture);
        assert_eq!(scene.instances.len(), 2);
        for (i, instance) in scene.instances.iter().enumerate() {
            let vector = |is_there, all: &[f32; 6], default| {
                let own: [f64; 3] = std::array::from_fn(|axis| f64::from(all[3 * i + axis]));
                if is_there { DVec3::from_array(own) } else { default }
            };
            let q: [f64; 4] = std::array::from_fn(|axis| f64::from(TURNS[4 * i + axis]));
            let rotation = if has_r { DQuat::from_array(q).normalize() } else { DQuat::IDENTITY };
            let own = DMat4::from_translation(vector(has_t, &PLACES, DVec3::ZERO))
                * DMat4::from_quat(rotation)
                * DMat4::from_scale(vector(has_s, &SIZES, DVec3::ONE));
            let node = DMat4::from_translation(DVec3::Y * 5.0) * DMat4::from_scale(DVec3::splat(3.0));
            assert_close(instance.world_from_model, node * own, 1e-12);
        }
        // Without the extension's attributes the node draws its mesh once.
        fixture.set("/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes", json!({"_ID": 0}));
        assert_eq!(loaded(&fixture).instances.len(), 1);
    }
}

/// Normalized rotations in 8 and 16 bits: 60° about z, up to quantization.
#[test]
fn rotations_may_be_integers() {
    let (sine, cosine) = (0.5_f64, 0.75_f64.sqrt());
    let codes = |largest: f64| [0.0, 0.0, sine * largest, cosine * largest].map(|code| code.round() as i16);
    for (bytes, component, step) in [
        (codes(127.0).map(|code| code as i8 as u8).to_vec(), 5120, 1.0 / 127.0),
        (codes(32767.0).iter().flat_map(|code| code.to_le_bytes()).collect(), 5122, 1.0 / 32767.0),
    ] {
        let fixture = instanced(|f| {
            let accessor = f.array(&bytes, component, "VEC4", 1);
            f.set(&format!("/accessors/{accessor}/normalized"), json!(true));
            json!({"ROTATION": accessor})
        });
        let node = DMat4::from_translation(DVec3::Y * 5.0) * DMat4::from_scale(DVec3::splat(3.0));
        let truth = node * DMat4::from_rotation_z(std::f64::consts::FRAC_PI_3);
        // The angle has an error of at most one step, three times that after the node's scale.
        assert_close(loaded(&fixture).instances[0].world_from_model, truth, 3.0 * step);
    }
}

#[test]
fn instances_move_with_their_node() {
    let mut fixture = instanced(|f| json!({"TRANSLATION": f.floats(3, &PLACES)}));
    let times = fixture.floats(1, &[0.0, 2.0]);
    let ways = fixture.floats(3, &[0.0, 5.0, 0.0, 10.0, 5.0, 0.0]);
    fixture.push(
        "animations",
        json!({"samplers": [{"input": times, "output": ways}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}),
    );
    let mut scene = loaded(&fixture);
    let rest = scene.instances.clone();
    scene.pose(Some(0), 1.0).expect("it can be posed");
    for (moved, rest) in scene.instances.iter().zip(&rest) {
        let truth = DMat4::from_translation(DVec3::X * 5.0) * rest.world_from_model;
        assert_close(moved.world_from_model, truth, 1e-12);
        assert!((moved.bounds.min - rest.bounds.min - DVec3::X * 5.0).length() < 1e-6);
    }
    scene.pose(None, 0.0).expect("it can be posed");
    assert_eq!(scene.instances, rest);
}

#[test]
fn broken_instances_are_errors() {
    let wrong = |attributes: &dyn Fn(&mut Fixture) -> Value, word: &str| {
        let error = instanced(attributes).error();
        assert!(error.contains("node 0 \"only\": EXT_mesh_gpu_instancing") && error.contains(word), "{word}: {error}");
    };
    wrong(
        &|f| json!({"TRANSLATION": f.floats(3, &PLACES), "SCALE": f.floats(3, &[1.0; 9])}),
        "its attributes have different lengths",
    );
    let none = |f: &mut Fixture| json!({"SCALE": f.push("accessors", json!({"componentType": 5126, "type": "VEC3", "count": 0}))});
    wrong(&none, "holds no elements");
    wrong(&|f| json!({"ROTATION": f.floats(4, &[0.0; 4])}), "the rotation of instance 0 has no length");
    wrong(&|f| json!({"SCALE": f.floats(3, &[1.0, f32::NAN, 1.0])}), "the transform of instance 0 is not finite");
    wrong(&|_| json!({"TRANSLATION": 99}), "accessor 99");
    wrong(&|_| json!({"TRANSLATION": "no"}), "its TRANSLATION is not an accessor index");
    wrong(&|f| json!({"TRANSLATION": f.floats(4, &[0.0; 4])}), "has 4 components, not 3");
}

/// A hidden parent hides its children and their lights, regardless of their own visibility; cameras and node transforms
/// stay.
#[test]
fn hidden_nodes_hide_what_is_below_them() {
    let mut fixture = Fixture::triangle();
    let hides = |visible: bool| json!({"KHR_node_visibility": {"visible": visible}});
    let mut hidden_light = hides(false);
    hidden_light["KHR_lights_punctual"] = json!({"light": 0});
    fixture.json["nodes"] = json!([
        {"children": [1, 2], "extensions": hides(false), "translation": [1, 0, 0]},
        {"mesh": 0, "name": "child", "extensions": hides(true)},
        {"name": "between", "children": [3]},
        {"camera": 0, "mesh": 0, "name": "grandchild", "extensions": {"KHR_lights_punctual": {"light": 0}}},
        {"mesh": 0, "name": "shown", "extensions": hides(true)},
        {"extensions": hidden_light},
        {"mesh": 0, "name": "plain", "extensions": {"KHR_node_visibility": {}}},
    ]);
    fixture.set("/scenes/0/nodes", json!([0, 4, 5, 6]));
    fixture.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "point"}]}});
    fixture.push("cameras", json!({"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}));
    fixture.json["extensionsUsed"] = json!(["KHR_node_visibility", "KHR_lights_punctual"]);
    let scene = loaded(&fixture);
    let drawn: Vec<&str> = scene.instances.iter().map(|instance| instance.name.as_str()).collect();
    assert_eq!(drawn, ["shown", "plain"]);
    assert!(scene.lights.is_empty(), "{:?}", scene.lights);
    assert_eq!(scene.cameras[0].eye, DVec3::X);
}
