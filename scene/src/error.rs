//! What can be wrong with a scene. Every message is one line: the file, where in it, and why.

use std::io;
use std::path::Path;

use super::progress::Stage;

/// Why a scene, an environment or a camera could not be had.
///
/// `Display` never contains a line break, whatever the file says: texts taken from files pass
/// through one function that sees to it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// A file cannot be opened or read.
    #[error("{file}: cannot be read: {source}")]
    Read {
        /// The file.
        file: String,
        /// What the system said.
        source: io::Error,
    },
    /// A file breaks its format's rules, or holds values that cannot be drawn.
    #[error("{file}: {at}: {reason}")]
    Malformed {
        /// The file.
        file: String,
        /// Where in the file: `accessor 3`, `mesh 0 primitive 1`.
        at: String,
        /// What is wrong there.
        reason: String,
    },
    /// A file is valid but asks for something this renderer does not do.
    #[error("{file}: {feature} is not supported{hint}")]
    Unsupported {
        /// The file.
        file: String,
        /// What it asks for.
        feature: String,
        /// What to do about it, beginning with `; `, or empty.
        hint: &'static str,
    },
    /// Something is larger than this renderer or the device accepts.
    #[error("{file}: {what} is {value}, over the limit of {limit}")]
    TooLarge {
        /// The file.
        file: String,
        /// What is too large, with its unit.
        what: String,
        /// How large it is.
        value: u64,
        /// How large it may be.
        limit: u64,
    },
    /// No built-in scene has this name.
    #[error("{name:?} is neither a file nor a built-in scene (built in: {known})")]
    UnknownScene {
        /// The name asked for.
        name: String,
        /// The names there are.
        known: String,
    },
    /// The scene has no camera of this name.
    #[error("the scene has no camera named {name:?} (its cameras: {known}; or use orbit)")]
    UnknownCamera {
        /// The name asked for.
        name: String,
        /// The names there are.
        known: String,
    },
    /// A camera written on the command line does not parse or cannot look anywhere.
    #[error("camera {text:?}: {reason} (write NAME, orbit, or EX,EY,EZ:TX,TY,TZ:FOVY)")]
    Camera {
        /// The text.
        text: String,
        /// What is wrong with it.
        reason: String,
    },
    /// A parameter of a generated scene or sky is outside its range.
    #[error("{parameter} is {value}, outside {range}")]
    Parameter {
        /// The parameter.
        parameter: &'static str,
        /// Its value.
        value: String,
        /// What it may be, with the unit.
        range: &'static str,
    },
    /// The progress callback asked to stop.
    #[error("{file}: interrupted while {stage}")]
    Interrupted {
        /// The file being loaded.
        file: String,
        /// What was going on.
        stage: Stage,
    },
}

impl SceneError {
    pub(crate) fn malformed(file: &Path, at: impl Into<String>, reason: impl Into<String>) -> Self {
        Self::Malformed {
            file: one_line(&file.display().to_string()),
            at: one_line(&at.into()),
            reason: one_line(&reason.into()),
        }
    }

    /// Something that is over a limit; `what` says what, with its unit.
    pub fn too_large(file: &Path, what: impl Into<String>, value: u64, limit: u64) -> Self {
        Self::TooLarge { file: one_line(&file.display().to_string()), what: one_line(&what.into()), value, limit }
    }

    pub(crate) fn unsupported(file: &Path, feature: impl Into<String>, hint: &'static str) -> Self {
        Self::Unsupported { file: one_line(&file.display().to_string()), feature: one_line(&feature.into()), hint }
    }
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
        let error = SceneError::malformed(Path::new("a\nb.gltf"), "node \"x\r\ny\"", "z".repeat(5000) + "\n");
        let text = error.to_string();
        assert!(!text.contains(['\n', '\r']), "{text}");
        assert!(text.starts_with("a b.gltf: node \"x  y\": zzz"));
        assert!(text.len() < 600);
    }
}
