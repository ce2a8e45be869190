//! The shape of a file, as serde reads it. Field by field the reference is `docs/graph-format.md`.

use super::entries::{Count, Entries};
use super::spanned::Spanned;
use crate::access::{AccessKind, ClearValue, Intent, Range};
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
    pub(super) version: Spanned<u32>,
    #[serde(default)]
    pub(super) name: String,
    pub(super) frame: Option<Spanned<(u32, u32)>>,
    #[serde(default)]
    pub(super) features: Entries<bool>,
    #[serde(default)]
    pub(super) resources: Vec<ResourceForm>,
    #[serde(default)]
    pub(super) passes: Vec<PassForm>,
    #[serde(default)]
    pub(super) exports: Vec<ExportForm>,
    pub(super) expect: Option<Spanned<Box<RawValue>>>,
}

/// The one field that is read whatever the version.
#[derive(Debug, Deserialize)]
#[serde(rename = "File")]
pub(super) struct VersionForm {
    pub(super) version: Spanned<u32>,
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
    pub(super) name: Spanned<String>,
    pub(super) id: Option<Spanned<String>>,
    pub(super) format: Format,
    pub(super) size: Option<Spanned<Size>>,
    pub(super) mips: Option<Spanned<Count>>,
    pub(super) layers: Option<Spanned<Count>>,
    pub(super) samples: Option<Spanned<Count>>,
    #[serde(default)]
    pub(super) dimension: Dimension,
    #[serde(default)]
    pub(super) kind: Origin,
    pub(super) when: Option<Spanned<String>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Buffer")]
pub(super) struct BufferForm {
    pub(super) name: Spanned<String>,
    pub(super) id: Option<Spanned<String>>,
    pub(super) bytes: Spanned<Count>,
    #[serde(default)]
    pub(super) kind: Origin,
    pub(super) when: Option<Spanned<String>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Previous")]
pub(super) struct PreviousForm {
    pub(super) of: Spanned<String>,
    pub(super) age: u8,
    pub(super) when: Option<Spanned<String>>,
}

/// What every entry says of itself.
pub(super) struct Head<'f> {
    pub(super) name: &'f Spanned<String>,
    /// What references call it: its `id`, or else its name.
    pub(super) id: &'f Spanned<String>,
    pub(super) when: Option<&'f Spanned<String>>,
    /// The passes that a pass must run after.
    pub(super) after: &'f [Spanned<String>],
}

impl TextureForm {
    pub(super) fn head(&self) -> Head<'_> {
        Head { name: &self.name, id: self.id.as_ref().unwrap_or(&self.name), when: self.when.as_ref(), after: &[] }
    }
}

impl BufferForm {
    pub(super) fn head(&self) -> Head<'_> {
        Head { name: &self.name, id: self.id.as_ref().unwrap_or(&self.name), when: self.when.as_ref(), after: &[] }
    }
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
    pub(super) name: Spanned<String>,
    pub(super) id: Option<Spanned<String>>,
    pub(super) when: Option<Spanned<String>>,
    #[serde(default)]
    pub(super) after: Vec<Spanned<String>>,
    #[serde(default)]
    pub(super) flags: Vec<Flag>,
    #[serde(default)]
    pub(super) accesses: Vec<AccessForm>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Plugin")]
pub(super) struct PluginForm {
    pub(super) kind: Spanned<String>,
    pub(super) name: Spanned<String>,
    pub(super) id: Option<Spanned<String>>,
    pub(super) when: Option<Spanned<String>>,
    #[serde(default)]
    pub(super) after: Vec<Spanned<String>>,
    #[serde(default)]
    pub(super) slots: Entries<Spanned<String>>,
    pub(super) params: Option<Spanned<Box<RawValue>>>,
}

impl PassForm {
    pub(super) fn head(&self) -> Head<'_> {
        let (name, id, when, after) = match self {
            Self::Raster(w) | Self::Compute(w) | Self::Copy(w) => (&w.name, &w.id, &w.when, &w.after),
            Self::Plugin(p) => (&p.name, &p.id, &p.when, &p.after),
        };
        Head { name, id: id.as_ref().unwrap_or(name), when: when.as_ref(), after }
    }
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

/// One access, named like [`AccessKind`].
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
    pub(super) of: Spanned<String>,
    pub(super) mip: Option<u8>,
    pub(super) mips: Option<u8>,
    pub(super) layer: Option<u16>,
    pub(super) layers: Option<u16>,
    pub(super) aspect: Option<Aspect>,
    pub(super) when: Option<Spanned<String>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Write")]
pub(super) struct WriteForm {
    pub(super) to: Spanned<String>,
    pub(super) intent: IntentForm,
    pub(super) mip: Option<u8>,
    pub(super) mips: Option<u8>,
    pub(super) layer: Option<u16>,
    pub(super) layers: Option<u16>,
    pub(super) aspect: Option<Aspect>,
    pub(super) when: Option<Spanned<String>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Color")]
pub(super) struct ColorForm {
    pub(super) to: Spanned<String>,
    pub(super) intent: IntentForm,
    pub(super) slot: Option<u8>,
    pub(super) mip: Option<u8>,
    pub(super) mips: Option<u8>,
    pub(super) layer: Option<u16>,
    pub(super) layers: Option<u16>,
    pub(super) when: Option<Spanned<String>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Resolve")]
pub(super) struct ResolveForm {
    pub(super) to: Spanned<String>,
    #[serde(default)]
    pub(super) slot: u8,
    pub(super) mip: Option<u8>,
    pub(super) mips: Option<u8>,
    pub(super) layer: Option<u16>,
    pub(super) layers: Option<u16>,
    pub(super) when: Option<Spanned<String>>,
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
    pub(super) of: Spanned<String>,
    pub(super) when: Option<Spanned<String>>,
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

/// An access, whatever its form.
#[derive(Clone, Copy)]
pub(super) struct AccessRow<'f> {
    pub(super) kind: AccessKind,
    /// What is touched.
    pub(super) of: &'f Spanned<String>,
    pub(super) when: Option<&'f Spanned<String>>,
    /// What a write does with older contents; none for a read.
    pub(super) intent: Option<Intent>,
    pub(super) range: Range,
    /// The slot of a color attachment where one is named; that of the attachment which a resolve averages.
    pub(super) slot: Option<u8>,
}

/// The levels of an access, as first and count; its layers alike.
type Levels<T> = (Option<T>, Option<T>);

impl<'f> AccessRow<'f> {
    /// The range that the optional fields spell: one level from the first, so many levels, or all; layers alike.
    fn new(
        kind: AccessKind,
        of: &'f Spanned<String>,
        when: &'f Option<Spanned<String>>,
        (mip, mips): Levels<u8>,
        (layer, layers): Levels<u16>,
    ) -> Self {
        let range = Range {
            mip: mip.unwrap_or(0),
            mips: mips.unwrap_or(if mip.is_some() { 1 } else { Range::ALL.mips }),
            layer: layer.unwrap_or(0),
            layers: layers.unwrap_or(if layer.is_some() { 1 } else { Range::ALL.layers }),
            aspect: Aspect::All,
        };
        Self { kind, of, when: when.as_ref(), intent: None, range, slot: None }
    }

    fn aspect(mut self, aspect: Option<Aspect>) -> Self {
        self.range.aspect = aspect.unwrap_or(Aspect::All);
        self
    }
}

impl ReadForm {
    fn row(&self, kind: AccessKind) -> AccessRow<'_> {
        let (mips, layers) = ((self.mip, self.mips), (self.layer, self.layers));
        AccessRow::new(kind, &self.of, &self.when, mips, layers).aspect(self.aspect)
    }
}

impl WriteForm {
    fn row(&self, kind: AccessKind) -> AccessRow<'_> {
        let (mips, layers) = ((self.mip, self.mips), (self.layer, self.layers));
        let row = AccessRow::new(kind, &self.to, &self.when, mips, layers).aspect(self.aspect);
        AccessRow { intent: Some(self.intent.into()), ..row }
    }
}

impl AccessForm {
    /// The access, whatever its form.
    pub(super) fn row(&self) -> AccessRow<'_> {
        use AccessKind as K;
        match self {
            Self::Color(c) => {
                let row = AccessRow::new(K::Color, &c.to, &c.when, (c.mip, c.mips), (c.layer, c.layers));
                AccessRow { intent: Some(c.intent.into()), slot: c.slot, ..row }
            }
            Self::Resolve(r) => {
                let row = AccessRow::new(K::Resolve, &r.to, &r.when, (r.mip, r.mips), (r.layer, r.layers));
                AccessRow { intent: Some(Intent::Overwrite), slot: Some(r.slot), ..row }
            }
            Self::Depth(w) => w.row(K::Depth),
            Self::StorageWrite(w) => w.row(K::StorageWrite),
            Self::CopyTarget(w) => w.row(K::CopyTarget),
            Self::DepthReadOnly(r) => r.row(K::DepthReadOnly),
            Self::SamePixel(r) => r.row(K::SamePixel),
            Self::Sampled(r) => r.row(K::Sampled),
            Self::StorageRead(r) => r.row(K::StorageRead),
            Self::Uniform(r) => r.row(K::Uniform),
            Self::Vertex(r) => r.row(K::Vertex),
            Self::Index(r) => r.row(K::Index),
            Self::Indirect(r) => r.row(K::Indirect),
            Self::CopySource(r) => r.row(K::CopySource),
        }
    }
}
