//! A write without an intent.

use framegraph::{Graph, Texture};

fn declare(graph: &mut Graph, hdr: Texture) {
    let _ = graph.add_fn("scene", |pass| pass.color(hdr));
}

fn main() {}
