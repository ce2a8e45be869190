//! Lights and cameras on moving nodes.

use glam::{DVec3, Vec3};
use serde_json::json;

use super::fixture::Fixture;
use crate::Scene;
use crate::light::LightKind;

const QUARTER: f32 = std::f32::consts::FRAC_1_SQRT_2;

/// A parent that moves along x and rotates about y by 90° in a second. Below it are a point light 1 above, a spot light
/// 2 above, a sun, and a camera 3 above; another light is static.
fn carousel() -> Fixture {
    let mut fixture = Fixture::triangle();
    let light = |index: usize| json!({"KHR_lights_punctual": {"light": index}});
    fixture.json["nodes"] = json!([
        {"children": [1, 2, 3, 4]},
        {"translation": [0, 1, 0], "extensions": light(0)},
        {"translation": [0, 2, 0], "extensions": light(1)},
        {"extensions": light(2)},
        {"translation": [0, 3, 0], "camera": 0},
        {"translation": [9, 9, 9], "mesh": 0, "extensions": light(0)},
    ]);
    fixture.set("/scenes/0/nodes", json!([0, 5]));
    fixture.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [
        {"type": "point", "name": "bulb", "intensity": 5.0},
        {"type": "spot", "spot": {}, "name": "beam"},
        {"type": "directional", "name": "sun"},
    ]}});
    fixture.push("cameras", json!({"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}));
    let times = fixture.floats(1, &[0.0, 1.0]);
    let ways = fixture.floats(3, &[0.0, 0.0, 0.0, 4.0, 0.0, 0.0]);
    let turns = fixture.floats(4, &[0.0, 0.0, 0.0, 1.0, 0.0, QUARTER, 0.0, QUARTER]);
    fixture.push(
        "animations",
        json!({"samplers": [{"input": times, "output": ways}, {"input": times, "output": turns}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}},
                {"sampler": 1, "target": {"node": 0, "path": "rotation"}}]}),
    );
    fixture
}

fn light<'a>(scene: &'a Scene, name: &str, near: DVec3) -> &'a crate::Light {
    let found = scene.lights.iter().filter(|light| light.name == name);
    found.min_by(|a, b| a.position.distance(near).total_cmp(&b.position.distance(near))).expect("there is one")
}

#[track_caller]
fn near(a: DVec3, b: DVec3) {
    assert!((a - b).length() < 1e-6, "{a} {b}");
}

/// A quarter turn about y maps −z to −x. Angles of f32 quaternions are accurate to 1e-7.
fn check_moved(scene: &Scene, moved: f64, forward: Vec3) {
    let along = |a: Vec3| assert!((a - forward).length() < 1e-6, "{a} {forward}");
    near(light(scene, "bulb", DVec3::ZERO).position, DVec3::new(moved, 1.0, 0.0));
    let beam = light(scene, "beam", DVec3::ZERO);
    near(beam.position, DVec3::new(moved, 2.0, 0.0));
    along(beam.direction);
    let sun = light(scene, "sun", DVec3::ZERO);
    assert_eq!(sun.position, DVec3::ZERO, "parallel light has none");
    along(sun.direction);
    near(scene.cameras[0].eye, DVec3::new(moved, 3.0, 0.0));
    along(scene.cameras[0].forward().as_vec3());
    near(light(scene, "bulb", DVec3::splat(9.0)).position, DVec3::splat(9.0));
}

#[test]
fn lights_and_cameras_move_with_their_nodes() {
    let mut scene = carousel().load().expect("it is sound");
    let rest = scene.clone();
    check_moved(&scene, 0.0, Vec3::NEG_Z);
    let half = Vec3::new(-QUARTER, 0.0, -QUARTER);
    for (time_s, moved, forward) in [(0.5, 2.0, half), (1.0, 4.0, Vec3::NEG_X), (7.0, 4.0, Vec3::NEG_X)] {
        scene.pose(Some(0), time_s).expect("it can be posed");
        check_moved(&scene, moved, forward);
    }
    scene.pose(None, 0.0).expect("it can be posed");
    assert_eq!((&scene.lights, &scene.cameras), (&rest.lights, &rest.cameras));
}

/// Applications remove lights of a scene and add their own, which no node moves.
#[test]
fn lights_that_are_left_still_move() {
    let mut scene = carousel().load().expect("it is sound");
    scene.lights.retain(|light| matches!(light.kind, LightKind::Spot { .. }));
    let own = crate::Light::directional("own", Vec3::NEG_Y, 7.0);
    scene.lights.insert(0, own.clone());
    scene.pose(Some(0), 1.0).expect("it can be posed");
    assert_eq!(scene.lights.len(), 2);
    assert_eq!(scene.lights[0], own);
    near(scene.lights[1].position, DVec3::new(4.0, 2.0, 0.0));
    assert!((scene.lights[1].direction - Vec3::NEG_X).length() < 1e-6);
}
