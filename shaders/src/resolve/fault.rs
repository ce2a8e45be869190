//! Error that the resolver finds in one file.

use crate::ShaderError;

/// Error in a file, with its line.
pub(super) struct Fault {
    /// Line number, starting at 1.
    pub line: usize,
    /// One-line message without file and line.
    pub message: String,
}

impl std::fmt::Debug for Fault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.line, self.message)
    }
}

impl Fault {
    pub fn new(line: usize, message: impl Into<String>) -> Self {
        Self { line, message: message.into() }
    }

    /// Converts the fault into an error of `file`.
    pub fn at(self, file: &str) -> ShaderError {
        ShaderError::Source { file: file.to_owned(), line: self.line, message: self.message }
    }
}
