//! Accesses of a pass in a file: their serde representations, and a common form.

use super::spanned::{Spanned, text_or};
use crate::access::{AccessKind, ClearValue, Intent, Range};
use crate::format::{Aspect, Format};
use crate::resolve::ResolveMode;
use serde::Deserialize;
use serde::de::{DeserializeOwned, Deserializer};

/// A number that may depend on a loop index, such as a mip level, a layer or the count of a nested loop.
#[derive(Clone, Debug, Default)]
pub(super) enum Level<T> {
    /// Not given.
    #[default]
    None,
    /// A literal number.
    Number(T),
    /// A text with names in braces that evaluates to a number.
    Text(Spanned<String>),
}

impl<T: Copy> Level<T> {
    /// Returns the number. Texts have been replaced by numbers when loops were expanded.
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

/// An access of any kind.
#[derive(Clone, Debug, Deserialize)]
#[serde(from = "Spelled")]
pub(super) struct AccessForm {
    pub(super) kind: AccessKind,
    /// The accessed resource.
    pub(super) of: Spanned<String>,
    /// Intent of a write; `None` for a read.
    pub(super) intent: Option<IntentForm>,
    /// Slot of a color attachment, if given, or of the attachment that is resolved.
    pub(super) slot: Option<u8>,
    /// Source of a resolve: `Depth` if given, otherwise the color attachment in the slot.
    pub(super) samples: Option<ResolvedPlane>,
    /// Mode of a resolve.
    pub(super) mode: ResolveMode,
    pub(super) mip: Level<u8>,
    mips: Option<u8>,
    pub(super) layer: Level<u16>,
    layers: Option<u16>,
    aspect: Option<Aspect>,
    view: Option<Format>,
    /// Offset and size in bytes; `None` for a whole buffer or a texture.
    pub(super) bytes: Option<(u64, u64)>,
    pub(super) when: Option<Spanned<String>>,
}

impl AccessForm {
    /// Returns the range given by the optional fields. A first level without a count means one level; without both, all
    /// levels. Layers follow the same rule.
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

/// Defines the serde representations of accesses, with their specific and common fields.
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

/// Defines the enumeration of accesses by kind, as in files.
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

/// Source of a resolve other than a color attachment.
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
