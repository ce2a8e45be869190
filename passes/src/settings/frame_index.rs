//! Which frame it is.

/// Counts frames from 0, wrapping. Passes whose result must not repeat from frame to frame (dither) depend on it; two
/// frames of one index and the same inputs are equal to the bit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct FrameIndex(pub u32);
