//! The member `framegraph` of `extras`.

use serde_json::{Value, json};

use super::fixture::Fixture;
use crate::Scene;

/// A triangle whose material has these extensions and extras.
fn load(extensions: Value, extras: Value) -> Scene {
    let mut fixture = Fixture::triangle();
    fixture.push("materials", json!({"extensions": extensions, "extras": extras}));
    fixture.set("/meshes/0/primitives/0/material", json!(0));
    fixture.load().expect("extras never make a file unreadable")
}

#[test]
fn the_coat_of_a_material_may_keep_the_reflectance_of_its_base() {
    let coat = json!({"KHR_materials_clearcoat": {"clearcoatFactor": 1.0}});
    for (extras, keeps) in [
        (json!({"framegraph": {"clearCoatIorChange": false}}), true),
        (json!({"framegraph": {"clearCoatIorChange": true}}), false),
        (json!({"other": {"clearCoatIorChange": false}}), false),
        (json!(3), false),
    ] {
        let scene = load(coat.clone(), extras.clone());
        assert_eq!(scene.materials[0].clear_coat.map(|coat| coat.keeps_base_f0), Some(keeps), "{extras}");
        assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    }
    let bare = load(json!({}), json!({"framegraph": {"clearCoatIorChange": false}}));
    assert_eq!(bare.materials[0].clear_coat, None);
}

#[test]
fn wrong_values_are_warnings_that_name_their_place() {
    for (extras, expected) in [
        (json!({"framegraph": 3}), "dir/fixture.glb: material 0: extras.framegraph is no object; it is ignored"),
        (
            json!({"framegraph": {"clearCoatIorChange": 0}}),
            "dir/fixture.glb: material 0: extras.framegraph.clearCoatIorChange is no boolean; it is ignored",
        ),
    ] {
        assert_eq!(load(json!({}), extras).warnings, [expected]);
    }
}
