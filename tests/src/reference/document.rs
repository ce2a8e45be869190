//! Statement of a reference: a JSON file with a scene, the conditions of its picture, and the tolerance.
//!
//! An unknown key of the scene is an error, since the picture may depend on it. Unknown options of an effect, and
//! unknown keys outside the scene, are reported as ignored. Keys with facts about the reference's production are known
//! and ignored.

mod occlusion;
mod scene;
mod view;

pub use occlusion::{Ao, AoQuality, AoType, Gtao, Ssct};

pub use scene::{
    Asset, Camera, CameraType, Exposure, Hashes, Ibl, Kept, Light, LightType, Output, Scene, ShadowOptions,
};
pub use view::{
    AntiAliasing, BlendMode, Bloom, BloomQuality, ColorGrading, Fog, GradingFormat, GradingQuality, Msaa, MsaaOptions,
    Ssr, Taa, TaaBox, TaaClipping, TaaJitter, ToneMapping, View, Vignette,
};

use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use std::path::{Path, PathBuf};

/// A reference cannot be read.
#[derive(thiserror::Error)]
pub enum DocumentError {
    /// The file system reported an error.
    #[error("{file}: {error}")]
    File {
        /// Path of the file.
        file: PathBuf,
        /// Error of the file system.
        error: std::io::Error,
    },
    /// Invalid JSON.
    #[error("{file}: {error}")]
    Json {
        /// Path of the file.
        file: PathBuf,
        /// Parse error with the line.
        error: serde_json::Error,
    },
    /// A key is missing, unknown, or has an invalid value.
    #[error("{file}: {key}: {reason}")]
    Key {
        /// Path of the file.
        file: PathBuf,
        /// Path of the key, such as `scene.view.ao`.
        key: String,
        /// Description of the problem.
        reason: String,
    },
}

impl std::fmt::Debug for DocumentError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// A reference, as its file states it.
#[derive(Clone, Debug)]
pub struct Document {
    /// Identifier.
    pub id: String,
    /// Description of the picture.
    pub what: String,
    /// Scene to render.
    pub scene: Scene,
    /// True if the picture was dithered.
    pub dithering: bool,
    /// Filter of shadow maps; `None` without shadows.
    pub shadow_type: Option<ShadowType>,
    /// Pictures and tables of the reference.
    pub files: Files,
    /// Centers of the scene's spheres, in m.
    pub spheres: Vec<[f64; 3]>,
    /// Tolerance, in the syntax of [`rule`](super::rule).
    pub suggested_pass: Option<String>,
    /// Unknown keys outside the scene.
    pub unknown: Vec<String>,
}

/// Keys with facts about the reference's production; [`MADE_PREFIXES`] has the prefixes of further ones.
const MADE: [&str; 4] = ["oracle", "conventions", "brdf", "camera_matrices"];
const MADE_PREFIXES: [&str; 7] =
    ["note", "measured_", "second_oracle", "known_wrong", "internal_", "gltf_", "render_ms"];

impl Document {
    /// Reads a file.
    ///
    /// # Errors
    /// [`DocumentError`].
    pub fn read(file: &Path) -> Result<Self, DocumentError> {
        let text = std::fs::read_to_string(file).map_err(|error| DocumentError::File { file: file.into(), error })?;
        Self::parse(file, &text)
    }

    /// Parses a text; `file` names it in errors.
    ///
    /// # Errors
    /// [`DocumentError`].
    pub fn parse(file: &Path, text: &str) -> Result<Self, DocumentError> {
        let mut top: Map<String, Value> =
            serde_json::from_str(text).map_err(|error| DocumentError::Json { file: file.into(), error })?;
        let mut take = |key: &str| top.remove(key).unwrap_or(Value::Null);
        let id: String = read(file, "id", take("id"))?;
        let what: Option<String> = read(file, "what", take("what"))?;
        let scene = read(file, "scene", take("scene"))?;
        let dithering: Option<bool> = read(file, "dithering", take("dithering"))?;
        let shadow_type = read(file, "shadow_type", take("shadow_type"))?;
        let files: Option<Files> = read(file, "files", take("files"))?;
        let spheres = spheres(file, &take("objects"))?;
        let suggested_pass = read(file, "suggested_pass", take("suggested_pass"))?;
        let made = |key: &str| MADE.contains(&key) || MADE_PREFIXES.iter().any(|prefix| key.starts_with(prefix));
        Ok(Self {
            id,
            what: what.unwrap_or_default(),
            scene,
            dithering: dithering.unwrap_or(false),
            shadow_type,
            files: files.unwrap_or_default(),
            spheres,
            suggested_pass,
            unknown: top.keys().filter(|key| !made(key)).cloned().collect(),
        })
    }
}

/// Returns the centers of all spheres among objects: a list, or a map by name, of objects or nested lists.
fn spheres(file: &Path, objects: &Value) -> Result<Vec<[f64; 3]>, DocumentError> {
    match objects {
        Value::Array(all) => Ok(all.iter().map(|one| spheres(file, one)).collect::<Result<Vec<_>, _>>()?.concat()),
        Value::Object(object) if object.get("shape").is_some_and(|shape| shape == "sphere") => {
            Ok(vec![read(file, "objects.center", object.get("center").cloned().unwrap_or(Value::Null))?])
        }
        Value::Object(all) if !all.contains_key("shape") => {
            Ok(all.values().map(|one| spheres(file, one)).collect::<Result<Vec<_>, _>>()?.concat())
        }
        _ => Ok(Vec::new()),
    }
}

/// Deserializes a value; `key` is its path in errors.
fn read<T: DeserializeOwned>(file: &Path, key: &str, value: Value) -> Result<T, DocumentError> {
    serde_path_to_error::deserialize(value).map_err(|error| {
        let within = error.path().to_string();
        let key = if within == "." { key.to_owned() } else { format!("{key}.{within}") };
        DocumentError::Key { file: file.into(), key, reason: error.into_inner().to_string() }
    })
}

/// Files of a reference, relative to the statement.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Files {
    /// Picture of linear light.
    pub exr: Option<PathBuf>,
    /// 8-bit picture; only a preview if there is a picture of linear light.
    pub png: Option<PathBuf>,
    /// Patches of a chart.
    pub csv: Option<PathBuf>,
}

/// Filter of a shadow map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum ShadowType {
    /// Percentage-closer filtering with a 3×3 tent.
    Pcf,
    /// Variance shadow map.
    Vsm,
    /// Percentage-closer soft shadows with Filament's `DPCF`: the penumbra grows with distance.
    Dpcf,
    /// Percentage-closer soft shadows with a blocker search.
    Pcss,
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAIN: &str = r#"{"id": "a", "what": "b", "oracle": {"engine": "x"}, "measured_centre_rgb": [], "scene": {
        "assets": ["a.glb", {"entry": "b.glb", "source": "somewhere", "sha256": "00"}], "resolution": [4, 2],
        "camera": {"type": "ortho", "ortho": [0, 1, 0, 1], "fov_y_deg": 0, "eye": [0, 0, 1], "center": [0, 0, 0],
            "up": [0, 1, 0], "near": 0.1, "far": 10},
        "lights": [{"type": "DIRECTIONAL", "color": [1, 1, 1], "intensity": 3, "direction": [0, -1, 0],
            "shadow_options": {"mapSize": 512, "normalBias": 1}}],
        "view": {"post_processing": true, "anti_aliasing": "FXAA", "msaa": {"enabled": true, "sampleCount": 4},
            "color_grading": {"tone_mapping": "FILMIC", "whiteBalance": [0.1, 0]}, "ao": {"enabled": false, "radius": 1}},
        "output": "ldr"},
        "objects": [{"shape": "plane"}, {"shape": "sphere", "center": [1, 2, 3], "radius": 4}],
        "dithering": false, "shadow_type": null, "files": {"png": "a.png"}, "suggested_pass": "psnr>=1"}"#;

    fn told(text: &str) -> String {
        Document::parse(Path::new("refs/a.json"), text).map(|d| d.id).expect_err("the statement is wrong").to_string()
    }

    #[test]
    fn a_statement_is_read_whole() -> Result<(), DocumentError> {
        let document = Document::parse(Path::new("a.json"), PLAIN)?;
        assert_eq!((document.id.as_str(), document.spheres.as_slice()), ("a", &[[1.0, 2.0, 3.0]][..]));
        let Scene { assets, lights, view, exposure, clear_color, .. } = document.scene;
        assert!(
            matches!(&assets[..], [Asset::Beside(_), Asset::Elsewhere(kept)] if kept.sha256 == Hashes::One("00".into()))
        );
        assert_eq!(lights[0].shadow_options.map_size, Some(512));
        assert_eq!(view.msaa.as_ref().map(Msaa::samples), Some(4));
        assert_eq!((exposure.direct, clear_color), (1.0, [0.0, 0.0, 0.0, 1.0]));
        for (msaa, samples) in [("true", 4), ("false", 1), ("8", 8), (r#"{"enabled": false, "sampleCount": 4}"#, 1)] {
            let text = PLAIN.replace(r#"{"enabled": true, "sampleCount": 4}"#, msaa);
            let document = Document::parse(Path::new("a.json"), &text)?;
            assert_eq!(document.scene.view.msaa.as_ref().map(Msaa::samples), Some(samples), "{msaa}");
        }
        Ok(())
    }

    /// Variations in other statements of the same source: unknown options, objects by name, a hash per file, null
    /// values.
    #[test]
    fn forms_of_lesser_weight_are_read_too() -> Result<(), DocumentError> {
        let mut text = PLAIN.to_owned();
        for (from, to) in [
            ("\"what\"", "\"mood\""),
            ("\"mapSize\"", "\"polygonOffset\": 2, \"mapSize\""),
            ("\"radius\": 1", "\"radius\": 1, \"noise\": {\"kind\": \"blue\"}"),
            ("\"sha256\": \"00\"", "\"sha256\": {\"b.glb\": \"00\", \"b.bin\": \"01\"}"),
            (
                r#"[{"shape": "plane"}, {"shape": "sphere", "center": [1, 2, 3], "radius": 4}]"#,
                r#"{"floor": {"shape": "plane"}, "balls": [{"shape": "sphere", "center": [1, 2, 3]}], "bounds": [[0, 1]]}"#,
            ),
            ("\"dithering\"", "\"notes\": [\"x\"], \"dithering\""),
            ("\"output\"", "\"ibl\": null, \"exposure\": null, \"output\""),
        ] {
            assert!(text.contains(from), "{from}");
            text = text.replace(from, to);
        }
        let document = Document::parse(Path::new("a.json"), &text)?;
        assert_eq!(
            (document.spheres.as_slice(), document.unknown.as_slice()),
            (&[[1.0, 2.0, 3.0]][..], &["mood".to_owned()][..])
        );
        let Scene { assets, lights, view, .. } = document.scene;
        assert!(matches!(&assets[1], Asset::Elsewhere(Kept { sha256: Hashes::Each(each), .. }) if each.len() == 2));
        assert_eq!(lights[0].shadow_options.unknown.keys().collect::<Vec<_>>(), ["polygonOffset"]);
        let ao = view.ao.unwrap_or_default();
        assert!(ao.radius == Some(1.0) && ao.unknown.keys().eq(["noise"]));
        Ok(())
    }

    #[test]
    fn what_is_wrong_is_named_with_its_place() {
        for (from, to, named) in [
            ("\"resolution\"", "\"size\"", "scene.size: unknown field `size`"),
            ("\"mapSize\": 512", "\"mapSize\": -1", "scene.lights[0].shadow_options.mapSize: "),
            ("\"radius\": 1", "\"radius\": []", "scene.view.ao.radius: "),
            ("\"enabled\": false", "\"enabled\": 0", "scene.view.ao.enabled: "),
            ("\"color\"", "\"colour\"", "scene.lights[0].colour: unknown field `colour`"),
            ("\"FILMIC\"", "\"SEPIA\"", "scene.view.color_grading.tone_mapping: unknown variant `SEPIA`"),
            ("[4, 2]", "[4, -2]", "scene.resolution[1]: "),
            ("\"intensity\": 3", "\"intensity\": \"3\"", "scene.lights[0].intensity: "),
            ("\"output\"", "\"outputs\"", "unknown field `outputs`"),
            ("\"id\": \"a\"", "\"id\": 1", "id: invalid type"),
            ("[1, 2, 3]", "[1, 2]", "objects.center"),
            ("\"source\"", "\"origin\"", "scene.assets[1]: a path, or an object of entry, source and sha256"),
            (
                "\"sha256\": \"00\"",
                "\"sha256\": [0]",
                "scene.assets[1]: a path, or an object of entry, source and sha256",
            ),
        ] {
            assert!(PLAIN.contains(from), "{from}");
            let error = told(&PLAIN.replace(from, to));
            assert!(error.starts_with("refs/a.json: ") && error.contains(named), "{from}: {error}");
        }
        assert!(told("{").starts_with("refs/a.json: "));
        assert!(Document::read(Path::new("no/such.json")).is_err_and(|e| e.to_string().contains("no/such.json")));
    }
}
