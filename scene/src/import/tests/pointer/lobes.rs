//! Lobes that are disabled at rest and enabled later.

use serde_json::{Value, json};

use super::{animate, loaded, posed, with_material};
use crate::material::{Lobe, Material};

/// Returns a material with one disabled extension, and textures that become visible once it is enabled.
fn off(name: &str, extension: Value) -> Value {
    json!({"extensions": {name: extension}})
}

/// A disabled extension, one of its properties with two keys, its lobe, and the property's value, −1 without the lobe.
type Row = (&'static str, Value, &'static str, [&'static [f32]; 2], Lobe, fn(&Material) -> f32);

#[test]
fn a_lobe_that_a_pointer_turns_on_is_kept() {
    let texture = json!({"index": 0});
    let rows: [Row; 7] = [
        (
            "KHR_materials_clearcoat",
            json!({"clearcoatTexture": texture, "clearcoatRoughnessFactor": 0.5}),
            "clearcoatFactor",
            [&[0.0], &[1.0]],
            Lobe::ClearCoat,
            |m| m.clear_coat.map_or(-1.0, |lobe| lobe.factor),
        ),
        (
            "KHR_materials_sheen",
            json!({"sheenColorTexture": texture, "sheenRoughnessFactor": 0.5}),
            "sheenColorFactor",
            [&[0.0; 3], &[1.0; 3]],
            Lobe::Sheen,
            |m| m.sheen.map_or(-1.0, |lobe| lobe.color.y),
        ),
        (
            "KHR_materials_anisotropy",
            json!({"anisotropyTexture": texture}),
            "anisotropyStrength",
            [&[0.0], &[1.0]],
            Lobe::Anisotropy,
            |m| m.anisotropy.map_or(-1.0, |lobe| lobe.strength),
        ),
        (
            "KHR_materials_transmission",
            json!({"transmissionTexture": texture}),
            "transmissionFactor",
            [&[0.0], &[1.0]],
            Lobe::Transmission,
            |m| m.transmission.map_or(-1.0, |lobe| lobe.factor),
        ),
        (
            "KHR_materials_diffuse_transmission",
            json!({"diffuseTransmissionTexture": texture}),
            "diffuseTransmissionFactor",
            [&[0.0], &[1.0]],
            Lobe::DiffuseTransmission,
            |m| m.diffuse_transmission.map_or(-1.0, |lobe| lobe.factor),
        ),
        (
            "KHR_materials_iridescence",
            json!({"iridescenceTexture": texture}),
            "iridescenceFactor",
            [&[0.0], &[1.0]],
            Lobe::Iridescence,
            |m| m.iridescence.map_or(-1.0, |lobe| lobe.factor),
        ),
        ("KHR_materials_specular", json!({}), "specularFactor", [&[1.0], &[0.0]], Lobe::Specular, |m| {
            m.specular.map_or(-1.0, |lobe| lobe.factor)
        }),
    ];
    for (name, extension, property, keys, lobe, value) in rows {
        let mut fixture = with_material(off(name, extension));
        let without = loaded(&fixture);
        assert!(
            !without.lobes().contains(lobe) && without.images.is_empty(),
            "{name} is left out where nothing moves it"
        );
        // Another property of the extension, or of another material, enables nothing.
        fixture.push("materials", json!({}));
        let mut other = fixture.clone();
        animate(&mut other, &format!("/materials/1/extensions/{name}/{property}"), keys);
        assert!(!loaded(&other).lobes().contains(lobe), "{name}");
        animate(&mut fixture, &format!("/materials/0/extensions/{name}/{property}"), keys);
        let scene = loaded(&fixture);
        assert!(scene.lobes().contains(lobe), "{name} is kept");
        assert_eq!(value(&scene.materials[0]), keys[0][0], "{name} is off at rest");
        assert_eq!(scene.images.len(), usize::from(name != "KHR_materials_specular"), "{name}: its texture is kept");
        assert_eq!(value(&posed(&fixture, 1.0).materials[0]), 0.5, "{name}");
    }
}

/// A volume without thickness, and one of a material that does not transmit light at rest.
#[test]
fn a_volume_that_a_pointer_makes_is_kept() {
    let material = |transmission: f32| {
        json!({"extensions": {
            "KHR_materials_transmission": {"transmissionFactor": transmission},
            "KHR_materials_volume": {"attenuationDistance": 2.0},
        }})
    };
    let thickness = "/materials/0/extensions/KHR_materials_volume/thicknessFactor";
    let volume = |scene: &crate::Scene| scene.materials[0].transmission.and_then(|lobe| lobe.volume);
    let mut fixture = with_material(material(0.5));
    assert!(volume(&loaded(&fixture)).is_none());
    animate(&mut fixture, thickness, [&[0.0], &[4.0]]);
    assert_eq!(volume(&loaded(&fixture)).map(|volume| volume.thickness), Some(0.0));
    assert_eq!(volume(&posed(&fixture, 1.0)).map(|volume| volume.thickness), Some(2.0));
    // Both grow from zero.
    let mut fixture = with_material(material(0.0));
    animate(&mut fixture, thickness, [&[0.0], &[4.0]]);
    animate(&mut fixture, "/materials/0/extensions/KHR_materials_transmission/transmissionFactor", [&[0.0], &[1.0]]);
    let scene = posed(&fixture, 1.0);
    assert_eq!(scene.materials[0].transmission.map(|lobe| lobe.factor), Some(0.5));
    assert_eq!(volume(&scene).map(|volume| volume.thickness), Some(2.0));
}
