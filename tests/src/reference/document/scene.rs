//! Scene of a statement: models, camera, lights, exposure.

use super::View;
use serde::{Deserialize, Deserializer};
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Scene to render.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Models.
    pub assets: Vec<Asset>,
    /// Width and height of the picture, in pixels.
    pub resolution: [u32; 2],
    /// Camera.
    pub camera: Camera,
    /// Lights.
    #[serde(default, deserialize_with = "or_default")]
    pub lights: Vec<Light>,
    /// Image-based light.
    pub ibl: Option<Ibl>,
    /// Exposure.
    #[serde(default, deserialize_with = "or_default")]
    pub exposure: Exposure,
    /// Background, as linear Rec.709 after exposure.
    #[serde(default = "black")]
    pub clear_color: [f64; 4],
    /// Variance and threshold of specular anti-aliasing.
    #[serde(default)]
    pub specular_aa: [f64; 2],
    /// Kind of values in the picture.
    pub output: Output,
    /// Processing of the picture.
    #[serde(default, deserialize_with = "or_default")]
    pub view: View,
}

/// Deserializes `null` as the default value.
fn or_default<'de, T: Default + Deserialize<'de>, D: Deserializer<'de>>(value: D) -> Result<T, D::Error> {
    Option::deserialize(value).map(Option::unwrap_or_default)
}

const fn black() -> [f64; 4] {
    [0.0, 0.0, 0.0, 1.0]
}

/// A model or environment.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(untagged, expecting = "a path, or an object of entry, source and sha256, is needed")]
pub enum Asset {
    /// Path relative to the statement.
    Beside(PathBuf),
    /// A file in the folder of assets.
    Elsewhere(Kept),
}

/// A file in the folder of assets.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Kept {
    /// Path in the folder of assets.
    pub entry: PathBuf,
    /// Origin of the file, for readers.
    #[serde(default)]
    pub source: Value,
    /// Hash of the file, or of each of its files.
    pub sha256: Hashes,
}

/// SHA-256 hashes with 64 hexadecimal digits.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(untagged)]
pub enum Hashes {
    /// Hash of the entry.
    One(String),
    /// Hash of each file, by path relative to the entry or to the folder of assets.
    Each(BTreeMap<PathBuf, String>),
}

/// Kind of projection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CameraType {
    /// Perspective.
    Perspective,
    /// Orthographic.
    Ortho,
}

/// A camera.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Camera {
    /// Projection.
    pub r#type: CameraType,
    /// Vertical field of view, in degrees.
    pub fov_y_deg: Option<f64>,
    /// Left, right, bottom and top of an orthographic view, in m.
    pub ortho: Option<[f64; 4]>,
    /// Position of the eye, in m.
    pub eye: [f64; 3],
    /// Point that the camera looks at, in m.
    pub center: [f64; 3],
    /// Up direction.
    pub up: [f64; 3],
    /// Distance of the near plane, in m.
    pub near: f64,
    /// Distance of the far plane, in m.
    pub far: f64,
}

/// Kind of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum LightType {
    /// Directional.
    Directional,
}

/// A light.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Light {
    /// Kind.
    pub r#type: LightType,
    /// Color, linear Rec.709.
    pub color: [f64; 3],
    /// Illuminance, in lux.
    pub intensity: f64,
    /// Direction in which the light travels; any length.
    pub direction: [f64; 3],
    /// True if the light casts shadows.
    #[serde(default)]
    pub cast_shadows: bool,
    /// Shadow options.
    #[serde(default)]
    pub shadow_options: ShadowOptions,
}

/// Shadow options of a light.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct ShadowOptions {
    /// Size of the shadow map in texels; 1024 by default.
    pub map_size: Option<u32>,
    /// Number of cascades.
    pub shadow_cascades: Option<u32>,
    /// Bias toward the light, in m.
    pub constant_bias: Option<f64>,
    /// Bias along the normal, in texels.
    pub normal_bias: Option<f64>,
    /// True if the map does not move with the camera.
    pub stable: Option<bool>,
    /// True for light-space perspective shadow maps (LiSPSM).
    pub lispsm: Option<bool>,
    /// Ends of cascades, relative to the range.
    pub cascade_split_positions: Option<[f64; 3]>,
    /// Distance at which shadows end, in m; 0 for the camera's far plane.
    pub shadow_far: Option<f64>,
    /// True for screen-space contact shadows.
    pub screen_space_contact_shadows: Option<bool>,
    /// Number of steps of contact shadows.
    pub step_count: Option<u32>,
    /// Length of contact shadow rays, in m.
    pub max_shadow_distance: Option<f64>,
    /// Radius of the light source for penumbrae, in m.
    pub shadow_bulb_radius: Option<f64>,
    /// Unknown options.
    #[serde(flatten)]
    pub unknown: Map<String, Value>,
}

/// Image-based light.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ibl {
    /// Irradiance / π in spherical harmonics, nine colors. With three numbers, only the first color is set.
    pub sh: Option<Vec<f64>>,
    /// Radiance of a uniform environment.
    pub uniform_cube: Option<[f64; 3]>,
    /// Prefiltered cube with harmonics, as a Khronos texture.
    pub ktx1: Option<Asset>,
    /// Factor on all of the light.
    #[serde(default = "one")]
    pub intensity: f64,
}

const fn one() -> f64 {
    1.0
}

/// Exposure of the picture.
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

/// Kind of values in a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Output {
    /// Linear light.
    Linear,
    /// 8-bit display values.
    Ldr,
}
