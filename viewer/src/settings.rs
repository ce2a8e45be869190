//! Settings of the standard frame as a tree of values, so that a panel can show every field without knowing it.

mod choices;
#[cfg(test)]
mod document;
mod tooltips;
mod tree;

pub use choices::{Alternatives, alternatives};
pub use tooltips::{about, range};
pub use tree::{Node, TreeError, parse};

use framegraph_passes::FrameSettings;

/// Field of the file that holds the frame.
const FRAME: &str = "frame";

/// Returns the settings as a tree of the complete file.
///
/// # Errors
/// No known cause, since the settings are written and read by the library.
pub fn tree(frame: &FrameSettings) -> Result<Node, String> {
    let text = frame.to_ron()?;
    let whole = parse(&text).map_err(|error| error.to_string())?;
    whole.field(FRAME).cloned().ok_or_else(|| format!("internal error: the settings have no field `{FRAME}`"))
}

/// Converts a tree to settings.
///
/// # Errors
/// The invalid field and its expected value.
pub fn settings(frame: &Node) -> Result<FrameSettings, String> {
    let version = framegraph_passes::frame::settings_file::SETTINGS_VERSION;
    let text = format!("(version: {version}, {FRAME}: {frame})");
    FrameSettings::from_ron("settings", &text).map_err(|error| error.to_string())
}
