//! Numbering of subresources (*parts*): each level × layer × plane of each resource has a number.
//!
//! Phases that track contents keep one value per part in a flat array. Most resources have one part. A range of a
//! texture with several parts consists of a few runs of consecutive numbers. A buffer with declared byte ranges is
//! split wherever such a range begins or ends.

use super::measure::Measures;
use crate::access::{ByteRange, Range};
use crate::format::Aspect;
use crate::graph::Tables;
use crate::id::{ResourceId, Span};

/// The numbering of parts.
///
/// The only part of a resource has the number of the resource. Parts of other resources follow after these, as `base +
/// (plane · layers + layer) · mips + mip`. Parts of a buffer count as layers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Parts {
    /// By resource: [`ONE`], or an index into `several`. Empty if every resource has one part.
    kinds: Vec<u32>,
    several: Vec<Row>,
    total: usize,
    /// Positions where buffers are split, as (buffer, byte), sorted.
    cuts: Vec<(ResourceId, u64)>,
    /// For each row of [`Tables::byte_ranges`], the parts it covers, counted from the buffer's first part.
    sections: Vec<Span>,
}

/// Marks a resource with one part.
const ONE: u32 = u32::MAX;

#[derive(Clone, Copy, Debug)]
struct Row {
    base: u32,
    parts: u32,
    mips: u32,
    layers: u32,
}

impl Parts {
    /// Numbers the parts of the resources of `graph`.
    pub(crate) fn number(&mut self, graph: &Tables, measures: &Measures) {
        let Self { kinds, several, total, cuts, sections } = self;
        several.clear();
        kinds.clear();
        *total = graph.resources.len();
        if !measures.several {
            return;
        }
        cut(&graph.byte_ranges, measures, cuts, sections);
        let mut cuts = &cuts[..];
        kinds.extend(measures.rows.iter().zip(&graph.resources).enumerate().map(|(index, (measured, resource))| {
            let (mips, layers, planes) = match resource.desc.texture() {
                Some(t) => (measured.layout.mips().into(), t.tracked_layers().max(1), t.format.planes()),
                None => {
                    let own = cuts.iter().take_while(|(r, _)| r.index() == index).count();
                    cuts = &cuts[own..];
                    (1, own.max(1) as u32, 1)
                }
            };
            let parts = mips * layers * planes;
            if parts == 1 {
                return ONE;
            }
            several.push(Row { base: *total as u32, parts, mips, layers });
            *total += parts as usize;
            several.len() as u32 - 1
        }));
        if several.is_empty() {
            kinds.clear();
        }
    }

    /// Number of parts; all part numbers are lower.
    pub(crate) fn total(&self) -> usize {
        self.total
    }

    /// Returns `true` if a resource has several parts.
    pub(crate) fn has_several(&self) -> bool {
        !self.several.is_empty()
    }

    /// Returns [`ONE`], or the index of a resource with several parts.
    #[inline(always)]
    fn kind(&self, resource: ResourceId) -> u32 {
        self.kinds.get(resource.index()).copied().unwrap_or(ONE)
    }

    /// The numbers of all parts of `resource`.
    #[inline]
    pub(crate) fn all(&self, resource: ResourceId) -> std::ops::Range<usize> {
        match self.kind(resource) {
            ONE => resource.index()..resource.index() + 1,
            row => {
                let row = &self.several[row as usize];
                row.base as usize..(row.base + row.parts) as usize
            }
        }
    }

    /// Calls `visit` for each run of consecutive part numbers in `range`. Ranges are clipped to the resource.
    #[inline]
    pub(crate) fn runs(&self, resource: ResourceId, range: Range, mut visit: impl FnMut(std::ops::Range<usize>)) {
        let kind = self.kind(resource);
        if kind == ONE || range.is_all() {
            return visit(self.all(resource));
        }
        let row = self.several[kind as usize];
        if let Some(section) = self.sections.get(range.bytes.index()) {
            let first = (row.base + section.start) as usize;
            return visit(first..first + section.len as usize);
        }
        let planes = row.parts / (row.mips * row.layers);
        let (mips, layers) = (range.mip_range(row.mips), range.layer_range(row.layers));
        // Slices of a three-dimensional texture are one layer.
        let layers = if row.layers == 1 { 0..1 } else { layers.start..layers.end.min(row.layers) };
        let mips = mips.start..mips.end.min(row.mips);
        if mips.is_empty() {
            return;
        }
        for plane in 0..planes {
            // Two planes are always depth (0) and stencil (1). With one plane, every valid aspect selects it.
            let selected = match range.aspect {
                Aspect::All => true,
                Aspect::Depth => plane == 0,
                Aspect::Stencil => plane + 1 == planes,
            };
            for layer in layers.clone() {
                if selected {
                    let first = row.base + (plane * row.layers + layer) * row.mips;
                    visit((first + mips.start) as usize..(first + mips.end) as usize);
                }
            }
        }
    }

    /// Returns `true` if `holds` is true for a part of the range.
    #[inline(always)]
    pub(crate) fn any<T: Copy>(
        &self,
        values: &[T],
        resource: ResourceId,
        range: Range,
        holds: impl Fn(T) -> bool,
    ) -> bool {
        self.find(values, resource, range, holds).is_some()
    }

    /// Returns the first value in the range for which `holds` is true.
    #[inline(always)]
    pub(crate) fn find<T: Copy>(
        &self,
        values: &[T],
        resource: ResourceId,
        range: Range,
        holds: impl Fn(T) -> bool,
    ) -> Option<T> {
        if self.kind(resource) == ONE {
            let value = values[resource.index()];
            return if holds(value) { Some(value) } else { None };
        }
        self.find_among(values, resource, range, holds)
    }

    #[inline(never)]
    fn find_among<T: Copy>(
        &self,
        values: &[T],
        resource: ResourceId,
        range: Range,
        holds: impl Fn(T) -> bool,
    ) -> Option<T> {
        let mut found = None;
        self.runs(resource, range, |run| {
            if found.is_none() {
                found = values[run].iter().copied().find(|v| holds(*v));
            }
        });
        found
    }

    /// Replaces every value in the range by `next(v)` and returns `v`: the first value for which `holds` is true,
    /// otherwise the first value.
    #[inline(always)]
    pub(crate) fn replace<T: Copy>(
        &self,
        values: &mut [T],
        resource: ResourceId,
        range: Range,
        holds: impl Fn(T) -> bool,
        next: impl FnOnce(T) -> T,
    ) -> T {
        if self.kind(resource) == ONE {
            let value = &mut values[resource.index()];
            return std::mem::replace(value, next(*value));
        }
        let found = self.find_among(values, resource, range, holds);
        let found = found.or_else(|| self.find_among(values, resource, range, |_| true));
        // A level that does not exist at this frame size has no parts. The resource's own number is unused then.
        let found = found.unwrap_or(values[resource.index()]);
        self.fill_among(values, resource, range, next(found));
        found
    }

    /// Applies `change` to every value in the range.
    #[inline(always)]
    pub(crate) fn update<T>(&self, values: &mut [T], resource: ResourceId, range: Range, change: impl Fn(&mut T)) {
        if self.kind(resource) == ONE {
            change(&mut values[resource.index()]);
        } else {
            self.runs(resource, range, |run| values[run].iter_mut().for_each(&change));
        }
    }

    /// Sets every value in the range.
    #[inline(always)]
    pub(crate) fn fill<T: Copy>(&self, values: &mut [T], resource: ResourceId, range: Range, value: T) {
        if self.kind(resource) == ONE {
            values[resource.index()] = value;
        } else {
            self.fill_among(values, resource, range, value);
        }
    }

    #[inline(never)]
    fn fill_among<T: Copy>(&self, values: &mut [T], resource: ResourceId, range: Range, value: T) {
        self.runs(resource, range, |run| values[run].fill(value));
    }
}

/// Splits buffers at both ends of each range, and computes the parts each range covers. Ranges beyond the end of a
/// buffer were rejected by the measuring phase.
#[inline(never)]
fn cut(ranges: &[ByteRange], measures: &Measures, cuts: &mut Vec<(ResourceId, u64)>, sections: &mut Vec<Span>) {
    cuts.clear();
    for range in ranges {
        let within = |byte: &u64| *byte < measures.rows[range.resource.index()].bytes;
        cuts.extend([0, range.offset, range.end()].into_iter().filter(within).map(|byte| (range.resource, byte)));
    }
    cuts.sort_unstable();
    cuts.dedup();
    sections.clear();
    sections.extend(ranges.iter().map(|range| {
        let before = |byte: u64| cuts.partition_point(|cut| *cut < (range.resource, byte));
        let first = before(0);
        Span::new(before(range.offset) - first, before(range.end()) - first)
    }));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::layout::Layout;
    use crate::compile::measure::Measured;
    use crate::format::Format;
    use crate::id::{Span, VersionId};
    use crate::resource::{Desc, Extent, Kind, Resource, TextureDesc};

    fn resource(desc: TextureDesc) -> Resource {
        Resource { name: Span::default(), current: VersionId::NONE, kind: Kind::Transient, desc: Desc::Texture(desc) }
    }

    #[test]
    fn every_part_is_reached_exactly_once() {
        let desc = TextureDesc::new(Extent::absolute(1 << 10, 4), Format::Depth32FloatStencil8).mips(11).layers(7);
        let resources = [resource(TextureDesc::new(Extent::FRAME, Format::R8Unorm)), resource(desc)];
        let mut parts = Parts::default();
        let measured = |r: &Resource| Measured {
            layout: r.desc.texture().map_or(Layout::BUFFER, |t| Layout::of_texture(t, t.mip_count([64, 64]) as u8)),
            ..Measured::default()
        };
        let rows = resources.iter().map(measured).collect();
        let graph = Tables { resources: resources.to_vec(), ..Tables::default() };
        parts.number(&graph, &Measures { rows, outside: Vec::new(), several: true });
        let r = ResourceId::at(1);
        assert_eq!(parts.all(r).len(), 11 * 7 * 2);
        let mut seen = vec![false; parts.total()];
        for aspect in [Aspect::Depth, Aspect::Stencil] {
            for layer in 0..7 {
                for mip in 0..11 {
                    let one = Range { mip, mips: 1, layer, layers: 1, aspect, ..Range::ALL };
                    assert!(!parts.any(&seen, r, one, |s| s), "{one:?} was visited twice");
                    parts.fill(&mut seen, r, one, true);
                }
            }
        }
        assert!(!parts.any(&seen, r, Range::ALL, |s| !s), "a part was missed");
        assert!(!seen[0], "a part of another resource changed");
        parts.fill(&mut seen, r, Range { layer: 3, layers: 1, ..Range::ALL }, false);
        assert!(!parts.any(&seen, r, Range { mip: 2, mips: 3, layer: 3, layers: 1, ..Range::ALL }, |s| s));
        assert!(!parts.any(&seen, r, Range { layer: 4, layers: 3, ..Range::ALL }, |s| !s));
    }
}
