//! Every factor and texture transform of a material.

use glam::{Vec2, Vec3, Vec4};
use serde_json::{Value, json};

use super::{animate, loaded, posed, with_material};
use crate::material::{AlphaMode, Material, Volume};
use crate::texture::TextureSlot;

/// Returns a material with all lobes and textures. Its values differ from all values in the tables below.
fn full() -> Value {
    let texture = json!({"index": 0});
    let coat = json!({
        "clearcoatFactor": 0.9, "clearcoatRoughnessFactor": 0.2, "clearcoatTexture": texture,
        "clearcoatRoughnessTexture": texture, "clearcoatNormalTexture": texture,
    });
    let sheen = json!({
        "sheenColorFactor": [0.9, 0.8, 0.7], "sheenRoughnessFactor": 0.9, "sheenColorTexture": texture,
        "sheenRoughnessTexture": texture,
    });
    let specular = json!({
        "specularFactor": 0.9, "specularColorFactor": [0.9, 0.8, 0.7], "specularTexture": texture,
        "specularColorTexture": texture,
    });
    let volume = json!({
        "thicknessFactor": 0.9, "thicknessTexture": texture, "attenuationDistance": 9.0,
        "attenuationColor": [0.9, 0.8, 0.7],
    });
    let iridescence = json!({
        "iridescenceFactor": 0.9, "iridescenceIor": 1.9, "iridescenceThicknessMinimum": 90.0,
        "iridescenceThicknessMaximum": 900.0, "iridescenceTexture": texture, "iridescenceThicknessTexture": texture,
    });
    let diffuse = json!({
        "diffuseTransmissionFactor": 0.9, "diffuseTransmissionTexture": texture,
        "diffuseTransmissionColorFactor": [0.9, 0.8, 0.7], "diffuseTransmissionColorTexture": texture,
    });
    json!({
        "alphaMode": "MASK", "alphaCutoff": 0.9, "emissiveFactor": [0.9, 0.8, 0.7],
        "pbrMetallicRoughness": {
            "baseColorFactor": [0.9, 0.8, 0.7, 0.6], "metallicFactor": 0.9, "roughnessFactor": 0.9,
            "baseColorTexture": texture, "metallicRoughnessTexture": texture,
        },
        "normalTexture": texture, "occlusionTexture": texture, "emissiveTexture": texture,
        "extensions": {
            "KHR_materials_ior": {"ior": 1.9},
            "KHR_materials_anisotropy":
                {"anisotropyStrength": 0.9, "anisotropyRotation": 0.9, "anisotropyTexture": texture},
            "KHR_materials_clearcoat": coat,
            "KHR_materials_diffuse_transmission": diffuse,
            "KHR_materials_dispersion": {"dispersion": 0.9},
            "KHR_materials_iridescence": iridescence,
            "KHR_materials_sheen": sheen,
            "KHR_materials_specular": specular,
            "KHR_materials_transmission": {"transmissionFactor": 0.9, "transmissionTexture": texture},
            "KHR_materials_volume": volume,
        },
    })
}

/// Returns the volumes of a material, one for each kind of transmission.
fn volumes(material: &mut Material) -> impl Iterator<Item = &mut Volume> {
    let Material { transmission, diffuse_transmission, .. } = material;
    let both = [
        &mut transmission.as_mut().expect("a lobe").volume,
        &mut diffuse_transmission.as_mut().expect("a lobe").volume,
    ];
    both.into_iter().map(|volume| volume.as_mut().expect("a volume"))
}

/// A pointer relative to a material, two keys, and the effect of their interpolated value on the material at rest.
type Row = (&'static str, [&'static [f32]; 2], fn(&mut Material));

const COLOR: [&[f32]; 2] = [&[0.0, 0.5, 1.0], &[0.5, 0.0, 0.5]];
const NUMBER: [&[f32]; 2] = [&[0.0], &[0.5]];
const MIDDLE: Vec3 = Vec3::new(0.25, 0.25, 0.75);

const FACTORS: &[Row] = &[
    ("pbrMetallicRoughness/baseColorFactor", [&[0.0, 0.5, 1.0, 0.0], &[0.5, 0.0, 0.5, 1.0]], |m| {
        m.base_color = Vec4::new(0.25, 0.25, 0.75, 0.5);
    }),
    ("pbrMetallicRoughness/metallicFactor", NUMBER, |m| m.metallic = 0.25),
    ("pbrMetallicRoughness/roughnessFactor", NUMBER, |m| m.roughness = 0.25),
    ("alphaCutoff", NUMBER, |m| m.alpha = AlphaMode::Mask { cutoff: 0.25 }),
    ("emissiveFactor", COLOR, |m| m.emissive = MIDDLE),
    ("normalTexture/scale", [&[-1.0], &[0.0]], |m| m.normal_scale = -0.5),
    ("occlusionTexture/strength", NUMBER, |m| m.occlusion_strength = 0.25),
    ("extensions/KHR_materials_ior/ior", [&[1.0], &[1.5]], |m| m.ior = 1.25),
    ("extensions/KHR_materials_anisotropy/anisotropyStrength", NUMBER, |m| {
        m.anisotropy.as_mut().expect("a lobe").strength = 0.25;
    }),
    ("extensions/KHR_materials_anisotropy/anisotropyRotation", [&[-2.0], &[1.0]], |m| {
        m.anisotropy.as_mut().expect("a lobe").rotation_rad = -0.5;
    }),
    ("extensions/KHR_materials_dispersion/dispersion", [&[1.0], &[4.0]], |m| m.dispersion = Some(2.5)),
    ("extensions/KHR_materials_iridescence/iridescenceFactor", NUMBER, |m| {
        m.iridescence.as_mut().expect("a lobe").factor = 0.25;
    }),
    ("extensions/KHR_materials_iridescence/iridescenceIor", [&[1.0], &[1.5]], |m| {
        m.iridescence.as_mut().expect("a lobe").ior = 1.25;
    }),
    ("extensions/KHR_materials_iridescence/iridescenceThicknessMinimum", [&[0.0], &[50.0]], |m| {
        m.iridescence.as_mut().expect("a lobe").min_thickness_nm = 25.0;
    }),
    ("extensions/KHR_materials_iridescence/iridescenceThicknessMaximum", [&[200.0], &[500.0]], |m| {
        m.iridescence.as_mut().expect("a lobe").max_thickness_nm = 350.0;
    }),
    ("extensions/KHR_materials_diffuse_transmission/diffuseTransmissionFactor", NUMBER, |m| {
        m.diffuse_transmission.as_mut().expect("a lobe").factor = 0.25;
    }),
    ("extensions/KHR_materials_diffuse_transmission/diffuseTransmissionColorFactor", COLOR, |m| {
        m.diffuse_transmission.as_mut().expect("a lobe").color = MIDDLE;
    }),
    ("extensions/KHR_materials_clearcoat/clearcoatFactor", NUMBER, |m| {
        m.clear_coat.as_mut().expect("a lobe").factor = 0.25;
    }),
    ("extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor", NUMBER, |m| {
        m.clear_coat.as_mut().expect("a lobe").roughness = 0.25;
    }),
    ("extensions/KHR_materials_clearcoat/clearcoatNormalTexture/scale", [&[-1.0], &[0.0]], |m| {
        m.clear_coat.as_mut().expect("a lobe").normal_scale = -0.5;
    }),
    ("extensions/KHR_materials_sheen/sheenColorFactor", COLOR, |m| m.sheen.as_mut().expect("a lobe").color = MIDDLE),
    ("extensions/KHR_materials_sheen/sheenRoughnessFactor", NUMBER, |m| {
        m.sheen.as_mut().expect("a lobe").roughness = 0.25;
    }),
    ("extensions/KHR_materials_specular/specularFactor", NUMBER, |m| {
        m.specular.as_mut().expect("a lobe").factor = 0.25;
    }),
    ("extensions/KHR_materials_specular/specularColorFactor", [&[4.0, 0.5, 1.0], &[0.0, 0.0, 0.5]], |m| {
        m.specular.as_mut().expect("a lobe").color = Vec3::new(2.0, 0.25, 0.75);
    }),
    ("extensions/KHR_materials_transmission/transmissionFactor", NUMBER, |m| {
        m.transmission.as_mut().expect("a lobe").factor = 0.25;
    }),
    ("extensions/KHR_materials_volume/thicknessFactor", [&[0.0], &[5.0]], |m| {
        volumes(m).for_each(|volume| volume.thickness = 2.5);
    }),
    ("extensions/KHR_materials_volume/attenuationDistance", [&[1.0], &[5.0]], |m| {
        volumes(m).for_each(|volume| volume.attenuation_distance_m = 3.0);
    }),
    ("extensions/KHR_materials_volume/attenuationColor", COLOR, |m| {
        volumes(m).for_each(|volume| volume.attenuation_color = MIDDLE);
    }),
];

/// Keys are at 0 s and 2 s. At 1 s only one property of the material differs from its rest value. The rest pose
/// restores it.
#[test]
fn every_factor_changes_and_comes_back() {
    for (pointer, keys, set) in FACTORS {
        let mut fixture = with_material(full());
        animate(&mut fixture, &format!("/materials/0/{pointer}"), *keys);
        let mut scene = loaded(&fixture);
        let rest = scene.materials[0].clone();
        let mut truth = rest.clone();
        set(&mut truth);
        scene.pose(Some(0), 1.0).expect("it can be posed");
        assert_eq!(scene.materials[0], truth, "{pointer}");
        assert_ne!(truth, rest, "{pointer}");
        scene.pose(None, 0.0).expect("it can be posed");
        assert_eq!(scene.materials[0], rest, "{pointer}");
    }
}

/// A pointer relative to a material, and its texture slot.
type Slot = (&'static str, fn(&mut Material) -> &mut Option<TextureSlot>);

const SLOTS: &[Slot] = &[
    ("pbrMetallicRoughness/baseColorTexture", |m| &mut m.base_color_texture),
    ("pbrMetallicRoughness/metallicRoughnessTexture", |m| &mut m.metallic_roughness_texture),
    ("normalTexture", |m| &mut m.normal_texture),
    ("occlusionTexture", |m| &mut m.occlusion_texture),
    ("emissiveTexture", |m| &mut m.emissive_texture),
    ("extensions/KHR_materials_anisotropy/anisotropyTexture", |m| &mut m.anisotropy.as_mut().expect("a lobe").texture),
    ("extensions/KHR_materials_clearcoat/clearcoatTexture", |m| &mut m.clear_coat.as_mut().expect("a lobe").texture),
    ("extensions/KHR_materials_clearcoat/clearcoatRoughnessTexture", |m| {
        &mut m.clear_coat.as_mut().expect("a lobe").roughness_texture
    }),
    ("extensions/KHR_materials_clearcoat/clearcoatNormalTexture", |m| {
        &mut m.clear_coat.as_mut().expect("a lobe").normal_texture
    }),
    ("extensions/KHR_materials_sheen/sheenColorTexture", |m| &mut m.sheen.as_mut().expect("a lobe").color_texture),
    ("extensions/KHR_materials_sheen/sheenRoughnessTexture", |m| {
        &mut m.sheen.as_mut().expect("a lobe").roughness_texture
    }),
    ("extensions/KHR_materials_specular/specularTexture", |m| &mut m.specular.as_mut().expect("a lobe").texture),
    ("extensions/KHR_materials_specular/specularColorTexture", |m| {
        &mut m.specular.as_mut().expect("a lobe").color_texture
    }),
    ("extensions/KHR_materials_transmission/transmissionTexture", |m| {
        &mut m.transmission.as_mut().expect("a lobe").texture
    }),
    ("extensions/KHR_materials_iridescence/iridescenceTexture", |m| {
        &mut m.iridescence.as_mut().expect("a lobe").texture
    }),
    ("extensions/KHR_materials_iridescence/iridescenceThicknessTexture", |m| {
        &mut m.iridescence.as_mut().expect("a lobe").thickness_texture
    }),
    ("extensions/KHR_materials_diffuse_transmission/diffuseTransmissionTexture", |m| {
        &mut m.diffuse_transmission.as_mut().expect("a lobe").texture
    }),
    ("extensions/KHR_materials_diffuse_transmission/diffuseTransmissionColorTexture", |m| {
        &mut m.diffuse_transmission.as_mut().expect("a lobe").color_texture
    }),
];

/// Changes a texture slot.
type Change<'a> = &'a dyn Fn(&mut Option<TextureSlot>);

fn check_transform(pointer: &str, change: &dyn Fn(&mut Material, Change<'_>)) {
    let mut fixture = with_material(full());
    let start = format!("/materials/0/{pointer}/extensions/KHR_texture_transform");
    animate(&mut fixture, &format!("{start}/offset"), [&[0.0, 1.0], &[1.0, -1.0]]);
    animate(&mut fixture, &format!("{start}/rotation"), [&[1.0], &[2.0]]);
    animate(&mut fixture, &format!("{start}/scale"), [&[1.0, 1.0], &[4.0, -3.0]]);
    let rest = loaded(&fixture);
    let mut truth = rest.materials[0].clone();
    change(&mut truth, &|slot| {
        let transform = &mut slot.as_mut().expect("it is textured").transform;
        (transform.offset, transform.rotation_rad, transform.scale) = (Vec2::new(0.5, 0.0), 1.5, Vec2::new(2.5, -1.0));
    });
    let mut scene = posed(&fixture, 1.0);
    assert_eq!(scene.materials[0], truth, "{pointer}");
    scene.pose(None, 0.0).expect("it can be posed");
    assert_eq!(scene.materials, rest.materials, "{pointer}");
}

#[test]
fn every_texture_can_be_moved_turned_and_scaled() {
    for (pointer, slot) in SLOTS {
        check_transform(pointer, &|material, change| change(slot(material)));
    }
    check_transform("extensions/KHR_materials_volume/thicknessTexture", &|material, change| {
        volumes(material).for_each(|volume| change(&mut volume.thickness_texture));
    });
}

/// Cubics overshoot, but shading expects numbers in range.
#[test]
fn values_are_held_in_range() {
    let at = |pointer: &str, keys: [&[f32]; 2]| {
        let mut fixture = with_material(full());
        animate(&mut fixture, &format!("/materials/0/{pointer}"), keys);
        posed(&fixture, 2.0).materials.remove(0)
    };
    let far: [&[f32]; 2] = [&[-3.0], &[3.0]];
    let near: [&[f32]; 2] = [&[3.0], &[-3.0]];
    assert_eq!(at("pbrMetallicRoughness/roughnessFactor", far).roughness, 1.0);
    assert_eq!(at("pbrMetallicRoughness/metallicFactor", near).metallic, 0.0);
    assert_eq!(at("extensions/KHR_materials_ior/ior", [&[2.0], &[0.5]]).ior, 1.0);
    assert_eq!(at("emissiveFactor", [&[0.0; 3], &[-1.0, 2.0, 0.5]]).emissive, Vec3::new(0.0, 2.0, 0.5));
    let color = at("pbrMetallicRoughness/baseColorFactor", [&[0.0; 4], &[-1.0, 2.0, 0.5, 9.0]]).base_color;
    assert_eq!(color, Vec4::new(0.0, 1.0, 0.5, 1.0));
    let largest = at("normalTexture/scale", [&[0.0], &[f32::MAX]]).normal_scale;
    assert_eq!(largest, f32::MAX);
    let volume = at("extensions/KHR_materials_volume/attenuationDistance", near).transmission.and_then(|t| t.volume);
    assert!(volume.expect("a volume").attenuation_distance_m > 0.0);
}
