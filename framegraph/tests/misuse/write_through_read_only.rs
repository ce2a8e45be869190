//! A write through a read-only handle.

use framegraph::{Graph, Intent, Texture};

fn declare(graph: &mut Graph, hdr: Texture) {
    let hdr = hdr.read_only();
    let _ = graph.add_fn("bloom", |pass| pass.color(hdr, Intent::Modify));
}

fn main() {}
