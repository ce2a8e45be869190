//! What light really does, by brute force in f64, and what an observer sees of a difference: the judges of tables, filters
//! and approximations.
//!
//! Nothing here is shared with what it judges, and this package depends on none of it: the formulas are written anew,
//! directions come from grids and not from importance sampling, and multiple scattering from a random walk.

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
