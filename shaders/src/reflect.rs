//! What a resolved shader asks of a pipeline, as plain data.
//!
//! Bind group layouts, vertex layouts and pipeline constants are derived from this and not
//! written a second time by hand, so they cannot drift from the WGSL.

mod interface;
mod operations;
mod read;

pub use interface::{
    Attribute, Binding, BindingKind, Dimension, EntryPoint, Member, Override, Reflection, Sample, Scalar, Slot, Stage,
    StructLayout,
};
pub use operations::Operations;
