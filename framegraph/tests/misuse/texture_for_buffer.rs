//! A texture instead of a buffer.

use framegraph::{AccessKind, Graph, Texture};

fn declare(graph: &mut Graph, hdr: Texture) {
    let _ = graph.add_fn("cull", |pass| pass.read_buffer(hdr, AccessKind::Uniform));
}

fn main() {}
