//! Vertices of a layer.

/// Space between nodes of a layer.
const NODE_GAP: f32 = 22.0;
/// Space between lines that pass a layer.
const LINE_GAP: f32 = 9.0;

/// Vertex of a layer: a node, or a bend of the edges of one source.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex {
    pub layer: usize,
    pub height: f32,
    pub bend: bool,
}

impl Vertex {
    /// Returns the minimum distance between the centers of two adjacent vertices.
    pub(super) fn apart(&self, other: &Self) -> f32 {
        let gap = if self.bend && other.bend { LINE_GAP } else { NODE_GAP };
        (self.height + other.height) / 2.0 + gap
    }
}
