//! Mutants of steps, passes of steps and attachments.

use super::mutator::{Edit, Mutator};
use framegraph::graph::PassKind;
use framegraph::id::{ResourceId, Span, StepId};
use framegraph::internals::PlanArrays;
use framegraph::plan::{Attachment, Join, LoadOp, Role, Step, StepPass, StoreOp};
use framegraph::resolve::ResolveMode;

/// Visits mutants of `pass_steps`, `steps` and `step_passes`.
pub(super) fn steps(m: &mut Mutator<'_>) {
    let plan = m.plan;
    for (row, &step) in plan.pass_steps().iter().enumerate() {
        let others = plan.step_ids().chain([StepId::NONE, StepId::at(plan.steps().len())]);
        for other in others.filter(|s| *s != step) {
            m.with("pass_steps", row, |p| p.pass_steps[row] = other);
        }
    }
    for (row, step) in plan.steps().iter().enumerate() {
        for kind in [PassKind::Raster, PassKind::Compute, PassKind::Copy] {
            if kind != step.kind {
                m.with("step.kind", row, |p| p.steps[row].kind = kind);
            }
        }
        for edit in STEP_EDITS {
            m.with("step", row, |p| edit(&mut p.steps[row]));
        }
        if row + 1 < plan.steps().len() {
            m.with("step order", row, |p| exchange(p, row));
            m.with("step boundary", row, |p| {
                p.steps[row].passes.len += 1;
                p.steps[row + 1].passes.start += 1;
                p.steps[row + 1].passes.len -= 1;
            });
        }
    }
    for (row, member) in plan.step_passes().iter().enumerate() {
        for pass in plan.graph().pass_ids().filter(|p| *p != member.pass) {
            m.with("step_pass.pass", row, |p| p.step_passes[row].pass = pass);
        }
        for join in [Join::First, Join::Attachments, Join::SamePixel, Join::Inlined, Join::Resolve] {
            if join != member.join {
                m.with("step_pass.join", row, |p| p.step_passes[row].join = join);
            }
        }
        // A pass with a full-screen resolve occurs twice.
        if plan.step_passes().get(row + 1).is_some_and(|next| next.pass != member.pass) {
            m.with("pass order", row, |p| {
                let next = p.step_passes[row + 1].pass;
                p.step_passes[row + 1].pass = p.step_passes[row].pass;
                p.step_passes[row].pass = next;
                renumber(p);
            });
        }
        m.with("pass missing", row, |p| remove_pass(p, row));
    }
}

const STEP_EDITS: [fn(&mut Step); 9] = [
    |s| s.samples = s.samples.wrapping_add(1),
    |s| s.extent[0] = s.extent[0].wrapping_add(1),
    |s| s.extent[1] = s.extent[1].wrapping_add(1),
    |s| s.layers = s.layers.wrapping_add(1),
    |s| s.passes.start = s.passes.start.wrapping_add(1),
    |s| s.passes.len = s.passes.len.wrapping_add(1),
    |s| s.passes.len = s.passes.len.wrapping_sub(1),
    |s| s.attachments.start = s.attachments.start.wrapping_add(1),
    |s| s.attachments.len = s.attachments.len.wrapping_add(1),
];

/// Updates `pass_steps` after passes were moved.
fn renumber(p: &mut PlanArrays<'_>) {
    for (index, step) in p.steps.iter().enumerate() {
        for member in step.passes.of(p.step_passes).iter().filter(|m| m.join != Join::Resolve) {
            p.pass_steps[member.pass.index()] = StepId::at(index);
        }
    }
}

/// Exchanges a step with the next one, and updates all references.
fn exchange(p: &mut PlanArrays<'_>, row: usize) {
    let (a, b) = (p.steps[row], p.steps[row + 1]);
    let middle = |first: Span, second: Span| (first.len as usize, first.range().start..second.range().end);
    let (length, both) = middle(a.passes, b.passes);
    p.step_passes[both].rotate_left(length);
    let (length, both) = middle(a.attachments, b.attachments);
    p.attachments[both].rotate_left(length);
    p.steps[row] = Step {
        passes: Span { start: a.passes.start, ..b.passes },
        attachments: Span { start: a.attachments.start, ..b.attachments },
        ..b
    };
    p.steps[row + 1] = Step {
        passes: Span { start: a.passes.start + b.passes.len, ..a.passes },
        attachments: Span { start: a.attachments.start + b.attachments.len, ..a.attachments },
        ..a
    };
    renumber(p);
}

/// Removes a pass from its step, and the step if it is empty then.
fn remove_pass(p: &mut PlanArrays<'_>, row: usize) {
    let owns = |s: &Step| s.passes.range().contains(&row);
    let step = p.steps.iter().position(owns).expect("each pass belongs to a step");
    let member = p.step_passes.remove(row);
    if member.join != Join::Resolve {
        p.pass_steps[member.pass.index()] = StepId::NONE;
    }
    p.steps[step].passes.len -= 1;
    for later in &mut p.steps[step + 1..] {
        later.passes.start = later.passes.start.wrapping_sub(1);
    }
    if let Some(first) = p.steps[step].passes.of(p.step_passes).first().copied() {
        let start = p.steps[step].passes.start as usize;
        let join = Join::First;
        p.step_passes[start] = StepPass { join, ..first };
    }
}

/// Visits mutants of `attachments`.
pub(super) fn attachments(m: &mut Mutator<'_>) {
    let plan = m.plan;
    for (row, attachment) in plan.attachments().iter().enumerate() {
        let texture = |r: &ResourceId| plan.graph().resources()[r.index()].desc.texture().is_some();
        for other in plan.graph().resource_ids().filter(texture) {
            if other != attachment.resource {
                m.with("attachment.resource", row, |p| p.attachments[row].resource = other);
            }
        }
        for (field, edit) in ATTACHMENT_EDITS {
            m.with(field, row, |p| edit(&mut p.attachments[row]));
        }
        for role in roles(attachment.role) {
            m.with("attachment.role", row, |p| p.attachments[row].role = role);
        }
        let format = plan.format(attachment.resource);
        let one_plane = !format.is_some_and(|f| f.has_depth() && f.has_stencil());
        for load in [LoadOp::Load, LoadOp::Clear, LoadOp::DontCare] {
            if load != attachment.load {
                m.with("attachment.load", row, |p| {
                    p.attachments[row].load = load;
                    if one_plane {
                        p.attachments[row].stencil_load = load;
                    }
                });
            }
            if load != attachment.stencil_load {
                m.with("attachment.stencil_load", row, |p| {
                    p.attachments[row].stencil_load = load;
                });
            }
        }
        for store in [StoreOp::Store, StoreOp::Discard, StoreOp::None] {
            if store != attachment.store {
                m.with("attachment.store", row, |p| {
                    p.attachments[row].store = store;
                    if one_plane {
                        p.attachments[row].stencil_store = store;
                    }
                });
            }
            if store != attachment.stencil_store {
                m.with("attachment.stencil_store", row, |p| {
                    p.attachments[row].stencil_store = store;
                });
            }
        }
        let clears = (0..plan.graph().clears().len() as u32).chain([u32::MAX]);
        for clear in clears.filter(|c| *c != attachment.clear) {
            m.with("attachment.clear", row, |p| p.attachments[row].clear = clear);
        }
        let view = attachment.view.is_none().then_some(framegraph::Format::Rgba8Unorm);
        m.with("attachment.view", row, |p| p.attachments[row].view = view);
        m.with("attachment missing", row, |p| remove_attachment(p, row));
        m.with("attachment duplicated", row, |p| {
            let copy = p.attachments[row];
            p.attachments.insert(row, copy);
            let step = step_of(p, row);
            p.steps[step].attachments.len += 1;
            for later in &mut p.steps[step + 1..] {
                later.attachments.start = later.attachments.start.wrapping_add(1);
            }
        });
    }
}

const ATTACHMENT_EDITS: [Edit<Attachment>; 6] = [
    ("attachment.mip", |a| a.mip = a.mip.wrapping_add(1)),
    ("attachment.mip", |a| a.mip = a.mip.wrapping_sub(1)),
    ("attachment.layer", |a| a.layer = a.layer.wrapping_add(1)),
    ("attachment.layer", |a| a.layer = a.layer.wrapping_sub(1)),
    ("attachment.layers", |a| a.layers = a.layers.wrapping_add(1)),
    ("attachment.layers", |a| a.layers = a.layers.wrapping_sub(1)),
];

fn roles(role: Role) -> Vec<Role> {
    let modes = |make: fn(ResolveMode) -> Role| ResolveMode::ALL.into_iter().map(make);
    let own_mode = modes(Role::ResolveDepth).chain(match role {
        Role::ResolveTarget(slot, _) => ResolveMode::ALL.map(|mode| Role::ResolveTarget(slot, mode)).to_vec(),
        _ => Vec::new(),
    });
    let all = (0..4).flat_map(|s| [Role::Color(s), Role::ResolveTarget(s, ResolveMode::Average)]).chain(own_mode);
    let depth = [Role::Depth, Role::DepthReadOnly];
    all.chain(depth).filter(|r| *r != role).collect()
}

/// Returns the step that owns an attachment.
fn step_of(p: &PlanArrays<'_>, row: usize) -> usize {
    let owns = |s: &Step| s.attachments.range().contains(&row);
    p.steps.iter().position(owns).expect("each attachment belongs to a step")
}

fn remove_attachment(p: &mut PlanArrays<'_>, row: usize) {
    let step = step_of(p, row);
    p.attachments.remove(row);
    p.steps[step].attachments.len -= 1;
    for later in &mut p.steps[step + 1..] {
        later.attachments.start = later.attachments.start.wrapping_sub(1);
    }
}
