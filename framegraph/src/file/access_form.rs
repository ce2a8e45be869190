//! The accesses of a pass in a file, as serde reads them, and as one row whatever their form.

use super::spanned::{Spanned, text_or};
use crate::access::{Access, AccessKind, ClearValue, Intent, Range};
use crate::format::{Aspect, Format};
use crate::pass_builder::MAX_COLORS;
use crate::resolve::ResolveMode;
use serde::Deserialize;
use serde::de::{DeserializeOwned, Deserializer};

/// The first level or layer of an access.
#[derive(Clone, Debug, Default)]
pub(super) enum Level<T> {
    /// Not named.
    #[default]
    None,
    /// That one.
    Number(T),
    /// In a loop: what a text with its index comes to.
    Text(Spanned<String>),
}

impl<T: Copy> Level<T> {
    /// The number; a text was put into numbers when its loop was written out.
    fn number(&self) -> Option<T> {
        match self {
            Self::Number(number) => Some(*number),
            Self::None | Self::Text(_) => None,
        }
    }

    /// Puts a number in the place of a text.
    pub(super) fn evaluate(&mut self, number: impl FnOnce(&mut Spanned<String>) -> T) {
        if let Self::Text(text) = self {
            *self = Self::Number(number(text));
        }
    }
}

impl<'de, T: DeserializeOwned> Deserialize<'de> for Level<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Ok(match text_or(deserializer)? {
            Ok(text) => Self::Text(text),
            Err(number) => Self::Number(number),
        })
    }
}

/// One access, named like [`AccessKind`].
#[derive(Clone, Debug, Deserialize)]
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

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Read")]
pub(super) struct ReadForm {
    pub(super) of: Spanned<String>,
    #[serde(default)]
    pub(super) mip: Level<u8>,
    pub(super) mips: Option<u8>,
    #[serde(default)]
    pub(super) layer: Level<u16>,
    pub(super) layers: Option<u16>,
    pub(super) aspect: Option<Aspect>,
    pub(super) view: Option<Format>,
    pub(super) bytes: Option<(u64, u64)>,
    pub(super) when: Option<Spanned<String>>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Write")]
pub(super) struct WriteForm {
    pub(super) to: Spanned<String>,
    pub(super) intent: IntentForm,
    #[serde(default)]
    pub(super) mip: Level<u8>,
    pub(super) mips: Option<u8>,
    #[serde(default)]
    pub(super) layer: Level<u16>,
    pub(super) layers: Option<u16>,
    pub(super) aspect: Option<Aspect>,
    pub(super) view: Option<Format>,
    pub(super) bytes: Option<(u64, u64)>,
    pub(super) when: Option<Spanned<String>>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Color")]
pub(super) struct ColorForm {
    pub(super) to: Spanned<String>,
    pub(super) intent: IntentForm,
    pub(super) slot: Option<u8>,
    #[serde(default)]
    pub(super) mip: Level<u8>,
    pub(super) mips: Option<u8>,
    #[serde(default)]
    pub(super) layer: Level<u16>,
    pub(super) layers: Option<u16>,
    pub(super) view: Option<Format>,
    pub(super) when: Option<Spanned<String>>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Resolve")]
pub(super) struct ResolveForm {
    pub(super) to: Spanned<String>,
    /// Depth where it is named so, else the color of the slot.
    pub(super) of: Option<ResolvedPlane>,
    #[serde(default)]
    pub(super) slot: u8,
    #[serde(default)]
    pub(super) mode: ResolveMode,
    #[serde(default)]
    pub(super) mip: Level<u8>,
    pub(super) mips: Option<u8>,
    #[serde(default)]
    pub(super) layer: Level<u16>,
    pub(super) layers: Option<u16>,
    pub(super) view: Option<Format>,
    pub(super) when: Option<Spanned<String>>,
}

/// What other than a color is resolved.
#[derive(Clone, Copy, Debug, Deserialize)]
pub(super) enum ResolvedPlane {
    Depth,
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
    /// Offset and size in bytes; none for all of a buffer, and for a texture.
    pub(super) bytes: Option<(u64, u64)>,
    /// The slot of a color attachment where one is named; that of the attachment which is resolved.
    pub(super) slot: Option<u8>,
    /// What a resolve makes of the samples.
    pub(super) resolve: ResolveMode,
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
            ..Range::ALL
        };
        Self {
            kind,
            of,
            when: when.as_ref(),
            intent: None,
            range,
            bytes: None,
            slot: None,
            resolve: ResolveMode::Average,
        }
    }

    fn seen(mut self, aspect: Option<Aspect>, view: Option<Format>) -> Self {
        self.range.aspect = aspect.unwrap_or(Aspect::All);
        self.range.view = view;
        self
    }
}

impl ReadForm {
    fn row(&self, kind: AccessKind) -> AccessRow<'_> {
        let (mips, layers) = ((self.mip.number(), self.mips), (self.layer.number(), self.layers));
        let row = AccessRow::new(kind, &self.of, &self.when, mips, layers).seen(self.aspect, self.view);
        AccessRow { bytes: self.bytes, ..row }
    }
}

impl WriteForm {
    fn row(&self, kind: AccessKind) -> AccessRow<'_> {
        let (mips, layers) = ((self.mip.number(), self.mips), (self.layer.number(), self.layers));
        let row = AccessRow::new(kind, &self.to, &self.when, mips, layers).seen(self.aspect, self.view);
        AccessRow { intent: Some(self.intent.into()), bytes: self.bytes, ..row }
    }
}

/// The texts of an access that can hold names in braces, and its first level and layer.
type Texts<'f> = ([Option<&'f mut Spanned<String>>; 2], (&'f mut Level<u8>, &'f mut Level<u16>));

impl AccessForm {
    /// What a loop or template puts meanings into.
    pub(super) fn texts(&mut self) -> Texts<'_> {
        match self {
            Self::Color(c) => ([Some(&mut c.to), c.when.as_mut()], (&mut c.mip, &mut c.layer)),
            Self::Resolve(r) => ([Some(&mut r.to), r.when.as_mut()], (&mut r.mip, &mut r.layer)),
            Self::Depth(w) | Self::StorageWrite(w) | Self::CopyTarget(w) => {
                ([Some(&mut w.to), w.when.as_mut()], (&mut w.mip, &mut w.layer))
            }
            Self::DepthReadOnly(r)
            | Self::SamePixel(r)
            | Self::Sampled(r)
            | Self::StorageRead(r)
            | Self::Uniform(r)
            | Self::Vertex(r)
            | Self::Index(r)
            | Self::Indirect(r)
            | Self::CopySource(r) => ([Some(&mut r.of), r.when.as_mut()], (&mut r.mip, &mut r.layer)),
        }
    }

    /// The access, whatever its form.
    pub(super) fn row(&self) -> AccessRow<'_> {
        use AccessKind as K;
        match self {
            Self::Color(c) => {
                let row =
                    AccessRow::new(K::Color, &c.to, &c.when, (c.mip.number(), c.mips), (c.layer.number(), c.layers));
                AccessRow { intent: Some(c.intent.into()), slot: c.slot, ..row.seen(None, c.view) }
            }
            Self::Resolve(r) => {
                let row =
                    AccessRow::new(K::Resolve, &r.to, &r.when, (r.mip.number(), r.mips), (r.layer.number(), r.layers));
                let color = Some(r.slot).filter(|slot| *slot < MAX_COLORS);
                let slot = r.of.map_or(color, |ResolvedPlane::Depth| Some(Access::DEPTH));
                AccessRow { intent: Some(Intent::Overwrite), slot, resolve: r.mode, ..row.seen(None, r.view) }
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
