//! Vertex work that needs no file: flat normals, tangents, splitting, and parametric shapes.

mod box_shape;
mod flat;
mod frame;
mod plane;
mod revolve;
mod tangent;
mod weld;

pub use box_shape::cuboid;
pub(crate) use flat::make_flat;
pub use frame::tangent_of_normal;
pub use plane::plane;
pub use revolve::{ProfilePoint, cylinder, profile_of_revolution, sphere, torus};
pub(crate) use tangent::{generate_tangents, repair_tangents};

#[cfg(test)]
mod tests;
