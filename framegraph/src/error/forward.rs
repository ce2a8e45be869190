//! What can be wrong with forwarding a texture.

use crate::access::AccessKind;
use crate::format::Format;

/// Why a texture cannot be forwarded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForwardFault {
    /// It is imported, a history, exported, or the target itself.
    NotTransient,
    /// No pass wrote it.
    Unwritten,
    /// Its levels and layers do not fit the part that it is forwarded to.
    Parts,
    /// The target was declared, or written, after the first pass that touched the texture.
    TargetLater,
    /// Passes touched the target while others touched the texture.
    Touched,
    /// The target's format cannot be used as the texture was.
    Format {
        /// The target's format.
        format: Format,
        /// How a pass uses the texture.
        access: AccessKind,
    },
}

impl ForwardFault {
    pub(super) fn words(self) -> (String, &'static str) {
        match self {
            Self::NotTransient => (
                "only a transient texture that is not exported can be forwarded, to another one".into(),
                "let the passes write the target itself, or copy",
            ),
            Self::Unwritten => ("no pass wrote what is forwarded".into(), "forward it behind the pass that writes it"),
            Self::Parts => (
                "a texture of one level and layer can be forwarded to one level of one layer, any other to a whole texture \
                 of as many"
                    .into(),
                "name the part: `target.mip(0).layer(0)`",
            ),
            Self::TargetLater => (
                "the target was declared or written after the first pass that touches what is forwarded".into(),
                "declare the target before that pass",
            ),
            Self::Touched => (
                "passes touched the target while others touched what is forwarded".into(),
                "let them use the target before or behind all of these, or copy",
            ),
            Self::Format { format, access } => (
                format!("a pass uses what is forwarded as `{}`, which {format:?} of the target does not allow", access.word()),
                "give the target a format that allows it",
            ),
        }
    }
}
