//! The previous image of a buffer, which has no history.

use framegraph::{Buffer, Graph};

fn declare(graph: &mut Graph, particles: Buffer) {
    let _ = graph.previous(particles, 1);
}

fn main() {}
