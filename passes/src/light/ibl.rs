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
//! An environment from Filament's `cmgen` comes with both, and nothing is filtered (`ready_made.rs`). Otherwise both GPU results are computed once (`ImageLight::new`, `DfgTable::new`), as render graphs of one slice of the work each,
//! and then come from a `Cache` on disk, found by the content they were made from. Making light is the feature `ibl`;
//! without it the types remain, to be filled with light that was made elsewhere.
//! Everything is photometric: the light is in the unit of the environment (nits), and whoever binds it multiplies with
//! intensity and exposure.
//!
//! The split sum is Karis's ("Real Shading in Unreal Engine 4", 2013), filtered importance sampling
//! Křivánek and Colbert's (GPU Gems 3, chapter 20).

#[cfg(feature = "ibl")]
mod bake;
#[cfg(feature = "ibl")]
pub mod cache;
#[cfg(feature = "ibl")]
mod cube;
#[cfg(feature = "ibl")]
mod entry;
mod error;
#[cfg(feature = "ibl")]
mod faces;
#[cfg(feature = "ibl")]
mod integrate;
#[cfg(feature = "ibl")]
mod kernel;
mod light;
#[cfg(feature = "ibl")]
mod ready_made;
#[cfg(feature = "ibl")]
mod rgbm;
mod settings;
#[cfg(feature = "ibl")]
mod slices;
mod table;
#[cfg(feature = "ibl")]
mod texture;

pub use error::IblError;
#[cfg(feature = "ibl")]
pub use kernel::{KernelRow, kernel_rows, lobe_kernel};
pub use light::{IRRADIANCE_COEFFICIENTS, ImageLight};
pub use settings::{EnvironmentFormat, IblSettings};
pub use table::{DfgSettings, DfgTable};

#[cfg(all(test, feature = "ibl"))]
mod tests;
