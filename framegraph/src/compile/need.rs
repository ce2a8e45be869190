//! What becomes of the contents of a part after a given moment: the value that the backward sweeps carry.

use crate::decision::Reason;
use crate::graph::Tables;
use crate::id::{PassId, ResourceId};
use crate::resource::Kind;

use super::measure::Measures;
use super::parts::Parts;
use crate::access::Range;

/// Who, if anybody, needs what a part holds at this moment; one word, since there is one for each part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Need(u32);

// The upper two bits say what becomes of the contents: needed (by a pass, or by one of three that are no pass), read by a
// culled pass, written over, or not looked at.
const CULLED: u32 = 1 << 30;
const OVERWRITTEN: u32 = 2 << 30;
const UNREAD: u32 = u32::MAX;
const EXPORT: u32 = CULLED - 1;
const IMPORT: u32 = CULLED - 2;
const HISTORY: u32 = CULLED - 3;
/// Of contents that are not needed: a pass that is kept writes over them later.
const LATER: u32 = 1 << 29;
const INDEX: u32 = LATER - 1;

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
    pub(crate) const MAX_PASSES: usize = INDEX as usize;
    /// Nobody looks at it any more.
    pub(crate) const UNREAD: Self = Self(UNREAD);

    #[inline]
    pub(crate) const fn reader(pass: PassId) -> Self {
        Self(pass.index() as u32)
    }

    /// A kept pass writes over it first.
    #[inline]
    pub(crate) const fn overwritten(pass: PassId) -> Self {
        Self(OVERWRITTEN | LATER | pass.index() as u32)
    }

    /// A culled pass reads what otherwise has this fate, which is not to be needed.
    #[inline]
    pub(crate) const fn or_culled_reader(self, pass: PassId) -> Self {
        Self(CULLED | self.later() | pass.index() as u32)
    }

    /// A culled pass writes over what otherwise has this fate, which is not to be needed.
    #[inline]
    pub(crate) const fn or_culled_writer(self, pass: PassId) -> Self {
        Self(OVERWRITTEN | self.later() | pass.index() as u32)
    }

    const fn later(self) -> u32 {
        if self.0 == UNREAD { 0 } else { self.0 & LATER }
    }

    /// Whether the contents must be kept.
    #[inline]
    pub(crate) const fn is_needed(self) -> bool {
        self.0 < CULLED
    }

    /// The pass that reads the contents, where that is why they are needed.
    #[inline]
    pub(crate) const fn reader_alone(self) -> Option<PassId> {
        if self.0 < HISTORY { Some(PassId::at(self.0 as usize)) } else { None }
    }

    /// Whether a kept pass writes over the contents before any kept pass reads them.
    #[inline]
    pub(crate) const fn is_overwritten(self) -> bool {
        !self.is_needed() && self.later() != 0
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
                match v & (CULLED | OVERWRITTEN) {
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

/// Fills `needs` with what is needed when the frame ends: histories, imports that survive, exports.
pub(crate) fn needs_at_exit(graph: &Tables, parts: &Parts, measures: &Measures, needs: &mut Vec<Need>) {
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
        assert_eq!(Need::UNREAD.or_culled_reader(p).why(), Why::CulledReader(p));
        assert_eq!(Need::overwritten(p).why(), Why::Overwritten(p));
        assert_eq!(Need(EXPORT).why(), Why::Export);
        assert!(Need::reader(p).is_needed() && Need(HISTORY).is_needed() && Need(EXPORT).is_needed());
        assert!(!Need::UNREAD.is_needed() && !Need::overwritten(p).is_needed());
        assert!(!Need::UNREAD.or_culled_reader(p).is_needed());
        let last = PassId::at(Need::MAX_PASSES - 1);
        assert_eq!(Need::overwritten(last).why(), Why::Overwritten(last));
        assert_eq!(Need::reader(last).why(), Why::Reader(last));
    }

    #[test]
    fn culled_passes_hide_no_kept_writer() {
        let [p, q] = [PassId::at(3), PassId::at(1)];
        let overwritten = Need::overwritten(p);
        for hidden in [overwritten.or_culled_reader(q), overwritten.or_culled_writer(q)] {
            assert!(hidden.is_overwritten() && hidden.or_culled_reader(q).is_overwritten());
        }
        assert_eq!(overwritten.or_culled_writer(q).why(), Why::Overwritten(q));
        for free in [Need::UNREAD, Need::UNREAD.or_culled_reader(q), Need::UNREAD.or_culled_writer(q)] {
            assert!(!free.is_overwritten());
        }
        assert!(!Need::reader(p).is_overwritten() && !Need(EXPORT).is_overwritten());
    }
}
