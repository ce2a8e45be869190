//! Limited quantities and their units.

use std::fmt;

/// A quantity with a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Quantity {
    /// Bytes of a file.
    FileBytes,
    /// Nodes of a file.
    Nodes,
    /// Instances of a scene.
    Instances,
    /// Elements of the accessor with this index in the file.
    AccessorElements(usize),
    /// Vertices of a scene.
    Vertices,
    /// Indices of a scene.
    Indices,
    /// Width or height of an image, in texels.
    Side,
    /// Bytes of a GPU buffer for one kind of data: `positions`, `materials`.
    BufferBytes(&'static str),
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::FileBytes => f.write_str("size in bytes"),
            Self::Nodes => f.write_str("number of nodes"),
            Self::Instances => f.write_str("number of instances"),
            Self::AccessorElements(accessor) => write!(f, "number of elements of accessor {accessor}"),
            Self::Vertices => f.write_str("number of vertices"),
            Self::Indices => f.write_str("number of indices"),
            Self::Side => f.write_str("side in texels"),
            Self::BufferBytes(kind) => write!(f, "size in bytes of all {kind}"),
        }
    }
}
