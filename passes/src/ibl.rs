//! Image-based light: what an [`Environment`](framegraph_scene::Environment) adds to every surface, ready for shaders to
//! look up.
//!
//! ```text
//!                ┌─> spherical harmonics (f64, CPU) ──> irradiance / π, 18 coefficients
//! Environment ───┤
//!                └─> panorama ─> cube + levels ─> prefiltered cube, a roughness a level      (GPU)
//! DFG table: directional albedo of the lobes over (n·v, roughness), whatever the environment (GPU)
//! ```
//!
//! Both GPU results are computed once, as render graphs of one slice of the work each ([`ImageLight::new`],
//! [`DfgTable::new`]), and then come from a [`Cache`](cache::Cache) on disk, found by the content they were made from.
//! Everything is photometric: the light is in the unit of the environment (nits), and whoever binds it multiplies with
//! intensity and exposure.
//!
//! The split sum is Karis's ("Real Shading in Unreal Engine 4", 2013), filtered importance sampling
//! Křivánek and Colbert's (GPU Gems 3, chapter 20).

mod bake;
pub mod cache;
mod cube;
mod entry;
mod error;
mod faces;
mod integrate;
mod kernel;
mod light;
mod settings;
mod slices;
mod table;
mod texture;

pub use error::IblError;
pub use kernel::{KernelRow, kernel_rows, lobe_kernel};
pub use light::{IRRADIANCE_COEFFICIENTS, ImageLight};
pub use settings::IblSettings;
pub use table::{DfgSettings, DfgTable};

#[cfg(test)]
mod tests;
