//! Documents that are valid but rejected by many parsers, and containers with common faults.

use std::path::Path;

use serde_json::{Value, json};

use super::fixture::Fixture;
use crate::Scene;
use crate::error::SceneError;
use crate::import::load_bytes;
use crate::progress::silent;

fn load(bytes: &[u8]) -> Result<Scene, SceneError> {
    load_bytes(Path::new("x.gltf"), bytes, &mut silent)
}

fn error(bytes: &[u8]) -> String {
    load(bytes).expect_err("it is broken").to_string()
}

/// Returns the text of a triangle, with every integer formatted by `form`.
fn with_numbers(form: fn(u64) -> String) -> String {
    let mut fixture = Fixture::triangle();
    let wide = fixture.floats(4, &[0.25; 12]);
    fixture.set("/meshes/0/primitives/0/attributes/COLOR_0", json!(wide));
    fixture.set("/meshes/0/primitives/0/mode", json!(4)).set("/meshes/0/primitives/0/material", json!(0));
    fixture.push("materials", json!({"emissiveFactor": [1, 0, 1], "extensions": {"KHR_materials_ior": {"ior": 2}}}));
    let json: Value = serde_json::from_slice(&fixture.gltf()).expect("it is JSON");
    written(&json, form)
}

fn written(json: &Value, form: fn(u64) -> String) -> String {
    match json {
        Value::Number(number) => number.as_u64().map_or_else(|| number.to_string(), form),
        Value::Array(all) => format!("[{}]", all.iter().map(|v| written(v, form)).collect::<Vec<_>>().join(",")),
        Value::Object(all) => {
            let members = all.iter().map(|(key, value)| format!("{}:{}", json!(key), written(value, form)));
            format!("{{{}}}", members.collect::<Vec<_>>().join(","))
        }
        other => other.to_string(),
    }
}

/// JSON Schema: a number without a fractional part is an integer in any notation.
#[test]
fn integers_may_be_written_as_floats_everywhere() {
    let truth = load(with_numbers(|n| n.to_string()).as_bytes()).expect("it is plain");
    let forms: [fn(u64) -> String; 5] = [
        |n| format!("{n}.0"),
        |n| format!("{n}e0"),
        |n| if n == 0 { "0e-1".into() } else { format!("{n}0e-1") },
        |n| format!("{n}.000E+0"),
        |n| {
            if n == 0 { "-0.0".into() } else { format!("0.{n:08}e8") }
        },
    ];
    for form in forms {
        let text = with_numbers(form);
        let scene = load(text.as_bytes()).unwrap_or_else(|error| panic!("{error}: {text}"));
        assert_eq!((&scene.meshes, &scene.materials), (&truth.meshes, &truth.materials), "{text}");
        assert_eq!(scene.instances[0].world_from_model, truth.instances[0].world_from_model);
    }
}

#[test]
fn fractions_and_huge_numbers_are_no_counts() {
    for (count, path) in
        [("1e300", "accessors[0].count"), ("2.5", "accessors[0].count"), ("-1.0", "accessors[0].count")]
    {
        let mut fixture = Fixture::triangle();
        fixture.set("/accessors/0/count", json!("COUNT"));
        let text = String::from_utf8(fixture.gltf()).expect("it is text").replace("\"COUNT\"", count);
        let error = error(text.as_bytes());
        assert!(error.starts_with("x.gltf: JSON: ") && error.contains(path), "{count}: {error}");
    }
    let mut fixture = Fixture::triangle();
    fixture.set("/accessors/0/count", json!(9_007_199_254_740_992_u64));
    assert!(fixture.error().contains("accessor"), "{}", fixture.error());
}

/// `extras` may hold anything, anywhere in the document, and are ignored.
#[test]
fn extras_are_ignored() {
    let truth = Fixture::triangle().load().expect("it is plain");
    let anything =
        [json!(null), json!(1.5), json!("text"), json!([1, [2]]), json!({"count": -1, "nodes": {}, "extras": 1e300})];
    for extras in anything {
        let mut fixture = Fixture::triangle();
        let mut places = vec!["".to_owned()];
        places.extend(["/asset", "/scenes/0", "/nodes/0", "/meshes/0", "/meshes/0/primitives/0"].map(str::to_owned));
        places.extend(["/accessors/0", "/accessors/1", "/bufferViews/0"].map(str::to_owned));
        for place in places {
            fixture.set(&format!("{place}/extras"), extras.clone());
        }
        let scene = fixture.load().expect("extras are ignored");
        assert_eq!((&scene.meshes, &scene.warnings), (&truth.meshes, &truth.warnings), "{extras}");
    }
}

/// Only extras of materials are read here, and errors in them are warnings.
#[test]
fn extras_of_materials_say_how_triangles_are_put_in_order() {
    use crate::material::TransparencyMode;
    let read = |extras: Value| {
        let mut fixture = Fixture::triangle();
        fixture.set("/materials", json!([{"extras": extras}]));
        fixture.set("/meshes/0/primitives/0/material", json!(0));
        let scene = fixture.load().expect("extras are never an error");
        (scene.materials[0].transparency, scene.warnings.len())
    };
    let named = |name: &str| read(json!({"framegraph": {"transparency": name}}));
    assert_eq!(named("default"), (TransparencyMode::Default, 0));
    assert_eq!(named("two-passes-one-side"), (TransparencyMode::TwoPassesOneSide, 0));
    assert_eq!(named("two-passes-two-sides"), (TransparencyMode::TwoPassesTwoSides, 0));
    assert_eq!(named("both"), (TransparencyMode::Default, 1));
    assert_eq!(read(json!({"framegraph": 1})), (TransparencyMode::Default, 1));
    for other in [json!(null), json!(3), json!({"other": {"transparency": "both"}})] {
        assert_eq!(read(other), (TransparencyMode::Default, 0));
    }
    assert_eq!(read(json!({"framegraph": {"transparency": [1]}})), (TransparencyMode::Default, 1));
}

#[test]
fn deep_nesting_is_an_error() {
    for (open, close) in [("[", "]"), ("{\"extras\":", "}")] {
        let depth = 100_000;
        let text =
            format!("{{\"asset\":{{\"version\":\"2.0\"}},\"extras\":{}0{}}}", open.repeat(depth), close.repeat(depth));
        let error = error(text.as_bytes());
        assert!(error.contains("JSON: recursion limit exceeded"), "{error}");
    }
}

#[test]
fn every_form_of_gltf_1_is_named() {
    let mut container = Fixture::triangle().glb();
    container[4] = 1;
    let texts: [&[u8]; 6] = [
        br#"{"asset": {"version": "1.0"}, "scenes": {"s": {}}}"#,
        br#"{"asset": {"version": 1.0}, "nodes": {}}"#,
        br#"{"asset": {"version": 1.0}}"#,
        br#"{"scenes": {"defaultScene": {"nodes": []}}, "scene": "defaultScene"}"#,
        br#"{"accessors": {"accessor_21": {"count": 24}}, "asset": {}}"#,
        &container,
    ];
    for text in texts {
        let error = error(text);
        assert!(error.starts_with("x.gltf: glTF version \"1.0\" is not supported"), "{error}");
    }
    // Dictionaries alone do not make a version 2 document an old one.
    let odd = error(br#"{"asset": {"version": "2.0"}, "nodes": {}}"#);
    assert!(odd.contains("JSON: nodes: ") && !odd.contains("1.0"), "{odd}");
}

#[test]
fn errors_carry_the_path_in_the_json() {
    for (pointer, value, path) in [
        ("/nodes/0/translation", json!("up"), "nodes[0].translation"),
        ("/meshes/0/primitives/0/attributes/NORMAL", json!(-1), "meshes[0].primitives[0].attributes"),
        ("/bufferViews/2/byteLength", json!(null), "bufferViews[2].byteLength"),
        ("/scenes/0/nodes", json!({"0": 1}), "scenes[0].nodes"),
        ("/asset/version", json!(2), "asset.version"),
    ] {
        let mut fixture = Fixture::triangle();
        fixture.set(pointer, value);
        let error = fixture.error();
        assert!(error.contains(&format!("JSON: {path}")), "{path}: {error}");
    }
    assert!(error(b"{}").contains("JSON: missing field `asset`"), "{}", error(b"{}"));
    assert!(error(b"[]").contains("JSON: it is not an object"), "{}", error(b"[]"));
}

/// Returns a GLB file of these chunks without padding.
fn container(chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
    let mut bytes = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
    for (kind, body) in chunks {
        bytes.extend((body.len() as u32).to_le_bytes());
        bytes.extend(*kind);
        bytes.extend(*body);
    }
    let length = (bytes.len() as u32).to_le_bytes();
    bytes[8..12].copy_from_slice(&length);
    bytes
}

/// Returns the JSON of a triangle, `extra` bytes longer than a multiple of four, and its buffer.
fn parts(extra: usize) -> (Vec<u8>, Vec<u8>) {
    let mut fixture = Fixture::triangle();
    fixture.json["buffers"] = json!([{"byteLength": fixture.bin.len()}]);
    let mut json = fixture.json.to_string().into_bytes();
    while json.len() % 4 != extra {
        json.push(b'\n');
    }
    (json, fixture.bin)
}

#[test]
fn chunks_without_padding_are_read_with_a_warning() {
    let truth = Fixture::triangle().load().expect("it is plain");
    for extra in 0..4 {
        let (json, bin) = parts(extra);
        let bytes = container(&[(b"JSON", &json), (b"BIN\0", &bin)]);
        let scene = load(&bytes).expect("it is read");
        assert_eq!(scene.meshes, truth.meshes);
        let warned = scene.warnings.iter().filter(|line| line.contains("a chunk is not padded to four bytes")).count();
        assert_eq!((warned, scene.warnings.len()), (usize::from(extra > 0), usize::from(extra > 0)));
        for length in 0..bytes.len() {
            let mut short = bytes[..length].to_vec();
            assert!(load(&short).is_err(), "{length} of {}", bytes.len());
            // Also with a header that states the shorter length.
            if length >= 12 {
                short[8..12].copy_from_slice(&(length as u32).to_le_bytes());
                // Only padding follows the JSON: the buffer is absent and reads as zeros, with a warning.
                if (20 + json.len()..=20 + json.len().next_multiple_of(4)).contains(&length) {
                    continue;
                }
                assert!(load(&short).is_err(), "{length} of {}", bytes.len());
            }
        }
    }
}

#[test]
fn json_may_be_padded_with_zeros() {
    let truth = Fixture::triangle().load().expect("it is plain");
    for zeros in [1, 3, 4, 9] {
        let (mut json, bin) = parts(0);
        json.resize(json.len() + zeros, 0);
        // Padding inside the chunk; the rest up to a multiple of four is spaces.
        json.resize(json.len().next_multiple_of(4), 0);
        let bytes = container(&[(b"JSON", &json), (b"BIN\0", &bin)]);
        let scene = load(&bytes).expect("it is read");
        assert_eq!((&scene.meshes, &scene.warnings), (&truth.meshes, &truth.warnings));
        let error = error(&bytes[..bytes.len() - 1]);
        assert!(error.contains("truncated"), "{error}");
    }
    let (mut json, bin) = parts(0);
    json.insert(1, 0);
    json.extend([b' '; 3]);
    let error = error(&container(&[(b"JSON", &json), (b"BIN\0", &bin)]));
    assert!(error.contains("JSON: "), "a zero inside is none of the padding: {error}");
}
