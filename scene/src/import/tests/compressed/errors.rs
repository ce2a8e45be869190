//! Errors name the place in the file. Uncompressed fallbacks are not read.

use std::ops::ControlFlow;
use std::path::Path;

use serde_json::{Value, json};

use super::super::fixture::Fixture;
use super::{bytes, fixture};
use crate::error::SceneError;
use crate::import::{load_bytes, load_bytes_with};
use crate::progress::{Progress, Stage, silent};
use crate::{LoadOptions, Memory, Mesh, Scene};

const DRACO: &str = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";
const MESHOPT: &str = "/bufferViews/0/extensions/KHR_meshopt_compression";

/// Sets one value of a file and expects a message with all `words`.
#[track_caller]
fn broken(name: &str, pointer: &str, value: Value, words: &[&str]) {
    let mut fixture = fixture(name);
    fixture.set(pointer, value);
    let error = fixture.error();
    for word in words {
        assert!(error.contains(word), "{error} lacks {word:?}");
    }
}

#[test]
fn wrong_draco_objects_are_named() {
    let place = "mesh 0 primitive 0: KHR_draco_mesh_compression";
    let broken = |pointer: &str, value, words: &[&str]| broken("draco_coarse", pointer, value, words);
    let of = |rest: &str| format!("{DRACO}{rest}");
    broken(&of("/bufferView"), json!(7), &[place, "names buffer view 7"]);
    broken(&of("/bufferView"), json!("x"), &[place, "no bufferView"]);
    broken(&of(""), json!([]), &[place, "no bufferView"]);
    broken(&of("/attributes/NORMAL"), json!(9), &[place, "no attribute 9", "0, 1, 2, 3"]);
    broken(&of("/attributes/NORMAL"), json!(-1), &[place, "id of NORMAL"]);
    // The texture coordinates have two components.
    broken(&of("/attributes/NORMAL"), json!(2), &["NORMAL: accessor 1", "attribute 2 of the compressed mesh has 2"]);
    broken("/bufferViews/0/byteLength", json!(900), &[place, "does not decode"]);
}

#[test]
fn accessors_must_match_the_compressed_mesh() {
    let place = "mesh 0 primitive 0";
    let broken = |pointer: &str, value, words: &[&str]| broken("draco_coarse", pointer, value, words);
    broken("/accessors/0/count", json!(560), &[place, "has 561 vertices", "states 560"]);
    broken("/accessors/1/count", json!(560), &[place, "accessor 1", "states 560 elements", "has 561"]);
    broken("/accessors/1/type", json!("VEC2"), &[place, "accessor 1", "has 2 components", "attribute 1"]);
    broken("/accessors/1/componentType", json!(5121), &[place, "states integers", "has floats"]);
    broken("/accessors/3/componentType", json!(5126), &[place, "states floats", "has integers"]);
    broken("/accessors/3/componentType", json!(5120), &[place, "outside -128…127"]);
    broken("/accessors/4/count", json!(3069), &[place, "more than the 1023 triangles"]);
    broken("/accessors/4/count", json!(3075), &[place, "states 3075 indices", "has 3072"]);
    broken("/accessors/4/count", json!(u64::MAX), &[place, "corners, over"]);
    broken("/accessors/0/count", json!(u64::MAX), &[place, "vertices", "over"]);
}

#[test]
fn wrong_meshopt_objects_are_named() {
    let place = "buffer view 0: KHR_meshopt_compression";
    let broken = |pointer: &str, value, words: &[&str]| broken("meshopt_v1", pointer, value, words);
    let of = |rest: &str| format!("{MESHOPT}{rest}");
    broken(&of("/mode"), json!("LINES"), &[place, "\"LINES\""]);
    broken(&of("/mode"), Value::Null, &[place, "mode"]);
    broken(&of("/mode"), json!("TRIANGLES"), &[place, "stride of 12 bytes", "2 or 4"]);
    broken(&of("/filter"), json!("BLUR"), &[place, "\"BLUR\""]);
    broken(&of("/filter"), json!("QUATERNION"), &[place, "QUATERNION", "12"]);
    broken(&of("/byteStride"), json!(6), &[place, "stride of 6 bytes"]);
    broken(&of("/count"), json!(560), &[place, "6720 bytes", "6732"]);
    broken(&of("/count"), json!(u64::MAX), &[place, "fewer than"]);
    broken(&of("/count"), json!(0), &[place, "count of 0"]);
    broken(&of("/count"), json!("many"), &[place, "its count is not a whole number"]);
    broken(&of("/buffer"), json!(9), &[place, "names buffer 9"]);
    broken(&of("/buffer"), json!(1), &[place, "fallback without data"]);
    broken(&of("/byteOffset"), json!(1u64 << 40), &[place, "from 1099511627776"]);
    broken(&of("/byteLength"), json!(100), &[place]);
    broken("/bufferViews/0/byteLength", json!(12), &[place, "6732 bytes, but the view has 12"]);
    // Views without the extension cannot use a fallback.
    broken("/bufferViews/0/extensions", json!({}), &["POSITION: accessor 0", "buffer 1, a fallback without data"]);
}

/// Fallbacks may be missing, have the URI of a missing file, or lack the mark.
#[test]
fn fallback_buffers_are_never_read() {
    let mut named = fixture("meshopt_v1");
    named.set("/buffers/1/uri", json!("not there.bin"));
    let mut unmarked = fixture("meshopt_v1");
    unmarked.set("/buffers/1/extensions", json!({}));
    for fixture in [named, unmarked.clone()] {
        assert_eq!(fixture.load().expect("the fallback is not needed").triangle_count(), 1024);
    }
    unmarked.set("/buffers/1/uri", json!("not there.bin"));
    assert!(unmarked.error().contains("not there.bin"), "nothing says that this buffer is a fallback");
}

/// Both names of the extension are equivalent, and the newer one takes precedence.
#[test]
fn either_name_of_the_extension_is_read() {
    let mut fixture = fixture("meshopt_v1");
    for view in 0..5 {
        let extensions = format!("/bufferViews/{view}/extensions");
        let json = fixture.json.pointer(&extensions).expect("it is compressed")["KHR_meshopt_compression"].clone();
        fixture.set(&extensions, json!({"EXT_meshopt_compression": json}));
    }
    assert_eq!(fixture.load().expect("a good file").triangle_count(), 1024);
    fixture.set("/bufferViews/0/extensions/KHR_meshopt_compression", json!({}));
    assert!(fixture.error().contains("buffer view 0: KHR_meshopt_compression"));
}

/// An image in a compressed view, whose bytes are elements of four.
#[test]
fn images_may_be_compressed_views() {
    let mut plain = Fixture::triangle();
    let uv = plain.floats(2, &[0.0; 6]);
    plain.set("/meshes/0/primitives/0/attributes/TEXCOORD_0", json!(uv));
    plain.set("/meshes/0/primitives/0/material", json!(0));
    plain.push("materials", json!({"emissiveTexture": {"index": 0}}));
    plain.push("textures", json!({"source": 0}));
    let mut picture = super::super::fixture::png(1, 1, [10, 20, 30, 255]);
    picture.resize(picture.len().next_multiple_of(4), 0);
    // Version 1: each byte position is stored literally as zigzag differences from the previous element, starting at
    // zero.
    let count = picture.len() / 4;
    let mut stream = vec![0xa1, 0xff];
    for byte in 0..4 {
        let mut last = 0u8;
        for element in picture.chunks_exact(4) {
            let difference = element[byte].wrapping_sub(last) as i8;
            stream.push((difference << 1 ^ difference >> 7) as u8);
            last = element[byte];
        }
    }
    stream.extend([0; 24]);
    let compressed = plain.view(&stream);
    let mut extension = plain.json["bufferViews"][compressed].clone();
    extension["count"] = json!(count);
    extension["byteStride"] = json!(4);
    extension["mode"] = json!("ATTRIBUTES");
    let view = json!({"buffer": 0, "byteLength": picture.len(), "extensions": {"KHR_meshopt_compression": extension}});
    let view = plain.push("bufferViews", view);
    plain.push("images", json!({"bufferView": view, "mimeType": "image/png"}));
    assert_eq!(plain.load().expect("a good file").images[0].rgba8(), Some(&[10, 20, 30, 255][..]));
}

/// Primitives that share a compressed view share its decoded mesh; the same accessors with another view are another
/// mesh.
#[test]
fn compressed_meshes_are_decoded_once_and_told_apart() {
    let mut fixture = fixture("draco_coarse");
    let (start, primitive) = (fixture.bin.len(), fixture.json["meshes"][0]["primitives"][0].clone());
    let length = fixture.json["bufferViews"][0]["byteLength"].clone();
    let bin = fixture.bin.clone();
    fixture.bin.extend(bin);
    fixture.set("/buffers/0/byteLength", json!(fixture.bin.len()));
    let copy = fixture.push("bufferViews", json!({"buffer": 0, "byteOffset": start, "byteLength": length}));
    let mut other = primitive.clone();
    other["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = json!(copy);
    // A third primitive with colors from a separate accessor.
    let white = fixture.array(&[255; 561 * 4], 5121, "VEC4", 561);
    fixture.set(&format!("/accessors/{white}/normalized"), json!(true));
    fixture.set("/buffers/0/byteLength", json!(fixture.bin.len()));
    let mut plain = primitive.clone();
    plain["extensions"]["KHR_draco_mesh_compression"]["attributes"].as_object_mut().expect("ids").remove("COLOR_0");
    plain["attributes"]["COLOR_0"] = json!(white);
    // The first uses fewer attributes than the second, which shares its view.
    fixture.set("/meshes/0/primitives", json!([plain, primitive, other, primitive]));
    let mut reports = Vec::new();
    let mut record = |p: Progress<'_>| {
        if p.stage == Stage::Decompression {
            reports.push((p.done, p.total));
        }
        ControlFlow::Continue(())
    };
    let scene = load_bytes(Path::new("x.glb"), &fixture.glb(), &mut record).expect("a good file");
    assert_eq!((scene.instances.len(), scene.meshes.len()), (4, 3));
    assert_eq!(reports, [(1, 2), (2, 2)]);
    let is_white = |mesh: &Mesh| mesh.colors.iter().all(|color| color.min_element() == 1.0);
    assert_eq!(scene.meshes.iter().map(is_white).collect::<Vec<_>>(), [true, false, false]);
}

/// A strip's accessor counts the strip's indices, but the stream contains triangles. Lines cannot be compressed: their
/// accessors are read, which have no data here.
#[test]
fn modes_other_than_triangles() {
    let count = |scene: &Scene| scene.triangle_count();
    let mut strip = fixture("draco_coarse");
    strip.set("/meshes/0/primitives/0/mode", json!(5)).set("/accessors/4/count", json!(1500));
    assert_eq!(count(&strip.load().expect("a good file")), 1024);
    let mut bare = fixture("draco_coarse");
    bare.json["meshes"][0]["primitives"][0].as_object_mut().expect("a primitive").remove("indices");
    assert_eq!(count(&bare.load().expect("a good file")), 1024);
    let mut lines = fixture("draco_coarse");
    lines.set("/meshes/0/primitives/0/mode", json!(1)).set(&format!("{DRACO}/attributes/NORMAL"), json!(99));
    let scene = lines.load().expect("nothing to draw");
    assert!(scene.warnings.iter().any(|line| line.contains("it has no line")), "{:?}", scene.warnings);
}

/// Decoded bytes are charged before they are allocated, and released by a failed load.
#[test]
fn decompression_keeps_to_the_budget() {
    for (name, place) in [("draco_coarse", "KHR_draco_mesh_compression"), ("meshopt_v0", "EXT_meshopt_compression")] {
        let glb = bytes(name);
        let with = |budget| {
            let options = LoadOptions { memory: Memory::new(budget).into(), ..LoadOptions::default() };
            let loaded = load_bytes_with(Path::new("x.glb"), &glb, &options, &mut silent);
            (loaded.map(|scene| scene.triangle_count()), options)
        };
        let (refused, options) = with(1000);
        let error = refused.expect_err("1000 bytes are not enough");
        assert!(matches!(error, SceneError::Memory { .. }) && error.to_string().contains(place), "{error}");
        assert!(options.memory.keep(1000).is_ok(), "{name}: a load that fails gives back its memory");
        assert_eq!(with(1 << 20).0.expect("a MiB is enough"), 1024);
    }

    // Many views of one mesh: their decoded copies count until the scene is built.
    let mut many = fixture("draco_coarse");
    let (view, primitive) = (many.json["bufferViews"][0].clone(), many.json["meshes"][0]["primitives"][0].clone());
    for _ in 0..20 {
        let mut primitive = primitive.clone();
        let view = many.push("bufferViews", view.clone());
        primitive["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = json!(view);
        many.primitive(primitive);
    }
    let glb = many.glb();
    let loads = |budget| {
        let options = LoadOptions { memory: Memory::new(budget).into(), ..LoadOptions::default() };
        load_bytes_with(Path::new("x.glb"), &glb, &options, &mut silent).is_ok()
    };
    // The scene's 21 meshes need 1.5 MiB, and their compressed data 1 MiB at the same time.
    assert_eq!((loads(2 << 20), loads(4 << 20)), (false, true));
}
