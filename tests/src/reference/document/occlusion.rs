//! Ambient occlusion as Filament states it.

use serde::Deserialize;
use serde_json::Value;

/// Ambient occlusion; what is not given is as Filament has it.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "camelCase")]
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
    pub ssct: Option<Value>,
    /// Horizons in slices.
    pub gtao: Option<Value>,
    /// Which of the two.
    #[serde(alias = "aoType")]
    pub ao_type: Option<AoType>,
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
