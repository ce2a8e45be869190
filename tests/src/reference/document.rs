//! What states a reference: a JSON file with a scene, how its picture was made, and when another is close enough.
//!
//! Keys that the schema does not know are errors that name them. Beside the scene stand facts about the making of the
//! reference, which nothing here depends on: they are known by name and not read.

use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use std::path::{Path, PathBuf};

/// A reference cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum DocumentError {
    /// The file system said no.
    #[error("{file}: {error}")]
    File {
        /// The file.
        file: PathBuf,
        /// Why.
        error: std::io::Error,
    },
    /// It is no JSON.
    #[error("{file}: {error}")]
    Json {
        /// The file.
        file: PathBuf,
        /// Why, with the line.
        error: serde_json::Error,
    },
    /// A key is missing, unknown, or holds something else than it should.
    #[error("{file}: {key}: {reason}")]
    Key {
        /// The file.
        file: PathBuf,
        /// Where, such as `scene.view.ao`.
        key: String,
        /// What is wrong.
        reason: String,
    },
}

/// A reference, as its file states it.
#[derive(Clone, Debug)]
pub struct Document {
    /// Its name.
    pub id: String,
    /// What it shows, in words.
    pub what: String,
    /// What to render.
    pub scene: Scene,
    /// Codes were dithered.
    pub dithering: bool,
    /// How shadows were filtered; none where there are none.
    pub shadow_type: Option<ShadowType>,
    /// Pictures and tables beside the file.
    pub files: Files,
    /// Centers of the spheres of the scene, in meters.
    pub spheres: Vec<[f64; 3]>,
    /// When a picture is close enough, in the words that [`rule`](super::rule) knows.
    pub suggested_pass: Option<String>,
}

/// Facts about how a reference was made; further ones begin as [`MADE_PREFIXES`] say.
const MADE: [&str; 5] = ["oracle", "conventions", "brdf", "camera_matrices", "notes"];
const MADE_PREFIXES: [&str; 6] = ["measured_", "second_oracle", "known_wrong", "internal_", "gltf_", "render_ms"];

impl Document {
    /// Reads a file.
    ///
    /// # Errors
    /// [`DocumentError`].
    pub fn read(file: &Path) -> Result<Self, DocumentError> {
        let text = std::fs::read_to_string(file).map_err(|error| DocumentError::File { file: file.into(), error })?;
        Self::parse(file, &text)
    }

    /// Reads a text; `file` names it in errors.
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
        let objects: Option<Vec<Map<String, Value>>> = read(file, "objects", take("objects"))?;
        let suggested_pass = read(file, "suggested_pass", take("suggested_pass"))?;
        let made = |key: &str| MADE.contains(&key) || MADE_PREFIXES.iter().any(|prefix| key.starts_with(prefix));
        if let Some(key) = top.keys().find(|key| !made(key)) {
            return Err(DocumentError::Key { file: file.into(), key: key.clone(), reason: "unknown key".into() });
        }
        let sphere = |object: &Map<String, Value>| object.get("shape").is_some_and(|shape| shape == "sphere");
        let spheres = objects.iter().flatten().filter(|object| sphere(object));
        let centre = |object: &Map<String, Value>| {
            read(file, "objects.center", object.get("center").cloned().unwrap_or(Value::Null))
        };
        Ok(Self {
            id,
            what: what.unwrap_or_default(),
            scene,
            dithering: dithering.unwrap_or(false),
            shadow_type,
            files: files.unwrap_or_default(),
            spheres: spheres.map(centre).collect::<Result<_, _>>()?,
            suggested_pass,
        })
    }
}

/// A value with its place in errors.
fn read<T: DeserializeOwned>(file: &Path, key: &str, value: Value) -> Result<T, DocumentError> {
    serde_path_to_error::deserialize(value).map_err(|error| {
        let within = error.path().to_string();
        let key = if within == "." { key.to_owned() } else { format!("{key}.{within}") };
        DocumentError::Key { file: file.into(), key, reason: error.into_inner().to_string() }
    })
}

/// Files beside the statement.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Files {
    /// Light.
    pub exr: Option<PathBuf>,
    /// Codes; beside light only a preview.
    pub png: Option<PathBuf>,
    /// Patches of a chart.
    pub csv: Option<PathBuf>,
}

/// How a shadow map is filtered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum ShadowType {
    /// A tent of 3×3 texels.
    Pcf,
    /// Variance.
    Vsm,
    /// A penumbra that grows with distance.
    Dpcf,
    /// The same, with a search for blockers.
    Pcss,
}

/// What to render.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Models.
    pub assets: Vec<Asset>,
    /// Width and height in pixels.
    pub resolution: [u32; 2],
    /// Where from.
    pub camera: Camera,
    /// Lights.
    #[serde(default)]
    pub lights: Vec<Light>,
    /// Light from all around.
    pub ibl: Option<Ibl>,
    /// How light becomes numbers.
    #[serde(default)]
    pub exposure: Exposure,
    /// What is behind the scene, in exposed light, linear Rec.709.
    #[serde(default = "black")]
    pub clear_color: [f64; 4],
    /// Variance and threshold of the filter of normals.
    #[serde(default)]
    pub specular_aa: [f64; 2],
    /// Which numbers the picture holds.
    pub output: Output,
    /// What becomes of the light.
    #[serde(default)]
    pub view: View,
}

const fn black() -> [f64; 4] {
    [0.0, 0.0, 0.0, 1.0]
}

/// A model.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(untagged)]
pub enum Asset {
    /// A path beside the statement.
    Beside(PathBuf),
    /// A file that is kept elsewhere.
    Elsewhere(Kept),
}

/// A file that is kept elsewhere.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Kept {
    /// Its path in the folder of assets.
    pub entry: PathBuf,
    /// Where it comes from, for people.
    #[serde(default)]
    pub source: Value,
    /// Its hash, 64 hexadecimal digits.
    pub sha256: String,
}

/// Kind of a projection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CameraType {
    /// Central.
    Perspective,
    /// Parallel.
    Ortho,
}

/// A camera.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Camera {
    /// Its projection.
    pub r#type: CameraType,
    /// Full vertical field of view in degrees.
    pub fov_y_deg: Option<f64>,
    /// Left, right, bottom and top of what is seen, in meters.
    pub ortho: Option<[f64; 4]>,
    /// In meters.
    pub eye: [f64; 3],
    /// In meters.
    pub center: [f64; 3],
    /// Upward.
    pub up: [f64; 3],
    /// In meters.
    pub near: f64,
    /// In meters.
    pub far: f64,
}

/// Kind of a light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum LightType {
    /// Parallel.
    Directional,
}

/// A light.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Light {
    /// Its kind.
    pub r#type: LightType,
    /// Linear Rec.709.
    pub color: [f64; 3],
    /// In lux.
    pub intensity: f64,
    /// The way it travels; any length.
    pub direction: [f64; 3],
    /// It casts shadows.
    #[serde(default)]
    pub cast_shadows: bool,
    /// How.
    #[serde(default)]
    pub shadow_options: ShadowOptions,
}

/// How a light casts shadows.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "camelCase")]
pub struct ShadowOptions {
    /// Width of the map in texels; 1024 where it is not given.
    pub map_size: Option<u32>,
    /// Maps by distance.
    pub shadow_cascades: Option<u32>,
    /// Toward the light, in meters.
    pub constant_bias: Option<f64>,
    /// Along the normal, in texels.
    pub normal_bias: Option<f64>,
    /// The map stands still as the camera moves.
    pub stable: Option<bool>,
    /// Perspective of the map follows the camera's.
    pub lispsm: Option<bool>,
}

/// Light from all around.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ibl {
    /// Irradiance / π in spherical harmonics; three numbers are the first of nine.
    pub sh: Option<Vec<f64>>,
    /// Radiance of an even environment.
    pub uniform_cube: Option<[f64; 3]>,
    /// A prefiltered cube in a file.
    pub ktx1: Option<Value>,
    /// Factor on all of it.
    #[serde(default = "one")]
    pub intensity: f64,
}

const fn one() -> f64 {
    1.0
}

/// How light becomes numbers.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Exposure {
    /// Factor on radiance in nits.
    pub direct: f64,
}

impl Default for Exposure {
    fn default() -> Self {
        Self { direct: 1.0 }
    }
}

/// Which numbers a picture holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Output {
    /// Light.
    Linear,
    /// Codes.
    Ldr,
}

/// What becomes of the light. Effects that are not built are kept as they are.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct View {
    /// Anything at all.
    #[serde(default)]
    pub post_processing: bool,
    /// Softens edges of the finished picture.
    #[serde(default)]
    pub anti_aliasing: AntiAliasing,
    /// Samples of each pixel.
    pub msaa: Option<Msaa>,
    /// Samples of former frames.
    pub taa: Option<Taa>,
    /// Color.
    pub color_grading: Option<ColorGrading>,
    /// Ambient occlusion.
    pub ao: Option<Ao>,
    /// Glare.
    pub bloom: Option<Bloom>,
    /// Haze.
    pub fog: Option<Fog>,
    /// Darker corners.
    pub vignette: Option<Vignette>,
}

/// Softens edges of the finished picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum AntiAliasing {
    /// Nothing does.
    #[default]
    None,
    /// FXAA.
    Fxaa,
}

/// Samples of each pixel.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
pub enum Msaa {
    /// Four, or one.
    On(bool),
    /// So many.
    Samples(u32),
    /// Filament's options.
    Options(MsaaOptions),
}

/// Filament's options.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "camelCase")]
pub struct MsaaOptions {
    /// On.
    #[serde(default)]
    pub enabled: bool,
    /// How many.
    pub sample_count: Option<u32>,
    /// A resolve of its own.
    pub custom_resolve: Option<bool>,
}

impl Msaa {
    /// How many.
    pub fn samples(&self) -> u32 {
        match self {
            Self::On(on) => 1 + 3 * u32::from(*on),
            Self::Samples(count) => *count,
            Self::Options(MsaaOptions { enabled: false, .. }) => 1,
            Self::Options(options) => options.sample_count.unwrap_or(4),
        }
    }
}

/// Samples of former frames.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Taa {
    /// On.
    #[serde(default)]
    pub enabled: bool,
}

/// A tone curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub enum ToneMapping {
    /// Cut off.
    Linear,
    /// ACES 1.0.
    Aces,
    /// The same, brighter by 1/0.6: what Filament does if not told.
    #[default]
    AcesLegacy,
    /// Narkowicz' curve.
    Filmic,
    /// A color for each stop.
    DisplayRange,
}

/// Color.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "camelCase")]
pub struct ColorGrading {
    /// The curve.
    #[serde(default, rename = "tone_mapping")]
    pub tone_mapping: ToneMapping,
    /// Size of Filament's table; ours has none.
    pub quality: Option<String>,
    /// Numbers of Filament's table; ours has none.
    pub format: Option<String>,
    /// In EV.
    pub exposure: Option<f64>,
    /// Loss of color in the dark.
    pub night_adaptation: Option<f64>,
    /// Temperature and tint, −1…1.
    pub white_balance: Option<[f64; 2]>,
    /// Rows of a matrix.
    pub channel_mixer: Option<Value>,
    /// Colors by brightness.
    pub shadows_midtones_highlights: Option<Value>,
    /// Of the logarithm.
    pub slope_offset_power: Option<Value>,
    /// About grey, 0…2.
    pub contrast: Option<f64>,
    /// Saturation of all but reds, 0…2.
    pub vibrance: Option<f64>,
    /// 0…2.
    pub saturation: Option<f64>,
    /// By channel.
    pub curves: Option<Value>,
    /// Of the tone curve.
    pub luminance_scaling: Option<bool>,
    /// Of the tone curve.
    pub gamut_mapping: Option<bool>,
}

/// Ambient occlusion.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "camelCase")]
#[allow(missing_docs, reason = "Filament's names, kept to refuse others")]
pub struct Ao {
    #[serde(default)]
    pub enabled: bool,
    pub radius: Option<Value>,
    pub power: Option<Value>,
    pub bias: Option<Value>,
    pub intensity: Option<Value>,
    pub resolution: Option<Value>,
    pub bilateral_threshold: Option<Value>,
    pub quality: Option<Value>,
    pub low_pass_filter: Option<Value>,
    pub upsampling: Option<Value>,
    pub min_horizon_angle_rad: Option<Value>,
    pub bent_normals: Option<Value>,
}

/// Glare.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "camelCase")]
#[allow(missing_docs, reason = "Filament's names, kept to refuse others")]
pub struct Bloom {
    #[serde(default)]
    pub enabled: bool,
    pub strength: Option<Value>,
    pub resolution: Option<Value>,
    pub levels: Option<Value>,
    pub blend_mode: Option<Value>,
    pub threshold: Option<Value>,
    pub highlight: Option<Value>,
    pub quality: Option<Value>,
    pub lens_flare: Option<Value>,
}

/// Haze.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "camelCase")]
#[allow(missing_docs, reason = "Filament's names, kept to refuse others")]
pub struct Fog {
    #[serde(default)]
    pub enabled: bool,
    pub distance: Option<Value>,
    pub density: Option<Value>,
    pub height: Option<Value>,
    pub height_falloff: Option<Value>,
    pub color: Option<Value>,
    pub maximum_opacity: Option<Value>,
    pub cut_off_distance: Option<Value>,
    pub in_scattering_start: Option<Value>,
    pub in_scattering_size: Option<Value>,
    pub fog_color_from_ibl: Option<Value>,
}

/// Darker corners.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "camelCase")]
#[allow(missing_docs, reason = "Filament's names, kept to refuse others")]
pub struct Vignette {
    #[serde(default)]
    pub enabled: bool,
    pub mid_point: Option<Value>,
    pub roundness: Option<Value>,
    pub feather: Option<Value>,
    pub color: Option<Value>,
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
        assert!(matches!(&assets[..], [Asset::Beside(_), Asset::Elsewhere(kept)] if kept.sha256 == "00"));
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

    #[test]
    fn what_is_wrong_is_named_with_its_place() {
        for (from, to, named) in [
            ("\"what\"", "\"mood\"", "mood: unknown key"),
            ("\"resolution\"", "\"size\"", "scene.size: unknown field `size`"),
            ("\"mapSize\"", "\"mapsize\"", "scene.lights[0].shadow_options.mapsize: unknown field `mapsize`"),
            ("\"radius\": 1", "\"radii\": 1", "scene.view.ao.radii: unknown field `radii`"),
            ("\"FILMIC\"", "\"SEPIA\"", "scene.view.color_grading.tone_mapping: unknown variant `SEPIA`"),
            ("[4, 2]", "[4, -2]", "scene.resolution[1]: "),
            ("\"intensity\": 3", "\"intensity\": \"3\"", "scene.lights[0].intensity: "),
            ("\"output\"", "\"outputs\"", "unknown field `outputs`"),
            ("\"id\": \"a\"", "\"id\": 1", "id: invalid type"),
            ("[1, 2, 3]", "[1, 2]", "objects.center"),
        ] {
            assert!(PLAIN.contains(from), "{from}");
            let error = told(&PLAIN.replace(from, to));
            assert!(error.starts_with("refs/a.json: ") && error.contains(named), "{from}: {error}");
        }
        assert!(told("{").starts_with("refs/a.json: "));
        assert!(Document::read(Path::new("no/such.json")).is_err_and(|e| e.to_string().contains("no/such.json")));
    }
}
