//! Serde representation of a graph file. `docs/reference/graph-format.md` documents the fields.

use super::access_form::{AccessForm, Level};
use super::entries::{Count, Entries};
use super::params::{Params, Word};
use super::spanned::{Raw, Spanned};
use crate::format::Format;
use crate::graph::PassFlags;
use crate::resource::{Dimension, Entry, Exit, Extent};
use serde::Deserialize;

/// A graph file.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename = "GraphFile")]
pub(super) struct GraphForm {
    pub(super) version: Option<Spanned<u32>>,
    #[serde(default)]
    pub(super) name: String,
    pub(super) frame: Option<Spanned<(u32, u32)>>,
    #[serde(default)]
    pub(super) features: Entries<bool>,
    /// Evaluated earlier, by [`super::Included`].
    #[serde(default)]
    pub(super) include: Vec<Spanned<String>>,
    #[serde(default)]
    pub(super) templates: Entries<TemplateForm>,
    #[serde(default)]
    pub(super) resources: Vec<ResourceEntry>,
    #[serde(default)]
    pub(super) passes: Vec<PassEntry>,
    #[serde(default)]
    pub(super) exports: Vec<ExportEntry>,
    pub(super) expect: Option<Raw>,
}

impl GraphForm {
    /// Appends the entries of a file to those of its included files. Name, size and expectations are replaced.
    pub(super) fn append(&mut self, later: Self) {
        let Self { version, name, frame, features, include, templates, resources, passes, exports, expect } = later;
        (self.version, self.name, self.frame, self.include, self.expect) = (version, name, frame, include, expect);
        self.features.0.extend(features.0);
        self.templates.0.extend(templates.0);
        self.resources.extend(resources);
        self.passes.extend(passes);
        self.exports.extend(exports);
    }
}

/// The field that lists included files.
#[derive(Debug, Deserialize)]
#[serde(rename = "File")]
pub(super) struct IncludeForm {
    #[serde(default)]
    pub(super) include: Vec<Spanned<String>>,
}

/// The field that is read before the version is known.
#[derive(Debug, Deserialize)]
#[serde(rename = "File")]
pub(super) struct VersionForm {
    pub(super) version: Spanned<u32>,
}

/// An entry of the list of resources.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename = "Resource")]
pub(super) enum ResourceEntry {
    Texture(TextureForm),
    Buffer(BufferForm),
    Previous(PreviousForm),
    MayAlias(AliasForm),
    Each(EachForm<Self>),
}

/// A resource after expansion of loops.
#[derive(Debug)]
pub(super) enum ResourceForm {
    Texture(TextureForm),
    Buffer(BufferForm),
    Previous(PreviousForm),
    MayAlias(AliasForm),
}

/// A loop: entries that are repeated for each number.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Each")]
pub(super) struct EachForm<E> {
    pub(super) index: Spanned<String>,
    #[serde(default)]
    pub(super) from: Level<u32>,
    pub(super) count: Level<u32>,
    #[serde(default = "one")]
    pub(super) step: i32,
    pub(super) entries: Vec<E>,
}

/// Entries with parameters in braces.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Template")]
pub(super) struct TemplateForm {
    #[serde(default)]
    pub(super) params: Vec<String>,
    #[serde(default)]
    pub(super) resources: Vec<ResourceEntry>,
    #[serde(default)]
    pub(super) passes: Vec<PassEntry>,
}

/// A use of a template.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Use")]
pub(super) struct UseForm {
    pub(super) template: Spanned<String>,
    #[serde(default)]
    pub(super) with: Entries<Word>,
}

#[derive(Clone, Debug, Deserialize)]
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

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Buffer")]
pub(super) struct BufferForm {
    pub(super) name: Spanned<String>,
    pub(super) id: Option<Spanned<String>>,
    pub(super) bytes: Spanned<Count>,
    pub(super) per_texel_of: Option<Spanned<Size>>,
    #[serde(default)]
    pub(super) kind: Origin,
    pub(super) when: Option<Spanned<String>>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Previous")]
pub(super) struct PreviousForm {
    pub(super) of: Spanned<String>,
    pub(super) age: u8,
    pub(super) when: Option<Spanned<String>>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "MayAlias")]
pub(super) struct AliasForm {
    pub(super) of: Spanned<String>,
    pub(super) with: Spanned<String>,
    pub(super) when: Option<Spanned<String>>,
}

/// Properties common to all entries.
pub(super) struct Head<'f> {
    pub(super) name: &'f Spanned<String>,
    /// The name used in references: `id` if given, otherwise `name`.
    pub(super) id: &'f Spanned<String>,
    pub(super) when: Option<&'f Spanned<String>>,
    /// Passes that must run before this one.
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

fn one<N: From<u8>>() -> N {
    1.into()
}

/// Origin of a resource.
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

/// An entry of the list of passes.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename = "Pass")]
pub(super) enum PassEntry {
    Raster(WorkForm),
    Compute(WorkForm),
    Copy(WorkForm),
    Plugin(PluginForm),
    Each(EachForm<Self>),
    Use(UseForm),
}

/// A pass after expansion of loops and templates.
#[derive(Debug)]
pub(super) enum PassForm {
    Raster(WorkForm),
    Compute(WorkForm),
    Copy(WorkForm),
    Plugin(PluginForm),
}

#[derive(Clone, Debug, Deserialize)]
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

#[derive(Clone, Debug, Deserialize)]
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
    pub(super) params: Option<Params>,
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
    MainQueue,
}

impl Flag {
    /// Every flag and its counterpart in [`PassFlags`].
    pub(super) const ALL: [(Self, PassFlags); 6] = [
        (Self::SideEffect, PassFlags::SIDE_EFFECT),
        (Self::Pointwise, PassFlags::POINTWISE),
        (Self::Blends, PassFlags::BLENDS),
        (Self::NeverMerge, PassFlags::NEVER_MERGE),
        (Self::TakesEpilogue, PassFlags::TAKES_EPILOGUE),
        (Self::MainQueue, PassFlags::MAIN_QUEUE),
    ];
}

/// An entry of the list of exports.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename = "Export")]
pub(super) enum ExportEntry {
    Keep(RefForm),
    Readback(RefForm),
    Forward(ForwardForm),
    Each(EachForm<Self>),
}

/// An export after expansion of loops.
#[derive(Debug)]
pub(super) enum ExportForm {
    Keep(RefForm),
    Readback(RefForm),
    Forward(ForwardForm),
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Export")]
pub(super) struct RefForm {
    pub(super) of: Spanned<String>,
    pub(super) when: Option<Spanned<String>>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Forward")]
pub(super) struct ForwardForm {
    pub(super) of: Spanned<String>,
    pub(super) to: Spanned<String>,
    #[serde(default)]
    pub(super) mip: Level<u8>,
    #[serde(default)]
    pub(super) layer: Level<u16>,
    pub(super) when: Option<Spanned<String>>,
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
