//! What goes beside the settings of a frame: exposure, lens, light from all around, sun, moment of an animation.

use super::factors::Factors;
use framegraph_passes::FrameSettings;
use framegraph_scene::camera::ev100_from_settings;
use framegraph_scene::{Light, LightKind};
use glam::{DQuat, DVec3, Vec3};
use std::collections::BTreeMap;

/// Height of a full-frame sensor, in millimeters: what focal lengths are given for.
pub const SENSOR_MM: f64 = 24.0;

/// How the camera is exposed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Exposure {
    /// As a white card in the scene's light asks for.
    #[default]
    Metered,
    /// An exposure value at ISO 100.
    Ev100(f32),
    /// A camera's settings.
    Camera {
        /// F-number.
        aperture: f32,
        /// Shutter, in seconds.
        shutter_s: f32,
        /// Sensitivity.
        iso: f32,
    },
}

impl Exposure {
    /// The exposure value, where that of the light is `metered`.
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

/// Which sun shines.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Sun {
    /// The environment's own, else the scene's brightest directional light.
    #[default]
    Own,
    /// None.
    Off,
    /// This one.
    Given {
        /// About the vertical, from +z toward +x, in degrees.
        azimuth_deg: f32,
        /// Above the horizon, in degrees.
        elevation_deg: f32,
        /// On a surface that faces it.
        illuminance_lux: f32,
        /// Diameter of its disc, in degrees.
        diameter_deg: f32,
    },
}

impl Sun {
    /// What a given sun begins with: a clear afternoon's.
    pub const GIVEN: Self =
        Self::Given { azimuth_deg: 75.0, elevation_deg: 40.0, illuminance_lux: 100_000.0, diameter_deg: 0.533 };

    /// From the scene toward a given sun.
    pub fn toward(self) -> Option<DVec3> {
        let Self::Given { azimuth_deg, elevation_deg, .. } = self else { return None };
        let (azimuth, elevation) = (f64::from(azimuth_deg).to_radians(), f64::from(elevation_deg).to_radians());
        let flat = elevation.cos();
        Some(DVec3::new(azimuth.sin() * flat, elevation.sin(), azimuth.cos() * flat))
    }

    /// The sun that shines, where the environment has `own`, turned with it.
    pub fn light(self, own: Option<&Light>, turned_rad: f64) -> Option<Light> {
        match self {
            Self::Off => None,
            Self::Own => own.map(|own| {
                let direction = DQuat::from_rotation_y(turned_rad) * own.direction.as_dvec3();
                Light { direction: direction.as_vec3(), ..own.clone() }
            }),
            Self::Given { illuminance_lux, diameter_deg, .. } => {
                let toward: Vec3 = self.toward().unwrap_or(DVec3::Y).as_vec3();
                let angular_radius_rad = (0.5 * diameter_deg).to_radians();
                let kind = LightKind::Directional { illuminance_lux, angular_radius_rad };
                Some(Light { kind, ..Light::directional("sun", -toward, 0.0) })
            }
        }
    }
}

/// What is seen behind the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Behind {
    /// What lights it.
    #[default]
    Environment,
    /// The same radiance everywhere, in nits, linear Rec.709.
    Constant([f32; 3]),
}

/// What goes beside the settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// How the camera is exposed.
    pub exposure: Exposure,
    /// Focal length for a full-frame sensor, in millimeters; none for the camera's own.
    pub focal_length_mm: Option<f64>,
    /// Factor on light from all around.
    pub environment_intensity: f32,
    /// The environment's picture turned about the vertical, in degrees, with its sun.
    pub environment_turned_deg: f32,
    /// Which sun shines.
    pub sun: Sun,
    /// What is seen behind the scene.
    pub behind: Behind,
    /// Which animation is shown; none for the scene at rest.
    pub animation: Option<usize>,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            exposure: Exposure::default(),
            focal_length_mm: None,
            environment_intensity: 1.0,
            environment_turned_deg: 0.0,
            sun: Sun::default(),
            behind: Behind::default(),
            animation: None,
        }
    }
}

impl Look {
    /// The vertical field of view that the focal length gives, in radians.
    pub fn fov_y_rad(&self) -> Option<f64> {
        self.focal_length_mm.map(|mm| 2.0 * (0.5 * SENSOR_MM / mm.max(1.0)).atan())
    }

    /// How far the environment is turned, in radians.
    pub fn turned_rad(&self) -> f64 {
        f64::from(self.environment_turned_deg).to_radians()
    }
}

/// The focal length in millimeters that gives a vertical field of view.
pub fn focal_length_mm(fov_y_rad: f64) -> f64 {
    0.5 * SENSOR_MM / (0.5 * fov_y_rad).tan()
}

/// All that undo and redo go back to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// The settings of the frame.
    pub frame: FrameSettings,
    /// What goes beside them.
    pub look: Look,
    /// Materials of the scene that are not as it has them, by their numbers.
    pub materials: BTreeMap<usize, Factors>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sun_stands_where_it_is_told_and_turns_with_its_picture() {
        let toward = Sun::GIVEN.toward().expect("it has a direction");
        let usual = framegraph_scene::environment::Sky::default().toward_sun;
        assert!(toward.abs_diff_eq(usual, 1e-6), "{toward} {usual}");
        let own = Light::directional("own", Vec3::new(0.0, 0.0, -1.0), 5.0);
        let turned = Sun::Own.light(Some(&own), std::f64::consts::FRAC_PI_2).expect("a sun");
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
        let look = Look { focal_length_mm: Some(28.0), ..Look::default() };
        assert!((focal_length_mm(look.fov_y_rad().expect("a lens")) - 28.0).abs() < 1e-9);
    }
}
