//! Errors of loading scenes. Every message is one line: the file, the place in it, and the reason.

mod camera;
mod quantity;
mod unsupported;

use std::io;
use std::path::{Path, PathBuf};

use crate::codec::CodecError;
use crate::memory::OverBudget;
use crate::stage::Stage;

pub use camera::{CameraTextError, LookAtError};
pub use quantity::Quantity;
pub use unsupported::Unsupported;

/// Error of loading a scene, an environment or a camera.
///
/// `Display` never contains a line break: text from files and users is printed through [`one_line`].
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// A file cannot be opened or read.
    #[error("{}: cannot be read: {source}", shown(file))]
    Read {
        /// Path of the file.
        file: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// A file violates its format, or contains values that cannot be drawn.
    #[error("{}: {}: {}", shown(file), one_line(at), one_line(reason))]
    Malformed {
        /// Path of the file.
        file: PathBuf,
        /// Place in the file: `accessor 3`, `mesh 0 primitive 1`.
        at: String,
        /// Description of the problem, as text.
        reason: String,
    },
    /// An image cannot be decoded.
    #[error("{}: {}: does not decode: {}", shown(file), one_line(at), one_line(&error.to_string()))]
    Picture {
        /// Path of the image, or of the file in which it is embedded.
        file: PathBuf,
        /// Image in the file: `image 3`, `environment`.
        at: String,
        /// Error of the decoder.
        error: CodecError,
    },
    /// A valid file uses an unsupported feature.
    #[error("{}: {}", shown(file), one_line(&feature.to_string()))]
    Unsupported {
        /// Path of the file.
        file: PathBuf,
        /// Unsupported feature; its `Display` suggests an alternative.
        feature: Unsupported,
    },
    /// A quantity exceeds a limit of this crate or of the device.
    #[error("{}: {what} is {value}, over the limit of {limit}", shown(file))]
    TooLarge {
        /// Path of the file, or name of the scene.
        file: PathBuf,
        /// Quantity that is too large.
        what: Quantity,
        /// Actual value, in the unit of the quantity.
        value: u64,
        /// Maximum value.
        limit: u64,
    },
    /// A referenced file cannot be loaded. The message is that of `error`, preceded by the name of `file`.
    #[error("{}: {}: {error}", shown(file), one_line(at))]
    Named {
        /// Path of the referring file.
        file: PathBuf,
        /// Place of the reference: `buffer 0`.
        at: String,
        /// Error of the referenced file.
        error: Box<SceneError>,
    },
    /// A URI points outside of the folder of its file.
    #[error(
        "{}: {}: the path {:?} leads out of the scene's folder (`LoadOptions::allow_outside` or `--allow-outside` reads it)",
        shown(file),
        one_line(at),
        one_line(uri)
    )]
    Outside {
        /// Path of the referring file.
        file: PathBuf,
        /// Place of the reference: `image 3`.
        at: String,
        /// The URI.
        uri: String,
    },
    /// The memory budget for loading is exceeded.
    #[error(
        "{}: {}: {budget}; raise the budget (`LoadOptions::memory`, `--memory`), or make it smaller",
        shown(file),
        one_line(at)
    )]
    Memory {
        /// Path of the file, or name of the scene.
        file: PathBuf,
        /// Object that exceeds the budget: `image 3 "wood", 8192×8192`.
        at: String,
        /// Required and available memory.
        budget: OverBudget,
    },
    /// No built-in scene has this name.
    #[error("{:?} is neither a file nor a built-in scene (built in: {})", one_line(name), known.join(", "))]
    UnknownScene {
        /// Requested name.
        name: String,
        /// Valid names.
        known: &'static [&'static str],
    },
    /// The scene has no material variant of this name.
    #[error("{}: it has no material variant {:?} (its variants: {})", shown(file), one_line(name), names(known))]
    UnknownVariant {
        /// Path of the file, or name of the scene.
        file: PathBuf,
        /// Requested name.
        name: String,
        /// Valid names.
        known: Vec<String>,
    },
    /// The number of panes in `panes:N` is invalid.
    #[error("panes:{}: a whole number from 0 to {most} is needed", one_line(count))]
    PaneCount {
        /// Text after the colon.
        count: String,
        /// Maximum number of panes.
        most: u32,
    },
    /// The number of lights in `lamps:N` is invalid.
    #[error("lamps:{}: a whole number from 0 to {most} is needed", one_line(count))]
    LampCount {
        /// Text after the colon.
        count: String,
        /// Maximum number of lights.
        most: u32,
    },
    /// The scene has no camera of this name.
    #[error("the scene has no camera named {:?} (its cameras: {}; or use orbit)", one_line(name), names(known))]
    UnknownCamera {
        /// Requested name.
        name: String,
        /// Valid names.
        known: Vec<String>,
    },
    /// The text of a camera is invalid or does not define a view.
    #[error("camera {:?}: {reason} (write NAME, orbit, or EX,EY,EZ:TX,TY,TZ:FOVY)", one_line(text))]
    Camera {
        /// Text of the camera.
        text: String,
        /// Problem with the text.
        reason: CameraTextError,
    },
    /// A parameter of a generated scene, sky or table is out of range.
    #[error("{parameter} is {value}, outside {range}")]
    Parameter {
        /// Name of the parameter.
        parameter: &'static str,
        /// Value of the parameter.
        value: f64,
        /// Valid range, with the unit.
        range: &'static str,
    },
    /// The progress callback requested to stop.
    #[error("{}: interrupted while {stage}", shown(file))]
    Interrupted {
        /// Path of the file being loaded.
        file: PathBuf,
        /// Stage that was interrupted.
        stage: Stage,
    },
}

impl std::fmt::Debug for SceneError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

impl SceneError {
    /// Returns the error for a violation of a format at a place in `file`.
    #[cfg(feature = "gltf")]
    pub(crate) fn malformed(file: &Path, at: impl Into<String>, reason: impl Into<String>) -> Self {
        Self::Malformed { file: file.into(), at: at.into(), reason: reason.into() }
    }
}

fn shown(file: &Path) -> String {
    one_line(&file.display().to_string())
}

fn names(known: &[String]) -> String {
    if known.is_empty() { "none".into() } else { one_line(&known.join(", ")) }
}

/// Returns `text` on one line: control characters become spaces, and text of more than 240 characters is cut.
#[must_use]
pub fn one_line(text: &str) -> String {
    const LONGEST: usize = 240;
    let mut line: String = text.chars().take(LONGEST).map(|c| if c.is_control() { ' ' } else { c }).collect();
    if text.chars().nth(LONGEST).is_some() {
        line.push('…');
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_stay_on_one_line() {
        let (at, reason) = ("node \"x\r\ny\"".into(), "z".repeat(5000) + "\n");
        let text = SceneError::Malformed { file: "a\nb.gltf".into(), at, reason }.to_string();
        assert!(!text.contains(['\n', '\r']), "{text}");
        assert!(text.starts_with("a b.gltf: node \"x  y\": zzz"));
        assert!(text.len() < 600);
    }
}
