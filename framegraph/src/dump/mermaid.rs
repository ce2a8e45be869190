//! Plans as Mermaid flow charts, which browsers, forges and notebooks can render.

use super::describe::{bytes, is_shared, joined, written};
use super::flow::{Flow, data_flow, reduced};
use crate::plan::{Join, Placement, Plan};
use crate::sanitize::escape_controls;
use std::fmt::Write;

/// Maximum number of passes for the transitive reduction of arrows, which is quadratic.
const MAX_REDUCED: usize = 2000;

/// Returns the plan as a Mermaid flow chart.
///
/// Steps are boxes of passes. Arrows show data dependencies, labeled with resources; implied arrows are omitted. Culled
/// passes are dashed.
pub fn mermaid(plan: &Plan) -> String {
    written(|out| write(plan, out))
}

fn write(plan: &Plan, out: &mut String) -> std::fmt::Result {
    let graph = plan.graph();
    writeln!(out, "flowchart LR")?;
    for warning in plan.warnings() {
        writeln!(out, "  warning[\"{}\"]:::culled", escaped(warning.sentence()))?;
    }
    for step in plan.step_ids() {
        let counts = plan.step_counts(step);
        let index = step.index();
        let ops = match (counts.unresolves, counts.resolves) {
            (0, 0) => String::new(),
            (loads, stores) => format!(": {loads} loads, {stores} stores"),
        };
        writeln!(out, "  subgraph s{index}[\"step {index}{ops}\"]")?;
        for member in plan.passes_of(step) {
            let name = escaped(graph.pass_name(member.pass));
            let how = if member.join == Join::First { "" } else { "<br/>" };
            let id = if member.join == Join::Resolve { "r" } else { "p" };
            writeln!(out, "    {id}{}[\"{name}{how}{}\"]", member.pass.index(), joined(member.join))?;
        }
        writeln!(out, "  end")?;
    }
    for pass in graph.pass_ids().filter(|p| plan.is_culled(*p)) {
        let name = escaped(graph.pass_name(pass));
        writeln!(out, "  p{}[\"{name}<br/>culled\"]:::culled", pass.index())?;
    }
    let (flows, passes) = (data_flow(graph), graph.passes().len());
    let flows = if passes <= MAX_REDUCED { reduced(&flows, passes) } else { flows };
    for Flow { from, to, resources } in flows {
        let label = |r: &crate::id::ResourceId| {
            let row = &plan.resources()[r.index()];
            let place = match row.placement {
                Placement::Memoryless => ", memoryless".to_owned(),
                Placement::Inlined => ", inlined".to_owned(),
                placement if is_shared(placement) => format!(", {}", bytes(row.bytes)),
                _ => String::new(),
            };
            format!("{}{place}", escaped(graph.resource_name(*r)))
        };
        let labels: Vec<_> = resources.iter().map(label).collect();
        let arrow = if plan.is_culled(from) || plan.is_culled(to) { "-.->" } else { "-->" };
        let labels = labels.join("<br/>");
        writeln!(out, "  p{} {arrow}|\"{labels}\"| p{}", from.index(), to.index())?;
    }
    writeln!(out, "  classDef culled fill:#eee,stroke:#999,stroke-dasharray:4,color:#666")
}

/// Escapes a name inside of quotes: special characters become entity codes.
fn escaped(name: &str) -> String {
    let mut out = String::with_capacity(name.len());
    for c in escape_controls(name).chars() {
        match c {
            '"' | '#' | '%' | '<' | '>' | '&' | '`' | '|' | ';' => {
                let _ = write!(out, "#{};", u32::from(c));
            }
            c => out.push(c),
        }
    }
    // Mermaid does not accept empty labels.
    if out.trim().is_empty() { "(no name)".into() } else { out }
}
