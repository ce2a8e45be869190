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
    /// A custom shader's file name is not a valid module name, or is taken.
    #[error("shader file `{file}`: {reason}; use a name of letters, digits and `_`")]
    FileName {
        /// The name as given.
        file: String,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// The source does not parse, does not link or does not validate.
    #[error("{file}:{line}: {message}")]
    Source {
        /// File, relative to `wgsl/` for embedded ones.
        file: String,
        /// Line, from one. Validation errors name the statement or the declaration.
        line: usize,
        /// What is wrong, from the front end or the validator.
        message: String,
    },
    /// An import names a module or an item that does not exist; the front end gives no line.
    #[error("{file}: {message}; modules are `package::lib::NAME`, `package::interface::NAME`")]
    Import {
        /// The file whose resolution failed.
        file: String,
        /// What is missing.
        message: String,
    },
}
