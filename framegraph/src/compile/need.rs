//! What becomes of the contents of a part after a given moment: the value that the backward sweeps carry.

use crate::decision::Reason;
use crate::graph::Tables;
use crate::id::{PassId, ResourceId};
use crate::resource::Kind;

use super::measure::Measures;
use super::parts::Parts;
use crate::access::Range;

/// Who needs what a part holds at this moment, or what becomes of it instead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Need {
    /// This pass reads it.
    Reader(PassId),
    /// It is exported.
    Export,
    /// It is imported and must survive.
    Import,
    /// Later frames read it.
    History,
    /// No pass reads it, and none writes over it.
    Unread,
    /// Only this culled pass reads it.
    CulledReader(PassId),
    /// Only this culled pass reads it; then a pass that is kept writes over it.
    CulledReaderThenKept(PassId),
    /// This culled pass writes over it, and no pass that is kept.
    CulledWriter(PassId),
    /// This pass writes over it first, and a pass that is kept does: this one or a later one.
    Overwritten(PassId),
}

impl Need {
    /// A culled pass reads what otherwise has this fate, which is not to be needed.
    #[inline]
    pub(crate) const fn or_culled_reader(self, pass: PassId) -> Self {
        if self.is_overwritten() { Self::CulledReaderThenKept(pass) } else { Self::CulledReader(pass) }
    }

    /// A culled pass writes over what otherwise has this fate, which is not to be needed.
    #[inline]
    pub(crate) const fn or_culled_writer(self, pass: PassId) -> Self {
        if self.is_overwritten() { Self::Overwritten(pass) } else { Self::CulledWriter(pass) }
    }

    /// Whether the contents must be kept.
    #[inline]
    pub(crate) const fn is_needed(self) -> bool {
        matches!(self, Self::Reader(_) | Self::Export | Self::Import | Self::History)
    }

    /// Whether a kept pass writes over the contents before any kept pass reads them.
    #[inline]
    pub(crate) const fn is_overwritten(self) -> bool {
        matches!(self, Self::CulledReaderThenKept(_) | Self::Overwritten(_))
    }

    /// The reason to keep the pass that writes `resource`.
    #[inline]
    pub(crate) fn kept(self, resource: ResourceId) -> Reason {
        match self {
            Self::Reader(p) => Reason::KeptReadBy(resource, p),
            Self::Export => Reason::KeptExport(resource),
            Self::Import => Reason::KeptImport(resource),
            Self::History => Reason::KeptHistory(resource),
            _ => Reason::KeptCullingOff,
        }
    }

    /// The reason to drop the pass that writes `resource`.
    pub(crate) fn culled(self, resource: ResourceId) -> Reason {
        match self {
            Self::CulledReader(pass) | Self::CulledReaderThenKept(pass) => Reason::CulledReaderCulled(resource, pass),
            Self::CulledWriter(pass) | Self::Overwritten(pass) => Reason::CulledOverwritten(resource, pass),
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
            _ => None,
        }
    }
}

/// Fills `needs` with what is needed when the frame ends: histories, imports that survive, exports.
pub(crate) fn needs_at_exit(graph: &Tables, parts: &Parts, measures: &Measures, needs: &mut Vec<Need>) {
    needs.clear();
    needs.resize(parts.total(), Need::Unread);
    for &resource in &measures.outside {
        let need = match graph.resources[resource.index()].kind {
            Kind::HistoryCurrent { .. } | Kind::HistoryPrevious { .. } => Need::History,
            kind if kind.kept_on_exit() => Need::Import,
            _ => continue,
        };
        parts.fill(needs, resource, Range::ALL, need);
    }
    for export in &graph.exports {
        parts.fill(needs, export.resource, Range::ALL, Need::Export);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn culled_passes_hide_no_kept_writer() {
        let [p, q] = [PassId::at(3), PassId::at(1)];
        let overwritten = Need::Overwritten(p);
        for hidden in [overwritten.or_culled_reader(q), overwritten.or_culled_writer(q)] {
            assert!(hidden.is_overwritten() && hidden.or_culled_reader(q).is_overwritten() && !hidden.is_needed());
        }
        for free in [Need::Unread, Need::Unread.or_culled_reader(q), Need::Unread.or_culled_writer(q)] {
            assert!(!free.is_overwritten() && !free.is_needed());
        }
        assert!(!Need::Reader(p).is_overwritten() && !Need::Export.is_overwritten());
    }
}
