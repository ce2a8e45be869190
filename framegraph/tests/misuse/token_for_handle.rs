//! The token of a read instead of the texture.

use framegraph::{Graph, Intent, Texture};

fn declare(graph: &mut Graph, hdr: Texture, ldr: Texture) {
    let _ = graph.add_fn("grade", |pass| {
        let view = pass.sampled(hdr)?;
        pass.resolve(view, ldr)
    });
    let _ = graph.add_fn("blend", |pass| {
        let view = pass.sampled(hdr)?;
        pass.color(view, Intent::Modify)
    });
}

fn main() {}
