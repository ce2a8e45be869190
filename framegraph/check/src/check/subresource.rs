//! The oracle's numbering of parts.
//!
//! Every level × layer × plane of every resource has the number `first + (mip · layers + layer) · planes + plane`. A
//! buffer with declared byte ranges has one layer for each section between ends of such ranges.

use super::finding::Subresource;
use framegraph::access::Range;
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
            let mut row = Row { first: total, mips: 1, layers: 1, planes: 1, format: None };
            if let Desc::Texture(texture) = resource.desc {
                row.mips = texture.mip_count(frame);
                if texture.dimension == Dimension::D2 {
                    row.layers = u32::from(texture.layers);
                }
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
        // A slice of a three-dimensional texture is a part of its only layer.
        let layers = if row.layers == 1 { 0..1 } else { layers.start..layers.end.min(row.layers) };
        let mips = mips.start..mips.end.min(row.mips);
        mips.flat_map(move |mip| {
            layers.clone().flat_map(move |layer| {
                let first = row.first + ((mip * row.layers + layer) * row.planes) as usize;
                let planes = (0..row.planes)
                    .filter(move |plane| row.format.is_none_or(|f| range.aspect.selects_plane(f, *plane)));
                planes.map(move |plane| first + plane as usize)
            })
        })
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

    /// Number of levels and layers of a resource.
    pub(super) fn counts(&self, resource: ResourceId) -> (u32, u32) {
        let row = self.rows[resource.index()];
        (row.mips, row.layers)
    }
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
}
