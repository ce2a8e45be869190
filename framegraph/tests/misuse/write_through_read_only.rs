//! A write through a view that may only be read.

use framegraph::{Graph, Intent, Texture};

fn declare(graph: &mut Graph, hdr: Texture) {
    let hdr = hdr.read_only();
    let _ = graph.add_fn("bloom", |pass| pass.color(hdr, Intent::Modify));
}

fn main() {}
