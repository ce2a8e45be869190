//! What can be wrong with a shader.

/// Why a shader could not be resolved. Every variant names the file as the author knows it,
/// not the text that the resolver made of it.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ShaderError {
    /// A feature that no file of the shader can test.
    #[error("{file}: `{name}` is not a known feature; list it in `Module::features`, or correct its name")]
    UnknownFeature {
        /// Its name.
        name: &'static str,
        /// The shader.
        file: String,
    },
    /// Effects for a shader that has no place for them.
    #[error("{file}: the shader takes no effects; it would have to call `package::interface::epilogue::epilogue`")]
    NoEpilogue {
        /// The shader.
        file: String,
    },
    /// A file name that cannot be used, or is taken.
    #[error("shader file `{file}`: {reason}")]
    FileName {
        /// The name as given.
        file: String,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// The source does not parse, imports what does not exist, or does not validate.
    #[error("{file}:{line}: {message}")]
    Source {
        /// File, relative to `wgsl/` for embedded ones.
        file: String,
        /// Line, from one.
        line: usize,
        /// What is wrong, from the resolver or naga.
        message: String,
    },
}

impl std::fmt::Debug for ShaderError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
