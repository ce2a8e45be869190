//! A builder that outlives its closure.

use framegraph::{Graph, PassBuilder};

fn declare(graph: &mut Graph) {
    let mut kept: Option<&mut PassBuilder<'_>> = None;
    let _ = graph.add_fn("late", |pass| {
        kept = Some(pass);
        Ok(())
    });
}

fn main() {}
