//! A fault that the resolver finds in one file.

use crate::ShaderError;

/// What is wrong with a file, and in which line.
pub(super) struct Fault {
    /// Line, from one.
    pub line: usize,
    /// One line without file and line.
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

    /// The same as a fault of `file`.
    pub fn at(self, file: &str) -> ShaderError {
        ShaderError::Source { file: file.to_owned(), line: self.line, message: self.message }
    }
}
