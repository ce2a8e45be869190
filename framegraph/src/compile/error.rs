//! What can be wrong with a graph as a whole, said with the names involved, the place and what to do about it.

use crate::error::DeclareError;
use crate::format::Format;
use std::fmt;
use std::panic::Location;

/// One error of a graph.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CompileError {
    /// What is wrong.
    pub reason: CompileReason,
    /// The pass concerned; empty when there is none.
    pub pass: String,
    /// The resource concerned; empty when there is none.
    pub resource: String,
    /// Where the pass was declared.
    pub location: Option<&'static Location<'static>>,
}

/// Why a graph does not compile.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CompileReason {
    /// A call on the graph itself was refused.
    Declare(DeclareError),
    /// Contents are read, modified or exported that nobody wrote before.
    ReadUnwritten {
        /// How they are used.
        access: &'static str,
        /// A later pass that writes them, if there is one.
        later_writer: Option<String>,
    },
    /// Contents are written that nobody can ever read: the resource is imported to be discarded, and no pass reads it.
    WriteUnreadable {
        /// How they are written.
        access: &'static str,
    },
    /// Two passes write one version (only graphs from files can say so).
    TwoWriters {
        /// The other writer.
        other: String,
    },
    /// Passes wait for each other (only graphs from files can say so).
    Cycle {
        /// The passes of the cycle, in order.
        passes: Vec<String>,
    },
    /// Attachments of one pass differ in samples, or a resolve does not go from many to one.
    Samples {
        /// What was expected.
        expected: u8,
        /// What was found.
        found: u8,
    },
    /// Attachments of one pass differ in size or layers.
    Extent {
        /// Width, height and layers that were expected.
        expected: [u32; 3],
        /// Width, height and layers that were found.
        found: [u32; 3],
    },
    /// A clear value of another kind than the attachment, or a depth that no depth texture holds.
    ClearValue {
        /// The value, in words.
        value: String,
        /// The format of the attachment.
        format: Format,
    },
    /// A resolve between formats that do not agree.
    Format {
        /// What was expected.
        expected: String,
        /// What was found.
        found: Format,
    },
    /// A shape that no texture or buffer can have, or that the device cannot make.
    Shape {
        /// What is wrong with it.
        detail: String,
        /// What to do.
        hint: &'static str,
    },
    /// More color attachments, or bytes of them, than the device allows.
    Attachments {
        /// What is too much.
        detail: String,
    },
    /// A range that the texture does not have at this frame size.
    OutOfRange {
        /// What was asked and what there is.
        detail: String,
    },
    /// A depth attachment is read in memory by the pass that tests against it, which the device cannot do.
    SampledDepth {
        /// How it is read.
        access: &'static str,
    },
    /// More passes than the compiler can number.
    TooManyPasses,
}

impl CompileReason {
    /// What is wrong, without names.
    pub fn sentence(&self) -> String {
        match self {
            Self::Declare(error) => error.to_string(),
            Self::ReadUnwritten { access, later_writer: None } => {
                format!("used as `{access}`, but nobody writes it before")
            }
            Self::ReadUnwritten { access, later_writer: Some(pass) } => {
                format!("used as `{access}`, but `{pass}`, which writes it, is declared later")
            }
            Self::WriteUnreadable { access } => {
                format!(
                    "written as `{access}`, but nobody can read it: it is imported to be discarded, and no pass reads it"
                )
            }
            Self::TwoWriters { other } => format!("`{other}` writes the same version"),
            Self::Cycle { passes } => {
                format!("passes wait for each other: {}", passes.join(" -> "))
            }
            Self::Samples { expected, found } => {
                format!("{found} samples where {expected} are needed")
            }
            Self::Extent { expected: [w, h, l], found: [x, y, m] } => {
                format!("{x}x{y} with {m} layers, where the other attachments have {w}x{h} with {l}")
            }
            Self::Format { expected, found } => {
                format!("format {found:?} where {expected} is needed")
            }
            Self::ClearValue { value, format } => {
                format!("cleared to {value}, which {format:?} does not take")
            }
            Self::Shape { detail, .. } | Self::Attachments { detail } | Self::OutOfRange { detail } => detail.clone(),
            Self::SampledDepth { access } => {
                format!("used as `{access}` and as depth attachment at once, which the device cannot do")
            }
            Self::TooManyPasses => "the graph has more passes than can be numbered".into(),
        }
    }

    /// What to do about it; empty when the sentence says so already.
    pub fn hint(&self) -> &'static str {
        match self {
            Self::Declare(_) => "",
            Self::ReadUnwritten { later_writer: None, .. } => {
                "clear or overwrite it in an earlier pass, or import it with contents"
            }
            Self::ReadUnwritten { .. } => "declare the writer first",
            Self::WriteUnreadable { .. } => "import it with `Exit::Keep`, or remove the write",
            Self::TwoWriters { .. } => "let the second pass modify the version that the first one wrote",
            Self::Cycle { .. } => "break the cycle with a history resource or a second texture",
            Self::Samples { .. } => "give all attachments of a pass the same samples; resolve from many to one",
            Self::Extent { .. } => "give all attachments of a pass the same size and layers",
            Self::Format { .. } => "give the target of a resolve the format of its samples",
            Self::ClearValue { .. } => {
                "clear color attachments to a color, depth attachments to a depth from 0 to 1 and a stencil"
            }
            Self::Shape { hint, .. } => hint,
            Self::Attachments { .. } => "split the pass, or pack outputs into fewer or smaller attachments",
            Self::OutOfRange { .. } => "ask for levels and layers that there are",
            Self::SampledDepth { .. } => "copy it before, or read it in a pass of its own",
            Self::TooManyPasses => "split the graph",
        }
    }
}

impl fmt::Display for CompileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { reason, pass, resource, location } = self;
        if !pass.is_empty() {
            write!(f, "pass `{pass}`: ")?;
        }
        if !resource.is_empty() {
            write!(f, "resource `{resource}`: ")?;
        }
        f.write_str(&reason.sentence())?;
        if let Some(location) = location {
            write!(f, " (at {}:{})", location.file(), location.line())?;
        }
        match reason.hint() {
            "" => Ok(()),
            hint => write!(f, "; {hint}"),
        }
    }
}

/// All errors of a graph, in the order of the passes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CompileErrors(pub Vec<CompileError>);

impl fmt::Display for CompileErrors {
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

impl std::error::Error for CompileError {}
impl std::error::Error for CompileErrors {}
