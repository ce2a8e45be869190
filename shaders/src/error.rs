//! What can be wrong with a shader.

/// Why a shader could not be resolved. Every variant names the file as the author knows it,
/// not the text that the resolver made of it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ShaderError {
    /// No pass of that name is embedded.
    #[error("no shader is named `{name}`; known are {known}")]
    UnknownShader {
        /// The name asked for.
        name: String,
        /// The embedded ones, joined by commas.
        known: String,
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
