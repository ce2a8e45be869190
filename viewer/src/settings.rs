//! The settings of the standard frame as a tree of values: what a panel needs to show every field of the file, also those that
//! it knows nothing of.

mod choices;
mod tree;
mod words;

pub use choices::{Alternatives, alternatives};
pub use tree::{Node, TreeError, parse};
pub use words::about;

use framegraph_passes::FrameSettings;

/// The field of the file that holds the frame.
const FRAME: &str = "frame";

/// The settings as a tree, as the complete file has them.
///
/// # Errors
/// What the file cannot hold, or the tree cannot read: no settings that there are.
pub fn tree(frame: &FrameSettings) -> Result<Node, String> {
    let text = frame.to_ron()?;
    let whole = parse(&text).map_err(|error| error.to_string())?;
    whole.field(FRAME).cloned().ok_or_else(|| format!("the settings have no field `{FRAME}`"))
}

/// The settings that a tree says.
///
/// # Errors
/// The field that is wrong, and what it takes.
pub fn settings(frame: &Node) -> Result<FrameSettings, String> {
    let version = framegraph_passes::settings_file::SETTINGS_VERSION;
    let text = format!("(version: {version}, {FRAME}: {frame})");
    FrameSettings::from_ron("settings", &text).map_err(|error| error.to_string())
}
