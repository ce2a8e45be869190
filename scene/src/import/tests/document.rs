//! Containers, hierarchies, extensions, progress and interruption.

use std::ops::ControlFlow;
use std::path::Path;

use glam::DVec3;
use serde_json::json;

use super::fixture::{Fixture, png};
use crate::error::SceneError;
use crate::import::{load, load_bytes, load_with};
use crate::progress::{Progress, Stage, silent};
use crate::{LoadOptions, Memory, Scene};

fn message(bytes: &[u8]) -> String {
    load_bytes(Path::new("x.glb"), bytes, &mut silent).expect_err("broken").to_string()
}

#[test]
fn broken_containers_say_what_is_wrong() {
    let good = Fixture::triangle().glb();
    assert!(message(b"").contains("empty"));
    assert!(message(b"not json").contains("JSON: "));
    assert!(message(b"[1, 2]").contains("JSON: "));
    assert!(message(b"{}").contains("asset"));
    assert!(message(&good[..8]).contains("truncated header"));
    assert!(message(&good[..good.len() - 9]).contains("truncated"));
    let patched = |at: usize, word: u32| {
        let mut bytes = good.clone();
        bytes[at..at + 4].copy_from_slice(&word.to_le_bytes());
        message(&bytes)
    };
    assert!(patched(4, 1).contains("glTF version \"1.0\" is not supported"));
    assert!(patched(4, 3).contains("version 3"));
    // Less than the header itself; the reader of the `gltf` crate subtracts without a check.
    assert!(patched(8, 3).contains("truncated"));
    assert!(patched(12, 0xffff_fff0).contains("a chunk promises"));
    assert!(patched(16, 0x004e_4942).contains("not JSON"));
}

/// Every prefix of a file returns an error, without a panic.
#[test]
fn every_truncation_is_an_error() {
    let good = Fixture::triangle().glb();
    for length in 0..good.len() {
        let error = message(&good[..length]);
        assert!(error.starts_with("x.glb: ") && !error.contains('\n'), "{length}: {error}");
    }
}

#[test]
fn required_extensions_are_named_and_versions_checked() {
    let mut fixture = Fixture::triangle();
    fixture.json["extensionsRequired"] = json!(["KHR_texture_transform", "EXT_w", "EXT_x"]);
    let error = fixture.error();
    assert!(error.contains("EXT_w, EXT_x"), "{error}");
    assert!(!error.contains("KHR_texture_transform"), "{error}");
    let mut fixture = Fixture::triangle();
    fixture.set("/asset/version", json!("1.0"));
    assert!(fixture.error().contains("\"1.0\""));
}

/// Three levels, one of them a matrix; far from the origin transforms are accumulated in f64.
#[test]
fn transforms_accumulate_along_the_hierarchy() {
    let mut fixture = Fixture::triangle();
    fixture.json["nodes"] = json!([
        {"mesh": 0, "name": "leaf", "translation": [0.001, 0.0, 0.0]},
        {"children": [0], "matrix": [0, 0, -2, 0, 0, 2, 0, 0, 2, 0, 0, 0, 1e6, 0, 0, 1]},
        {"children": [1], "translation": [1e6, 5.0, 0.0]},
        {"mesh": 0, "name": "not in the scene"},
    ]);
    fixture.set("/scenes/0/nodes", json!([2]));
    let scene = fixture.load().expect("a good file");
    assert_eq!(scene.instances.len(), 1);
    let at = scene.instances[0].world_from_model.transform_point3(DVec3::ZERO);
    let expected = DVec3::new(2e6, 5.0, -2.0 * f64::from(0.001_f32));
    assert!((at - expected).length() < 1e-9, "{at}");
    assert!((scene.bounds().half_extent() - DVec3::new(0.0, 1.0, 1.0)).length() < 1e-6);
}

#[test]
fn without_scenes_every_root_is_drawn() {
    let mut fixture = Fixture::triangle();
    fixture.json["nodes"] = json!([{"mesh": 0}, {"children": [0]}, {"mesh": 0}]);
    let document = fixture.json.as_object_mut().expect("an object");
    document.remove("scenes");
    document.remove("scene");
    assert_eq!(fixture.load().expect("a good file").instances.len(), 2);
}

#[test]
fn cycles_and_shared_children_are_errors() {
    let broken = |nodes: serde_json::Value, word: &str| {
        let mut fixture = Fixture::triangle();
        fixture.json["nodes"] = nodes;
        let error = fixture.error();
        assert!(error.contains(word), "{error}");
    };
    broken(json!([{"children": [0]}]), "node 0: it has two parents or is its own ancestor");
    broken(json!([{"children": [1]}, {"children": [0]}]), "node 0: it has two parents");
    broken(json!([{"children": [1, 2]}, {"children": [2]}, {}]), "node 2: it has two parents");
    broken(json!([{"children": [7]}]), "names node 7, but there are 1");
    broken(json!([{"rotation": [0, 0, 0, 0]}]), "has no length");
    broken(json!([{"translation": [0, 1e39, 0]}]), "not finite");
    broken(json!([{"matrix": [1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}]), "last row");
    let big = json!([1e30, 1.0, 1.0]);
    broken(json!([{"mesh": 0, "scale": big, "name": "n"}]), "node 0 \"n\": its mesh reaches 1.000e30 m");
    // A chain whose product overflows f64.
    let mut chain: Vec<_> = (0..12).map(|i| json!({"scale": [1e38, 1e38, 1e38], "children": [i + 1]})).collect();
    chain.push(json!({"mesh": 0}));
    broken(json!(chain), "overflows");
}

/// A chain deep enough to overflow the stack under recursion.
#[test]
fn deep_hierarchies_do_not_recurse() {
    let mut fixture = Fixture::triangle();
    let depth = 50_000;
    let mut nodes: Vec<_> = (1..depth).map(|i| json!({"children": [i]})).collect();
    nodes.push(json!({"mesh": 0}));
    fixture.json["nodes"] = json!(nodes);
    assert_eq!(fixture.load().expect("deep, but good").instances.len(), 1);
}

/// A file with an external buffer and an image under percent-encoded names. Every stage is reported; stopping at any
/// report returns the matching error.
#[test]
fn external_files_progress_and_interruption() {
    let folder = std::env::temp_dir().join(format!("scene import {}", std::process::id()));
    std::fs::create_dir_all(folder.join("ä")).expect("a temporary folder");
    let mut fixture = Fixture::triangle();
    let uv = fixture.floats(2, &[0.0; 6]);
    fixture.set("/meshes/0/primitives/0/attributes/TEXCOORD_0", json!(uv));
    fixture.set("/meshes/0/primitives/0/material", json!(0));
    let base = json!({"baseColorTexture": {"index": 0}});
    fixture.push("materials", json!({"pbrMetallicRoughness": base}));
    fixture.push("textures", json!({"source": 0}));
    fixture.push("images", json!({"uri": "%C3%A4/my%20image.png"}));
    fixture.json["buffers"] = json!([{"uri": "the%20data.bin", "byteLength": fixture.bin.len()}]);
    std::fs::write(folder.join("the data.bin"), &fixture.bin).expect("a temporary file");
    let image = folder.join("ä/my image.png");
    std::fs::write(&image, png(3, 2, [1, 2, 3, 4])).expect("a temporary file");
    let file = folder.join("a model.gltf");
    std::fs::write(&file, fixture.json.to_string()).expect("a temporary file");

    let mut stages = Vec::new();
    let mut record = |p: Progress<'_>| {
        assert!(p.done <= p.total && !p.item.is_empty());
        stages.push(p.stage);
        ControlFlow::Continue(())
    };
    let scene = load(&file, &mut record).expect("a good file");
    assert_eq!(scene.name, "a model");
    assert_eq!((scene.images[0].width, scene.images[0].height), (3, 2));
    assert!(scene.images[0].name.ends_with("my image.png"));
    assert_eq!(stages, [Stage::Files, Stage::Geometry, Stage::Headers, Stage::Images]);

    for stop_at in 0..3 {
        let mut seen = 0;
        let mut stop = |_: Progress<'_>| {
            seen += 1;
            if seen > stop_at { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let error = load(&file, &mut stop).expect_err("it was stopped");
        assert!(matches!(error, SceneError::Interrupted { .. }), "{error}");
    }

    std::fs::write(&image, b"\x89PNG\r\n\x1a\nrubbish").expect("a temporary file");
    let error = load(&file, &mut silent).expect_err("a broken image").to_string();
    assert!(error.contains("my image.png") && error.contains("does not decode"), "{error}");
    std::fs::remove_file(&image).expect("the file is ours");
    let error = load(&file, &mut silent).expect_err("a missing image").to_string();
    assert!(error.contains("my image.png: cannot be read"), "{error}");
    std::fs::write(folder.join("the data.bin"), [0; 7]).expect("a temporary file");
    let error = load(&file, &mut silent).expect_err("a short buffer").to_string();
    assert!(error.contains("buffer 0: truncated"), "{error}");
    let error = load(&folder, &mut silent).expect_err("a folder").to_string();
    assert!(error.contains("cannot be read"), "{error}");
    std::fs::remove_dir_all(&folder).expect("the folder is ours");
}

/// Sixteen images of one file, and as many of one buffer view, are decoded as two images and charged as such.
#[test]
fn an_image_with_one_source_is_decoded_once() {
    let folder = std::env::temp_dir().join(format!("scene-shared-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a temporary folder");
    std::fs::write(folder.join("a.png"), png(32, 32, [1, 2, 3, 4])).expect("the folder is ours");
    let mut fixture = Fixture::triangle();
    let uv = fixture.floats(2, &[0.0; 6]);
    let view = fixture.view(&png(32, 16, [4, 3, 2, 1]));
    let primitive = fixture.json["meshes"][0]["primitives"][0].clone();
    fixture.json["meshes"][0]["primitives"] = json!([]);
    for i in 0..32 {
        let uri = ["a.png", "./a.png"][i / 2 % 2];
        let image = if i % 2 == 0 { json!({"uri": uri}) } else { json!({"bufferView": view, "mimeType": "image/png"}) };
        fixture.push("images", image);
        fixture.push("textures", json!({"source": i}));
        fixture.push("materials", json!({"emissiveTexture": {"index": i}}));
        let mut primitive = primitive.clone();
        (primitive["attributes"]["TEXCOORD_0"], primitive["material"]) = (json!(uv), json!(i));
        fixture.primitive(primitive);
    }
    let file = folder.join("s.glb");
    std::fs::write(&file, fixture.glb()).expect("the folder is ours");
    let options = LoadOptions { memory: Memory::new(1 << 20).into(), ..LoadOptions::default() };
    let scene = load_with(&file, &options, &mut silent).expect("a good file");
    assert_eq!((scene.images.len(), scene.textures.len(), scene.materials.len()), (2, 2, 32));
    assert_eq!(scene.files, [folder.join("a.png"), file.clone()]);
    let texels = (32 * 32 + 32 * 16) * 4;
    let left = (1 << 20) - texels;
    assert!(options.memory.keep(left).is_err(), "vertices are counted, too");
    assert!(options.memory.keep(left - 2000).is_ok(), "files and working memory are given back");
    // Enough for the file and the images, but not for vertices: nothing is decoded, and nothing stays charged.
    let bytes = texels + fixture.glb().len() as u64;
    let small = LoadOptions { memory: Memory::new(bytes).into(), ..LoadOptions::default() };
    let error = load_with(&file, &small, &mut silent).map(drop).expect_err("no room").to_string();
    assert!(error.contains("32×") && error.contains("memory are needed"), "{error}");
    assert!(small.memory.keep(bytes).is_ok());
    std::fs::remove_dir_all(&folder).expect("the folder is ours");
}

#[test]
fn a_name_is_a_built_in_scene_or_a_file() {
    let open = |name: &str| Scene::open(name, &mut silent);
    assert_eq!(open("spheres").expect("built in").name, "spheres");
    let error = open("sphere").expect_err("misspelt").to_string();
    assert!(error.contains(&crate::builtin::NAMES.join(", ")), "{error}");
    let error = open("no/such/file.gltf").expect_err("missing").to_string();
    assert!(error.contains("no/such/file.gltf: cannot be read"), "{error}");
}
