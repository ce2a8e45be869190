//! The member `framegraph` of `extras`.

use serde_json::{Value, json};

use glam::Vec3;

use super::fixture::Fixture;
use crate::material::{AlphaMode, Lobe, Lobes, Material, Subsurface};
use crate::{Scene, SunHalo};

/// Loads a triangle whose material has these extensions and extras.
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
fn materials_may_scatter_light_as_filaments_do() {
    let given = json!({"color": [0.5, 0.25, 1], "power": 3, "thickness": 0.75});
    let scene = load(json!({}), json!({"framegraph": {"subsurface": given, "clothSubsurface": [0.25, 0, 1]}}));
    let expected = Subsurface { color: Vec3::new(0.5, 0.25, 1.0), power: 3.0, thickness: 0.75 };
    let material = &scene.materials[0];
    assert_eq!((material.subsurface, material.cloth_subsurface), (Some(expected), Some(Vec3::new(0.25, 0.0, 1.0))));
    assert_eq!(material.lobes(), Lobes::NONE.with(Lobe::Subsurface).with(Lobe::ClothSubsurface));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    let usual = load(json!({}), json!({"framegraph": {"subsurface": {}}}));
    assert_eq!(usual.materials[0].subsurface, Some(Subsurface::default()));
}

#[test]
fn a_shadow_catcher_is_unlit_and_blended() {
    let scene = load(json!({}), json!({"framegraph": {"shadowCatcher": 0.5}}));
    let Material { shadow_catcher, unlit, alpha, .. } = scene.materials[0];
    assert_eq!((shadow_catcher, unlit, alpha), (Some(0.5), true, AlphaMode::Blend));
}

#[test]
fn lights_state_their_shadows_and_halos() {
    let with = |extras: Value| {
        let mut fixture = Fixture::triangle();
        let light = json!({"type": "directional", "extras": {"framegraph": extras}});
        fixture.set("/extensions", json!({"KHR_lights_punctual": {"lights": [light]}}));
        fixture.set("/nodes/0/extensions", json!({"KHR_lights_punctual": {"light": 0}}));
        fixture.load().expect("a light")
    };
    let given = with(json!({"shadowStrength": 0.25, "sunHalo": {"size": 4, "falloff": 2.5}}));
    let light = &given.lights[0];
    assert_eq!((light.shadow_strength, light.halo), (0.25, Some(SunHalo { size: 4.0, falloff: 2.5 })));
    assert!(given.warnings.is_empty(), "{:?}", given.warnings);
    assert_eq!(with(json!({"sunHalo": {}})).lights[0].halo, Some(SunHalo::FILAMENT));
    let wrong = with(json!({"shadowStrength": 7, "sunHalo": {"size": "wide"}}));
    assert_eq!((wrong.lights[0].shadow_strength, wrong.lights[0].halo), (1.0, Some(SunHalo::FILAMENT)));
    let warning = "light 0: extras.framegraph.shadowStrength and one other place: 2 switches are unknown or out of range; they are ignored";
    assert!(wrong.warnings.iter().any(|own| own.ends_with(warning)), "{:?}", wrong.warnings);
}

#[test]
fn wrong_values_are_warnings_that_name_their_place() {
    for (extras, place) in [
        (json!({"framegraph": 3}), "extras.framegraph"),
        (json!({"framegraph": {"subsurface": {"power": -1}}}), "extras.framegraph.subsurface.power"),
        (json!({"framegraph": {"subsurface": 3}}), "extras.framegraph.subsurface"),
        (json!({"framegraph": {"clothSubsurface": [1, 2]}}), "extras.framegraph.clothSubsurface"),
        (json!({"framegraph": {"clearCoatIorChange": 0}}), "extras.framegraph.clearCoatIorChange"),
        (json!({"framegraph": {"unheardOf": 0}}), "extras.framegraph.unheardOf"),
    ] {
        let expected =
            format!("dir/fixture.glb: material 0: {place}: 1 switches are unknown or out of range; they are ignored");
        assert_eq!(load(json!({}), extras).warnings, [expected]);
    }
}
