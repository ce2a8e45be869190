//! Small generated glTF files.

use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};

use crate::Scene;
use crate::error::SceneError;
use crate::import::container::split;
use crate::import::load_bytes;
use crate::progress::silent;

/// A document under construction: JSON, and one buffer with a view and an accessor per array.
#[derive(Clone)]
pub(super) struct Fixture {
    pub json: Value,
    pub bin: Vec<u8>,
}

impl Fixture {
    /// Returns a document with one node that draws mesh 0, which has no primitives yet.
    pub fn new() -> Self {
        Self {
            json: json!({
                "asset": {"version": "2.0"},
                "scene": 0,
                "scenes": [{"nodes": [0]}],
                "nodes": [{"mesh": 0, "name": "only"}],
                "meshes": [{"primitives": []}],
                "accessors": [],
                "bufferViews": [],
                "buffers": [],
            }),
            bin: Vec::new(),
        }
    }

    /// Parses a binary file, to be modified.
    pub fn of_glb(bytes: &[u8]) -> Self {
        let parts = split(Path::new("fixture.glb"), bytes).expect("a GLB");
        let json = serde_json::from_slice(parts.json).expect("JSON");
        Self { json, bin: parts.blob.unwrap_or_default().into() }
    }

    /// Returns one triangle in the plane z = 0, with normals and an unset material 0.
    pub fn triangle() -> Self {
        let mut fixture = Self::new();
        let position = fixture.floats(3, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        let normal = fixture.floats(3, &[0.0, 0.0, 1.0].repeat(3));
        let indices = fixture.shorts(&[0, 1, 2]);
        fixture.primitive(json!({
            "attributes": {"POSITION": position, "NORMAL": normal},
            "indices": indices,
        }));
        fixture
    }

    /// Appends bytes as a buffer view, aligned to four bytes.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let view = json!({"buffer": 0, "byteOffset": self.bin.len(), "byteLength": bytes.len()});
        self.bin.extend(bytes);
        self.push("bufferViews", view)
    }

    /// Appends an array of vectors of `width` floats; returns its accessor.
    pub fn floats(&mut self, width: usize, values: &[f32]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][width - 1];
        self.array(&bytes, 5126, kind, values.len() / width)
    }

    /// Appends an array of 16-bit indices; returns its accessor.
    pub fn shorts(&mut self, values: &[u16]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        self.array(&bytes, 5123, "SCALAR", values.len())
    }

    pub fn array(&mut self, bytes: &[u8], component: u32, kind: &str, count: usize) -> usize {
        let view = self.view(bytes);
        self.push("accessors", json!({"bufferView": view, "componentType": component, "type": kind, "count": count}))
    }

    pub fn primitive(&mut self, primitive: Value) {
        self.json["meshes"][0]["primitives"].as_array_mut().expect("the fixture has a mesh").push(primitive);
    }

    /// Appends to a top-level array, created if needed; returns the index.
    pub fn push(&mut self, array: &str, value: Value) -> usize {
        if self.json[array].is_null() {
            self.json[array] = json!([]);
        }
        let array = self.json[array].as_array_mut().expect("a top-level array");
        array.push(value);
        array.len() - 1
    }

    /// Sets the value at a JSON pointer, created if missing.
    pub fn set(&mut self, pointer: &str, value: Value) -> &mut Self {
        let (parent, key) = pointer.rsplit_once('/').expect("a pointer begins with /");
        let parent = self.json.pointer_mut(parent).expect(pointer);
        match key.parse::<usize>() {
            Ok(i) if parent.is_array() => parent[i] = value,
            _ => parent[key] = value,
        }
        self
    }

    /// Returns the file as GLB.
    pub fn glb(&self) -> Vec<u8> {
        let mut document = self.json.clone();
        if document["buffers"] == json!([]) {
            document["buffers"] = json!([{"byteLength": self.bin.len()}]);
        }
        let mut json = document.to_string().into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        let mut bin = self.bin.clone();
        bin.resize(bin.len().next_multiple_of(4), 0);
        let length = 12 + 8 + json.len() + 8 + bin.len();
        let mut bytes = b"glTF".to_vec();
        for word in [2, length as u32, json.len() as u32] {
            bytes.extend(word.to_le_bytes());
        }
        bytes.extend(b"JSON");
        bytes.extend(&json);
        bytes.extend((bin.len() as u32).to_le_bytes());
        bytes.extend(b"BIN\0");
        bytes.extend(&bin);
        bytes
    }

    /// Returns the file as text, its buffer as a data URI.
    pub fn gltf(&self) -> Vec<u8> {
        let mut document = self.json.clone();
        let uri = format!("data:application/octet-stream;base64,{}", STANDARD.encode(&self.bin));
        document["buffers"] = json!([{"byteLength": self.bin.len(), "uri": uri}]);
        document.to_string().into_bytes()
    }

    /// Loads the GLB form and checks a returned scene.
    pub fn load(&self) -> Result<Scene, SceneError> {
        let scene = load_bytes(Path::new("dir/fixture.glb"), &self.glb(), &mut silent)?;
        assert_eq!(scene.check(), Ok(()));
        Ok(scene)
    }

    /// Returns the warnings of a successful load, one per line.
    pub fn warnings(&self) -> String {
        self.load().expect("the file loads").warnings.join("\n")
    }

    /// Returns the error message of a failing load.
    pub fn error(&self) -> String {
        let text = self.load().expect_err("the file is broken").to_string();
        assert!(text.starts_with("dir/fixture.glb: "), "{text}");
        assert!(!text.contains('\n'), "{text}");
        text
    }
}

/// Returns a PNG of `width` × `height` texels of one RGBA color.
pub(super) fn png(width: u32, height: u32, texel: [u8; 4]) -> Vec<u8> {
    let image = image::RgbaImage::from_pixel(width, height, image::Rgba(texel));
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).expect("writing to memory");
    bytes.into_inner()
}
