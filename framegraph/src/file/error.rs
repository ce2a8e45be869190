//! What can be wrong with a file, said with the place, the names and what to do about it.

use super::suggest::nearest;
use super::syntax::listed;
use super::value::ValueFault;
use crate::capped::Errors;
use crate::compile::CompileReason;
use crate::error::DeclareReason;
use crate::faults::{errors, faults, show};
use std::fmt;

/// One error of a file. Displayed as one line: `path:line:column: reason; hint`.
#[derive(Clone, PartialEq, Eq)]
pub struct FileError {
    /// The file, as the caller named it.
    pub path: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The pass concerned, as the file or the graph names it.
    pub pass: Option<String>,
    /// The resource concerned, as the file or the graph names it.
    pub resource: Option<String>,
    /// What is wrong.
    pub reason: Box<FileReason>,
}

faults! {
    /// Why a file was refused. `what` is the kind of thing that was meant: pass, resource, feature, plugin, slot.
    FileReason {
        /// The text is no RON, or not of this form.
        Syntax { message: String, hint: String } => (message.clone(), hint.clone());
        Version { found: u32, known: u32 } "the file is of version {found}, this program reads version {known}",
            "write `version: {known}` once the file follows docs/graph-format.md";
        Unknown {
            what: &'static str,
            name: String,
            /// The name that was probably meant.
            near: Option<String>,
            /// The first of the names that exist.
            known: Vec<String>
        } "there is no {what} `{name}`", "{hint}",
            hint = match near {
                Some(near) => format!("did you mean `{near}`?"),
                None if known.is_empty() => "there are none here".into(),
                None => format!("there are {}", listed(known, 8)),
            };
        Duplicate { what: &'static str, name: String } "more than one {what} is called `{name}`",
            "rename one, or give it an `id` of its own";
        SwitchedOff { what: &'static str, name: String, /** Its condition. */ when: String }
            "{what} `{name}` is switched off here, it exists when `{when}`", "put the same `when` here";
        /// A value outside of its range, or that does not go together with another.
        Value(fault: ValueFault) => fault.words();
        /// `resource@pass` of a pass that does not write the resource.
        NotWrittenBy { pass: String, writers: Vec<String> } "pass `{pass}` does not write it", "{hint}",
            hint = match writers.as_slice() {
                [] => "no pass writes it".into(),
                writers => format!("it is written by {}", listed(writers, 8)),
            };
        TwoVersions { /** As the file names it. */ other: String } "the pass already names it as `{other}`",
            "a pass sees one version of a resource; copy the other one aside";
        /// Only the last version can be exported.
        NotLast { writer: String } "this is not its last version, pass `{writer}` writes it later",
            "export it by its plain name, or copy it aside";
        /// The plugin cannot do without.
        Unbound { plugin: String, slot: String } "slot `{slot}` of plugin `{plugin}` is not bound",
            "add `\"{slot}\": \"name\"` to its slots";
        /// What a plugin says of its own parameters or inputs.
        Plugin { plugin: String, message: String, hint: String } "plugin `{plugin}`: {message}", "{hint}";
        /// The declaration was refused.
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
    /// A name that none of `names` is.
    pub(super) fn unknown<'n>(what: &'static str, name: &str, names: impl Iterator<Item = &'n str> + Clone) -> Self {
        let near = nearest(name, names.clone()).map(str::to_owned);
        Self::Unknown { what, name: name.into(), near, known: names.take(9).map(str::to_owned).collect() }
    }
}

impl From<ValueFault> for FileReason {
    fn from(fault: ValueFault) -> Self {
        Self::Value(fault)
    }
}

impl From<DeclareReason> for FileReason {
    fn from(reason: DeclareReason) -> Self {
        Self::Declare(reason)
    }
}

impl FileError {
    /// The error with the pass that it is about.
    pub(super) fn of_pass(self, pass: &str) -> Self {
        Self { pass: Some(pass.into()), ..self }
    }

    /// The error with the resource that it is about.
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

errors!(FileError);

/// The errors of a file, in the order in which they stand in it: a hundred, and how many more there are.
pub type FileErrors = Errors<FileError>;

impl FileErrors {
    /// The errors in the order in which they stand in the file.
    pub(super) fn sorted(mut self) -> Self {
        self.listed.sort_by(|a, b| (&a.path, a.line, a.column).cmp(&(&b.path, b.line, b.column)));
        self
    }
}
