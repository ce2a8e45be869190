//! Textures in KTX2 and WebP files, and textures without an image.

use std::path::Path;

use serde_json::{Value, json};

use super::fixture::{Fixture, png};
use crate::error::SceneError;
use crate::import::load_bytes_with;
use crate::memory::Memory;
use crate::options::LoadOptions;
use crate::progress::silent;
use crate::scene::Scene;
use crate::texture::{BlockFormats, ImageFormat, TextureRole};

/// Returns a triangle whose material reads texture 0 as base color, and texture 1, if any, as normal map.
fn with_textures(images: &[&[u8]], textures: &[Value]) -> Fixture {
    let mut fixture = Fixture::triangle();
    let uv = fixture.floats(2, &[0.0; 6]);
    fixture.set("/meshes/0/primitives/0/attributes/TEXCOORD_0", json!(uv));
    fixture.set("/meshes/0/primitives/0/material", json!(0));
    for image in images {
        let view = fixture.view(image);
        fixture.push("images", json!({"bufferView": view}));
    }
    textures.iter().for_each(|texture| {
        fixture.push("textures", texture.clone());
    });
    let mut material = json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}});
    if textures.len() > 1 {
        material["normalTexture"] = json!({"index": 1});
    }
    fixture.push("materials", material);
    fixture.json["extensionsUsed"] = json!(["KHR_texture_basisu", "EXT_texture_webp"]);
    fixture
}

fn file(name: &str) -> Vec<u8> {
    let path = crate::test_files::file(&format!("textures/{name}")).expect("it is committed");
    std::fs::read(path).expect("it can be read")
}

fn basis(image: usize) -> Value {
    json!({"extensions": {"KHR_texture_basisu": {"source": image}}})
}

fn load_with(fixture: &Fixture, options: &LoadOptions) -> Result<Scene, SceneError> {
    let scene = load_bytes_with(Path::new("dir/fixture.glb"), &fixture.glb(), options, &mut silent)?;
    assert_eq!(scene.check(), Ok(()));
    Ok(scene)
}

fn formats(bc7: bool, etc2: bool, astc: bool) -> LoadOptions {
    LoadOptions { block_formats: BlockFormats { bc7, etc2, astc }, ..LoadOptions::default() }
}

/// The extension that is first in the importer's list, then the other, then the fallback.
#[test]
fn the_image_of_an_extension_is_preferred() {
    let (ktx, webp, fallback) = (file("color_etc1s.ktx2"), file("color_lossless.webp"), png(3, 1, [9; 4]));
    let images: [&[u8]; 3] = [&fallback, &webp, &ktx];
    let webp = |image: usize| json!({"EXT_texture_webp": {"source": image}});
    let both = json!({"KHR_texture_basisu": {"source": 2}, "EXT_texture_webp": {"source": 1}});
    for (texture, levels, width) in [
        (json!({"source": 0}), 1, 3),
        (json!({"source": 0, "extensions": webp(1)}), 1, 64),
        (json!({"extensions": webp(1)}), 1, 64),
        (json!({"source": 0, "extensions": both}), 7, 64),
        (json!({"source": 0, "extensions": {"MSFT_texture_dds": {"source": 2}}}), 1, 3),
    ] {
        let mut fixture = with_textures(&images, std::slice::from_ref(&texture));
        fixture.json["extensionsRequired"] = json!(["KHR_texture_basisu", "EXT_texture_webp"]);
        let scene = fixture.load().unwrap_or_else(|error| panic!("{texture}: {error}"));
        assert_eq!(scene.warnings, [""; 0], "{texture}");
        let [image] = &scene.images[..] else { panic!("{texture}: {} images", scene.images.len()) };
        assert_eq!((image.format, image.levels.len(), image.width), (ImageFormat::Rgba8, levels, width), "{texture}");
        assert_eq!(image.missing_levels(), levels == 1);
    }
}

/// A texture may lack an image (glTF 2.0, section 5.29): one of each kind, without and with an unsupported extension.
#[test]
fn textures_without_an_image_are_left_out() {
    for texture in [json!({}), json!({"extensions": {"MSFT_texture_dds": {"source": 0}}})] {
        let scene = with_textures(&[], &[texture, json!({})]).load().expect("a good file");
        let expected = |texture: usize| {
            format!("dir/fixture.glb: texture {texture} has no image that this build reads; it is left out")
        };
        assert_eq!(scene.warnings, [expected(0), expected(1)]);
        assert_eq!(scene.materials[0].slots().into_iter().flatten().count(), 0);
        assert!(scene.textures.is_empty() && scene.images.is_empty());
    }
}

/// Block formats that the device supports; normal maps not as ETC2; images without whole blocks or with missing levels
/// as RGBA.
#[test]
fn images_are_transcoded_to_what_the_device_samples() {
    let (color, normal) = (file("color_uastc_zstd.ktx2"), file("normal_uastc.ktx2"));
    let fixture = with_textures(&[&color, &normal], &[basis(0), basis(1)]);
    let of = |options: &LoadOptions| {
        let scene = load_with(&fixture, options).expect("a good file");
        assert_eq!(scene.textures[1].role, TextureRole::Normal);
        [0, 1].map(|i| scene.images[i].format)
    };
    use ImageFormat::{Astc4x4, Bc7, Etc2Rgba8, Rgba8};
    assert_eq!(of(&formats(true, true, true)), [Astc4x4, Astc4x4]);
    assert_eq!(of(&formats(true, true, false)), [Bc7, Bc7]);
    assert_eq!(of(&formats(false, true, false)), [Etc2Rgba8, Rgba8]);
    assert_eq!(of(&LoadOptions::default()), [Rgba8, Rgba8]);
    for name in ["odd_uastc.ktx2", "color_one_level.ktx2", "color_rgba8.ktx2"] {
        let scene = load_with(&with_textures(&[&file(name)], &[basis(0)]), &formats(true, true, true));
        let image = &scene.expect("a good file").images[0];
        assert!(image.format == Rgba8 && image.levels.len() == 1 && image.missing_levels(), "{name}");
    }
}

/// Blocks of 64 × 64 texels with all levels need 5,488 bytes, RGBA 21,844; the budget is charged for the chosen format.
#[test]
fn the_budget_is_charged_for_the_format() {
    let fixture = with_textures(&[&file("color_uastc.ktx2")], &[basis(0)]);
    let taken = |options: LoadOptions| {
        let memory = Memory::new(1 << 24);
        let options = LoadOptions { memory: memory.into(), ..options };
        load_with(&fixture, &options).expect("there is enough");
        (1 << 24) - options.memory.lend(u64::MAX).map(drop).expect_err("so much is never left").left_bytes
    };
    let texels: u64 = (0..7).map(|level| (64_u64 >> level).pow(2)).sum();
    let blocks: u64 = (0..7).map(|level| (64_u64 >> level).div_ceil(4).pow(2)).sum();
    assert_eq!((4 * texels, 16 * blocks), (21_844, 5_488));
    let difference = taken(LoadOptions::default()) - taken(formats(true, false, false));
    assert_eq!(difference, 4 * texels - 16 * blocks);
    let options = LoadOptions { memory: Memory::new(20_000).into(), ..LoadOptions::default() };
    let error = load_with(&fixture, &options).expect_err("too little").to_string();
    assert!(error.contains("image 0, 64×64"), "{error}");
}

#[test]
fn damaged_images_name_image_and_reason() {
    let mut ktx = file("color_etc1s.ktx2");
    ktx.truncate(1000);
    let error = with_textures(&[&ktx], &[basis(0)]).error();
    assert!(error.contains("image 0") && error.contains("it ends within its levels"), "{error}");
    let mut webp = file("color_lossless.webp");
    webp.truncate(100);
    let error = with_textures(&[&webp], &[json!({"source": 0})]).error();
    assert!(error.contains("image 0"), "{error}");
}
