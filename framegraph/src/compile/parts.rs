//! Subresources as numbers: each level × layer × plane of each resource is one *part*, numbered without gaps.
//!
//! Phases that follow contents keep one value for each part in a flat array. Most resources have one part; a mip pyramid
//! or an array of cascades has several, and a range of it is a few runs of consecutive numbers.

use crate::access::Range;
use crate::format::Aspect;
use crate::id::ResourceId;
use crate::resource::{Desc, Resource};

/// Numbers the parts: `base + (plane · layers + layer) · mips + mip`.
#[derive(Clone, Debug, Default)]
pub(crate) struct Parts {
    rows: Vec<Row>,
    total: usize,
}

#[derive(Clone, Copy, Debug)]
struct Row {
    base: u32,
    parts: u32,
    mips: u32,
    layers: u32,
}

impl Parts {
    /// Numbers the parts of `resources` in a frame of `frame` texels.
    pub(crate) fn number(&mut self, resources: &[Resource], frame: [u32; 2]) {
        self.rows.clear();
        let mut base = 0;
        self.rows.extend(resources.iter().map(|r| {
            let (mips, layers, planes) = match &r.desc {
                Desc::Texture(t) => (
                    t.mip_count(frame),
                    t.tracked_layers().max(1),
                    t.format.planes(),
                ),
                Desc::Buffer(_) => (1, 1, 1),
            };
            let row = Row {
                base,
                parts: mips * layers * planes,
                mips,
                layers,
            };
            base += row.parts;
            row
        }));
        self.total = base as usize;
    }

    /// How many parts all resources have together.
    pub(crate) fn total(&self) -> usize {
        self.total
    }

    /// The numbers of all parts of `resource`.
    #[inline]
    pub(crate) fn all(&self, resource: ResourceId) -> std::ops::Range<usize> {
        let row = &self.rows[resource.index()];
        row.base as usize..(row.base + row.parts) as usize
    }

    /// Calls `visit` with each run of consecutive numbers that `range` of `resource` covers; ranges are clipped to what
    /// there is.
    #[inline]
    pub(crate) fn runs(
        &self,
        resource: ResourceId,
        range: Range,
        mut visit: impl FnMut(std::ops::Range<usize>),
    ) {
        let row = self.rows[resource.index()];
        if row.parts == 1 || range.is_all() {
            return visit(row.base as usize..(row.base + row.parts) as usize);
        }
        let planes = row.parts / (row.mips * row.layers);
        let (mips, layers) = (range.mip_range(row.mips), range.layer_range(row.layers));
        let (mips, layers) = (
            mips.start..mips.end.min(row.mips),
            layers.start..layers.end.min(row.layers),
        );
        if mips.is_empty() {
            return;
        }
        for plane in 0..planes {
            // Two planes exist only as depth (0) and stencil (1); with one plane, every aspect that exists selects it.
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

    /// Whether `holds` is true of some part of the range.
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

    /// The first value in the range of which `holds` is true.
    #[inline(always)]
    pub(crate) fn find<T: Copy>(
        &self,
        values: &[T],
        resource: ResourceId,
        range: Range,
        holds: impl Fn(T) -> bool,
    ) -> Option<T> {
        let row = &self.rows[resource.index()];
        if row.parts == 1 {
            let value = values[row.base as usize];
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

    /// Sets every part of the range.
    #[inline(always)]
    pub(crate) fn fill<T: Copy>(
        &self,
        values: &mut [T],
        resource: ResourceId,
        range: Range,
        value: T,
    ) {
        let row = &self.rows[resource.index()];
        if row.parts == 1 {
            values[row.base as usize] = value;
        } else {
            self.fill_among(values, resource, range, value);
        }
    }

    #[inline(never)]
    fn fill_among<T: Copy>(&self, values: &mut [T], resource: ResourceId, range: Range, value: T) {
        self.runs(resource, range, |run| values[run].fill(value));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::Format;
    use crate::id::{Span, VersionId};
    use crate::resource::{Extent, Kind, TextureDesc};

    fn resource(desc: TextureDesc) -> Resource {
        Resource {
            name: Span::default(),
            current: VersionId::NONE,
            kind: Kind::Transient,
            desc: Desc::Texture(desc),
        }
    }

    #[test]
    fn every_part_is_reached_exactly_once() {
        let desc = TextureDesc::new(Extent::absolute(1 << 10, 4), Format::Depth32FloatStencil8)
            .mips(11)
            .layers(7);
        let resources = [
            resource(TextureDesc::new(Extent::FRAME, Format::R8Unorm)),
            resource(desc),
        ];
        let mut parts = Parts::default();
        parts.number(&resources, [64, 64]);
        let r = ResourceId::at(1);
        assert_eq!(parts.all(r).len(), 11 * 7 * 2);
        let mut seen = vec![false; parts.total()];
        for aspect in [Aspect::Depth, Aspect::Stencil] {
            for layer in 0..7 {
                for mip in 0..11 {
                    let one = Range {
                        mip,
                        mips: 1,
                        layer,
                        layers: 1,
                        aspect,
                    };
                    assert!(
                        !parts.any(&seen, r, one, |s| s),
                        "{one:?} was already there"
                    );
                    parts.fill(&mut seen, r, one, true);
                }
            }
        }
        assert!(
            !parts.any(&seen, r, Range::ALL, |s| !s),
            "a part was missed"
        );
        assert!(!seen[0], "a neighbour's part was touched");
        parts.fill(
            &mut seen,
            r,
            Range {
                layer: 3,
                layers: 1,
                ..Range::ALL
            },
            false,
        );
        assert!(!parts.any(
            &seen,
            r,
            Range {
                mip: 2,
                mips: 3,
                layer: 3,
                layers: 1,
                aspect: Aspect::All
            },
            |s| s
        ));
        assert!(!parts.any(
            &seen,
            r,
            Range {
                layer: 4,
                layers: 3,
                ..Range::ALL
            },
            |s| !s
        ));
    }
}
