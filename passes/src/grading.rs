//! Color grading and the tone curve: settings by name, and tables that both are baked into.
//!
//! [`Look`] is all that happens to a color between radiance and code, but dither. It is computed for each pixel, or once for
//! each entry of a table ([`GradeBy`]): the same functions either way, in f32 by the shader and in f64 on the CPU. What only
//! the CPU knows, a curve of the application's own and a file of colors, needs a table; [`GradingTables`] holds these, and
//! the tables made of them. `docs/design/grading.md` has the errors.

mod bake;
mod by;
mod error;
mod keys;
mod look;
mod tables;

pub use bake::Baked;
pub use by::{GradeBy, TableDesc, TableFormat};
pub use error::GradingError;
pub use keys::tone_map;
pub use look::{Extras, Look, OwnCurve};
pub use tables::GradingTables;
