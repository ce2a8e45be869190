//! Requested measurements of a frame, and their results.

use crate::stages::{Handles, Slot};
use framegraph::Texture;

/// Requested measurements of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Measure {
    /// Measures the brightest light before depth of field and bloom.
    pub light: bool,
    /// Measures the nearest and the farthest visible depth.
    pub depth: bool,
}

/// Textures with measurements of a frame, for readback.
#[derive(Clone, Copy, Debug, Default)]
pub struct MeasuredTextures {
    /// Maximum and minimum light.
    pub light: Option<Texture>,
    /// Nearest and farthest reversed depth.
    pub depth: Option<Texture>,
}

impl Measure {
    /// No measurements.
    pub const NONE: Self = Self { light: false, depth: false };
}

impl MeasuredTextures {
    /// Returns the textures that stages have set.
    pub fn of(handles: &Handles) -> Self {
        Self { light: handles.find(Slot::MEASURED_LIGHT), depth: handles.find(Slot::MEASURED_DEPTH) }
    }
}
