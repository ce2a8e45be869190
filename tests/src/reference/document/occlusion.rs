//! Ambient occlusion as Filament states it.

use serde::Deserialize;
use serde_json::{Map, Value};

/// Ambient occlusion; what is not given is as Filament has it.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Ao {
    /// On.
    #[serde(default)]
    pub enabled: bool,
    /// In m.
    pub radius: Option<f64>,
    /// Exponent.
    pub power: Option<f64>,
    /// Share of the distance.
    pub bias: Option<f64>,
    /// Factor.
    pub intensity: Option<f64>,
    /// Share of the picture's width: 1 or 0.5.
    pub resolution: Option<f64>,
    /// Distance between surfaces in m.
    pub bilateral_threshold: Option<f64>,
    /// Taps.
    pub quality: Option<AoQuality>,
    /// The blur.
    pub low_pass_filter: Option<AoQuality>,
    /// How a smaller picture is read: by depth from high on.
    pub upsampling: Option<AoQuality>,
    /// In radians.
    pub min_horizon_angle_rad: Option<f64>,
    /// Reflections look along the mean open direction.
    pub bent_normals: Option<bool>,
    /// Cone tracing toward the sun.
    pub ssct: Option<Ssct>,
    /// Horizons in slices.
    pub gtao: Option<Gtao>,
    /// Which of the two.
    #[serde(alias = "aoType")]
    pub ao_type: Option<AoType>,
    /// Options that are not known.
    #[serde(flatten)]
    pub unknown: Map<String, Value>,
}

/// Cone tracing toward the sun; the angle is at the tip.
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

/// Horizons in slices.
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

/// Filament's levels of quality.
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

/// The method.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum AoType {
    /// Scalable ambient obscurance.
    #[default]
    Sao,
    /// Horizons in slices.
    Gtao,
}
