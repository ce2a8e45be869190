//! Cost of the frame on another device.

use crate::run::{Failure, input};
use crate::table::{aligned, mebibytes};
use framegraph::file::caps;
use framegraph::{Caps, Graph, Options, Plan, Scratch, compile};
use program::input::{MAX_TEXT_BYTES, text};
use std::path::Path;

/// Returns the capabilities of a preset or of a device file.
///
/// # Errors
/// One line that names the option, and the place in the file.
pub fn device(which: &str) -> Result<Caps, Failure> {
    if let Some(caps) = Caps::preset(which) {
        return Ok(caps);
    }
    if Path::new(which).extension().is_none_or(|ending| ending != "ron") {
        let known = Caps::PRESETS.join(", ");
        return Err(input(format!("--what-if {which}: unknown device; expected {known}, or a FILE.ron")));
    }
    let text = text(Path::new(which), MAX_TEXT_BYTES).map_err(|error| input(format!("--what-if {error}")))?;
    caps(which, &text).map_err(|error| input(format!("--what-if {error}")))
}

/// Formats the plan's counts on this device and on another one.
///
/// # Errors
/// The other device cannot run the frame.
pub fn table(caps: &Caps, graph: &Graph, options: &Options, plan: &Plan) -> Result<String, Failure> {
    let mut other = Plan::new();
    compile(graph, caps, options, &mut Scratch::new(), &mut other)
        .map_err(|error| input(format!("--what-if {}: {error}", caps.name)))?;
    let head = ["device", "steps", "loads", "stores", "loaded", "stored", "memoryless", "memory"];
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
