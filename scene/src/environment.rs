//! Environments: an equirectangular radiance map and, if known, the sun as a separate light.
//!
//! A sun inside a map is difficult to filter: spherical harmonics ring, and importance sampling converges slowly. The
//! procedural sky therefore excludes the sun from its map and returns it as a [`Light`](crate::Light).

mod clean;
mod cube;
mod cube_file;
mod definition;
mod equirect;
mod extract;
mod file;
mod filtered;
mod levels;
mod refused;
mod sh;
mod sh_basis;
mod sh_project;
mod sh_window;
mod sky;
mod sun;

pub use clean::{Cleaning, MAX_RADIANCE, cleaned};
pub use definition::Environment;
pub use equirect::{EquirectMap, direction_from_equirect_uv, equirect_uv_from_direction};
pub use extract::SunExtraction;
pub use filtered::FilteredLight;
pub use levels::RadianceLevel;
pub use sh::{Sh, ShBands};
pub use sh_basis::{polynomials, scale as sh_basis_scale};
pub use sh_window::ShWindow;
pub use sky::{Sky, SkyModel};
pub use sun::{SOLAR_ANGULAR_RADIUS_RAD, sun_light};

#[cfg(test)]
mod tests;
