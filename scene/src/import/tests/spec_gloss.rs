//! KHR_materials_pbrSpecularGlossiness, converted to metallic-roughness materials that Filament shades alike.

use glam::{Vec3, Vec4};
use serde_json::{Value, json};

use super::fixture::Fixture;
use crate::Scene;
use crate::material::Material;
use crate::texture::TextureRole;

/// Returns the triangle with a material that has the extension, and images with glossiness in alpha.
fn with(extension: Value) -> Fixture {
    let mut fixture = Fixture::triangle();
    let uv = fixture.floats(2, &[0.0; 6]);
    fixture.set("/meshes/0/primitives/0/attributes/TEXCOORD_0", json!(uv));
    fixture.set("/meshes/0/primitives/0/material", json!(0));
    for texels in [[[200, 100, 50, 255], [10, 20, 30, 0], [1, 2, 3, 128]], [[9, 8, 7, 6]; 3]] {
        let image = image::RgbaImage::from_fn(3, 1, |x, _| image::Rgba(texels[x as usize]));
        let mut bytes = std::io::Cursor::new(Vec::new());
        image.write_to(&mut bytes, image::ImageFormat::Png).expect("writing to memory");
        let view = fixture.view(&bytes.into_inner());
        let image = fixture.push("images", json!({"bufferView": view, "mimeType": "image/png"}));
        fixture.push("textures", json!({"source": image}));
    }
    fixture.push("materials", json!({"extensions": {"KHR_materials_pbrSpecularGlossiness": extension}}));
    // The extension replaces these.
    let other = json!({"metallicFactor": 0.7, "roughnessFactor": 0.1, "baseColorTexture": {"index": 1}});
    fixture.set("/materials/0/pbrMetallicRoughness", other);
    fixture.json["extensionsUsed"] = json!(["KHR_materials_pbrSpecularGlossiness"]);
    fixture
}

fn loaded(fixture: &Fixture) -> Scene {
    let scene = fixture.load().expect("it is sound");
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    scene
}

/// Returns f0 and diffuse albedo, before its factor 1 − max f0, of a metallic-roughness material with a specular color.
/// The formulas are those of KHR_materials_specular, as Filament shades it.
fn f0_and_diffuse(material: &Material) -> (Vec3, Vec4) {
    assert_eq!(material.metallic, 0.0, "a metal has no diffuse part");
    let specular = material.specular.expect("it has a specular color");
    let f0 = specular.color * material.dielectric_f0() * specular.factor;
    (f0.min(Vec3::ONE), material.base_color)
}

#[test]
fn factors_become_f0_diffuse_and_roughness() {
    let factors =
        json!({"diffuseFactor": [0.2, 0.4, 0.6, 0.8], "specularFactor": [0.9, 0.5, 0.1], "glossinessFactor": 0.7});
    let scene = loaded(&with(factors));
    let material = &scene.materials[0];
    assert_eq!(f0_and_diffuse(material), (Vec3::new(0.9, 0.5, 0.1), Vec4::new(0.2, 0.4, 0.6, 0.8)));
    assert!((material.roughness - 0.3).abs() < 1e-6);
    assert_eq!(material.slots().into_iter().flatten().count(), 0, "the textures of the other model are not used");
    assert!(scene.images.is_empty());
    // Defaults: white, fully specular and smooth.
    let scene = loaded(&with(json!({})));
    assert_eq!(f0_and_diffuse(&scene.materials[0]), (Vec3::ONE, Vec4::ONE));
    assert_eq!(scene.materials[0].roughness, 0.0);
}

/// One image is the specular color, decoded from sRGB, and the source of a roughness image: 1 − glossiness · alpha.
#[test]
fn a_texture_of_glossiness_makes_one_of_roughness() {
    let slot = json!({"index": 0, "extensions": {"KHR_texture_transform": {"offset": [0.5, 0.25]}}});
    let fixture = with(json!({
        "specularGlossinessTexture": slot, "diffuseTexture": {"index": 1},
        "specularFactor": [0.5, 1.0, 1.0], "glossinessFactor": 0.5,
    }));
    let scene = loaded(&fixture);
    let material = &scene.materials[0];
    let specular = material.specular.expect("it has a specular color");
    let texture = |slot: Option<crate::TextureSlot>| scene.textures[slot.expect("it is textured").texture.index()];
    let image = |slot| &scene.images[texture(slot).image.index()];
    assert_eq!(specular.color, Vec3::new(0.5, 1.0, 1.0));
    assert_eq!(texture(specular.color_texture).role, TextureRole::Color);
    assert_eq!(image(specular.color_texture).rgba8().expect("texels")[..4], [200, 100, 50, 255]);
    assert_eq!(texture(material.base_color_texture).role, TextureRole::Color);
    assert_eq!(image(material.base_color_texture).rgba8().expect("texels")[..4], [9, 8, 7, 6]);
    let roughness = material.metallic_roughness_texture;
    assert_eq!((texture(roughness).role, material.roughness), (TextureRole::Linear, 1.0));
    assert_eq!(roughness.map(|slot| slot.transform), specular.color_texture.map(|slot| slot.transform));
    let computed = image(roughness);
    assert_eq!((computed.width, computed.height, scene.images.len()), (3, 1, 3));
    // Green: 1 − 0.5 · (1, 0, 128/255); blue (metallic): 0.
    let green: Vec<u8> = computed.rgba8().expect("texels").chunks(4).map(|texel| texel[1]).collect();
    assert_eq!(green, [128, 255, 191]);
    assert!(computed.rgba8().expect("texels").chunks(4).all(|texel| texel[2] == 0));
}

/// Materials share computed images with the same source and factor; a direct use of the source is separate.
#[test]
fn computed_images_are_shared() {
    let mut fixture = with(json!({"specularGlossinessTexture": {"index": 0}}));
    let primitive = fixture.json["meshes"][0]["primitives"][0].clone();
    for (index, factor) in [(1, 1.0), (2, 0.5)] {
        let mut material = fixture.json["materials"][0].clone();
        material["extensions"]["KHR_materials_pbrSpecularGlossiness"]["glossinessFactor"] = json!(factor);
        fixture.push("materials", material);
        let mut next = primitive.clone();
        next["material"] = json!(index);
        fixture.primitive(next);
    }
    fixture.push("materials", json!({"pbrMetallicRoughness": {"metallicRoughnessTexture": {"index": 0}}}));
    let mut next = primitive;
    next["material"] = json!(3);
    fixture.primitive(next);
    let scene = loaded(&fixture);
    let image = |material: usize| {
        let slot = scene.materials[material].metallic_roughness_texture.expect("it is textured");
        scene.textures[slot.texture.index()].image.index()
    };
    assert_eq!(image(0), image(1));
    assert!(image(0) != image(2) && image(3) != image(0) && image(3) != image(2));
    assert_eq!(scene.images[image(3)].rgba8().expect("texels")[..4], [200, 100, 50, 255], "the image of the file");
    // Three images: those of the file, and computed ones. The extension replaces the base color of the last material.
    assert_eq!(scene.images.len(), 3);
}

#[test]
fn what_is_out_of_range_is_clamped_or_refused() {
    let fixture = with(json!({"specularFactor": [2.0, 0.5, -1.0], "glossinessFactor": 3.0}));
    let scene = fixture.load().expect("it is clamped");
    assert_eq!(f0_and_diffuse(&scene.materials[0]).0, Vec3::new(1.0, 0.5, 0.0));
    assert_eq!(scene.materials[0].roughness, 0.0);
    let text = scene.warnings.join("\n");
    assert!(text.contains("specularFactor was clamped") && text.contains("glossinessFactor was clamped"), "{text}");
    let at = "material 0: KHR_materials_pbrSpecularGlossiness: its ";
    for (extension, word) in [
        (json!({"diffuseFactor": [1, 1, 1]}), "diffuseFactor is not 4 numbers"),
        (json!({"glossinessFactor": "shiny"}), "glossinessFactor is not a number"),
        (json!({"specularGlossinessTexture": {}}), "specularGlossinessTexture has no index"),
    ] {
        let error = with(extension).error();
        assert!(error.contains(&format!("{at}{word}")), "{error}");
    }
}
