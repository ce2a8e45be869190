//! Properties of lights and cameras.

use glam::{DVec3, Vec3};
use serde_json::json;

use super::super::fixture::Fixture;
use super::{animate, loaded, posed};
use crate::camera::Projection;
use crate::light::LightKind;

/// A spot, a point and a directional light; nodes 1 and 2 share the spot light. A camera of each kind.
fn lit() -> Fixture {
    let mut fixture = Fixture::triangle();
    let light = |index: usize, x: f32| json!({"translation": [x, 0.0, 0.0], "extensions": {"KHR_lights_punctual": {"light": index}}});
    for node in [light(0, 1.0), light(0, 2.0), light(1, 3.0), light(2, 4.0), json!({"camera": 0}), json!({"camera": 1})]
    {
        let index = fixture.push("nodes", node);
        fixture.json["scenes"][0]["nodes"].as_array_mut().expect("a list").push(json!(index));
    }
    let spot = json!({"innerConeAngle": 0.25, "outerConeAngle": 0.5});
    fixture.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [
        {"type": "spot", "spot": spot, "intensity": 10.0, "range": 9.0, "color": [1.0, 0.5, 0.25]},
        {"type": "point", "intensity": 20.0},
        {"type": "directional", "intensity": 30.0},
    ]}});
    fixture.push("cameras", json!({"type": "perspective", "perspective": {"yfov": 1.0, "znear": 1.0, "zfar": 3.0}}));
    let orthographic = json!({"xmag": 2.0, "ymag": 1.0, "znear": 1.0, "zfar": 3.0});
    fixture.push("cameras", json!({"type": "orthographic", "orthographic": orthographic}));
    fixture
}

const LIGHTS: &str = "/extensions/KHR_lights_punctual/lights";

fn spot(kind: &mut LightKind) -> [&mut f32; 4] {
    let LightKind::Spot { intensity_candela, range_m, inner_cone_rad, outer_cone_rad } = kind else {
        panic!("{kind:?} is no spot")
    };
    [intensity_candela, range_m.as_mut().expect("it has one"), inner_cone_rad, outer_cone_rad]
}

/// Between keys at 0 s and 2 s, other properties are at rest, for both nodes that share the light.
#[test]
fn every_property_of_lights() {
    type Row = (&'static str, [&'static [f32]; 2], fn(&mut [crate::Light]));
    let rows: [Row; 7] = [
        ("0/color", [&[0.0, 1.0, 2.0], &[1.0, 1.0, 0.0]], |all| {
            all[..2].iter_mut().for_each(|light| light.color = Vec3::new(0.5, 1.0, 1.0));
        }),
        ("0/intensity", [&[0.0], &[8.0]], |all| all[..2].iter_mut().for_each(|l| *spot(&mut l.kind)[0] = 4.0)),
        ("0/range", [&[1.0], &[2.0]], |all| all[..2].iter_mut().for_each(|l| *spot(&mut l.kind)[1] = 1.5)),
        ("0/spot/innerConeAngle", [&[0.0], &[0.25]], |all| {
            all[..2].iter_mut().for_each(|light| *spot(&mut light.kind)[2] = 0.125);
        }),
        ("0/spot/outerConeAngle", [&[0.5], &[1.0]], |all| {
            all[..2].iter_mut().for_each(|light| *spot(&mut light.kind)[3] = 0.75);
        }),
        ("1/intensity", [&[0.0], &[8.0]], |all| {
            all[2].kind = LightKind::Point { intensity_candela: 4.0, range_m: None };
        }),
        ("2/intensity", [&[0.0], &[8.0]], |all| {
            all[3].kind = LightKind::Directional { illuminance_lux: 4.0, angular_radius_rad: 0.0 };
        }),
    ];
    for (pointer, keys, set) in rows {
        let mut fixture = lit();
        animate(&mut fixture, &format!("{LIGHTS}/{pointer}"), keys);
        let rest = loaded(&fixture);
        assert_eq!(rest.lights.len(), 4);
        let mut truth = rest.lights.clone();
        set(&mut truth);
        let mut scene = posed(&fixture, 1.0);
        assert_eq!(scene.lights, truth, "{pointer}");
        assert_ne!(scene.lights, rest.lights, "{pointer}");
        scene.pose(None, 0.0).expect("it can be posed");
        assert_eq!(scene.lights, rest.lights, "{pointer}");
    }
}

/// Moving lights that pointers animate, some of which the application removed.
#[test]
fn lights_that_are_left_still_change() {
    let mut fixture = lit();
    animate(&mut fixture, &format!("{LIGHTS}/1/intensity"), [&[0.0], &[8.0]]);
    animate(&mut fixture, "/nodes/3/translation", [&[0.0, 0.0, 0.0], &[0.0, 6.0, 0.0]]);
    let mut scene = loaded(&fixture);
    scene.lights.retain(|light| matches!(light.kind, LightKind::Point { .. }));
    scene.pose(Some(0), 1.0).expect("it can be posed");
    assert_eq!(scene.lights.len(), 1);
    assert_eq!(scene.lights[0].kind, LightKind::Point { intensity_candela: 4.0, range_m: None });
    assert_eq!(scene.lights[0].position, DVec3::new(0.0, 3.0, 0.0));
}

/// Both angles grow beyond the outer one at rest, in either channel order.
#[test]
fn cone_angles_may_grow_together() {
    let channels: [(&str, [&[f32]; 2]); 2] =
        [("innerConeAngle", [&[0.5], &[1.0]]), ("outerConeAngle", [&[1.0], &[1.5]])];
    for order in [[0, 1], [1, 0]] {
        let mut fixture = lit();
        for (name, keys) in order.map(|i| channels[i]) {
            animate(&mut fixture, &format!("{LIGHTS}/0/spot/{name}"), keys);
        }
        let mut scene = posed(&fixture, 1.0);
        assert_eq!(spot(&mut scene.lights[0].kind).map(|value| *value)[2..], [0.75, 1.25], "{order:?}");
    }
    // An inner angle beyond the outer one is clamped.
    let mut fixture = lit();
    animate(&mut fixture, &format!("{LIGHTS}/0/spot/innerConeAngle"), [&[1.0], &[1.0]]);
    let mut scene = posed(&fixture, 1.0);
    let [_, _, inner, outer] = spot(&mut scene.lights[0].kind).map(|value| *value);
    assert!(outer == 0.5 && inner < outer && inner > 0.49, "{inner} {outer}");
}

#[test]
fn every_property_of_cameras() {
    let perspective = |fov_y_rad, near_m, far_m| Projection::Perspective { fov_y_rad, near_m, far_m: Some(far_m) };
    let orthographic = |width, half_height_m, near_m, far_m| Projection::Orthographic {
        half_width_m: Some(width),
        half_height_m,
        near_m,
        far_m,
    };
    let rows: [(usize, &str, [f32; 2], Projection); 7] = [
        (0, "perspective/yfov", [0.5, 1.0], perspective(0.75, 1.0, 3.0)),
        (0, "perspective/znear", [1.0, 2.0], perspective(1.0, 1.5, 3.0)),
        (0, "perspective/zfar", [3.0, 9.0], perspective(1.0, 1.0, 6.0)),
        (1, "orthographic/xmag", [3.0, 4.0], orthographic(3.5, 1.0, 1.0, 3.0)),
        (1, "orthographic/ymag", [3.0, 4.0], orthographic(2.0, 3.5, 1.0, 3.0)),
        (1, "orthographic/znear", [0.0, 1.0], orthographic(2.0, 1.0, 0.5, 3.0)),
        (1, "orthographic/zfar", [3.0, 9.0], orthographic(2.0, 1.0, 1.0, 6.0)),
    ];
    for (camera, property, [from, to], truth) in rows {
        let mut fixture = lit();
        animate(&mut fixture, &format!("/cameras/{camera}/{property}"), [&[from], &[to]]);
        let rest = loaded(&fixture);
        let mut scene = posed(&fixture, 1.0);
        assert_eq!(scene.cameras[camera].projection, truth, "{property}");
        assert_eq!(scene.cameras[1 - camera], rest.cameras[1 - camera], "{property}");
        scene.pose(None, 0.0).expect("it can be posed");
        assert_eq!(scene.cameras, rest.cameras, "{property}");
    }
}

/// Both planes move beyond the other's rest position; a static plane limits the other.
#[test]
fn planes_may_move_together() {
    let channels: [(&str, [f32; 2]); 2] = [("znear", [4.0, 6.0]), ("zfar", [8.0, 12.0])];
    for order in [[0, 1], [1, 0]] {
        let mut fixture = lit();
        for (name, [from, to]) in order.map(|i| channels[i]) {
            animate(&mut fixture, &format!("/cameras/0/perspective/{name}"), [&[from], &[to]]);
        }
        let truth = Projection::Perspective { fov_y_rad: 1.0, near_m: 5.0, far_m: Some(10.0) };
        assert_eq!(posed(&fixture, 1.0).cameras[0].projection, truth, "{order:?}");
    }
    for (name, value) in [("znear", 5.0), ("zfar", 0.5), ("yfov", 4.0), ("yfov", -1.0)] {
        let mut fixture = lit();
        animate(&mut fixture, &format!("/cameras/0/perspective/{name}"), [&[value], &[value]]);
        let scene = posed(&fixture, 1.0);
        assert_eq!(scene.cameras, loaded(&fixture).cameras, "{name}");
    }
}
