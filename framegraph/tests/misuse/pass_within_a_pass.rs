//! A pass that is declared inside of another one.

use framegraph::{Graph, Intent, Texture};

fn declare(graph: &mut Graph, hdr: Texture) {
    let _ = graph.add_fn("outer", |pass| {
        graph.add_fn("inner", |pass| pass.color(hdr, Intent::Overwrite))?;
        pass.sampled(hdr)
    });
}

fn main() {}
