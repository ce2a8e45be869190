//! What becomes of the contents of a part after a given moment: the value that the backward sweeps carry.

use crate::decision::Reason;
use crate::graph::{ExportKind, Graph};
use crate::id::{PassId, ResourceId};
use crate::resource::Kind;

use super::measure::Measures;
use super::parts::Parts;
use crate::access::Range;

/// Who, if anybody, needs what a part holds at this moment; one word, since there is one for each part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Need(u32);

const UNREAD: u32 = u32::MAX;
const EXPORT: u32 = u32::MAX - 1;
const IMPORT: u32 = u32::MAX - 2;
const HISTORY: u32 = u32::MAX - 3;
const CULLED: u32 = 1 << 30;
const OVERWRITTEN: u32 = 2 << 30;
const INDEX: u32 = CULLED - 1;

/// A need, taken apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Why {
    /// Nobody looks at it any more.
    Unread,
    /// Only this culled pass reads it.
    CulledReader(PassId),
    /// This pass writes over it first.
    Overwritten(PassId),
    /// This pass reads it.
    Reader(PassId),
    /// It is exported.
    Export,
    /// It is imported and must survive.
    Import,
    /// Later frames read it.
    History,
}

impl Need {
    /// How many passes can be told apart.
    pub(crate) const MAX_PASSES: usize = INDEX as usize - 4;
    /// Nobody looks at it any more.
    pub(crate) const UNREAD: Self = Self(UNREAD);

    #[inline]
    pub(crate) const fn reader(pass: PassId) -> Self {
        Self(pass.index() as u32)
    }

    #[inline]
    pub(crate) const fn culled_reader(pass: PassId) -> Self {
        Self(CULLED | pass.index() as u32)
    }

    #[inline]
    pub(crate) const fn overwritten(pass: PassId) -> Self {
        Self(OVERWRITTEN | pass.index() as u32)
    }

    /// Whether the contents must be kept.
    #[inline]
    pub(crate) const fn is_needed(self) -> bool {
        self.0 < CULLED || (self.0 >= HISTORY && self.0 != UNREAD)
    }

    #[inline]
    pub(crate) const fn why(self) -> Why {
        match self.0 {
            UNREAD => Why::Unread,
            EXPORT => Why::Export,
            IMPORT => Why::Import,
            HISTORY => Why::History,
            v => {
                let pass = PassId::at((v & INDEX) as usize);
                match v & !INDEX {
                    CULLED => Why::CulledReader(pass),
                    OVERWRITTEN => Why::Overwritten(pass),
                    _ => Why::Reader(pass),
                }
            }
        }
    }
}

impl Why {
    /// The reason to keep the pass that writes `resource`.
    #[inline]
    pub(crate) fn kept(self, resource: ResourceId) -> Reason {
        match self {
            Self::Reader(p) => Reason::KeptReadBy(resource, p),
            Self::Export => Reason::KeptExport(resource),
            Self::Import => Reason::KeptImport(resource),
            Self::History => Reason::KeptHistory(resource),
            Self::Unread | Self::CulledReader(_) | Self::Overwritten(_) => Reason::KeptCullingOff,
        }
    }

    /// The reason to drop the pass that writes `resource`.
    pub(crate) fn culled(self, resource: ResourceId) -> Reason {
        match self {
            Self::CulledReader(p) => Reason::CulledReaderCulled(resource, p),
            Self::Overwritten(p) => Reason::CulledOverwritten(resource, p),
            _ => Reason::CulledUnread(resource),
        }
    }

    /// The reason to store what was written, when it is needed.
    #[inline]
    pub(crate) fn stored(self) -> Option<Reason> {
        match self {
            Self::Reader(p) => Some(Reason::StoreReadBy(p)),
            Self::Export => Some(Reason::StoreExport),
            Self::Import => Some(Reason::StoreImport),
            Self::History => Some(Reason::StoreHistory),
            Self::Unread | Self::CulledReader(_) | Self::Overwritten(_) => None,
        }
    }
}

/// Fills `needs` with what is needed when the frame ends: exports, surviving imports, histories.
pub(crate) fn needs_at_exit(graph: &Graph, parts: &Parts, measures: &Measures, needs: &mut Vec<Need>) {
    needs.clear();
    needs.resize(parts.total(), Need::UNREAD);
    for &resource in &measures.outside {
        let need = match graph.resources[resource.index()].kind {
            Kind::HistoryCurrent { .. } | Kind::HistoryPrevious { .. } => Need(HISTORY),
            kind if kind.kept_on_exit() => Need(IMPORT),
            _ => continue,
        };
        parts.fill(needs, resource, Range::ALL, need);
    }
    for export in &graph.exports {
        debug_assert!(matches!(export.kind, ExportKind::Keep | ExportKind::Readback));
        parts.fill(needs, export.resource, Range::ALL, Need(EXPORT));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn needs_survive_packing() {
        let p = PassId::at(12345);
        assert_eq!(Need::reader(p).why(), Why::Reader(p));
        assert_eq!(Need::culled_reader(p).why(), Why::CulledReader(p));
        assert_eq!(Need::overwritten(p).why(), Why::Overwritten(p));
        assert_eq!(Need(EXPORT).why(), Why::Export);
        assert!(Need::reader(p).is_needed() && Need(HISTORY).is_needed() && Need(EXPORT).is_needed());
        assert!(!Need::UNREAD.is_needed() && !Need::culled_reader(p).is_needed() && !Need::overwritten(p).is_needed());
        let last = PassId::at(Need::MAX_PASSES - 1);
        assert_eq!(Need::overwritten(last).why(), Why::Overwritten(last));
    }
}
