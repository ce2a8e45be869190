//! A buffer instead of a texture.

use framegraph::{Buffer, Graph};

fn declare(graph: &mut Graph, lights: Buffer) {
    let _ = graph.add_fn("shade", |pass| pass.sampled(lights));
}

fn main() {}
