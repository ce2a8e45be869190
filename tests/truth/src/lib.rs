//! Reference results for light transport by brute force in f64, and for perceived differences: ground truth for tables,
//! filters and approximations.
//!
//! This package shares no code with what it tests and depends on none of it. Formulas are implemented independently,
//! directions come from grids instead of importance sampling, and multiple scattering from a random walk.

pub mod albedo;
pub mod film;
pub mod flip;
pub mod lobe;
pub mod microsurface;
pub mod occlusion;
pub mod rays;
pub mod reflection;
pub mod slab;
pub mod sphere;
pub mod surface;
pub mod translucent;
