//! What stands in a layer.

/// Space between nodes of a layer.
const NODE_GAP: f32 = 22.0;
/// Lines that pass through a layer keep this apart.
const LINE_GAP: f32 = 9.0;

/// A node of a layer: one that was given, or a bend, where the edges of one source pass.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex {
    pub layer: usize,
    pub height: f32,
    pub bend: bool,
}

impl Vertex {
    /// How far the centers of two neighbours of a layer must be apart.
    pub(super) fn apart(&self, other: &Self) -> f32 {
        let gap = if self.bend && other.bend { LINE_GAP } else { NODE_GAP };
        (self.height + other.height) / 2.0 + gap
    }
}
