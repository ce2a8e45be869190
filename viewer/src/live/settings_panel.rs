//! State of the settings panel.

use crate::settings::Node;
use framegraph_passes::FrameSettings;

/// State of the settings panel.
#[derive(Clone, Debug, Default)]
pub struct SettingsPanel {
    /// Settings as a tree, with the settings it was created from.
    pub tree: Option<(FrameSettings, Node)>,
    /// Reason that the last edit was rejected.
    pub refused: Option<String>,
    /// Confirmation that the settings were saved, until they change.
    pub saved: Option<String>,
    /// Search text for field names.
    pub search: String,
}
