//! Animations, skins and morph targets of generated files, with known results.

use super::fixture::Fixture;
use crate::Scene;
use glam::{DVec3, Vec3};
use serde_json::json;

const QUARTER: f32 = std::f32::consts::FRAC_1_SQRT_2;

/// A triangle on a child node; animation 0 moves the parent along x and rotates the child about z.
fn hierarchy() -> Fixture {
    let mut fixture = Fixture::triangle();
    fixture.set("/scenes/0/nodes", json!([1]));
    fixture.push("nodes", json!({"children": [0], "translation": [0, 5, 0]}));
    let times = fixture.floats(1, &[1.0, 3.0]);
    let ways = fixture.floats(3, &[0.0, 5.0, 0.0, 4.0, 5.0, 0.0]);
    let turns = fixture.floats(4, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, QUARTER, QUARTER]);
    fixture.push(
        "animations",
        json!({"name": "go", "samplers": [{"input": times, "output": ways}, {"input": times, "output": turns}],
            "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}},
                {"sampler": 1, "target": {"node": 0, "path": "rotation"}}]}),
    );
    fixture
}

fn loaded(fixture: &Fixture) -> Scene {
    fixture.load().expect("it is sound")
}

fn posed(fixture: &Fixture, time_s: f64) -> Scene {
    let mut scene = loaded(fixture);
    scene.pose(Some(0), time_s).expect("it can be posed");
    assert_eq!(scene.check(), Ok(()));
    scene
}

#[test]
fn nodes_move_with_their_parents() {
    let fixture = hierarchy();
    assert_eq!(loaded(&fixture).motion.animations[0].duration_s(), 3.0);
    // A corner of the triangle at (1, 0, 0), moved halfway and rotated by 45°, and at the end by 90°.
    let half = std::f64::consts::FRAC_1_SQRT_2;
    for (time_s, place) in [(0.0, [1.0, 5.0]), (2.0, [2.0 + half, 5.0 + half]), (3.0, [4.0, 6.0]), (9.0, [4.0, 6.0])] {
        let corner = posed(&fixture, time_s).instances[0].world_from_model.transform_point3(DVec3::X);
        assert!((corner - DVec3::new(place[0], place[1], 0.0)).length() < 1e-6, "{time_s} s: {corner}");
    }
}

/// Step-interpolated weights of two targets; the displacements of both are added.
#[test]
fn morph_targets_add_what_their_weights_say() {
    let mut fixture = Fixture::triangle();
    let up = fixture.floats(3, &[0.0, 0.0, 1.0].repeat(3));
    let aside = fixture.floats(3, &[2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    fixture.set("/meshes/0/primitives/0/targets", json!([{"POSITION": up}, {"POSITION": aside}]));
    fixture.set("/meshes/0/weights", json!([0.5, 0.0]));
    let times = fixture.floats(1, &[0.0, 1.0]);
    let weights = fixture.floats(1, &[0.0, 1.0, 0.25, 0.5]);
    fixture.push(
        "animations",
        json!({"samplers": [{"input": times, "output": weights, "interpolation": "STEP"}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}]}),
    );
    let first = |scene: &Scene| scene.meshes[0].positions[0];
    assert_eq!(first(&loaded(&fixture)), Vec3::new(0.0, 0.0, 0.5), "at rest, by the mesh's own weights");
    assert_eq!(first(&posed(&fixture, 0.9)), Vec3::new(2.0, 0.0, 0.0));
    assert_eq!(first(&posed(&fixture, 1.0)), Vec3::new(1.0, 0.0, 0.25));
}

/// A triangle whose corners follow the first joint, the second, and both equally; the second is moved and rotated. The
/// node's own transform is ignored.
fn skinned(weights: [f32; 12], joints: [u16; 12]) -> Fixture {
    let mut fixture = Fixture::triangle();
    let weights = fixture.floats(4, &weights);
    let bytes: Vec<u8> = joints.iter().flat_map(|joint| joint.to_le_bytes()).collect();
    let joints = fixture.array(&bytes, 5123, "VEC4", 3);
    fixture.set("/meshes/0/primitives/0/attributes/JOINTS_0", json!(joints));
    fixture.set("/meshes/0/primitives/0/attributes/WEIGHTS_0", json!(weights));
    fixture.set("/scenes/0/nodes", json!([0, 1, 2]));
    fixture.set("/nodes/0/translation", json!([100, 0, 0]));
    fixture.set("/nodes/0/skin", json!(0));
    fixture.push("nodes", json!({"translation": [0, 0, 0]}));
    fixture.push("nodes", json!({"translation": [0, 0, 2], "rotation": [0, 0, 1, 0]}));
    fixture.push("skins", json!({"joints": [1, 2]}));
    fixture
}

const SHARES: [f32; 12] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.5, 0.5, 0.0, 0.0];
const OWNERS: [u16; 12] = [0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0];

#[test]
fn skins_bend_by_their_joints() {
    let scene = loaded(&skinned(SHARES, OWNERS));
    let instance = &scene.instances[0];
    let place =
        |vertex: usize| instance.world_from_model.transform_point3(scene.meshes[0].positions[vertex].as_dvec3());
    // (1, 0, 0) rotated by 180° about z and raised by 2; (0, 1, 0) halfway between itself and (0, -1, 2).
    for (vertex, truth) in [(0, DVec3::ZERO), (1, DVec3::new(-1.0, 0.0, 2.0)), (2, DVec3::new(0.0, 0.0, 1.0))] {
        assert!((place(vertex) - truth).length() < 1e-6, "{vertex}: {}", place(vertex));
    }
    assert!((instance.bounds.min - DVec3::new(-1.0, 0.0, 0.0)).length() < 1e-6, "{:?}", instance.bounds);
    assert_eq!(scene.check(), Ok(()));
}

#[test]
fn what_is_wrong_is_named_with_animation_and_channel() {
    let changed = |change: &dyn Fn(&mut Fixture)| {
        let mut fixture = hierarchy();
        change(&mut fixture);
        fixture
    };
    let named = |text: &str, words: &[&str]| assert!(words.iter().all(|word| text.contains(word)), "{words:?}: {text}");
    // Channels with invalid keys are skipped.
    let left_out = |change: &dyn Fn(&mut Fixture), words: &[&str]| {
        let fixture = changed(change);
        named(&fixture.warnings(), words);
        let channels = loaded(&fixture).motion.animations[0].channels.len();
        assert_eq!(channels, 1, "{words:?}");
    };
    let input = |times: &'static [f32]| {
        move |fixture: &mut Fixture| {
            let accessor = fixture.floats(1, times);
            _ = fixture.set("/animations/0/samplers/1/input", json!(accessor));
        }
    };
    left_out(&input(&[0.0, f32::NAN]), &["animation 0 channel 1", "time of key 1 is NaN"]);
    let empty = |f: &mut Fixture| {
        let accessor = f.push("accessors", json!({"componentType": 5126, "type": "SCALAR", "count": 0}));
        _ = f.set("/animations/0/samplers/1/input", json!(accessor));
    };
    left_out(&empty, &["animation 0 channel 1", "no keys"]);
    left_out(&input(&[2.0, 1.0]), &["animation 0 channel 1", "key 1 is at 1 s, not after"]);
    left_out(&input(&[0.0, 1.0, 2.0]), &["animation 0 channel 1", "8 numbers", "need 12"]);
    left_out(
        &|f| _ = f.set("/animations/0/channels/0/target/path", json!("weights")),
        &["animation 0 channel 0", "no keys"],
    );
    let wrong = |change: &dyn Fn(&mut Fixture), words: &[&str]| named(&changed(change).error(), words);
    wrong(&|f| _ = f.set("/animations/0/channels/0/sampler", json!(9)), &["animation 0 channel 0", "sampler 9"]);
    wrong(&|f| _ = f.set("/animations/0/channels/0/target/node", json!(9)), &["animation 0 channel 0", "node 9"]);
    wrong(&|f| _ = f.set("/animations/0/samplers/0/output", json!(99)), &["animation 0 channel 0", "accessor 99"]);
    let mut owners = OWNERS;
    owners[4] = 7;
    assert!(skinned(SHARES, owners).error().contains("vertex 1 of its mesh follows joint 7"));
    for (joints, named) in [(json!([]), "skin 0: it has no joints"), (json!([9]), "skin 0: names node 9")] {
        let mut fixture = skinned(SHARES, OWNERS);
        fixture.set("/skins/0/joints", joints);
        assert!(fixture.error().contains(named), "{}", fixture.error());
    }
    let mut scene = loaded(&hierarchy());
    assert!(scene.pose(Some(3), 0.0).is_err_and(|told| told.to_string().contains("animation 3: there are 1")));
}

/// Neither an animation nor a joint at rest may move the scene beyond the range in which f32 squares are finite.
#[test]
fn poses_stay_within_the_largest_coordinate() {
    let mut fixture = hierarchy();
    let ways = fixture.floats(3, &[0.0, 5.0, 0.0, 4e18, 5.0, 0.0]);
    fixture.set("/animations/0/samplers/0/output", json!(ways));
    let mut scene = loaded(&fixture);
    assert!(scene.pose(Some(0), 1.1).is_ok());
    let told = scene.pose(Some(0), 3.0).expect_err("it is too far").to_string();
    assert!(told.contains("animation 0 \"go\": at 3 s instance \"only\" is more than 1e18 m"), "{told}");
    let mut far = skinned(SHARES, OWNERS);
    far.set("/nodes/2/translation", json!([0, 0, 4e18]));
    assert!(far.error().contains("at rest: at 0 s instance \"only\" is more than 1e18 m"), "{}", far.error());
}
