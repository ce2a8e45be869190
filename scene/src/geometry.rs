//! Geometry algorithms: parametric shapes, levels of detail, triangle order, and for import flat normals, tangents and
//! vertex splitting.

mod box_shape;
#[cfg(feature = "gltf")]
mod flat;
#[cfg(feature = "gltf")]
mod frame;
mod levels;
mod order;
mod plane;
mod revolve;
#[cfg(feature = "gltf")]
mod tangent;
#[cfg(feature = "gltf")]
mod weld;

pub use box_shape::cuboid;
#[cfg(feature = "gltf")]
pub(crate) use flat::{make_flat, repair_normals};
pub use levels::{ReadStreams, levels_of_detail};
pub use order::{order_for_drawing, shaded_vertices};
pub use plane::plane;
pub use revolve::{ProfilePoint, cylinder, profile_of_revolution, sphere, torus};
#[cfg(feature = "gltf")]
pub(crate) use tangent::{generate_tangents, repair_tangents};

#[cfg(all(test, feature = "gltf"))]
mod tests;
