//! What the panel of settings keeps from frame to frame.

use crate::settings::Node;
use framegraph_passes::FrameSettings;

/// What the panel of settings keeps.
#[derive(Clone, Debug, Default)]
pub struct SettingsPanel {
    /// The settings as a tree, and what it was made of.
    pub tree: Option<(FrameSettings, Node)>,
    /// Why what was asked last is not shown.
    pub refused: Option<String>,
    /// Part of the names of the fields that are shown.
    pub search: String,
}
