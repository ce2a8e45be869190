//! What can be wrong with a declaration, said with the names involved, the place and what to do about it.

use std::fmt;
use std::panic::Location;

/// A call that declares something was refused; nothing of it stays in the graph.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeclareError {
    /// What was wrong.
    pub reason: DeclareReason,
    /// The pass that was being declared; empty for a call on the graph itself.
    pub pass: String,
    /// The resource concerned; empty when there is none.
    pub resource: String,
    /// Where the call was made.
    pub location: &'static Location<'static>,
}

/// Why a declaration was refused.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum DeclareReason {
    /// The handle names an older version: the named pass has written a newer one.
    Stale {
        /// Who wrote the newest version.
        writer: String,
    },
    /// The handle is of another graph, or of this one before its last reset.
    Foreign,
    /// The range lies outside of the texture.
    OutOfRange {
        /// What was asked and what there is.
        detail: String,
    },
    /// The pass already touches the same part in a way that excludes this.
    Conflict {
        /// The earlier access.
        earlier: &'static str,
        /// The refused access.
        later: &'static str,
    },
    /// The format cannot be used that way.
    Format {
        /// The format.
        format: crate::Format,
        /// The access.
        access: &'static str,
    },
    /// An attachment must be one level of one range of layers.
    NotOneLevel {
        /// The access.
        access: &'static str,
    },
    /// A second depth attachment.
    SecondDepth,
    /// A color slot is taken.
    SlotTaken {
        /// The slot.
        slot: u8,
    },
    /// More color attachments than any device has.
    TooManyColors,
    /// A resolve target without a multisampled color attachment in that pass.
    NothingToResolve,
    /// The pass is of a kind that cannot make this access.
    WrongPassKind {
        /// The kind that was asked for.
        kind: &'static str,
        /// The access.
        access: &'static str,
    },
    /// The pass copies, and also does what copy passes cannot.
    MixedKinds {
        /// The earlier access.
        earlier: &'static str,
        /// The resource of the earlier access.
        of: String,
        /// The refused access.
        later: &'static str,
    },
    /// The resource has a shape that nothing can have.
    Shape {
        /// What is wrong with it.
        detail: String,
    },
    /// The pass's own reason.
    Custom {
        /// What is wrong.
        message: String,
        /// What to do.
        hint: String,
    },
}

impl DeclareReason {
    /// What is wrong, without names.
    pub fn sentence(&self) -> String {
        match self {
            Self::Stale { writer } => {
                format!("the handle is stale: pass `{writer}` has written a newer version")
            }
            Self::Foreign => "the handle is of another graph, or from before this graph was reset".into(),
            Self::OutOfRange { detail } | Self::Shape { detail } => detail.clone(),
            Self::Conflict { earlier, later } => {
                format!("`{later}` touches a part that the same pass already uses as `{earlier}`")
            }
            Self::Format { format, access } => {
                format!("format {format:?} cannot be used as `{access}`")
            }
            Self::NotOneLevel { access } => format!("`{access}` must name one mip level"),
            Self::SecondDepth => "a pass has one depth attachment".into(),
            Self::SlotTaken { slot } => format!("color slot {slot} is taken"),
            Self::TooManyColors => "a pass has at most 8 color attachments".into(),
            Self::NothingToResolve => "the pass has no multisampled color attachment of that handle".into(),
            Self::WrongPassKind { kind, access } => format!("a {kind} pass cannot use `{access}`"),
            Self::MixedKinds { earlier, of, later } => {
                format!("`{later}` cannot be in one pass with `{earlier}` of `{of}`")
            }
            Self::Custom { message, .. } => message.clone(),
        }
    }

    /// What to do about it.
    pub fn hint(&self) -> String {
        match self {
            Self::Stale { writer } => {
                format!("use the handle that `{writer}` returned, or declare this pass before it")
            }
            Self::Foreign => "declare the resource in this graph, and anew after each reset".into(),
            Self::OutOfRange { .. } => "ask for levels and layers that the descriptor has".into(),
            Self::Conflict { .. } => "split the pass in two, or use different mip levels or layers".into(),
            Self::Format { .. } => "choose a format with that capability".into(),
            Self::NotOneLevel { .. } => "name the level: `texture.mip(n)`".into(),
            Self::SecondDepth => "split the pass in two".into(),
            Self::SlotTaken { .. } => "let `color` choose the slot, or name a free one".into(),
            Self::TooManyColors => "split the pass, or pack outputs into fewer attachments".into(),
            Self::NothingToResolve => {
                "declare the multisampled color attachment first and pass the handle it returned".into()
            }
            Self::WrongPassKind { .. } => "leave the kind to the accesses, or split the pass".into(),
            Self::MixedKinds { .. } => "put the copies into a pass of their own".into(),
            Self::Shape { .. } => "give the resource at least one texel, layer and sample, or one byte".into(),
            Self::Custom { hint, .. } => hint.clone(),
        }
    }
}

impl fmt::Display for DeclareError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { reason, pass, resource, location } = self;
        if !pass.is_empty() {
            write!(f, "pass `{pass}`: ")?;
        }
        if !resource.is_empty() {
            write!(f, "resource `{resource}`: ")?;
        }
        write!(f, "{} (at {}:{}); {}", reason.sentence(), location.file(), location.line(), reason.hint())
    }
}

impl std::error::Error for DeclareError {}
