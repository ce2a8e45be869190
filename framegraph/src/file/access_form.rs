//! The accesses of a pass in a file: as serde reads them, and as one form whatever their kind.

use super::spanned::{Spanned, text_or};
use crate::access::{AccessKind, ClearValue, Intent, Range};
use crate::format::{Aspect, Format};
use crate::resolve::ResolveMode;
use serde::Deserialize;
use serde::de::{DeserializeOwned, Deserializer};

/// A number that a loop can give: the first level or layer of an access, how often another loop repeats.
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
    pub(super) fn number(&self) -> Option<T> {
        match self {
            Self::Number(number) => Some(*number),
            Self::None | Self::Text(_) => None,
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

/// An access, whatever its kind.
#[derive(Clone, Debug, Deserialize)]
#[serde(from = "Spelled")]
pub(super) struct AccessForm {
    pub(super) kind: AccessKind,
    /// What is touched.
    pub(super) of: Spanned<String>,
    /// What a write does with older contents; none for a read.
    pub(super) intent: Option<IntentForm>,
    /// The slot of a color attachment where one is named; that of the attachment which is resolved.
    pub(super) slot: Option<u8>,
    /// Of a resolve: depth where it is named so, else the color of the slot.
    pub(super) samples: Option<ResolvedPlane>,
    /// Of a resolve: what it makes of the samples.
    pub(super) mode: ResolveMode,
    pub(super) mip: Level<u8>,
    mips: Option<u8>,
    pub(super) layer: Level<u16>,
    layers: Option<u16>,
    aspect: Option<Aspect>,
    view: Option<Format>,
    /// Offset and size in bytes; none for all of a buffer, and for a texture.
    pub(super) bytes: Option<(u64, u64)>,
    pub(super) when: Option<Spanned<String>>,
}

impl AccessForm {
    /// The range that the optional fields spell: one level from the first, so many levels, or all; layers alike.
    pub(super) fn range(&self) -> Range {
        let (mip, layer) = (self.mip.number(), self.layer.number());
        Range {
            mip: mip.unwrap_or(0),
            mips: self.mips.unwrap_or(if mip.is_some() { 1 } else { Range::ALL.mips }),
            layer: layer.unwrap_or(0),
            layers: self.layers.unwrap_or(if layer.is_some() { 1 } else { Range::ALL.layers }),
            aspect: self.aspect.unwrap_or(Aspect::All),
            view: self.view,
            ..Range::ALL
        }
    }
}

/// Makes the forms in which accesses stand in files: the resource, fields of their own, and those that all have.
macro_rules! forms {
    ($($form:ident($name:literal, $of:ident { $($(#[$serde:meta])* $own:ident: $type:ty),+ });)+) => { $(
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields, rename = $name)]
        struct $form {
            $of: Spanned<String>,
            $($(#[$serde])* $own: $type,)+
            #[serde(default)]
            mip: Level<u8>,
            mips: Option<u8>,
            #[serde(default)]
            layer: Level<u16>,
            layers: Option<u16>,
            view: Option<Format>,
            when: Option<Spanned<String>>,
        }

        impl $form {
            fn access(self, kind: AccessKind) -> AccessForm {
                let Self { $of: of, $($own,)+ mip, mips, layer, layers, view, when } = self;
                let intent = (kind == AccessKind::Resolve).then_some(IntentForm::Overwrite);
                let (slot, aspect, bytes, samples, mode) = (None, None, None, None, ResolveMode::Average);
                let mut access = AccessForm { kind, of, intent, slot, samples, mode, mip, mips, layer, layers, aspect, view, bytes, when };
                $(access.$own = $own.into();)+
                access
            }
        }
    )+ };
}

forms! {
    ReadForm("Read", of { aspect: Option<Aspect>, bytes: Option<(u64, u64)> });
    WriteForm("Write", to { intent: IntentForm, aspect: Option<Aspect>, bytes: Option<(u64, u64)> });
    ColorForm("Color", to { intent: IntentForm, slot: Option<u8> });
    ResolveForm("Resolve", to {
        #[serde(default)] slot: u8,
        #[serde(rename = "of")] samples: Option<ResolvedPlane>,
        #[serde(default)] mode: ResolveMode
    });
}

/// Makes the enumeration of accesses as files name them, by kind.
macro_rules! spelled {
    ($($kind:ident: $form:ident),+) => {
        #[derive(Deserialize)]
        #[serde(rename = "Access")]
        enum Spelled {
            $($kind($form),)+
        }

        impl From<Spelled> for AccessForm {
            fn from(spelled: Spelled) -> Self {
                match spelled {
                    $(Spelled::$kind(form) => form.access(AccessKind::$kind),)+
                }
            }
        }
    };
}

spelled! {
    Color: ColorForm, Depth: WriteForm, DepthReadOnly: ReadForm, Resolve: ResolveForm, SamePixel: ReadForm,
    Sampled: ReadForm, StorageRead: ReadForm, StorageWrite: WriteForm, Uniform: ReadForm, Vertex: ReadForm,
    Index: ReadForm, Indirect: ReadForm, CopySource: ReadForm, CopyTarget: WriteForm
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
