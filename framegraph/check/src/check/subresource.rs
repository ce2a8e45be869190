//! The oracle's numbering of parts.
//!
//! Every level × layer × plane of every resource has the number `first + (mip · layers + layer) · planes + plane`. A
//! buffer with declared byte ranges has one layer for each section between ends of such ranges. The slices of a
//! three-dimensional texture are numbered like layers; numbers of slices that a small level lacks stay unused.

use super::finding::Subresource;
use framegraph::access::{Access, Range};
use framegraph::format::Format;
use framegraph::graph::Graph;
use framegraph::id::ResourceId;
use framegraph::resource::{Desc, Dimension};
use std::collections::{BTreeMap, BTreeSet};

/// The numbers of all parts of a graph at a given frame size.
#[derive(Debug)]
pub(super) struct Subresources {
    rows: Vec<Row>,
    total: usize,
    /// For each row of [`Tables::byte_ranges`](framegraph::graph::Tables::byte_ranges), the layers of the buffer it covers.
    bytes: Vec<std::ops::Range<u32>>,
}

#[derive(Clone, Copy, Debug)]
struct Row {
    first: usize,
    mips: u32,
    layers: u32,
    planes: u32,
    format: Option<Format>,
    /// The layers are slices of a three-dimensional texture: each level has half as many.
    slices: bool,
}

impl Row {
    /// Number of layers of a level.
    fn layers_of(&self, mip: u32) -> u32 {
        if self.slices { self.layers.checked_shr(mip).unwrap_or(0).max(1) } else { self.layers }
    }
}

impl Subresources {
    /// Numbers the parts of `graph` for a frame of `frame` texels.
    pub(super) fn of_graph(graph: &Graph, frame: [u32; 2]) -> Self {
        let mut total = 0;
        let mut rows = Vec::with_capacity(graph.resources().len());
        let mut borders: BTreeMap<ResourceId, BTreeSet<u64>> = BTreeMap::new();
        for range in graph.byte_ranges() {
            borders.entry(range.resource).or_default().extend([range.offset, range.offset + range.bytes]);
        }
        for (id, own) in &mut borders {
            let size = graph.resources()[id.index()].desc.bytes(frame);
            own.insert(0);
            own.retain(|border| *border < size);
        }
        let layer = |of: ResourceId, byte: u64| borders[&of].range(..byte).count() as u32;
        let bytes = graph.byte_ranges().iter();
        let bytes = bytes.map(|b| layer(b.resource, b.offset)..layer(b.resource, b.offset + b.bytes)).collect();
        for (id, resource) in graph.resource_ids().zip(graph.resources()) {
            let mut row = Row { first: total, mips: 1, layers: 1, planes: 1, format: None, slices: false };
            if let Desc::Texture(texture) = resource.desc {
                row.mips = texture.mip_count(frame);
                row.layers = texture.slices(0).max(1);
                row.slices = texture.dimension == Dimension::D3;
                let both = texture.format.has_depth() && texture.format.has_stencil();
                row.planes = if both { 2 } else { 1 };
                row.format = Some(texture.format);
            }
            row.layers = borders.get(&id).map_or(row.layers, |own| own.len() as u32);
            total += (row.mips * row.layers * row.planes) as usize;
            rows.push(row);
        }
        Self { rows, total, bytes }
    }

    /// Number of parts.
    pub(super) fn total(&self) -> usize {
        self.total
    }

    /// The numbers of a whole resource.
    pub(super) fn all(&self, resource: ResourceId) -> std::ops::Range<usize> {
        let row = self.rows[resource.index()];
        row.first..row.first + (row.mips * row.layers * row.planes) as usize
    }

    /// The numbers that a range of a resource covers, clipped to the resource.
    pub(super) fn covered(&self, resource: ResourceId, range: Range) -> impl Iterator<Item = usize> + Clone + use<> {
        let row = self.rows[resource.index()];
        let mips = range.mip_range(row.mips);
        let named = self.bytes.get(range.bytes.index()).cloned();
        let layers = named.unwrap_or_else(|| range.layer_range(row.layers));
        let mips = mips.start..mips.end.min(row.mips);
        mips.flat_map(move |mip| {
            let layers = layers.start..layers.end.min(row.layers_of(mip));
            layers.flat_map(move |layer| {
                let first = row.first + ((mip * row.layers + layer) * row.planes) as usize;
                let planes = (0..row.planes)
                    .filter(move |plane| row.format.is_none_or(|f| range.aspect.selects_plane(f, *plane)));
                planes.map(move |plane| first + plane as usize)
            })
        })
    }

    /// The numbers of the parts whose contents an access reads or keeps: its range, or the whole level of a slice.
    pub(super) fn kept(&self, access: &Access) -> impl Iterator<Item = usize> + Clone + use<> {
        self.covered(access.resource, whole_levels(access.range))
    }

    /// Level, layer and plane of the part with this number.
    pub(super) fn name(&self, resource: ResourceId, part: usize) -> Subresource {
        let row = self.rows[resource.index()];
        let within = (part - row.first) as u32;
        Subresource {
            mip: within / (row.layers * row.planes),
            layer: within / row.planes % row.layers,
            plane: within % row.planes,
        }
    }

    /// Number of levels, layers and planes of a resource. The slices of a level are one layer, as for barriers.
    pub(super) fn counts(&self, resource: ResourceId) -> [u32; 3] {
        let row = self.rows[resource.index()];
        [row.mips, if row.slices { 1 } else { row.layers }, row.planes]
    }
}

/// Returns the range with all slices of its levels, if it is a slice of a three-dimensional texture.
pub(super) fn whole_levels(range: Range) -> Range {
    if range.slice { Range { layer: 0, layers: u16::MAX, slice: false, ..range } } else { range }
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph::format::Aspect;
    use framegraph::resource::{Extent, TextureDesc};

    #[test]
    fn every_subresource_has_one_number() {
        let mut graph = Graph::new();
        graph.texture("a", TextureDesc::new(Extent::FRAME, Format::R8Unorm));
        let ds = TextureDesc::new(Extent::absolute(8, 8), Format::Depth32FloatStencil8);
        graph.texture("b", ds.mips(3).layers(2));
        let parts = Subresources::of_graph(&graph, [4, 4]);
        let b = ResourceId::at(1);
        assert_eq!((parts.total(), parts.all(b)), (13, 1..13));
        for aspect in [Aspect::Depth, Aspect::Stencil] {
            let range = Range { mip: 1, mips: 1, layer: 1, layers: 1, aspect, ..Range::ALL };
            let found: Vec<_> = parts.covered(b, range).collect();
            let plane = u32::from(aspect == Aspect::Stencil);
            let name = Subresource { mip: 1, layer: 1, plane };
            assert_eq!(found.len(), 1);
            assert_eq!(parts.name(b, found[0]), name);
        }
        assert_eq!(parts.covered(b, Range::ALL).count(), 12);
        let last = Range { mip: 2, mips: 9, ..Range::ALL };
        assert_eq!(parts.covered(b, last).collect::<Vec<_>>(), [9, 10, 11, 12]);
    }

    #[test]
    fn every_slice_has_one_number() {
        let mut graph = Graph::new();
        let desc = TextureDesc::new(Extent::absolute(8, 8), Format::Rgba8Unorm).mips(3).layers(4);
        graph.texture("volume", TextureDesc { dimension: Dimension::D3, ..desc });
        let parts = Subresources::of_graph(&graph, [4, 4]);
        let (volume, mip) = (ResourceId::at(0), |mip| Range { mip, mips: 1, ..Range::ALL });
        let slice = Range { layer: 1, layers: 1, slice: true, ..mip(1) };
        assert_eq!(parts.covered(volume, slice).collect::<Vec<_>>(), [5]);
        assert_eq!(parts.covered(volume, whole_levels(slice)).collect::<Vec<_>>(), [4, 5]);
        assert_eq!(parts.covered(volume, mip(2)).collect::<Vec<_>>(), [8]);
        assert_eq!(parts.counts(volume), [3, 1, 1]);
    }
}
