//! What light really does, by brute force in f64: the judge of tables, filters and approximations.
//!
//! Nothing here is shared with what it judges: the formulas are written anew, directions come from grids
//! and not from importance sampling, and multiple scattering from a random walk.

pub mod albedo;
pub mod lobe;
pub mod microsurface;
pub mod occlusion;
pub mod rays;
pub mod reflection;
pub mod sphere;
pub mod surface;
