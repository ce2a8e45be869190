//! Errors of decoders as those of loading an environment.

use std::path::Path;

use crate::codec::CodecError;
use crate::error::{SceneError, Unsupported};

/// An error of a decoder as one of loading.
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
