//! Reflection of a resolved shader: the interface that a pipeline must match, as plain data.
//!
//! Bind group layouts, vertex layouts and pipeline constants are derived from reflection rather than written by hand.
//! They therefore always match the WGSL.

mod interface;
mod operations;
mod read;

pub use interface::{
    Attribute, Binding, BindingKind, Dimension, EntryPoint, Member, Override, Reflection, Sample, Scalar, Slot, Stage,
    StructLayout,
};
pub use operations::Operations;
