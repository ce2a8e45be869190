//! Errors of shader resolution.

/// Error from resolving a shader. Every variant names the author's file, not the text that the resolver generates.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ShaderError {
    /// Feature that no file of the shader can test.
    #[error("{file}: `{name}` is not a known feature; list it in `Module::features`, or correct its name")]
    UnknownFeature {
        /// Name of the feature.
        name: &'static str,
        /// File of the shader.
        file: String,
    },
    /// Effects were given for a shader that does not end with the socket for effects.
    #[error("{file}: the shader takes no effects; it would have to call `package::interface::epilogue::epilogue`")]
    NoEpilogue {
        /// File of the shader.
        file: String,
    },
    /// File name that is invalid or already in use.
    #[error("shader file `{file}`: {reason}")]
    FileName {
        /// File name as given.
        file: String,
        /// Reason for the rejection.
        reason: &'static str,
    },
    /// The source does not parse, imports a missing item, or fails validation.
    #[error("{file}:{line}: {message}")]
    Source {
        /// Path of the file, relative to `wgsl/` for embedded files.
        file: String,
        /// Line number, starting at 1.
        line: usize,
        /// Message from the resolver or naga.
        message: String,
    },
}

impl std::fmt::Debug for ShaderError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
