//! What the frame would cost on a device that is not here.

use crate::run::{Failure, input};
use crate::table::{aligned, mebibytes};
use framegraph::file::caps;
use framegraph::{Caps, Graph, Options, Plan, Scratch, compile};
use program::input::{MOST_TEXT_BYTES, text};
use std::path::Path;

/// A device by the name of a preset, or from a file.
///
/// # Errors
/// One line that names the option, and the file with the place.
pub fn device(which: &str) -> Result<Caps, Failure> {
    if let Some(caps) = Caps::preset(which) {
        return Ok(caps);
    }
    if Path::new(which).extension().is_none_or(|ending| ending != "ron") {
        let known = Caps::PRESETS.join(", ");
        return Err(input(format!("--what-if {which}: no such device; there are {known}, or a FILE.ron")));
    }
    let text = text(Path::new(which), MOST_TEXT_BYTES).map_err(|error| input(format!("--what-if {error}")))?;
    caps(which, &text).map_err(|error| input(format!("--what-if {error}")))
}

/// A table of the plan's counts for this device and for another.
///
/// # Errors
/// When that one cannot hold the frame.
pub fn table(caps: &Caps, graph: &Graph, options: &Options, plan: &Plan) -> Result<String, Failure> {
    let mut other = Plan::new();
    compile(graph, caps, options, &mut Scratch::new(), &mut other)
        .map_err(|error| input(format!("--what-if {}: {error}", caps.name)))?;
    let head = ["device", "steps", "unresolves", "resolves", "loaded", "stored", "memoryless", "memory"];
    let mut rows = vec![head.map(String::from)];
    for plan in [plan, &other] {
        let (counts, traffic, memory) = (plan.counts(), plan.traffic(plan.frame()), plan.memory());
        rows.push([
            plan.caps().name.clone(),
            counts.steps.to_string(),
            counts.unresolves.to_string(),
            counts.resolves.to_string(),
            mebibytes(traffic.loaded_bytes),
            mebibytes(traffic.stored_bytes),
            counts.memoryless.to_string(),
            mebibytes(memory.bytes + memory.own_bytes),
        ]);
    }
    Ok(format!("\n{}", aligned(&rows, 1)))
}
