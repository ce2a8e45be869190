//! Conversion of decoder errors to environment loading errors.

use std::path::Path;

use crate::codec::CodecError;
use crate::error::{SceneError, Unsupported};

/// Converts a decoder error to a loading error.
pub(super) fn refused(path: &Path, error: CodecError) -> SceneError {
    let file = path.to_path_buf();
    match error {
        CodecError::Unknown => SceneError::Unsupported { file, feature: Unsupported::Environment { kind: None } },
        CodecError::Kind(kind) => {
            SceneError::Unsupported { file, feature: Unsupported::Environment { kind: Some(kind) } }
        }
        error => SceneError::Picture { file, at: "environment".into(), error },
    }
}
