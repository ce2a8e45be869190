//! A write to a history image of an earlier frame.

use framegraph::{Graph, Intent, Previous};

fn declare(graph: &mut Graph, last_frame: Previous) {
    let _ = graph.add_fn("accumulate", |pass| pass.storage_write(last_frame, Intent::Modify));
}

fn main() {}
