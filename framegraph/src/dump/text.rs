//! Plans as text, for golden tests and for `render --plan`.

use super::describe::{bytes, joined, part, place, role_words, shape, uses, written};
use crate::barrier::{Barrier, Stages};
use crate::format::Aspect;
use crate::id::{ResourceId, StepId};
use crate::plan::{Attachment, Join, Placement, Plan};
use crate::sanitize::escape_controls;
use std::fmt::Write;

/// Version of the format, printed in the first line.
pub const TEXT_VERSION: u32 = 2;

/// Returns the plan as text: totals, steps with their attachments, resources, barriers and all decisions.
pub fn text(plan: &Plan) -> String {
    written(|out| write(plan, out))
}

fn write(plan: &Plan, out: &mut String) -> std::fmt::Result {
    let [w, h] = plan.frame();
    let counts = plan.counts();
    let traffic = plan.traffic(plan.frame());
    let memory = plan.memory();
    writeln!(out, "plan {TEXT_VERSION} for {} at {w}x{h}", escape_controls(&plan.caps().name))?;
    writeln!(
        out,
        "counts: {} loads, {} stores, {} clears, {} discards, {} multisample resolves, {} memoryless, {} inlined, \
         {} steps, {} passes, {} culled",
        counts.unresolves,
        counts.resolves,
        counts.clears,
        counts.discards,
        counts.multisample_resolves,
        counts.memoryless,
        counts.inlined,
        counts.steps,
        counts.passes,
        counts.culled,
    )?;
    writeln!(out, "traffic: {} B loaded, {} B stored", traffic.loaded_bytes, traffic.stored_bytes)?;
    let proved = if memory.optimal { ", optimal" } else { "" };
    writeln!(
        out,
        "memory: {} B of {} B unaliased, lower bound {} B{proved}; {} B avoided, {} B outlive the frame",
        memory.bytes, memory.unaliased_bytes, memory.lower_bound_bytes, memory.avoided_bytes, memory.own_bytes,
    )?;
    for warning in plan.warnings() {
        writeln!(out, "warning: {}", warning.sentence())?;
    }
    writeln!(out, "\nsteps:")?;
    for step in plan.step_ids() {
        write_step(plan, step, out)?;
    }
    writeln!(out, "\nresources:")?;
    for resource in plan.graph().resource_ids() {
        write_resource(plan, resource, out)?;
    }
    if !plan.barriers().is_empty() {
        writeln!(out, "\nbarriers:")?;
    }
    for barrier in plan.barriers() {
        write_barrier(plan, barrier, out)?;
    }
    writeln!(out, "\ndecisions:")?;
    for (about, note) in plan.graph().notes() {
        writeln!(out, "  effect `{}`: {}", escape_controls(about), escape_controls(note))?;
    }
    for decision in plan.decisions() {
        writeln!(out, "  {}", plan.explained(decision))?;
    }
    Ok(())
}

fn write_step(plan: &Plan, step: StepId, out: &mut String) -> std::fmt::Result {
    let graph = plan.graph();
    let row = &plan.steps()[step.index()];
    write!(out, "  {} {}", step.index(), row.kind.word())?;
    if row.extent != [0; 2] {
        let [w, h] = row.extent;
        write!(out, " {w}x{h} samples {}", row.samples)?;
        if row.layers > 1 {
            write!(out, " layers {}", row.layers)?;
        }
    }
    writeln!(out)?;
    for member in plan.passes_of(step) {
        let how = match joined(member.join) {
            "" => String::new(),
            how => format!(" ({how})"),
        };
        writeln!(out, "    pass {}{how}", escape_controls(graph.pass_name(member.pass)))?;
        for (samples, _) in plan.full_screen_resolves(step) {
            writeln!(out, "      read sampled {}", escape_controls(graph.resource_name(samples.resource)))?;
        }
        let drawn = member.join != Join::Resolve;
        for access in graph.accesses_of(member.pass).iter().filter(|a| drawn && !a.kind.is_attachment()) {
            writeln!(
                out,
                "      {} {} {}{}",
                access.mode.word(),
                access.kind.word(),
                escape_controls(graph.resource_name(access.resource)),
                part(&access.range, graph.bytes_of(access)),
            )?;
        }
    }
    for attachment in plan.attachments_of(step) {
        writeln!(out, "    {}", attachment_line(plan, attachment))?;
    }
    Ok(())
}

/// Writes a barrier: step, subresources, states, stages, and the previous resource in the same memory.
fn write_barrier(plan: &Plan, barrier: &Barrier, out: &mut String) -> std::fmt::Result {
    let Barrier { before, resource, first_part, parts, from, to, from_stages, to_stages, after, aliases } = *barrier;
    let graph = plan.graph();
    let stages = |s: Stages| s.names().collect::<Vec<_>>().join("+");
    write!(out, "  before step {}: {}", before.index(), escape_controls(graph.resource_name(resource)))?;
    if parts != graph.resources()[resource.index()].desc.subresources(plan.frame()) {
        write!(out, " parts {first_part}..{}", first_part + parts)?;
    }
    write!(out, " {from:?} -> {to:?}, [{}] -> [{}]", stages(from_stages), stages(to_stages))?;
    if let Some(after) = after.some() {
        write!(out, " after step {}", after.index())?;
    }
    if let Some(tenant) = aliases.some() {
        write!(out, ", aliases {}", escape_controls(graph.resource_name(tenant)))?;
    }
    writeln!(out)
}

/// Returns one attachment: role, name, range and operations.
fn attachment_line(plan: &Plan, attachment: &Attachment) -> String {
    let graph = plan.graph();
    let name = escape_controls(graph.resource_name(attachment.resource));
    let mut line = format!("{}: {name}", role_words(attachment.role));
    if let Some(texture) = graph.resources()[attachment.resource.index()].desc.texture() {
        if texture.mip_count(plan.frame()) > 1 {
            line += &format!(" mip {}", attachment.mip);
        }
        if texture.tracked_layers() > u32::from(attachment.layers) {
            line += &format!(" layer {}", attachment.layer);
        }
    }
    if let Some(view) = attachment.view {
        line += &format!(" as {view:?}");
    }
    line += &format!(" {} -> {}", attachment.load.word(), attachment.store.word());
    if let Some((load, store)) = plan.format(attachment.resource).and_then(|f| attachment.ops(f, Aspect::Stencil)) {
        line += &format!(", stencil {} -> {}", load.word(), store.word());
    }
    line
}

fn write_resource(plan: &Plan, resource: ResourceId, out: &mut String) -> std::fmt::Result {
    let graph = plan.graph();
    let declared = &graph.resources()[resource.index()];
    let row = &plan.resources()[resource.index()];
    write!(out, "  {}: {}", escape_controls(graph.resource_name(resource)), shape(plan, &declared.desc, row.format))?;
    if row.first.is_none() {
        return writeln!(out, ", {}", if row.placement == Placement::Inlined { "inlined" } else { "unused" });
    }
    write!(out, ", steps {}..{}, {}, {}", row.first.index(), row.last.index(), uses(row.usage), bytes(row.bytes))?;
    match row.placement {
        Placement::Heap { offset } => write!(out, ", heap offset {offset}"),
        Placement::Own => write!(out, ", own memory"),
        other => write!(out, ", {}", place(other)),
    }?;
    for other in graph.aliases_of(resource) {
        write!(out, ", may alias {}", escape_controls(graph.resource_name(other)))?;
    }
    writeln!(out)
}
