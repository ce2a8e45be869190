//! The earlier image of what is no history: buffers have none.

use framegraph::{Buffer, Graph};

fn declare(graph: &mut Graph, particles: Buffer) {
    let _ = graph.previous(particles, 1);
}

fn main() {}
