//! Color grading and tone curves: settings by name, and lookup tables.
//!
//! [`Look`] describes all color processing between radiance and the encoded picture, except dither. It is evaluated per
//! pixel, or once for each entry of a table ([`GradeBy`]). Both use the same functions, in `f32` in the shader and in
//! `f64` on the CPU. Custom tone curves and color tables exist only on the CPU, so they require a table.
//! [`GradingTables`] holds them and the tables made from them. `docs/design/grading.md` has the errors.

mod bake;
mod by;
mod error;
mod fields;
mod look;
mod tables;

pub use bake::Baked;
pub use by::{GradeBy, TableDesc, TableFormat};
pub use error::GradingError;
pub use fields::tone_map;
pub use look::{Extras, Look, OwnCurve};
pub use tables::GradingTables;
