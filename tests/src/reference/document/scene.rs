//! What to render: models, camera, lights, exposure.

use super::View;
use serde::{Deserialize, Deserializer};
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::path::PathBuf;

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
    #[serde(default, deserialize_with = "or_default")]
    pub lights: Vec<Light>,
    /// Light from all around.
    pub ibl: Option<Ibl>,
    /// How light becomes numbers.
    #[serde(default, deserialize_with = "or_default")]
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
    #[serde(default, deserialize_with = "or_default")]
    pub view: View,
}

/// `null` is as good as nothing.
fn or_default<'de, T: Default + Deserialize<'de>, D: Deserializer<'de>>(value: D) -> Result<T, D::Error> {
    Option::deserialize(value).map(Option::unwrap_or_default)
}

const fn black() -> [f64; 4] {
    [0.0, 0.0, 0.0, 1.0]
}

/// A model.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(untagged, expecting = "a path, or an object of entry, source and sha256, is needed")]
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
    /// Its hash, or those of all files that it consists of.
    pub sha256: Hashes,
}

/// SHA-256 of one file or of several, 64 hexadecimal digits each.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(untagged)]
pub enum Hashes {
    /// That of the entry.
    One(String),
    /// Each under the path of its file, beside the entry or in the folder of assets.
    Each(BTreeMap<PathBuf, String>),
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
#[serde(rename_all = "camelCase")]
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
    /// Where cascades end, as shares of the range.
    pub cascade_split_positions: Option<[f64; 3]>,
    /// Where shadows end, in meters; 0: where the camera's view does.
    pub shadow_far: Option<f64>,
    /// Short rays through the picture's depth complete the maps.
    pub screen_space_contact_shadows: Option<bool>,
    /// How many steps they have.
    pub step_count: Option<u32>,
    /// How long they are, in meters.
    pub max_shadow_distance: Option<f64>,
    /// Radius of the bulb in meters, for penumbrae.
    pub shadow_bulb_radius: Option<f64>,
    /// Options that are not known.
    #[serde(flatten)]
    pub unknown: Map<String, Value>,
}

/// Light from all around.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ibl {
    /// Irradiance / π in spherical harmonics, nine colors; three numbers are the first, and the others zero.
    pub sh: Option<Vec<f64>>,
    /// Radiance of an even environment.
    pub uniform_cube: Option<[f64; 3]>,
    /// A filtered cube with its harmonics in a Khronos texture.
    pub ktx1: Option<Asset>,
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
