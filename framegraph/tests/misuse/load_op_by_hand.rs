//! A load op instead of an intent: loads and stores are derived.

use framegraph::{Graph, LoadOp, Texture};

fn declare(graph: &mut Graph, hdr: Texture) {
    let _ = graph.add_fn("scene", |pass| pass.color(hdr, LoadOp::DontCare));
}

fn main() {}
