//! What can be wrong with a file, said with the place, the names and what to do about it.

use super::suggest::nearest;
use super::syntax::listed;
use super::value::ValueFault;
use crate::capped::{self, Capped};
use crate::compile::CompileReason;
use crate::error::{DeclareReason, about};
use crate::plain::line;
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
    Value(ValueFault),
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
    /// A name that none of `names` is.
    pub(super) fn unknown<'n>(what: &'static str, name: &str, names: impl Iterator<Item = &'n str> + Clone) -> Self {
        Self::Unknown {
            what,
            name: name.into(),
            near: nearest(name, names.clone()).map(str::to_owned),
            known: names.take(9).map(str::to_owned).collect(),
        }
    }

    /// What is wrong, without place and names; and what to do about it.
    fn words(&self) -> (String, String) {
        let names = |names: &[String]| listed(names.iter().map(String::as_str), 8);
        match self {
            Self::Syntax { message, hint } => (message.clone(), hint.clone()),
            Self::Version { found, known } => (
                format!("the file is of version {found}, this program reads version {known}"),
                format!("write `version: {known}` once the file follows docs/graph-format.md"),
            ),
            Self::Unknown { what, name, near, known } => {
                let hint = match near {
                    Some(near) => format!("did you mean `{near}`?"),
                    None if known.is_empty() => "there are none here".into(),
                    None => format!("there are {}", names(known)),
                };
                (format!("there is no {what} `{name}`"), hint)
            }
            Self::Duplicate { what, name } => {
                (format!("more than one {what} is called `{name}`"), "rename one, or give it an `id` of its own".into())
            }
            Self::SwitchedOff { what, name, when } => (
                format!("{what} `{name}` is switched off here, it exists when `{when}`"),
                "put the same `when` here".into(),
            ),
            Self::Value(fault) => fault.words(),
            Self::NotWrittenBy { pass, writers } => {
                let hint = match writers.as_slice() {
                    [] => "no pass writes it".into(),
                    writers => format!("it is written by {}", names(writers)),
                };
                (format!("pass `{pass}` does not write it"), hint)
            }
            Self::TwoVersions { other } => (
                format!("the pass already names it as `{other}`"),
                "a pass sees one version of a resource; copy the other one aside".into(),
            ),
            Self::NotLast { writer } => (
                format!("this is not its last version, pass `{writer}` writes it later"),
                "export it by its plain name, or copy it aside".into(),
            ),
            Self::Unbound { plugin, slot } => (
                format!("slot `{slot}` of plugin `{plugin}` is not bound"),
                format!("add `\"{slot}\": \"name\"` to its slots"),
            ),
            Self::Plugin { plugin, message, hint } => (format!("plugin `{plugin}`: {message}"), hint.clone()),
            Self::Declare(reason) => (reason.sentence(), reason.hint()),
            Self::Compile(CompileReason::Declare(error)) => (error.reason.sentence(), error.reason.hint()),
            Self::Compile(reason) => (reason.sentence(), reason.hint().into()),
        }
    }

    /// What is wrong, without place and names.
    pub fn sentence(&self) -> String {
        self.words().0
    }

    /// What to do about it.
    pub fn hint(&self) -> String {
        self.words().1
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
        let Self { path, line: at, column, pass, resource, reason } = self;
        let mut text = format!("{path}:{at}:{column}: ");
        text += &about(pass.as_deref(), resource.as_deref());
        let (sentence, hint) = reason.words();
        text += &sentence;
        if !hint.is_empty() {
            text += &format!("; {hint}");
        }
        f.write_str(&line(&text))
    }
}

impl fmt::Debug for FileError {
    /// The sentence, since that is what an `unwrap` shows.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for FileError {}

/// The errors of a file, in the order in which they stand in it: a hundred, and how many more there are. Displayed as one
/// line each.
#[derive(Clone, Default, PartialEq, Eq)]
pub struct FileErrors {
    /// A hundred at most.
    pub listed: Vec<FileError>,
    /// How many there are beside these.
    pub more: usize,
}

impl fmt::Debug for FileErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl fmt::Display for FileErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&capped::lines(&self.listed, self.more))
    }
}

impl std::error::Error for FileErrors {}

impl From<FileError> for FileErrors {
    fn from(error: FileError) -> Self {
        Self { listed: vec![error], more: 0 }
    }
}

impl From<Capped<FileError>> for FileErrors {
    fn from(Capped { mut listed, more }: Capped<FileError>) -> Self {
        listed.sort_by(|a, b| (&a.path, a.line, a.column).cmp(&(&b.path, b.line, b.column)));
        Self { listed, more }
    }
}
