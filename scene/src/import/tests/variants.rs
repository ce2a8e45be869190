//! KHR_materials_variants.

use std::path::Path;

use serde_json::json;

use super::fixture::Fixture;
use crate::error::SceneError;
use crate::import::load_bytes_with;
use crate::progress::silent;
use crate::{LoadOptions, Scene};

/// Three primitives with material 0. The first maps the variants `day` and `dusk` to 1 and `night` to 2, the second
/// `night` to 3, the third none.
fn shoe() -> Fixture {
    let mut fixture = Fixture::triangle();
    for roughness in [0.0, 0.25, 0.5, 0.75] {
        fixture.push("materials", json!({"pbrMetallicRoughness": {"roughnessFactor": roughness}}));
    }
    let primitive = fixture.json["meshes"][0]["primitives"][0].clone();
    fixture.json["meshes"][0]["primitives"] = json!([]);
    let mapping = |material: usize, variants: &[usize]| json!({"material": material, "variants": variants});
    for mappings in [json!([mapping(1, &[0, 1]), mapping(2, &[2])]), json!([mapping(3, &[2])]), json!(null)] {
        let mut next = primitive.clone();
        next["material"] = json!(0);
        if mappings.is_array() {
            next["extensions"] = json!({"KHR_materials_variants": {"mappings": mappings}});
        }
        fixture.primitive(next);
    }
    let names = json!([{"name": "day"}, {"name": "dusk"}, {"name": "night"}]);
    fixture.json["extensions"] = json!({"KHR_materials_variants": {"variants": names}});
    fixture.json["extensionsUsed"] = json!(["KHR_materials_variants"]);
    fixture
}

fn load(fixture: &Fixture, variant: Option<&str>) -> Result<Scene, SceneError> {
    let options = LoadOptions { variant: variant.map(Into::into), ..LoadOptions::default() };
    load_bytes_with(Path::new("shoe.glb"), &fixture.glb(), &options, &mut silent)
}

/// Returns the roughness of each instance, which identifies materials.
fn roughnesses(fixture: &Fixture, variant: Option<&str>) -> Vec<f32> {
    let scene = load(fixture, variant).expect("it is sound");
    assert_eq!(scene.variants, ["day", "dusk", "night"]);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    scene.instances.iter().map(|instance| scene.materials[instance.material.index()].roughness).collect()
}

#[test]
fn a_variant_changes_the_primitives_that_map_it() {
    let fixture = shoe();
    for (variant, truth) in [
        (None, [0.0, 0.0, 0.0]),
        (Some("day"), [0.25, 0.0, 0.0]),
        (Some("dusk"), [0.25, 0.0, 0.0]),
        (Some("night"), [0.5, 0.75, 0.0]),
    ] {
        assert_eq!(roughnesses(&fixture, variant), truth, "{variant:?}");
    }
    // Only used materials are read.
    assert_eq!(load(&fixture, Some("night")).expect("it is sound").materials.len(), 3);
}

/// A primitive without a material gets that of the variant; both materials share one geometry.
#[test]
fn variants_replace_the_default_material_too() {
    let mut fixture = shoe();
    fixture.json["meshes"][0]["primitives"][0].as_object_mut().expect("a primitive").remove("material");
    assert_eq!(roughnesses(&fixture, Some("night")), [0.5, 0.75, 0.0]);
    assert_eq!(roughnesses(&fixture, None), [1.0, 0.0, 0.0]);
    assert_eq!(load(&fixture, None).expect("it is sound").meshes.len(), 1);
}

#[test]
fn unknown_variants_and_broken_mappings_are_errors() {
    let error =
        |fixture: &Fixture, variant: &str| load(fixture, Some(variant)).expect_err("no such variant").to_string();
    let text = error(&shoe(), "Night");
    assert_eq!(text, "shoe.glb: it has no material variant \"Night\" (its variants: day, dusk, night)");
    let text = error(&Fixture::triangle(), "day");
    assert_eq!(text, "shoe.glb: it has no material variant \"day\" (its variants: none)");
    let mut fixture = shoe();
    let mapping = "/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/1/material";
    fixture.set(mapping, json!(9));
    assert!(error(&fixture, "night").contains("mesh 0 primitive 0: names material 9, but there are 4"));
    fixture.set(mapping, json!("gold"));
    assert!(error(&fixture, "night").contains("mesh 0 primitive 0: KHR_materials_variants: a mapping has no index"));
    // The other variants do not need it.
    assert!(load(&fixture, Some("day")).is_ok());
}

#[test]
fn built_in_scenes_have_no_variants() {
    let options = LoadOptions { variant: Some("day".into()), ..LoadOptions::default() };
    let error = Scene::open_with("spheres", &options, &mut silent).expect_err("it has none").to_string();
    assert!(error.contains("spheres") && error.contains("no material variant \"day\" (its variants: none)"), "{error}");
}
