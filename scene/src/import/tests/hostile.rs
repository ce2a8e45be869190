//! Files that violate one rule each: the one-line error contains the place and the reason.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};

use super::fixture::{Fixture, png};
use crate::{LoadOptions, Memory};

/// Sets one value of the valid triangle and expects a message with all `words`.
#[track_caller]
fn broken(pointer: &str, value: Value, words: &[&str]) {
    let mut fixture = Fixture::triangle();
    fixture.set(pointer, value);
    let error = fixture.error();
    for word in words {
        assert!(error.contains(word), "{error} lacks {word:?}");
    }
}

#[test]
fn indices_out_of_range() {
    let primitive = "/meshes/0/primitives/0";
    let at = |rest: &str| format!("{primitive}{rest}");
    let position = at("/attributes/POSITION");
    // The validation of the `gltf` crate panics on this one.
    broken(&position, json!(99), &["mesh 0 primitive 0 POSITION", "accessor 99", "are 3"]);
    broken(&at("/attributes/NORMAL"), json!(99), &["NORMAL", "names accessor 99"]);
    broken(&at("/indices"), json!(7), &["mesh 0 primitive 0 indices", "accessor 7"]);
    broken(&at("/material"), json!(3), &["mesh 0 primitive 0", "material 3"]);
    broken("/nodes/0/mesh", json!(5), &["node 0 \"only\"", "names mesh 5, but there are 1"]);
    broken("/nodes/0/camera", json!(5), &["names camera 5"]);
    broken("/scenes/0/nodes", json!([8]), &["names node 8"]);
    broken("/scene", json!(2), &["default scene", "names scene 2"]);
    broken("/accessors/0/bufferView", json!(9), &["accessor 0", "buffer view 9"]);
    broken("/bufferViews/0/buffer", json!(9), &["accessor 0", "names buffer 9"]);
}

#[test]
fn ranges_that_exceed_their_bytes() {
    let exceeds = ["POSITION: accessor 0", "exceed buffer view 0 of 36 bytes"];
    broken("/accessors/0/count", json!(4), &exceeds);
    broken("/accessors/0/byteOffset", json!(1), &exceeds);
    broken("/accessors/0/byteOffset", json!(u64::MAX), &exceeds);
    broken("/bufferViews/0/byteLength", json!(35), &["exceed buffer view 0 of 35 bytes"]);
    broken("/bufferViews/0/byteLength", json!(u64::MAX), &["buffer view 0 covers"]);
    broken("/bufferViews/0/byteOffset", json!(u64::MAX), &["buffer view 0 covers"]);
    broken("/bufferViews/0/byteStride", json!(4), &["stride of 4 bytes is less"]);
    broken("/bufferViews/0/byteStride", json!(1_000_000), &["exceed buffer view 0"]);
    broken("/bufferViews/0/byteStride", json!(usize::MAX), &["exceed buffer view 0"]);
    broken("/buffers", json!([{"byteLength": 1_000_000}]), &["buffer 0: truncated"]);
    // A buffer without bytes reads as zeros, up to its stated length and the memory budget.
    let absent = |bytes: u64| {
        let mut fixture = Fixture::triangle();
        fixture.set("/bufferViews/1/buffer", json!(1));
        fixture.set("/bufferViews/1/byteOffset", json!(0));
        fixture.set("/buffers", json!([{"byteLength": 78}, {"byteLength": bytes}]));
        fixture
    };
    let scene = absent(36).load().expect("normals of zero are repaired");
    assert!(scene.warnings.iter().any(|w| w.contains("buffer 1: the buffer has neither")), "{:?}", scene.warnings);
    assert!(absent(35).error().contains("buffer view 1 covers 36 bytes"));
    assert!(absent(1 << 60).error().contains("buffer 1: "));
}

/// Counts without bytes must not cause allocations.
#[test]
fn allocation_bombs() {
    let over = ["over the limit of 268435456"];
    broken("/accessors/0/count", json!(u64::MAX), &over);
    broken("/accessors/0/count", json!(1_u64 << 40), &over);
    broken("/accessors/0/count", json!(0), &["no elements"]);
    let mut fixture = Fixture::triangle();
    // Without a buffer view the elements are zeros, in any number.
    fixture.json["accessors"][0] = json!({"componentType": 5126, "type": "VEC3", "count": 1_u64 << 40});
    assert!(fixture.error().contains("over the limit of 268435456"));
    // Many meshes of a few bytes each, all over the same large view.
    let options = LoadOptions { memory: Memory::new(100).into(), ..LoadOptions::default() };
    let file = std::path::Path::new("x");
    let document = crate::import::document::parse(file, br#"{"asset": {"version": "2.0"}}"#).expect("a document");
    let source = crate::import::source::Source::new(file, &document, &options);
    assert!(source.charge(100).is_ok());
    let error = source.charge(1).expect_err("the budget is spent").to_string();
    assert!(error.contains("x: vertices: ") && error.contains("0.0 MiB are left"), "{error}");
    assert!(source.charge(u64::MAX).is_err());
    // A failed load releases its memory.
    drop(source);
    assert!(options.memory.keep(100).is_ok());
}

#[test]
fn wrong_types() {
    broken("/accessors/0/type", json!("VEC2"), &["accessor 0 has 2 components, not 3"]);
    broken("/accessors/0/type", json!("MAT2"), &["accessor 0", "2×2 or 3×3 matrices"]);
    broken("/accessors/0/type", json!("MAT4"), &["accessor 0", "3 elements of 64 bytes"]);
    broken("/accessors/0", json!({"componentType": 5126, "type": "MAT4", "count": 1}), &["16 components, not 3"]);
    broken("/accessors/0/type", json!("VEC5"), &["accessor 0", "unknown component type"]);
    broken("/accessors/0/componentType", json!(5124), &["accessor 0", "unknown component type"]);
    broken("/accessors/2/componentType", json!(5122), &["accessor 2", "unsigned scalars"]);
    broken("/meshes/0/primitives/0/mode", json!(9), &["unknown primitive mode"]);
    broken("/accessors/1/count", json!(2), &["2 elements of NORMAL for 3 vertices"]);
}

#[test]
fn numbers_that_cannot_be_drawn() {
    let with = |set: &dyn Fn(&mut Fixture)| {
        let mut fixture = Fixture::triangle();
        set(&mut fixture);
        fixture.error()
    };
    let poke = |fixture: &mut Fixture, at: usize, value: f32| {
        fixture.bin[at..at + 4].copy_from_slice(&value.to_le_bytes());
    };
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let error = with(&|f| poke(f, 12, value));
        assert!(error.contains("mesh 0 primitive 0: POSITION of vertex 1 is not finite"), "{error}");
    }
    let error = with(&|f| {
        let i = f.shorts(&[0, 1, 3]);
        f.set("/meshes/0/primitives/0/indices", json!(i));
    });
    assert!(error.contains("index 2 names vertex 3, but there are 3"), "{error}");
}

#[test]
fn broken_sparse_accessors() {
    let with = |change: &dyn Fn(&mut Value), word: &str| {
        let mut fixture = Fixture::triangle();
        let indices = fixture.view(&[2, 0]);
        let values = fixture.view(&[0; 12]);
        let mut sparse = json!({
            "count": 1,
            "indices": {"bufferView": indices, "componentType": 5121},
            "values": {"bufferView": values},
        });
        change(&mut sparse);
        fixture.set("/accessors/0/sparse", sparse);
        let error = fixture.error();
        assert!(error.contains("accessor 0") && error.contains(word), "{error}");
    };
    with(&|s| s["count"] = json!(0), "0 sparse elements");
    with(&|s| s["count"] = json!(4), "4 sparse elements of 3");
    with(&|s| s["count"] = json!(u64::MAX), "sparse elements of 3");
    with(&|s| s["count"] = json!(3), "exceed buffer view");
    // The last byte of the float 1.0 as an index.
    with(
        &|s| s["indices"] = json!({"bufferView": 0, "byteOffset": 15, "componentType": 5121}),
        "a sparse index is 63, but there are 3",
    );
    with(&|s| s["indices"]["bufferView"] = json!(77), "buffer view 77");
    with(&|s| s["indices"]["componentType"] = json!(5126), "component type of sparse indices");
    with(&|s| s["values"]["byteOffset"] = json!(4), "exceed buffer view");
}

#[test]
fn broken_materials_and_images() {
    let with = |change: &dyn Fn(&mut Fixture), word: &str| {
        let mut fixture = Fixture::triangle();
        let uv = fixture.floats(2, &[0.0; 6]);
        fixture.set("/meshes/0/primitives/0/attributes/TEXCOORD_0", json!(uv));
        fixture.set("/meshes/0/primitives/0/material", json!(0));
        fixture.push("materials", json!({"emissiveTexture": {"index": 0}}));
        fixture.push("textures", json!({"source": 0, "sampler": 0}));
        fixture.push("samplers", json!({}));
        let view = fixture.view(&png(2, 2, [9; 4]));
        fixture.push("images", json!({"bufferView": view, "mimeType": "image/png"}));
        fixture.clone().load().expect("good until changed");
        change(&mut fixture);
        let error = fixture.error();
        assert!(error.contains(word), "{error} lacks {word:?}");
    };
    let set = |pointer: &'static str, value: Value| {
        move |f: &mut Fixture| {
            f.set(pointer, value.clone());
        }
    };
    with(&set("/materials/0/emissiveTexture/index", json!(4)), "material 0: names texture 4");
    with(&set("/textures/0/source", json!(4)), "names image 4");
    let basis = json!({"source": 0, "extensions": {"KHR_texture_basisu": {"source": 4}}});
    with(&set("/textures/0", basis), "texture 0 names image 4");
    with(&set("/textures/0/sampler", json!(4)), "names sampler 4");
    with(&set("/samplers/0/wrapS", json!(1)), "sampler 0 has an unknown value");
    with(&set("/materials/0/alphaMode", json!("GLASS")), "unknown alpha mode");
    with(&set("/materials/0/emissiveFactor", json!([1e39, 0, 0])), "its emission is");
    with(&set("/materials/0/emissiveFactor", json!([-1, 0, 0])), "its emission is");
    let ior = json!({"KHR_materials_ior": {"ior": 0.5}});
    with(&set("/materials/0/extensions", ior), "index of refraction is 0.5");
    let transform = json!({"KHR_texture_transform": {"scale": [1e39, 1.0]}});
    with(&set("/materials/0/emissiveTexture/extensions", transform), "transform is not finite");
    let normal = json!({"index": 0, "extensions": {"KHR_texture_transform": {"scale": "big"}}});
    with(&set("/materials/0/normalTexture", normal), "KHR_texture_transform: ");
    with(&set("/images/0", json!({"mimeType": "image/png"})), "neither a URI nor");
    with(&set("/images/0/bufferView", json!(0)), "image 0: does not decode");
    with(&set("/images/0/bufferView", json!(77)), "buffer view 77");
    with(&set("/images/0", json!({"uri": "http://x/y.png"})), "URI scheme \"http\"");
    let gif = format!("data:image/gif;base64,{}", STANDARD.encode(b"GIF89a"));
    with(&set("/images/0", json!({"uri": gif})), "GIF format is not supported; use PNG, JPEG, WebP or KTX2");
    with(
        &|f| {
            let mut bytes = png(2, 2, [9; 4]);
            bytes.truncate(bytes.len() / 2);
            let view = f.view(&bytes);
            f.set("/images/0/bufferView", json!(view));
        },
        "image 0: does not decode",
    );
    with(
        &|f| {
            // A header that claims 2^31 − 1 texels a side.
            let mut bytes = png(2, 2, [9; 4]);
            bytes[16..24].copy_from_slice(&[0x7f, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff]);
            let view = f.view(&bytes);
            f.set("/images/0/bufferView", json!(view));
        },
        "image 0",
    );
}
