//! Ambient occlusion options in Filament's terms.

use serde::Deserialize;
use serde_json::{Map, Value};

/// Ambient occlusion; missing options have Filament's defaults.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Ao {
    /// True if enabled.
    #[serde(default)]
    pub enabled: bool,
    /// Radius, in m.
    pub radius: Option<f64>,
    /// Exponent of the visibility.
    pub power: Option<f64>,
    /// Bias, relative to the distance.
    pub bias: Option<f64>,
    /// Factor on occlusion.
    pub intensity: Option<f64>,
    /// Resolution relative to the picture: 1 or 0.5.
    pub resolution: Option<f64>,
    /// Depth threshold of the blur, in m.
    pub bilateral_threshold: Option<f64>,
    /// Quality, which selects the number of samples.
    pub quality: Option<AoQuality>,
    /// Quality of the blur.
    pub low_pass_filter: Option<AoQuality>,
    /// Quality of upsampling from a lower resolution; depth-aware at `High` and `Ultra`.
    pub upsampling: Option<AoQuality>,
    /// Minimum horizon angle, in radians.
    pub min_horizon_angle_rad: Option<f64>,
    /// True if reflections use bent normals.
    pub bent_normals: Option<bool>,
    /// Screen-space cone tracing toward the sun.
    pub ssct: Option<Ssct>,
    /// Options of GTAO.
    pub gtao: Option<Gtao>,
    /// Method.
    #[serde(alias = "aoType")]
    pub ao_type: Option<AoType>,
    /// Unknown options.
    #[serde(flatten)]
    pub unknown: Map<String, Value>,
}

/// Options of screen-space cone tracing toward the sun; the cone angle is the full angle at the tip.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "camelCase")]
#[allow(missing_docs, reason = "Filament's names; lengths in m, angles in radians")]
pub struct Ssct {
    #[serde(default)]
    pub enabled: bool,
    pub light_cone_rad: Option<f64>,
    pub shadow_distance: Option<f64>,
    pub contact_distance_max: Option<f64>,
    pub intensity: Option<f64>,
    pub light_direction: Option<[f64; 3]>,
    pub depth_bias: Option<f64>,
    pub depth_slope_bias: Option<f64>,
    pub sample_count: Option<u32>,
    pub ray_count: Option<u32>,
}

/// Options of GTAO.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "camelCase")]
#[allow(missing_docs, reason = "Filament's names")]
pub struct Gtao {
    pub sample_slice_count: Option<u32>,
    pub sample_steps_per_slice: Option<u32>,
    pub thickness_heuristic: Option<f64>,
    pub use_visibility_bitmasks: Option<bool>,
    pub const_thickness: Option<f64>,
    pub linear_thickness: Option<bool>,
}

/// Filament's quality levels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum AoQuality {
    /// Low.
    #[default]
    Low,
    /// Medium.
    Medium,
    /// High.
    High,
    /// Ultra.
    Ultra,
}

/// Method of ambient occlusion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum AoType {
    /// Scalable ambient obscurance.
    #[default]
    Sao,
    /// Ground-truth ambient occlusion.
    Gtao,
}
