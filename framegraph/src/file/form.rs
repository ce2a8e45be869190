//! The shape of a file, as serde reads it. Field by field the reference is `docs/graph-format.md`.

use super::entries::{Count, Entries};
use super::spot::Spot;
use crate::access::{ClearValue, Intent, Range};
use crate::format::{Aspect, Format};
use crate::graph::PassFlags;
use crate::resource::{Dimension, Entry, Exit, Extent};
use ron::value::RawValue;
use serde::Deserialize;

/// A graph.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "GraphFile")]
pub(super) struct GraphForm {
    #[expect(dead_code, reason = "checked before everything else is read")]
    pub(super) version: Spot<u32>,
    #[serde(default)]
    pub(super) name: String,
    #[serde(default)]
    pub(super) frame: Option<Spot<(u32, u32)>>,
    #[serde(default)]
    pub(super) features: Entries<bool>,
    #[serde(default)]
    pub(super) resources: Vec<ResourceForm>,
    #[serde(default)]
    pub(super) passes: Vec<PassForm>,
    #[serde(default)]
    pub(super) exports: Vec<ExportForm>,
    #[serde(default)]
    pub(super) expect: Option<Spot<Box<RawValue>>>,
}

/// The one field that is read whatever the version.
#[derive(Debug, Deserialize)]
#[serde(rename = "File")]
pub(super) struct VersionForm {
    pub(super) version: Spot<u32>,
}

#[derive(Debug, Deserialize)]
#[serde(rename = "Resource")]
pub(super) enum ResourceForm {
    Texture(TextureForm),
    Buffer(BufferForm),
    Previous(PreviousForm),
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Texture")]
pub(super) struct TextureForm {
    pub(super) name: Spot<String>,
    #[serde(default)]
    pub(super) id: Option<Spot<String>>,
    pub(super) format: Format,
    #[serde(default)]
    pub(super) size: Option<Spot<Size>>,
    #[serde(default)]
    pub(super) mips: Option<Spot<Count>>,
    #[serde(default)]
    pub(super) layers: Option<Spot<Count>>,
    #[serde(default)]
    pub(super) samples: Option<Spot<Count>>,
    #[serde(default)]
    pub(super) dimension: Dimension,
    #[serde(default)]
    pub(super) kind: Origin,
    #[serde(default)]
    pub(super) when: Option<Spot<String>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Buffer")]
pub(super) struct BufferForm {
    pub(super) name: Spot<String>,
    #[serde(default)]
    pub(super) id: Option<Spot<String>>,
    pub(super) bytes: Spot<Count>,
    #[serde(default)]
    pub(super) kind: Origin,
    #[serde(default)]
    pub(super) when: Option<Spot<String>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Previous")]
pub(super) struct PreviousForm {
    pub(super) of: Spot<String>,
    pub(super) age: u8,
    #[serde(default)]
    pub(super) when: Option<Spot<String>>,
}

/// Width and height.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename = "Size")]
pub(super) enum Size {
    #[default]
    Frame,
    Scale {
        num: u16,
        den: u16,
        #[serde(default = "one")]
        align: u16,
    },
    Texels(u32, u32),
}

const fn one() -> u16 {
    1
}

/// Where a resource comes from.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename = "Kind")]
pub(super) enum Origin {
    #[default]
    Transient,
    Import {
        entry: Entry,
        exit: Exit,
    },
    History {
        frames: u8,
    },
}

#[derive(Debug, Deserialize)]
#[serde(rename = "Pass")]
pub(super) enum PassForm {
    Raster(WorkForm),
    Compute(WorkForm),
    Copy(WorkForm),
    Plugin(PluginForm),
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Pass")]
pub(super) struct WorkForm {
    pub(super) name: Spot<String>,
    #[serde(default)]
    pub(super) id: Option<Spot<String>>,
    #[serde(default)]
    pub(super) when: Option<Spot<String>>,
    #[serde(default)]
    pub(super) after: Vec<Spot<String>>,
    #[serde(default)]
    pub(super) flags: Vec<Flag>,
    #[serde(default)]
    pub(super) accesses: Vec<AccessForm>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Plugin")]
pub(super) struct PluginForm {
    pub(super) kind: Spot<String>,
    pub(super) name: Spot<String>,
    #[serde(default)]
    pub(super) id: Option<Spot<String>>,
    #[serde(default)]
    pub(super) when: Option<Spot<String>>,
    #[serde(default)]
    pub(super) after: Vec<Spot<String>>,
    #[serde(default)]
    pub(super) slots: Entries<Spot<String>>,
    #[serde(default)]
    pub(super) params: Option<Spot<Box<RawValue>>>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename = "Flag")]
pub(super) enum Flag {
    SideEffect,
    Pointwise,
    Blends,
    NeverMerge,
    TakesEpilogue,
}

impl Flag {
    /// Every flag with what it stands for.
    pub(super) const ALL: [(Self, PassFlags); 5] = [
        (Self::SideEffect, PassFlags::SIDE_EFFECT),
        (Self::Pointwise, PassFlags::POINTWISE),
        (Self::Blends, PassFlags::BLENDS),
        (Self::NeverMerge, PassFlags::NEVER_MERGE),
        (Self::TakesEpilogue, PassFlags::TAKES_EPILOGUE),
    ];
}

/// One access, named like [`AccessKind`](crate::AccessKind).
#[derive(Debug, Deserialize)]
#[serde(rename = "Access")]
pub(super) enum AccessForm {
    Color(ColorForm),
    Depth(WriteForm),
    DepthReadOnly(ReadForm),
    Resolve(ResolveForm),
    SamePixel(ReadForm),
    Sampled(ReadForm),
    StorageRead(ReadForm),
    StorageWrite(WriteForm),
    Uniform(ReadForm),
    Vertex(ReadForm),
    Index(ReadForm),
    Indirect(ReadForm),
    CopySource(ReadForm),
    CopyTarget(WriteForm),
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Read")]
pub(super) struct ReadForm {
    pub(super) of: Spot<String>,
    #[serde(default)]
    pub(super) mip: Option<u8>,
    #[serde(default)]
    pub(super) mips: Option<u8>,
    #[serde(default)]
    pub(super) layer: Option<u16>,
    #[serde(default)]
    pub(super) layers: Option<u16>,
    #[serde(default)]
    pub(super) aspect: Option<Aspect>,
    #[serde(default)]
    pub(super) when: Option<Spot<String>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Write")]
pub(super) struct WriteForm {
    pub(super) to: Spot<String>,
    pub(super) intent: IntentForm,
    #[serde(default)]
    pub(super) mip: Option<u8>,
    #[serde(default)]
    pub(super) mips: Option<u8>,
    #[serde(default)]
    pub(super) layer: Option<u16>,
    #[serde(default)]
    pub(super) layers: Option<u16>,
    #[serde(default)]
    pub(super) aspect: Option<Aspect>,
    #[serde(default)]
    pub(super) when: Option<Spot<String>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Color")]
pub(super) struct ColorForm {
    pub(super) to: Spot<String>,
    pub(super) intent: IntentForm,
    #[serde(default)]
    pub(super) slot: Option<u8>,
    #[serde(default)]
    pub(super) mip: Option<u8>,
    #[serde(default)]
    pub(super) mips: Option<u8>,
    #[serde(default)]
    pub(super) layer: Option<u16>,
    #[serde(default)]
    pub(super) layers: Option<u16>,
    #[serde(default)]
    pub(super) when: Option<Spot<String>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Resolve")]
pub(super) struct ResolveForm {
    pub(super) to: Spot<String>,
    #[serde(default)]
    pub(super) slot: u8,
    #[serde(default)]
    pub(super) mip: Option<u8>,
    #[serde(default)]
    pub(super) mips: Option<u8>,
    #[serde(default)]
    pub(super) layer: Option<u16>,
    #[serde(default)]
    pub(super) layers: Option<u16>,
    #[serde(default)]
    pub(super) when: Option<Spot<String>>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename = "Intent")]
pub(super) enum IntentForm {
    ClearColor(f64, f64, f64, f64),
    ClearDepth(f32),
    ClearDepthStencil(f32, u32),
    ClearZero,
    Overwrite,
    Modify,
}

#[derive(Debug, Deserialize)]
#[serde(rename = "Export")]
pub(super) enum ExportForm {
    Keep(RefForm),
    Readback(RefForm),
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Export")]
pub(super) struct RefForm {
    pub(super) of: Spot<String>,
    #[serde(default)]
    pub(super) when: Option<Spot<String>>,
}

impl From<IntentForm> for Intent {
    fn from(form: IntentForm) -> Self {
        match form {
            IntentForm::ClearColor(r, g, b, a) => Self::Clear(ClearValue::Color([r, g, b, a])),
            IntentForm::ClearDepth(depth) => Self::Clear(ClearValue::DepthStencil(depth, 0)),
            IntentForm::ClearDepthStencil(depth, stencil) => Self::Clear(ClearValue::DepthStencil(depth, stencil)),
            IntentForm::ClearZero => Self::Clear(ClearValue::Zero),
            IntentForm::Overwrite => Self::Overwrite,
            IntentForm::Modify => Self::Modify,
        }
    }
}

impl From<Size> for Extent {
    fn from(size: Size) -> Self {
        match size {
            Size::Frame => Self::FRAME,
            Size::Scale { num, den, align } => Self::Relative { num, den, align },
            Size::Texels(width, height) => Self::Absolute { width, height },
        }
    }
}

/// The range that the optional fields of an access spell: one level from `mip`, `mips` levels, or all; layers alike.
pub(super) fn range(
    (mip, mips): (Option<u8>, Option<u8>),
    (layer, layers): (Option<u16>, Option<u16>),
    aspect: Option<Aspect>,
) -> Range {
    let all = Range::ALL;
    Range {
        mip: mip.unwrap_or(0),
        mips: mips.unwrap_or(if mip.is_some() { 1 } else { all.mips }),
        layer: layer.unwrap_or(0),
        layers: layers.unwrap_or(if layer.is_some() { 1 } else { all.layers }),
        aspect: aspect.unwrap_or(Aspect::All),
    }
}
