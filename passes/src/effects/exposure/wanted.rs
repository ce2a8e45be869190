//! What of a frame is measured, and what it leaves of that.

use crate::stages::{Handles, Slot};
use framegraph::Texture;

/// What of a frame is measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Measure {
    /// The brightest light before depth of field and bloom.
    pub light: bool,
    /// The nearest and the farthest that is seen.
    pub depth: bool,
}

/// What a frame leaves of its measures: handles that are read back.
#[derive(Clone, Copy, Debug, Default)]
pub struct MeasuredTextures {
    /// The most and the least light.
    pub light: Option<Texture>,
    /// The nearest and the farthest depth, reversed.
    pub depth: Option<Texture>,
}

impl Measure {
    /// Nothing.
    pub const NONE: Self = Self { light: false, depth: false };
}

impl MeasuredTextures {
    /// What stages have handed on.
    pub fn of(handles: &Handles) -> Self {
        Self { light: handles.find(Slot::MEASURED_LIGHT), depth: handles.find(Slot::MEASURED_DEPTH) }
    }
}
