//! Plans as Graphviz graphs: steps as clusters of passes, resources as ellipses, reads and writes as edges.

use super::describe::{place, shape, written};
use crate::id::{PassId, ResourceId};
use crate::plan::{Join, Placement, Plan};
use crate::sanitize::escape_controls;
use std::fmt::Write;

/// Returns the plan in the DOT language.
///
/// Culled passes are dashed. An edge into a pass is a read, an edge out of it a write. Edges to attachments show load
/// and store operations.
pub fn dot(plan: &Plan) -> String {
    written(|out| write(plan, out))
}

fn write(plan: &Plan, out: &mut String) -> std::fmt::Result {
    let graph = plan.graph();
    writeln!(
        out,
        "digraph plan {{\n  rankdir=LR;\n  graph [fontname=\"sans-serif\", fontsize=10];\n  \
         node [fontname=\"sans-serif\", fontsize=10];\n  edge [fontname=\"sans-serif\", fontsize=9];"
    )?;
    for warning in plan.warnings() {
        writeln!(out, "  warning [shape=note, color=red, label=\"{}\"];", escaped(warning.sentence()))?;
    }
    for step in plan.step_ids() {
        writeln!(out, "  subgraph cluster_{0} {{\n    label=\"step {0}\"; style=rounded;", step.index())?;
        for member in plan.passes_of(step) {
            let (id, what) = if member.join == Join::Resolve { ("r", "\\nfull-screen resolve") } else { ("p", "") };
            let name = escaped(graph.pass_name(member.pass));
            writeln!(
                out,
                "    {id}{} [shape=box, style=filled, fillcolor=\"#ffe0b0\", label=\"{name}{what}\"];",
                member.pass.index()
            )?;
        }
        writeln!(out, "  }}")?;
    }
    for pass in graph.pass_ids().filter(|p| plan.is_culled(*p)) {
        let name = escaped(graph.pass_name(pass));
        writeln!(
            out,
            "  p{} [shape=box, style=dashed, color=gray, fontcolor=gray, label=\"{name}\\nculled\"];",
            pass.index()
        )?;
    }
    for resource in graph.resource_ids() {
        write_resource(plan, resource, out)?;
    }
    for pass in graph.pass_ids() {
        write_arrows(plan, pass, out)?;
    }
    writeln!(out, "}}")
}

fn write_resource(plan: &Plan, resource: ResourceId, out: &mut String) -> std::fmt::Result {
    let graph = plan.graph();
    let row = &plan.resources()[resource.index()];
    let color = match row.placement {
        Placement::Unused => "#eeeeee",
        Placement::Memoryless | Placement::Inlined => "#c8f0c8",
        Placement::External | Placement::Own => "#e0d0f0",
        Placement::Slot(_) | Placement::Heap { .. } => "#c8dcf0",
    };
    let name = escaped(graph.resource_name(resource));
    let shape = shape(plan, &graph.resources()[resource.index()].desc, row.format);
    let label = format!("{name}\\n{shape}\\n{}", place(row.placement));
    writeln!(out, "  r{} [shape=ellipse, style=filled, fillcolor=\"{color}\", label=\"{label}\"];", resource.index())
}

fn write_arrows(plan: &Plan, pass: PassId, out: &mut String) -> std::fmt::Result {
    let graph = plan.graph();
    let step = plan.pass_steps()[pass.index()].some();
    let style = if step.is_none() { ", style=dashed, color=gray" } else { "" };
    for access in graph.accesses_of(pass) {
        let (p, r) = (pass.index(), access.resource.index());
        let word = access.kind.word();
        if access.needs_contents() {
            writeln!(out, "  r{r} -> p{p} [label=\"{word}\"{style}];")?;
        }
        if access.mode.writes() {
            let ops = step.and_then(|s| plan.attachments_of(s).iter().find(|a| a.resource == access.resource));
            let ops = ops.map_or(String::new(), |a| format!("\\n{} / {}", a.load.word(), a.store.word()));
            writeln!(out, "  p{p} -> r{r} [label=\"{word}{ops}\"{style}];")?;
        }
    }
    Ok(())
}

fn escaped(name: &str) -> String {
    escape_controls(name).replace('\\', "\\\\").replace('"', "\\\"")
}
