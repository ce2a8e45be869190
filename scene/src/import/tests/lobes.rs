//! Lobes of materials: clear coat, sheen, anisotropy, transmission with its volume, dispersion, specular, iridescence,
//! diffuse
//! transmission.

use crate::material::{Lobe, Lobes};
use glam::{Vec2, Vec3};
use serde_json::{Value, json};

use super::fixture::{Fixture, png};
use crate::material::{
    Anisotropy, ClearCoat, DiffuseTransmission, Iridescence, Material, Sheen, Specular, Transmission, Volume,
};
use crate::texture::{TextureRole, TextureSlot, UvTransform};
use crate::{Scene, TextureId};

/// Returns a triangle whose material has these extensions, with one image.
fn with_extensions(extensions: Value) -> Fixture {
    let mut fixture = Fixture::triangle();
    let uv = fixture.floats(2, &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
    for set in 0..2 {
        fixture.set(&format!("/meshes/0/primitives/0/attributes/TEXCOORD_{set}"), json!(uv));
    }
    let view = fixture.view(&png(2, 1, [10, 20, 30, 40]));
    fixture.push("images", json!({"bufferView": view, "mimeType": "image/png"}));
    fixture.push("textures", json!({"source": 0}));
    fixture.push("materials", json!({"extensions": extensions}));
    fixture.set("/meshes/0/primitives/0/material", json!(0));
    fixture
}

/// Returns texture 0 with a transform that identifies the slot.
fn texture(x: f32) -> Value {
    json!({"index": 0, "texCoord": 1, "extensions": {"KHR_texture_transform": {"offset": [x, 0.0]}}})
}

fn slot(scene: &Scene, x: f32, role: TextureRole) -> Option<TextureSlot> {
    let texture = scene.textures.iter().position(|t| t.role == role).map(TextureId::new)?;
    let transform = UvTransform { offset: Vec2::new(x, 0.0), ..UvTransform::default() };
    Some(TextureSlot { texture, uv_set: 1, transform })
}

fn one(lobe: Lobe) -> Lobes {
    Lobes::NONE.with(lobe)
}

/// Returns the only material of a file that loads without warnings.
fn load(extensions: Value) -> (Scene, Material) {
    let scene = with_extensions(extensions).load().expect("a good file");
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    let material = scene.materials[0].clone();
    assert_eq!(scene.lobes(), material.lobes());
    (scene, material)
}

#[test]
fn clear_coat() {
    let mut normal = texture(3.0);
    normal["scale"] = json!(0.5);
    let (scene, material) = load(json!({"KHR_materials_clearcoat": {
        "clearcoatFactor": 0.75, "clearcoatRoughnessFactor": 0.25,
        "clearcoatTexture": texture(1.0), "clearcoatRoughnessTexture": texture(2.0),
        "clearcoatNormalTexture": normal,
    }}));
    let expected = ClearCoat {
        factor: 0.75,
        roughness: 0.25,
        normal_scale: 0.5,
        texture: slot(&scene, 1.0, TextureRole::Linear),
        roughness_texture: slot(&scene, 2.0, TextureRole::Linear),
        normal_texture: slot(&scene, 3.0, TextureRole::Normal),
        keeps_base_f0: false,
    };
    assert_eq!(material.clear_coat, Some(expected));
    assert_eq!(material.lobes(), one(Lobe::ClearCoat));
    assert_eq!(material.tangent_uv_set(), Some(1));
}

#[test]
fn sheen() {
    let (scene, material) = load(json!({"KHR_materials_sheen": {
        "sheenColorFactor": [0.5, 0.25, 0.125], "sheenRoughnessFactor": 0.75,
        "sheenColorTexture": texture(1.0), "sheenRoughnessTexture": texture(2.0),
    }}));
    let expected = Sheen {
        color: Vec3::new(0.5, 0.25, 0.125),
        roughness: 0.75,
        color_texture: slot(&scene, 1.0, TextureRole::Color),
        roughness_texture: slot(&scene, 2.0, TextureRole::Linear),
    };
    assert_eq!(material.sheen, Some(expected));
    assert_eq!(material.lobes(), one(Lobe::Sheen));
}

#[test]
fn anisotropy() {
    let (scene, material) = load(json!({"KHR_materials_anisotropy": {
        "anisotropyStrength": 0.5, "anisotropyRotation": 2.0, "anisotropyTexture": texture(1.0),
    }}));
    let texture = slot(&scene, 1.0, TextureRole::Linear);
    assert_eq!(material.anisotropy, Some(Anisotropy { strength: 0.5, rotation_rad: 2.0, texture }));
    assert_eq!(material.lobes(), one(Lobe::Anisotropy));
    // The direction is relative to the tangent, so tangents are needed.
    assert_eq!(material.tangent_uv_set(), Some(1));
    assert_eq!(scene.meshes[0].tangents.len(), 3);
    let (_, plain) = load(json!({"KHR_materials_anisotropy": {"anisotropyStrength": 1.0}}));
    assert_eq!(plain.tangent_uv_set(), Some(0));
    assert_eq!(Material::default().tangent_uv_set(), None);
}

#[test]
fn transmission_and_its_volume() {
    let (scene, material) = load(json!({
        "KHR_materials_ior": {"ior": 1.33},
        "KHR_materials_transmission": {"transmissionFactor": 0.75, "transmissionTexture": texture(1.0)},
        "KHR_materials_volume": {
            "thicknessFactor": 2.0, "thicknessTexture": texture(2.0),
            "attenuationColor": [0.5, 0.25, 1.0], "attenuationDistance": 0.5,
        },
    }));
    let volume = Volume {
        thickness: 2.0,
        thickness_texture: slot(&scene, 2.0, TextureRole::Linear),
        attenuation_color: Vec3::new(0.5, 0.25, 1.0),
        attenuation_distance_m: 0.5,
    };
    let texture = slot(&scene, 1.0, TextureRole::Linear);
    assert_eq!(material.transmission, Some(Transmission { factor: 0.75, texture, volume: Some(volume) }));
    assert_eq!(material.lobes(), one(Lobe::Transmission));

    // Thin-walled: no volume, or zero thickness.
    let wall = |extra: Value| {
        let mut extensions = json!({"KHR_materials_transmission": {"transmissionFactor": 1.0}});
        extensions["KHR_materials_volume"] = extra;
        load(extensions).1
    };
    for material in [wall(json!({})), load(json!({"KHR_materials_transmission": {"transmissionFactor": 1.0}})).1] {
        assert_eq!(material.transmission, Some(Transmission { factor: 1.0, ..Transmission::default() }));
    }
}

#[test]
fn specular() {
    let (scene, material) = load(json!({"KHR_materials_specular": {
        "specularFactor": 0.5, "specularColorFactor": [1.0, 0.5, 3.0],
        "specularTexture": texture(1.0), "specularColorTexture": texture(2.0),
    }}));
    let expected = Specular {
        factor: 0.5,
        color: Vec3::new(1.0, 0.5, 3.0),
        texture: slot(&scene, 1.0, TextureRole::Linear),
        color_texture: slot(&scene, 2.0, TextureRole::Color),
    };
    assert_eq!(material.specular, Some(expected));
    assert_eq!(material.lobes(), one(Lobe::Specular));
}

#[test]
fn iridescence() {
    let (scene, material) = load(json!({"KHR_materials_iridescence": {
        "iridescenceFactor": 0.75, "iridescenceIor": 1.8,
        "iridescenceThicknessMinimum": 250.0, "iridescenceThicknessMaximum": 150.0,
        "iridescenceTexture": texture(1.0), "iridescenceThicknessTexture": texture(2.0),
    }}));
    // The bounds may be in either order.
    let expected = Iridescence {
        factor: 0.75,
        texture: slot(&scene, 1.0, TextureRole::Linear),
        ior: 1.8,
        min_thickness_nm: 250.0,
        max_thickness_nm: 150.0,
        thickness_texture: slot(&scene, 2.0, TextureRole::Linear),
    };
    assert_eq!(material.iridescence, Some(expected));
    assert_eq!(material.lobes(), one(Lobe::Iridescence));
    let (_, plain) = load(json!({"KHR_materials_iridescence": {"iridescenceFactor": 1.0}}));
    assert_eq!(plain.iridescence, Some(Iridescence::default()));
    let of = |thickness: Value| {
        let film = json!({"iridescenceFactor": 1.0, "iridescenceThicknessMaximum": 0.0, "iridescenceThicknessTexture": thickness});
        load(json!({"KHR_materials_iridescence": film})).1.iridescence.is_some()
    };
    assert!(of(texture(1.0)), "where the texture is 0 the film is thickest");
    let (_, none) =
        load(json!({"KHR_materials_iridescence": {"iridescenceFactor": 1.0, "iridescenceThicknessMaximum": 0}}));
    assert_eq!(none.iridescence, None, "a film without thickness");
}

#[test]
fn dispersion_shows_in_a_volume_that_transmits() {
    let dispersion = json!({"dispersion": 0.33});
    let glass = json!({"transmissionFactor": 1.0});
    let body = json!({"thicknessFactor": 1.0});
    let (_, material) = load(json!({
        "KHR_materials_dispersion": dispersion, "KHR_materials_transmission": glass, "KHR_materials_volume": body,
    }));
    assert_eq!((material.dispersion, material.lobes()), (Some(0.33), one(Lobe::Transmission).with(Lobe::Dispersion)));
    let (_, wall) = load(json!({"KHR_materials_dispersion": dispersion, "KHR_materials_transmission": glass}));
    assert_eq!(wall.lobes(), one(Lobe::Transmission));
    let (_, none) = load(json!({
        "KHR_materials_dispersion": {}, "KHR_materials_transmission": glass, "KHR_materials_volume": body,
    }));
    assert_eq!(none.lobes(), one(Lobe::Transmission));
    assert!(load(json!({"KHR_materials_dispersion": dispersion})).1.lobes().is_empty());
}

#[test]
fn diffuse_transmission() {
    let (scene, material) = load(json!({
        "KHR_materials_diffuse_transmission": {
            "diffuseTransmissionFactor": 0.75, "diffuseTransmissionColorFactor": [0.5, 0.25, 1.0],
            "diffuseTransmissionTexture": texture(1.0), "diffuseTransmissionColorTexture": texture(2.0),
        },
        "KHR_materials_volume": {"thicknessFactor": 2.0, "thicknessTexture": texture(3.0)},
    }));
    let thickness_texture = slot(&scene, 3.0, TextureRole::Linear);
    let volume = Some(Volume { thickness: 2.0, thickness_texture, ..Volume::default() });
    let expected = DiffuseTransmission {
        factor: 0.75,
        texture: slot(&scene, 1.0, TextureRole::Linear),
        color: Vec3::new(0.5, 0.25, 1.0),
        color_texture: slot(&scene, 2.0, TextureRole::Color),
        volume,
    };
    assert_eq!(material.diffuse_transmission, Some(expected));
    assert_eq!((material.lobes(), material.volume()), (one(Lobe::DiffuseTransmission), volume));
    let (_, plain) = load(json!({"KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 1.0}}));
    assert_eq!(plain.diffuse_transmission, Some(DiffuseTransmission::default()));
    // Both kinds of transmission share the volume.
    let (_, both) = load(json!({
        "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 1.0},
        "KHR_materials_transmission": {"transmissionFactor": 0.5},
        "KHR_materials_volume": {"thicknessFactor": 2.0},
    }));
    let body = Some(Volume { thickness: 2.0, ..Volume::default() });
    assert_eq!(both.transmission.map(|t| t.volume), Some(body));
    assert_eq!(both.diffuse_transmission.map(|t| t.volume), Some(body));
}

/// A factor of zero disables a lobe and its textures; unlit materials have no lobes.
#[test]
fn lobes_that_do_not_show_are_left_out() {
    let (scene, material) = load(json!({
        "KHR_materials_clearcoat": {"clearcoatRoughnessFactor": 1.0, "clearcoatTexture": texture(1.0)},
        "KHR_materials_sheen": {"sheenRoughnessFactor": 1.0, "sheenColorTexture": texture(1.0)},
        "KHR_materials_anisotropy": {"anisotropyRotation": 1.0, "anisotropyTexture": texture(1.0)},
        "KHR_materials_transmission": {"transmissionTexture": texture(1.0)},
        "KHR_materials_volume": {"attenuationColor": [0.5, 0.5, 0.5]},
        "KHR_materials_specular": {},
        "KHR_materials_iridescence": {"iridescenceIor": 2.0, "iridescenceTexture": texture(1.0)},
        "KHR_materials_dispersion": {},
        "KHR_materials_diffuse_transmission": {"diffuseTransmissionTexture": texture(1.0)},
    }));
    assert_eq!(material, Material::default());
    assert!(material.lobes().is_empty() && scene.textures.is_empty() && scene.images.is_empty());
    let (_, unlit) = load(json!({"KHR_materials_unlit": {}, "KHR_materials_sheen": {"sheenColorFactor": [1, 1, 1]}}));
    assert!(unlit.sheen.is_some() && unlit.lobes().is_empty());
}

#[test]
fn what_is_out_of_range_is_clamped_and_said() {
    let scene = with_extensions(json!({
        "KHR_materials_clearcoat": {"clearcoatFactor": 2.0},
        "KHR_materials_sheen": {"sheenColorFactor": [0.5, -1.0, 9.0]},
        "KHR_materials_specular": {"specularColorFactor": [7.0, -1.0, 0.0]},
        "KHR_materials_iridescence": {
            "iridescenceFactor": 1.5, "iridescenceIor": 0.5, "iridescenceThicknessMinimum": -1.0,
        },
        "KHR_materials_dispersion": {"dispersion": -0.5},
        "KHR_materials_diffuse_transmission": {
            "diffuseTransmissionFactor": 2.0, "diffuseTransmissionColorFactor": [0.5, 2.0, 0.5],
        },
    }));
    let scene = scene.load().expect("a file to repair");
    let material = &scene.materials[0];
    assert_eq!(material.clear_coat.map(|c| c.factor), Some(1.0));
    assert_eq!(material.sheen.map(|s| s.color), Some(Vec3::new(0.5, 0.0, 1.0)));
    assert_eq!(material.specular.map(|s| s.color), Some(Vec3::new(7.0, 0.0, 0.0)));
    let film = Iridescence { ior: 1.0, min_thickness_nm: 0.0, ..Iridescence::default() };
    assert_eq!((material.iridescence, material.dispersion), (Some(film), None));
    let through = DiffuseTransmission { color: Vec3::new(0.5, 1.0, 0.5), ..DiffuseTransmission::default() };
    assert_eq!(material.diffuse_transmission, Some(through));
    for words in [
        "dir/fixture.glb: material 0: KHR_materials_iridescence: its iridescenceIor was raised from 0.5 to 1",
        "dir/fixture.glb: material 0: KHR_materials_dispersion: its dispersion was raised from -0.5 to 0",
        "dir/fixture.glb: material 0: KHR_materials_clearcoat: its clearcoatFactor was clamped to 0…1",
        "dir/fixture.glb: material 0: KHR_materials_sheen: its sheenColorFactor was clamped to 0…1",
        "dir/fixture.glb: material 0: KHR_materials_specular: its specularColorFactor was clamped to 0 or more",
    ] {
        assert!(scene.warnings.iter().any(|w| w == words), "{words}: {:?}", scene.warnings);
    }
}

#[test]
fn broken_lobes_are_errors() {
    let coat = |member: &str, value: Value| {
        let mut coat = json!({"clearcoatFactor": 1.0});
        coat[member] = value;
        json!({"KHR_materials_clearcoat": coat})
    };
    let volume = |member: &str, value: Value| {
        let mut volume = json!({"thicknessFactor": 1.0});
        volume[member] = value;
        json!({"KHR_materials_transmission": {"transmissionFactor": 1.0}, "KHR_materials_volume": volume})
    };
    for (extensions, words) in [
        (json!({"KHR_materials_sheen": 3}), "KHR_materials_sheen: it is not an object"),
        (coat("clearcoatFactor", json!("much")), "KHR_materials_clearcoat: its clearcoatFactor is not a number"),
        (coat("clearcoatFactor", json!(1e300)), "its clearcoatFactor is inf"),
        (coat("clearcoatTexture", json!({})), "its clearcoatTexture has no index"),
        (coat("clearcoatTexture", json!([])), "its clearcoatTexture has no index"),
        (coat("clearcoatTexture", json!({"index": -1})), "its clearcoatTexture has no index"),
        (coat("clearcoatTexture", json!({"index": 7})), "names texture 7, but there are 1"),
        (coat("clearcoatTexture", json!({"index": 0, "texCoord": 0.5})), "no valid texCoord"),
        (coat("clearcoatNormalTexture", json!({"index": 0, "scale": null})), "scale is not a number"),
        (json!({"KHR_materials_sheen": {"sheenColorFactor": [1, 1]}}), "sheenColorFactor is not 3 numbers"),
        (json!({"KHR_materials_sheen": {"sheenColorFactor": [1, 1, "x"]}}), "sheenColorFactor is not a number"),
        (json!({"KHR_materials_anisotropy": {"anisotropyRotation": 1e39}}), "its anisotropyRotation is inf"),
        (json!({"KHR_materials_iridescence": []}), "KHR_materials_iridescence: it is not an object"),
        (json!({"KHR_materials_iridescence": {"iridescenceIor": "x"}}), "its iridescenceIor is not a number"),
        (json!({"KHR_materials_dispersion": {"dispersion": 1e300}}), "its dispersion is inf"),
        (json!({"KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": []}}), "Factor is not a number"),
        (volume("thicknessFactor", json!(-1.0)), "KHR_materials_volume: its thicknessFactor is -1"),
        (volume("attenuationDistance", json!(0.0)), "its attenuationDistance is 0"),
        (
            json!({"KHR_materials_specular": {"specularTexture": {"index": 0, "extensions":
            {"KHR_texture_transform": {"offset": 1}}}}}),
            "KHR_materials_specular: KHR_texture_transform: ",
        ),
    ] {
        let error = with_extensions(extensions).error();
        assert!(error.contains("material 0: ") && error.contains(words), "{error} lacks {words:?}");
    }
}
