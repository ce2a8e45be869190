//! Frame index.

/// Index of the frame, from 0, wrapping. Passes whose result must not repeat, such as dither, depend on it. Frames with
/// the same index and inputs are bit-identical.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct FrameIndex(pub u32);
