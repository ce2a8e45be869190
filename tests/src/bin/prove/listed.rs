//! Frames of 22 and 46 resources on which peers' allocators are measured.

use crate::document::Document;
use crate::table::{Table, mebibytes};
use framegraph::file::GraphFile;
use framegraph::{Alias, Caps, Options, Plan, Scratch, compile};

const FORWARD: &str = include_str!("../../../cases/forward.ron");
const DEFERRED: &str = include_str!("../../../cases/deferred.ron");

/// Plans each frame with and without merging and memoryless attachments.
///
/// # Errors
/// A frame that cannot be read or planned.
pub fn section(document: &mut Document) -> Result<(), String> {
    let columns =
        ["frame", "resources", "size", "steps", "nothing shared, MiB", "pool, MiB", "heap, B", "lower bound, B"];
    let mut table = Table::new(&[&columns[..], &["proved"]].concat());
    let mut least = true;
    for (name, text) in [("forward.ron", FORWARD), ("deferred.ron", DEFERRED)] {
        let file = GraphFile::parse(name, text).map_err(|e| e.to_string())?;
        let graph = file.graph(&[]).map_err(|e| e.to_string())?;
        for ([width, height], plain) in
            [([1920, 1080], true), ([1920, 1080], false), ([3840, 2160], true), ([3840, 2160], false)]
        {
            let planned = |alias| {
                let mut options = Options { alias, ..Options::for_frame(width, height) };
                (options.merge, options.memoryless) = (!plain, !plain);
                let mut plan = Plan::new();
                let caps = if plain { Caps::desktop() } else { Caps::tiler() };
                let outcome = compile(&graph, &caps, &options, &mut Scratch::new(), &mut plan);
                outcome.map_err(|e| file.explain(&e).to_string()).map(|()| plan)
            };
            let (pool, heap) = (planned(Alias::Pool)?, planned(Alias::Heap)?);
            let memory = heap.memory();
            let proved = memory.bytes == memory.lower_bound_bytes && memory.optimal;
            least &= proved;
            table.row(vec![
                format!("{}{}", file.name(), if plain { ", passes apart" } else { ", tiler" }),
                (graph.resources().len() - 1).to_string(),
                format!("{width}x{height}"),
                heap.steps().len().to_string(),
                mebibytes(memory.unaliased_bytes),
                mebibytes(pool.memory().bytes),
                memory.bytes.to_string(),
                memory.lower_bound_bytes.to_string(),
                if proved { "yes" } else { "no" }.into(),
            ]);
        }
    }
    document.claim(least, || "a frame of 22 or 46 resources misses its lower bound".to_owned());
    let all = if least { "all reach" } else { "not all reach" };
    document.section(
        "The frames of 22 and 46 resources",
        &format!(
            "`tests/cases/forward.ron` and `deferred.ron`; {all} their lower bound. Passes apart: for a desktop device \
             without\nmerging, as peers count. Tiler: as planned for a tiler.\n\n{}",
            table.text()
        ),
    );
    Ok(())
}
