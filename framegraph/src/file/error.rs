//! Errors of files, with position, names and a hint.

use super::syntax::listed;
use super::value::ValueReason;
use crate::compile::CompileReason;
use crate::error::DeclareReason;
use crate::error_list::Errors;
use crate::error_macros::{error_enum, impl_error, show};
use crate::suggest::nearest;
use std::fmt;

/// One error of a file. Displays as one line: `path:line:column: reason; hint`.
#[derive(Clone, PartialEq, Eq)]
pub struct FileError {
    /// Path of the file, as given by the caller.
    pub path: String,
    /// Line, starting at 1.
    pub line: usize,
    /// Column in characters, starting at 1.
    pub column: usize,
    /// The pass concerned, as named in the file or the graph.
    pub pass: Option<String>,
    /// The resource concerned, as named in the file or the graph.
    pub resource: Option<String>,
    /// The error.
    pub reason: Box<FileReason>,
}

error_enum! {
    /// Reason why a file is invalid. `what` is the expected kind of item: pass, resource, feature, plugin or slot.
    FileReason {
        /// The text is not valid RON, or has an unsupported form.
        Syntax { message: String, hint: String } => (message.clone(), hint.clone());
        Version { found: u32, known: u32 } "the file has version {found}, this program reads version {known}",
            "write `version: {known}` once the file follows docs/reference/graph-format.md";
        Unknown {
            what: &'static str,
            name: String,
            /// The most similar name.
            near: Option<String>,
            /// The first of the existing names.
            known: Vec<String>
        } "unknown {what} `{name}`", "{hint}",
            hint = match near {
                Some(near) => format!("did you mean `{near}`?"),
                None if known.is_empty() => "none exist here".into(),
                None => format!("use one of {}", listed(known, 8)),
            };
        Duplicate { what: &'static str, name: String } "more than one {what} is named `{name}`",
            "rename one of them, or give it an `id`";
        SwitchedOff { what: &'static str, name: String, /** Its condition. */ when: String }
            "{what} `{name}` is disabled, it requires `{when}`", "add the same `when` here";
        /// The value is out of range or conflicts with another one.
        Value(fault: ValueReason) => fault.words();
        /// `resource@pass`, but the pass does not write the resource.
        NotWrittenBy { pass: String, writers: Vec<String> } "pass `{pass}` does not write it", "{hint}",
            hint = match writers.as_slice() {
                [] => "no pass writes it".into(),
                writers => format!("it is written by {}", listed(writers, 8)),
            };
        TwoVersions { /** As the file names it. */ other: String } "the pass already refers to it as `{other}`",
            "a pass can use only one version of a resource; copy the other one first";
        /// Only the last version can be exported.
        NotLast { writer: String } "this is not the last version: pass `{writer}` writes it later",
            "export it by its plain name, or copy it first";
        /// A required slot is not bound.
        Unbound { plugin: String, slot: String } "slot `{slot}` of plugin `{plugin}` is not bound",
            "add `\"{slot}\": \"name\"` to its slots";
        /// Error reported by a plugin about its parameters or inputs.
        Plugin { plugin: String, message: String, hint: String } "plugin `{plugin}`: {message}", "{hint}";
        /// A declaration is invalid.
        Declare(reason: DeclareReason) => reason.words();
        /// The graph does not compile.
        Compile(reason: CompileReason)
            => match reason {
                CompileReason::Declare(error) => error.reason.words(),
                reason => reason.words(),
            };
    }
}

impl FileReason {
    /// Returns the reason for an unknown name, with a suggestion from `names`.
    pub(super) fn unknown<'n>(what: &'static str, name: &str, names: impl Iterator<Item = &'n str> + Clone) -> Self {
        let near = nearest(name, names.clone()).map(str::to_owned);
        Self::Unknown { what, name: name.into(), near, known: names.take(9).map(str::to_owned).collect() }
    }
}

impl From<ValueReason> for FileReason {
    fn from(fault: ValueReason) -> Self {
        Self::Value(fault)
    }
}

impl From<DeclareReason> for FileReason {
    fn from(reason: DeclareReason) -> Self {
        Self::Declare(reason)
    }
}

impl FileError {
    /// Adds the pass concerned.
    pub(super) fn of_pass(self, pass: &str) -> Self {
        Self { pass: Some(pass.into()), ..self }
    }

    /// Adds the resource concerned.
    pub(super) fn of_resource(self, resource: &str) -> Self {
        Self { resource: Some(resource.into()), ..self }
    }
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { path, line, column, pass, resource, reason } = self;
        let whom = (pass.as_deref(), resource.as_deref());
        show(f, &format!("{path}:{line}:{column}: "), whom, reason.words(), None)
    }
}

impl_error!(FileError);

/// The errors of a file, in the order of the file: the first hundred, and the number of further errors.
pub type FileErrors = Errors<FileError>;

impl FileErrors {
    /// Sorts the errors by position.
    pub(super) fn sorted(mut self) -> Self {
        self.listed.sort_by(|a, b| (&a.path, a.line, a.column).cmp(&(&b.path, b.line, b.column)));
        self
    }
}
