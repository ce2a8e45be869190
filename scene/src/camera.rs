//! Cameras: position, projection and exposure.

mod choice;
mod definition;
mod exposure;
mod orbit;
mod pixel;
mod projection;

pub use choice::CameraChoice;
pub use definition::Camera;
pub use exposure::{EV100_RANGE, ev100_from_average_luminance, ev100_from_settings, exposure_from_ev100};
pub use orbit::{ORBIT_AZIMUTH_DEG, ORBIT_ELEVATION_DEG, orbit};
pub use pixel::PixelSize;
pub use projection::Projection;

#[cfg(test)]
mod tests;
