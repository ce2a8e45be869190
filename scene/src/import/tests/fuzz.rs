//! Thousands of damaged files: each loads as a valid scene or returns one line, without a panic.

use std::path::Path;

use serde_json::json;

use super::fixture::{Fixture, png};
use crate::import::load_bytes;
use crate::progress::silent;

/// Returns a file of a few kilobytes that uses most of the importer.
fn rich() -> Fixture {
    let mut f = Fixture::new();
    let corners = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.5];
    let position = f.floats(3, &corners);
    let uv = f.floats(2, &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 1.0]);
    let color = f.array(&[200; 16], 5121, "VEC4", 4);
    f.set(&format!("/accessors/{color}/normalized"), json!(true));
    let indices = f.shorts(&[0, 1, 2, 2, 1, 3]);
    let sparse_indices = f.view(&[1, 3]);
    let sparse_values = f.view(&[0; 24]);
    f.push(
        "accessors",
        json!({
            "componentType": 5126, "type": "VEC3", "count": 4,
            "sparse": {
                "count": 2,
                "indices": {"bufferView": sparse_indices, "componentType": 5121},
                "values": {"bufferView": sparse_values},
            },
        }),
    );
    let view = f.view(&png(2, 2, [128, 128, 255, 255]));
    f.push("images", json!({"bufferView": view, "mimeType": "image/png"}));
    f.push("samplers", json!({"wrapS": 33071, "minFilter": 9987}));
    f.push("textures", json!({"source": 0, "sampler": 0}));
    let moved = json!({"KHR_texture_transform": {"offset": [0.5, 0.5], "rotation": 0.3}});
    f.push(
        "materials",
        json!({
            "pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions": moved}},
            "normalTexture": {"index": 0, "extensions": moved},
            "alphaMode": "MASK",
            "extensions": {
                "KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatNormalTexture": {"index": 0}},
                "KHR_materials_sheen": {"sheenColorFactor": [0.5, 0.5, 0.5], "sheenRoughnessTexture": {"index": 0}},
                "KHR_materials_transmission": {"transmissionFactor": 0.5},
                "KHR_materials_volume": {"thicknessFactor": 1.0, "attenuationDistance": 2.0},
                "KHR_materials_iridescence": {"iridescenceFactor": 0.5, "iridescenceThicknessTexture": {"index": 0}},
                "KHR_materials_dispersion": {"dispersion": 0.1},
                "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.5},
            },
        }),
    );
    let attributes = json!({"POSITION": position, "TEXCOORD_0": uv, "COLOR_0": color});
    f.primitive(json!({"attributes": attributes, "indices": indices, "material": 0}));
    f.primitive(json!({"attributes": attributes, "mode": 5}));
    f.primitive(json!({"attributes": {"POSITION": 4}, "mode": 6}));
    f.push("cameras", json!({"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}));
    f.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [
        {"type": "spot", "intensity": 10.0, "range": 5.0, "spot": {"outerConeAngle": 0.5}}]}});
    f.json["nodes"] = json!([
        {"children": [1, 2], "scale": [2.0, 1.0, 1.0]},
        {"mesh": 0, "rotation": [0.0, 0.6, 0.0, 0.8]},
        {"camera": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}},
    ]);
    f
}

/// Deterministic random numbers, for reproducible failures (Knuth's MMIX generator).
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % n
    }
}

fn survive(bytes: &[u8], what: &str) -> bool {
    match load_bytes(Path::new("fuzz.glb"), bytes, &mut silent) {
        Ok(scene) => {
            assert_eq!(scene.check(), Ok(()), "{what}");
            true
        }
        Err(error) => {
            let text = error.to_string();
            assert!(text.contains("fuzz.glb") || text.contains("cannot be read"), "{what}: {text}");
            assert!(!text.contains('\n'), "{what}: {text}");
            false
        }
    }
}

/// Random bytes anywhere in a GLB.
#[test]
fn random_bytes_never_panic() {
    let good = rich().glb();
    assert!(survive(&good, "undamaged"));
    let mut random = Random(1);
    let (mut loaded, mut refused) = (0, 0);
    for round in 0..6000 {
        let mut bytes = good.clone();
        for _ in 0..=random.below(4) {
            let at = random.below(bytes.len());
            bytes[at] = match random.below(4) {
                0 => 0xff,
                1 => 0,
                2 => bytes[at] ^ 1 << random.below(8),
                _ => random.below(256) as u8,
            };
        }
        if survive(&bytes, &format!("round {round}")) {
            loaded += 1;
        } else {
            refused += 1;
        }
    }
    // Both outcomes must occur; otherwise the damage is too heavy or too light.
    assert!(loaded > 100 && refused > 1000, "{loaded} loaded, {refused} refused");
}

/// Replaces JSON digits by other digits: the structure stays, every number changes.
#[test]
fn random_numbers_in_the_json_never_panic() {
    let fixture = rich();
    let text = fixture.json.to_string();
    let digits: Vec<usize> = text.bytes().enumerate().filter(|(_, b)| b.is_ascii_digit()).map(|(i, _)| i).collect();
    let mut random = Random(2);
    let (mut loaded, mut refused) = (0, 0);
    for round in 0..4000 {
        let mut bytes = text.clone().into_bytes();
        for _ in 0..=random.below(3) {
            bytes[digits[random.below(digits.len())]] = b'0' + random.below(10) as u8;
        }
        let text = String::from_utf8(bytes).expect("digits are ASCII");
        // Leading zeros are not JSON; such rounds test nothing.
        let Ok(json) = serde_json::from_str(&text) else {
            continue;
        };
        let damaged = Fixture { json, bin: fixture.bin.clone() };
        if survive(&damaged.glb(), &format!("round {round}: {text}")) {
            loaded += 1;
        } else {
            refused += 1;
        }
    }
    assert!(loaded > 300 && refused > 300, "{loaded} loaded, {refused} refused");
}

/// Replaces each JSON value by hostile ones, one at a time, exhaustively.
#[test]
fn every_value_replaced_by_hostile_ones_never_panics() {
    let fixture = rich();
    let mut pointers = Vec::new();
    collect(&fixture.json, String::new(), &mut pointers);
    assert!(pointers.len() > 100);
    let hostile = [
        json!(0),
        json!(1),
        json!(-1),
        json!(u32::MAX),
        json!(u64::MAX),
        json!(1e39),
        json!(1e-300),
        json!(0.5),
        json!(""),
        json!("data:,"),
        json!("VEC4"),
        json!(null),
        json!([]),
        json!({}),
        json!(true),
        json!([0, 0, 0, 0]),
    ];
    let mut loaded = 0;
    for pointer in &pointers {
        for value in &hostile {
            let mut damaged = fixture.clone();
            damaged.set(pointer, value.clone());
            if survive(&damaged.glb(), &format!("{pointer} = {value}")) {
                loaded += 1;
            }
        }
    }
    assert!(loaded > 100, "{loaded} loaded");
}

/// Collects the JSON pointers of every value below `value`.
fn collect(value: &serde_json::Value, at: String, pointers: &mut Vec<String>) {
    if let Some(object) = value.as_object() {
        for (key, child) in object {
            let at = format!("{at}/{key}");
            pointers.push(at.clone());
            collect(child, at, pointers);
        }
    } else if let Some(array) = value.as_array() {
        for (i, child) in array.iter().enumerate() {
            let at = format!("{at}/{i}");
            pointers.push(at.clone());
            collect(child, at, pointers);
        }
    }
}
