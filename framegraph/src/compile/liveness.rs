//! Liveness: the next use of the contents of a subresource, as tracked by the backward sweeps.

use crate::decision::Reason;
use crate::graph::Tables;
use crate::id::{PassId, ResourceId};
use crate::resource::Kind;

use super::measure::Measures;
use super::parts::Parts;
use crate::access::Range;

/// The next use of the contents of a subresource, or the way they are lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NextUse {
    /// This pass reads them.
    Reader(PassId),
    /// They are exported.
    Export,
    /// They are imported and must survive the frame.
    Import,
    /// They are imported, and a pass may read them through another import at any time. Stays the next use.
    Alias,
    /// Later frames read them.
    History,
    /// No pass reads or overwrites them.
    Unread,
    /// Only this culled pass reads them.
    CulledReader(PassId),
    /// Only this culled pass reads them, before a kept pass overwrites them.
    CulledReaderThenKept(PassId),
    /// This culled pass overwrites them, and no kept pass does.
    CulledWriter(PassId),
    /// This pass overwrites them first. It is kept, or a later pass that overwrites them is.
    Overwritten(PassId),
}

impl NextUse {
    /// Returns the next use before a culled pass that reads contents which are not needed.
    #[inline]
    pub(crate) const fn or_culled_reader(self, pass: PassId) -> Self {
        if self.is_overwritten() { Self::CulledReaderThenKept(pass) } else { Self::CulledReader(pass) }
    }

    /// Returns the next use before a culled pass that overwrites contents which are not needed.
    #[inline]
    pub(crate) const fn or_culled_writer(self, pass: PassId) -> Self {
        if self.is_overwritten() { Self::Overwritten(pass) } else { Self::CulledWriter(pass) }
    }

    /// Returns `true` if the contents must be kept.
    #[inline]
    pub(crate) const fn is_needed(self) -> bool {
        matches!(self, Self::Reader(_) | Self::Export | Self::Import | Self::Alias | Self::History)
    }

    /// Returns `true` if a kept pass overwrites the contents before any kept pass reads them.
    #[inline]
    pub(crate) const fn is_overwritten(self) -> bool {
        matches!(self, Self::CulledReaderThenKept(_) | Self::Overwritten(_))
    }

    /// Returns the reason to keep the pass that writes `resource`.
    #[inline]
    pub(crate) fn kept(self, resource: ResourceId) -> Reason {
        match self {
            Self::Reader(p) => Reason::KeptReadBy(resource, p),
            Self::Export => Reason::KeptExport(resource),
            Self::Import | Self::Alias => Reason::KeptImport(resource),
            Self::History => Reason::KeptHistory(resource),
            _ => Reason::KeptCullingOff,
        }
    }

    /// Returns the reason to cull the pass that writes `resource`.
    pub(crate) fn culled(self, resource: ResourceId) -> Reason {
        match self {
            Self::CulledReader(pass) | Self::CulledReaderThenKept(pass) => Reason::CulledReaderCulled(resource, pass),
            Self::CulledWriter(pass) | Self::Overwritten(pass) => Reason::CulledOverwritten(resource, pass),
            _ => Reason::CulledUnread(resource),
        }
    }

    /// Returns the reason to store the contents if they are needed.
    #[inline]
    pub(crate) fn stored(self) -> Option<Reason> {
        match self {
            Self::Reader(p) => Some(Reason::StoreReadBy(p)),
            Self::Export => Some(Reason::StoreExport),
            Self::Import | Self::Alias => Some(Reason::StoreImport),
            Self::History => Some(Reason::StoreHistory),
            _ => None,
        }
    }
}

/// Fills `needs` with the uses at the end of the frame: histories, kept imports and exports.
pub(crate) fn uses_at_exit(graph: &Tables, parts: &Parts, measures: &Measures, needs: &mut Vec<NextUse>) {
    needs.clear();
    needs.resize(parts.total(), NextUse::Unread);
    for &resource in &measures.outside {
        let need = match graph.resources[resource.index()].kind {
            Kind::HistoryCurrent { .. } | Kind::HistoryPrevious { .. } => NextUse::History,
            kind if kind.kept_on_exit() => NextUse::Import,
            _ => continue,
        };
        parts.fill(needs, resource, Range::ALL, need);
    }
    for export in &graph.exports {
        parts.fill(needs, export.resource, Range::ALL, NextUse::Export);
    }
    for import in graph.aliases.iter().flat_map(|(a, b)| [*a, *b]) {
        parts.fill(needs, import, Range::ALL, NextUse::Alias);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn culled_passes_hide_no_kept_writer() {
        let [p, q] = [PassId::at(3), PassId::at(1)];
        let overwritten = NextUse::Overwritten(p);
        for hidden in [overwritten.or_culled_reader(q), overwritten.or_culled_writer(q)] {
            assert!(hidden.is_overwritten() && hidden.or_culled_reader(q).is_overwritten() && !hidden.is_needed());
        }
        for free in [NextUse::Unread, NextUse::Unread.or_culled_reader(q), NextUse::Unread.or_culled_writer(q)] {
            assert!(!free.is_overwritten() && !free.is_needed());
        }
        assert!(!NextUse::Reader(p).is_overwritten() && !NextUse::Export.is_overwritten());
    }
}
