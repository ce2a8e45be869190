//! Capture settings in addition to the frame settings: exposure, lens, environment, sun and animation.

use super::factors::Factors;
use framegraph_passes::FrameSettings;
use framegraph_scene::camera::ev100_from_settings;
use framegraph_scene::{Light, LightKind};
use glam::{DQuat, DVec3, Vec3};
use std::collections::BTreeMap;

/// Height of a full-frame sensor in millimeters, the reference of focal lengths.
pub const SENSOR_MM: f64 = 24.0;

/// Exposure of the camera.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Exposure {
    /// Metered so that a white card in the scene's light appears white.
    #[default]
    Metered,
    /// Exposure value at ISO 100.
    Ev100(f32),
    /// Camera settings.
    Camera {
        /// F-number.
        aperture: f32,
        /// Shutter time in seconds.
        shutter_s: f32,
        /// ISO sensitivity.
        iso: f32,
    },
}

impl Exposure {
    /// Returns the exposure value at ISO 100; `metered` is that of the light.
    pub fn ev100(self, metered: f32) -> f32 {
        match self {
            Self::Metered => metered,
            Self::Ev100(value) => value,
            Self::Camera { aperture, shutter_s, iso } => {
                ev100_from_settings(aperture, shutter_s, iso).unwrap_or(metered)
            }
        }
    }
}

/// Source of the sun light.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Sun {
    /// Sun of the environment, or else the brightest directional light of the scene.
    #[default]
    FromScene,
    /// No sun.
    Off,
    /// Custom sun.
    Custom {
        /// Azimuth from +z toward +x, in degrees.
        azimuth_deg: f32,
        /// Elevation above the horizon, in degrees.
        elevation_deg: f32,
        /// Illuminance on a surface that faces the sun, in lux.
        illuminance_lux: f32,
        /// Diameter of the disc, in degrees.
        diameter_deg: f32,
    },
}

impl Sun {
    /// Initial custom sun: a clear afternoon.
    pub const CUSTOM: Self =
        Self::Custom { azimuth_deg: 75.0, elevation_deg: 40.0, illuminance_lux: 100_000.0, diameter_deg: 0.533 };

    /// Returns the direction toward a custom sun.
    pub fn toward(self) -> Option<DVec3> {
        let Self::Custom { azimuth_deg, elevation_deg, .. } = self else { return None };
        let (azimuth, elevation) = (f64::from(azimuth_deg).to_radians(), f64::from(elevation_deg).to_radians());
        let flat = elevation.cos();
        Some(DVec3::new(azimuth.sin() * flat, elevation.sin(), azimuth.cos() * flat))
    }

    /// Returns the sun light. `own` is the sun of the environment, rotated with it.
    pub fn light(self, own: Option<&Light>, turned_rad: f64) -> Option<Light> {
        match self {
            Self::Off => None,
            Self::FromScene => own.map(|own| {
                let direction = DQuat::from_rotation_y(turned_rad) * own.direction.as_dvec3();
                Light { direction: direction.as_vec3(), ..own.clone() }
            }),
            Self::Custom { illuminance_lux, diameter_deg, .. } => {
                let toward: Vec3 = self.toward().unwrap_or(DVec3::Y).as_vec3();
                let angular_radius_rad = (0.5 * diameter_deg).to_radians();
                let kind = LightKind::Directional { illuminance_lux, angular_radius_rad };
                Some(Light { kind, ..Light::directional("sun", -toward, 0.0) })
            }
        }
    }
}

/// Source of the visible background.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum BackgroundSource {
    /// The environment.
    #[default]
    Environment,
    /// Constant radiance in nits, linear Rec.709.
    Constant([f32; 3]),
}

/// Exposure, lens, environment, sun and animation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capture {
    /// Exposure of the camera.
    pub exposure: Exposure,
    /// Focal length for a full-frame sensor in millimeters; `None` for the lens of the scene's camera.
    pub focal_length_mm: Option<f64>,
    /// Factor on the environment light.
    pub environment_intensity: f32,
    /// Rotation of the environment picture and its sun about the vertical, in degrees.
    pub environment_turned_deg: f32,
    /// Sun.
    pub sun: Sun,
    /// Visible background.
    pub background: BackgroundSource,
    /// Index of the animation; `None` for the rest pose.
    pub animation: Option<usize>,
}

impl Default for Capture {
    fn default() -> Self {
        Self {
            exposure: Exposure::default(),
            focal_length_mm: None,
            environment_intensity: 1.0,
            environment_turned_deg: 0.0,
            sun: Sun::default(),
            background: BackgroundSource::default(),
            animation: None,
        }
    }
}

impl Capture {
    /// Returns the vertical field of view of the focal length, in radians.
    pub fn fov_y_rad(&self) -> Option<f64> {
        self.focal_length_mm.map(|mm| 2.0 * (0.5 * SENSOR_MM / mm.max(1.0)).atan())
    }

    /// Returns the rotation of the environment in radians.
    pub fn turned_rad(&self) -> f64 {
        f64::from(self.environment_turned_deg).to_radians()
    }
}

/// Returns the focal length in millimeters for a vertical field of view.
pub fn focal_length_mm(fov_y_rad: f64) -> f64 {
    0.5 * SENSOR_MM / (0.5 * fov_y_rad).tan()
}

/// State that undo and redo restore.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// Settings of the frame.
    pub frame: FrameSettings,
    /// Exposure, lens, environment, sun and animation.
    pub capture: Capture,
    /// Edited materials by index.
    pub materials: BTreeMap<usize, Factors>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_custom_sun_has_its_direction_and_the_sun_of_a_picture_rotates() {
        let toward = Sun::CUSTOM.toward().expect("it has a direction");
        let usual = framegraph_scene::environment::Sky::default().toward_sun;
        assert!(toward.abs_diff_eq(usual, 1e-6), "{toward} {usual}");
        let own = Light::directional("own", Vec3::new(0.0, 0.0, -1.0), 5.0);
        let turned = Sun::FromScene.light(Some(&own), std::f64::consts::FRAC_PI_2).expect("a sun");
        assert!(turned.direction.abs_diff_eq(Vec3::new(-1.0, 0.0, 0.0), 1e-6), "{}", turned.direction);
        assert_eq!(Sun::Off.light(Some(&own), 0.0), None);
    }

    #[test]
    fn exposure_and_lens_are_those_of_cameras() {
        let sunny = Exposure::Camera { aperture: 16.0, shutter_s: 1.0 / 128.0, iso: 100.0 };
        assert_eq!(
            (sunny.ev100(3.0), Exposure::Metered.ev100(3.0), Exposure::Ev100(-2.0).ev100(3.0)),
            (15.0, 3.0, -2.0)
        );
        let capture = Capture { focal_length_mm: Some(28.0), ..Capture::default() };
        assert!((focal_length_mm(capture.fov_y_rad().expect("a lens")) - 28.0).abs() < 1e-9);
    }
}
