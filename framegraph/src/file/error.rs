//! What can be wrong with a file, said with the place, the names and what to do about it.

use super::syntax::{listed, one_line};
use crate::compile::CompileReason;
use crate::error::DeclareReason;
use std::fmt;

/// One error of a file. Displayed as one line: `path:line:column: reason; hint`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileError {
    /// The file, as the caller named it.
    pub path: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The pass concerned; empty when there is none.
    pub pass: String,
    /// The resource concerned; empty when there is none.
    pub resource: String,
    /// What is wrong.
    pub reason: Box<FileReason>,
}

/// Why a file was refused.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FileReason {
    /// The text is no RON, or not of this form.
    Syntax {
        /// What RON says.
        message: String,
        /// What to do.
        hint: String,
    },
    /// A version of the format that this program does not read.
    Version {
        /// What the file says.
        found: u32,
        /// What is read.
        known: u32,
    },
    /// A name that nothing has.
    Unknown {
        /// What kind of thing was meant: pass, resource, feature, plugin, slot.
        what: &'static str,
        /// The name.
        name: String,
        /// The name that was probably meant.
        near: Option<String>,
        /// The first of the names that exist.
        known: Vec<String>,
    },
    /// A name that two things have.
    Duplicate {
        /// What kind of thing.
        what: &'static str,
        /// The name.
        name: String,
    },
    /// A name that exists, but not with these features.
    SwitchedOff {
        /// Pass or resource.
        what: &'static str,
        /// The name.
        name: String,
        /// Its condition.
        when: String,
    },
    /// A value outside of its range, or that does not go together with another.
    Value {
        /// What is wrong with it.
        detail: String,
        /// What to do.
        hint: String,
    },
    /// `resource@pass` of a pass that does not write the resource.
    NotWrittenBy {
        /// The pass.
        pass: String,
        /// The passes that write it.
        writers: Vec<String>,
    },
    /// One pass names two versions of one resource.
    TwoVersions {
        /// The other one, as the file names it.
        other: String,
    },
    /// An export of a version that is not the last.
    NotLast {
        /// Who writes the next one.
        writer: String,
    },
    /// A slot that a plugin cannot do without, and that is not bound.
    Unbound {
        /// The kind of the plugin.
        plugin: String,
        /// The slot.
        slot: String,
    },
    /// What a plugin says of its own parameters or inputs.
    Plugin {
        /// The kind of the plugin.
        plugin: String,
        /// What is wrong.
        message: String,
        /// What to do.
        hint: String,
    },
    /// The declaration was refused.
    Declare(DeclareReason),
    /// The graph does not compile.
    Compile(CompileReason),
}

impl FileReason {
    /// What is wrong, without place and names.
    pub fn sentence(&self) -> String {
        match self {
            Self::Syntax { message, .. } => message.clone(),
            Self::Version { found, known } => {
                format!("the file is of version {found}, this program reads version {known}")
            }
            Self::Unknown { what, name, .. } => format!("there is no {what} `{name}`"),
            Self::Duplicate { what, name } => format!("more than one {what} is called `{name}`"),
            Self::SwitchedOff { what, name, when } => {
                format!("{what} `{name}` is switched off here, it exists when `{when}`")
            }
            Self::Value { detail, .. } => detail.clone(),
            Self::NotWrittenBy { pass, .. } => format!("pass `{pass}` does not write it"),
            Self::TwoVersions { other } => format!("the pass already names it as `{other}`"),
            Self::NotLast { writer } => {
                format!("this is not its last version, pass `{writer}` writes it later")
            }
            Self::Unbound { plugin, slot } => {
                format!("slot `{slot}` of plugin `{plugin}` is not bound")
            }
            Self::Plugin { plugin, message, .. } => format!("plugin `{plugin}`: {message}"),
            Self::Declare(reason) => reason.sentence(),
            Self::Compile(CompileReason::Declare(error)) => error.reason.sentence(),
            Self::Compile(reason) => reason.sentence(),
        }
    }

    /// What to do about it.
    pub fn hint(&self) -> String {
        let names = |names: &[String]| listed(names.iter().map(String::as_str), 8);
        match self {
            Self::Syntax { hint, .. } | Self::Value { hint, .. } | Self::Plugin { hint, .. } => hint.clone(),
            Self::Version { known, .. } => {
                format!("write `version: {known}` once the file follows docs/graph-format.md")
            }
            Self::Unknown { near: Some(near), .. } => format!("did you mean `{near}`?"),
            Self::Unknown { known, .. } if known.is_empty() => "there are none here".into(),
            Self::Unknown { known, .. } => format!("there are {}", names(known)),
            Self::Duplicate { .. } => "rename one, or give it an `id` of its own".into(),
            Self::SwitchedOff { .. } => "put the same `when` here".into(),
            Self::NotWrittenBy { writers, .. } if writers.is_empty() => "no pass writes it".into(),
            Self::NotWrittenBy { writers, .. } => format!("it is written by {}", names(writers)),
            Self::TwoVersions { .. } => "a pass sees one version of a resource; copy the other one aside".into(),
            Self::NotLast { .. } => "export it by its plain name, or copy it aside".into(),
            Self::Unbound { slot, .. } => format!("add `\"{slot}\": \"name\"` to its slots"),
            Self::Declare(reason) => reason.hint(),
            Self::Compile(CompileReason::Declare(error)) => error.reason.hint(),
            Self::Compile(reason) => reason.hint().into(),
        }
    }
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { path, line, column, pass, resource, reason } = self;
        let mut text = format!("{path}:{line}:{column}: ");
        if !pass.is_empty() {
            text += &format!("pass `{pass}`: ");
        }
        if !resource.is_empty() {
            text += &format!("resource `{resource}`: ");
        }
        text += &reason.sentence();
        let hint = reason.hint();
        if !hint.is_empty() {
            text += "; ";
            text += &hint;
        }
        f.write_str(&one_line(&text))
    }
}

impl std::error::Error for FileError {}

/// All errors of a file, in the order in which they stand in it. Displayed as one line each.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FileErrors(pub Vec<FileError>);

impl fmt::Display for FileErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, error) in self.0.iter().enumerate() {
            if i > 0 {
                f.write_str("\n")?;
            }
            write!(f, "{error}")?;
        }
        Ok(())
    }
}

impl std::error::Error for FileErrors {}

impl From<FileError> for FileErrors {
    fn from(error: FileError) -> Self {
        Self(vec![error])
    }
}
