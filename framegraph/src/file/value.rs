//! Values that stand in a file and cannot be: outside of their range, or not together with another.

use super::slot::Takes;

/// What is wrong with a value.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ValueFault {
    /// A word that cannot be the name of a feature.
    FeatureName(String),
    /// A condition that is not made of features.
    Condition(String),
    /// A frame of no texels.
    EmptyFrame,
    /// An alignment in bytes that no device has.
    Alignment(u64),
    /// Most samples that no device has.
    MaxSamples(u8),
    /// Most color attachments that no device has.
    MaxColors(u8),
    /// Most texels a side, or most layers, that no device has.
    MaxSide(u32),
    /// A previous image of a history that is listed below.
    PreviousAbove,
    /// A previous image of what is no history.
    NotAHistory {
        /// The name of the resource.
        id: String,
    },
    /// More levels, layers and planes than all textures may have together.
    Subresources {
        /// The most there may be.
        max: u64,
    },
    /// A history of no earlier frame.
    EmptyHistory,
    /// A name that a plugin makes is used before that plugin ran.
    MadeLater,
    /// The contents on entry of what a plugin makes.
    MadeEmpty,
    /// What is forwarded, or its target, is no texture.
    ForwardsTextures,
    /// A path to a file that does not lie beside or below the one that names it.
    Path(String),
    /// A file that cannot be read: what the system says.
    Unreadable(String),
    /// A level or layer that is no number, or too large.
    Level(String),
    /// A parameter of a template that a use does not give.
    Parameter(String),
    /// A template that uses a template.
    TemplateInTemplate,
    /// More entries than loops and templates may make.
    Entries {
        /// The most there may be.
        max: u64,
    },
    /// A slot of a plugin is bound to a resource of another type.
    SlotType {
        /// The slot.
        slot: String,
        /// What it takes.
        takes: Takes,
    },
    /// The image that an earlier frame left is written.
    WritesEarlierFrame,
    /// The image that an earlier frame left is exported.
    ExportsEarlierFrame,
    /// An id that references cannot spell.
    Id(String),
    /// A history of a buffer.
    BufferHistory,
    /// Levels, layers, aspects or views of a buffer.
    BufferRange,
    /// Bytes of a texture.
    TextureBytes,
    /// `"all"` where a number is needed.
    All {
        /// What is counted.
        what: &'static str,
    },
    /// A choice by features of which no condition holds.
    NoChoice {
        /// What is counted.
        what: &'static str,
    },
    /// A number out of its range, which starts at 1.
    Count {
        /// What is counted.
        what: &'static str,
        /// The number.
        value: u64,
        /// The largest number.
        max: u64,
        /// Whether `"all"` would do.
        all: bool,
    },
    /// A zero in a size; the words say where.
    Zero(&'static str),
}

impl ValueFault {
    /// What is wrong, and what to do about it.
    pub(super) fn words(&self) -> (String, String) {
        let earlier = |what: &str| format!("an earlier frame's image cannot be {what}");
        let (detail, hint): (String, &str) = match self {
            Self::FeatureName(name) => (
                format!("`{name}` cannot be the name of a feature"),
                "use letters, digits, `_`, `-` and `.`, and another word than `else`",
            ),
            Self::Condition(text) => (
                format!("`{text}` is no condition"),
                "write features joined by `&&` and `||`, with `!` in front of those that must be off",
            ),
            Self::EmptyFrame => ("a frame of 0 texels".into(), "write width and height, `frame: (1920, 1080)`"),
            Self::Alignment(bytes) => (format!("an alignment of {bytes} bytes"), "write a power of two from 1 to 2^32"),
            Self::MaxSamples(samples) => (format!("{samples} samples at most"), "write 1, 2, 4, 8 or 16"),
            Self::MaxColors(colors) => (format!("{colors} color attachments at most"), "write a number from 1 to 8"),
            Self::MaxSide(side) => (format!("{side} texels or layers at most"), "write a number from 1 to 2^20"),
            Self::PreviousAbove => ("the history stands further down".into(), "list it before its previous images"),
            Self::NotAHistory { id } => (format!("`{id}` is no history"), "declare it with `kind: History(frames: 1)`"),
            Self::Subresources { max } => (
                format!("more than {max} levels, layers and planes together"),
                "give the textures fewer levels or layers",
            ),
            Self::EmptyHistory => ("a history of 0 frames".into(), "write 1 or more"),
            Self::MadeLater => {
                ("the plugin that makes it is listed later".into(), "list it first, or name the version: `name@plugin`")
            }
            Self::Path(path) => (
                format!("`{path}` leads out of the folder of this file"),
                "name a file in this folder or below, with `/` between the parts",
            ),
            Self::Unreadable(message) => {
                (format!("the file cannot be included: {message}"), "name a file that can be read")
            }
            Self::Level(text) => {
                (format!("`{text}` is no level or layer"), "write a number, in a loop one in braces: `\"{i-1}\"`")
            }
            Self::Parameter(name) => {
                let hint = format!("add `\"{name}\": \"…\"` to its `with`");
                return (format!("the template needs the parameter `{name}`"), hint);
            }
            Self::TemplateInTemplate => ("a template uses a template".into(), "write its entries out here"),
            Self::Entries { max } => (
                format!("loops, templates or includes make more than {max} entries"),
                "repeat less, or split the frame",
            ),
            Self::ForwardsTextures => {
                ("only a texture can be forwarded, once, to a texture".into(), "name textures that passes write")
            }
            Self::MadeEmpty => {
                ("the plugin that makes it writes it first: it holds nothing on entry".into(), "leave `@entry` out")
            }
            Self::SlotType { slot, takes } => {
                let wanted = match takes {
                    Takes::Texture => "a texture to read",
                    Takes::Buffer => "a buffer to read",
                    Takes::Target => "a texture to write",
                    Takes::TargetBuffer => "a buffer to write",
                };
                (format!("slot `{slot}` takes {wanted}"), "bind a resource of that type")
            }
            Self::WritesEarlierFrame => (earlier("written"), "write the history by its plain name"),
            Self::ExportsEarlierFrame => (earlier("exported"), "the history keeps it; export the history itself"),
            Self::Id(id) => {
                (format!("`{id}` cannot be named by passes"), "give it an `id` that is not empty and has no `@`")
            }
            Self::BufferHistory => ("a buffer cannot be a history".into(), "import two buffers and swap them"),
            Self::BufferRange => (
                "a buffer has no levels, layers, aspects or views".into(),
                "name `bytes: (offset, size)`, or all of it",
            ),
            Self::TextureBytes => {
                ("a texture is not accessed by bytes".into(), "name levels and layers in their place, or all of it")
            }
            Self::All { what } => (format!("{what} cannot be \"all\""), "write a number"),
            Self::NoChoice { what } => (format!("no choice of {what} applies"), "add `\"else\": 1` as the last one"),
            Self::Count { what, value, max, all } => {
                let or_all = if *all { ", or \"all\"" } else { "" };
                return (format!("{value} {what}"), format!("write a number from 1 to {max}{or_all}"));
            }
            Self::Zero(what) => ((*what).into(), "write 1 or more"),
        };
        (detail, hint.into())
    }
}
