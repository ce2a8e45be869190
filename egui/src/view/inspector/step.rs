//! Inspector sections of a step, its attachments and barriers.

use super::section::{Line, Section};
use crate::drawing::Item;
use crate::plan_data::{Attachment, Barrier, PlanData, Step};
use crate::view::bandwidth;
use crate::view::format::bytes;

pub(super) fn sections(plan: &PlanData, index: usize) -> Vec<Section> {
    let step = &plan.form.steps[index];
    let [w, h] = step.extent;
    let mut head = Section::new(format!("step {index}"));
    let resolve = if step.full_screen_resolve { ", a full-screen resolve" } else { "" };
    head.say(format!("{}{resolve}, {w}x{h}, {} layers, {} samples", step.kind, step.layers, step.samples));
    for name in &step.passes {
        head.lines.extend(plan.pass(name).map(|pass| {
            let pass_row = &plan.form.passes[pass];
            let join = pass_row.join.as_deref().unwrap_or("first").replace('_', " ");
            Line::Link(Item::Pass(pass), format!("{name} ({join}): {}", pass_row.reason))
        }));
    }
    let mut cost = Section::new("bytes");
    let moved = bandwidth::of_step(plan, step);
    cost.say(format!("loads: {}, {}", step.unresolves, bytes(moved.loaded)));
    cost.say(format!("stores: {}, {}", step.resolves, bytes(step.resolve_bytes)));
    if moved.resolved > 0 {
        cost.say(format!("including multisample resolve targets: {}", bytes(moved.resolved)));
    }
    cost.say(format!("fetches: at most {}, each level, layer and buffer once", bytes(moved.fetched)));
    if let Some(peak) = plan.form.peak.as_ref().filter(|peak| peak.step == index) {
        cost.say(format!("memory peak: {}", peak.resources.join(", ")));
    }
    vec![head, cost, attachments(plan, step, step.attachments.iter()), barriers(plan, |b| b.before_step == index)]
}

/// Returns the load and store of attachments with reasons and hints.
pub(super) fn attachments<'a>(
    plan: &PlanData,
    step: &Step,
    attachments: impl Iterator<Item = &'a Attachment>,
) -> Section {
    let mut section = Section::new("attachments");
    for attachment in attachments {
        let Attachment { resource, role, slot, load, store, mip, layer, .. } = attachment;
        let slot = slot.map(|slot| format!(" {slot}")).unwrap_or_default();
        let view = attachment.view.as_ref().map(|view| format!(" as {view}")).unwrap_or_default();
        let words = format!(
            "{}{slot}: {resource}, mip {mip}, layer {layer}{view}: load {}, store {}",
            role.replace('_', " "),
            if load == "dont_care" { "don't care" } else { load },
            store
        );
        section.lines.push(match plan.resource(resource) {
            Some(index) => Line::Link(Item::Resource(index), words),
            None => Line::Plain(words),
        });
        for (about, reason, moved) in [
            ("load", &attachment.load_reason, attachment.unresolve_bytes),
            ("store", &attachment.store_reason, attachment.resolve_bytes),
        ] {
            let cost = if moved > 0 { format!(" ({})", bytes(moved)) } else { String::new() };
            section.say(format!("  {about}: {reason}{cost}"));
            let hint = plan
                .form
                .decisions
                .iter()
                .find(|d| d.about == about && d.step == Some(step.index) && d.resource.as_ref() == Some(resource));
            section.lines.extend(hint.and_then(|d| d.hint.clone()).map(Line::Hint));
        }
    }
    section
}

/// Returns the layout transitions and aliasing barriers.
pub(super) fn barriers(plan: &PlanData, is: impl Fn(&Barrier) -> bool) -> Section {
    let mut section = Section::new("barriers");
    for barrier in plan.form.barriers.iter().filter(|b| is(b)) {
        let stages = |stages: &[String]| if stages.is_empty() { "-".to_owned() } else { stages.join("+") };
        let (waiting, from) = (stages(&barrier.to_stages), stages(&barrier.from_stages));
        let wait = match barrier.after_step {
            Some(step) => format!("{waiting} waits for {from} of step {step}"),
            None => format!("{waiting} waits for {from}, initial layout"),
        };
        let over = barrier.hand_over.as_ref().map(|r| format!(", takes memory over from {r}")).unwrap_or_default();
        section.say(format!(
            "before step {}: {} from {} to {}; {wait}{over}",
            barrier.before_step,
            barrier.resource,
            barrier.from.replace('_', " "),
            barrier.to.replace('_', " "),
        ));
    }
    section
}
