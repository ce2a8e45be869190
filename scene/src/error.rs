//! What can be wrong with a scene. Every message is one line: the file, where in it, and why.

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

/// Why a scene, an environment or a camera could not be had.
///
/// `Display` never contains a line break, whatever a file says: all text taken from files and from users is shown
/// through [`one_line`].
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// A file cannot be opened or read.
    #[error("{}: cannot be read: {source}", shown(file))]
    Read {
        /// The file.
        file: PathBuf,
        /// The error of the operating system.
        source: io::Error,
    },
    /// A file breaks its format's rules, or holds values that cannot be drawn.
    #[error("{}: {}: {}", shown(file), one_line(at), one_line(reason))]
    Malformed {
        /// The file.
        file: PathBuf,
        /// Where in the file: `accessor 3`, `mesh 0 primitive 1`.
        at: String,
        /// What is wrong there, for people: the rules of a format are too many to be told apart by programs.
        reason: String,
    },
    /// A picture does not decode.
    #[error("{}: {}: does not decode: {}", shown(file), one_line(at), one_line(&error.to_string()))]
    Picture {
        /// The picture's own file, or the file it is embedded in.
        file: PathBuf,
        /// Which picture: `image 3`, `environment`.
        at: String,
        /// What is wrong with it.
        error: CodecError,
    },
    /// A file is valid but asks for something that is not read.
    #[error("{}: {}", shown(file), one_line(&feature.to_string()))]
    Unsupported {
        /// The file.
        file: PathBuf,
        /// What it asks for, and what to do instead.
        feature: Unsupported,
    },
    /// Something is larger than this crate or the device accepts.
    #[error("{}: {what} is {value}, over the limit of {limit}", shown(file))]
    TooLarge {
        /// The file, or the name of the scene.
        file: PathBuf,
        /// What is too large.
        what: Quantity,
        /// How large it is, in the unit of the quantity.
        value: u64,
        /// How large it may be.
        limit: u64,
    },
    /// A file that another one names is not to be had; the message is that of `error` behind the name of `file`.
    #[error("{}: {}: {error}", shown(file), one_line(at))]
    Named {
        /// The file that asks for it.
        file: PathBuf,
        /// Where it does: `buffer 0`.
        at: String,
        /// What is wrong with the file that is asked for.
        error: Box<SceneError>,
    },
    /// A URI leads out of the folder of its file.
    #[error(
        "{}: {}: the path {:?} leads out of the scene's folder (`LoadOptions::allow_outside` or `--allow-outside` reads it)",
        shown(file),
        one_line(at),
        one_line(uri)
    )]
    Outside {
        /// The file that asks for it.
        file: PathBuf,
        /// Where it does: `image 3`.
        at: String,
        /// The URI.
        uri: String,
    },
    /// Something does not fit into the memory that loading may take.
    #[error(
        "{}: {}: {budget}; raise the budget (`LoadOptions::memory`, `--memory`), or make it smaller",
        shown(file),
        one_line(at)
    )]
    Memory {
        /// The file, or the name of the scene.
        file: PathBuf,
        /// What does not fit: `image 3 "wood", 8192×8192`.
        at: String,
        /// How much it needs, and how much there is.
        budget: OverBudget,
    },
    /// No built-in scene has this name.
    #[error("{:?} is neither a file nor a built-in scene (built in: {})", one_line(name), known.join(", "))]
    UnknownScene {
        /// The name asked for.
        name: String,
        /// The names there are.
        known: &'static [&'static str],
    },
    /// The scene has no material variant of this name.
    #[error("{}: it has no material variant {:?} (its variants: {})", shown(file), one_line(name), names(known))]
    UnknownVariant {
        /// The file, or the name of the scene.
        file: PathBuf,
        /// The name asked for.
        name: String,
        /// The names there are.
        known: Vec<String>,
    },
    /// A scene of panes has too many, or no number of them.
    #[error("panes:{}: a whole number from 0 to {most} is needed", one_line(count))]
    PaneCount {
        /// The word after the colon.
        count: String,
        /// The most that the scene takes.
        most: u32,
    },
    /// The built-in scene of lamps has no such number of them.
    #[error("lamps:{}: a whole number from 0 to {most} is needed", one_line(count))]
    LampCount {
        /// What was written for the number.
        count: String,
        /// The most.
        most: u32,
    },
    /// The scene has no camera of this name.
    #[error("the scene has no camera named {:?} (its cameras: {}; or use orbit)", one_line(name), names(known))]
    UnknownCamera {
        /// The name asked for.
        name: String,
        /// The names there are.
        known: Vec<String>,
    },
    /// A camera written as text does not parse or cannot look anywhere.
    #[error("camera {:?}: {reason} (write NAME, orbit, or EX,EY,EZ:TX,TY,TZ:FOVY)", one_line(text))]
    Camera {
        /// The text that should describe a camera.
        text: String,
        /// What is wrong with it.
        reason: CameraTextError,
    },
    /// A parameter of a generated scene, sky or table is outside its range.
    #[error("{parameter} is {value}, outside {range}")]
    Parameter {
        /// Name of the parameter.
        parameter: &'static str,
        /// Its value.
        value: f64,
        /// What it may be, with the unit.
        range: &'static str,
    },
    /// The progress callback asked to stop.
    #[error("{}: interrupted while {stage}", shown(file))]
    Interrupted {
        /// The file being loaded.
        file: PathBuf,
        /// The stage that was interrupted.
        stage: Stage,
    },
}

impl std::fmt::Debug for SceneError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

impl SceneError {
    /// A rule of a format that `file` breaks at a place in it.
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

/// `text` on one line: control characters become spaces, and a text of more than 240 characters is
/// cut, since a file may hold names of any length.
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
