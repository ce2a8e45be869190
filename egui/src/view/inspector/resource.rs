//! Inspector sections of a resource.

use super::section::{Line, Section};
use super::step;
use crate::drawing::Item;
use crate::plan_data::PlanData;
use crate::view::format::bytes;

pub(super) fn sections(plan: &PlanData, index: usize) -> Vec<Section> {
    let form = &plan.form;
    let resource = &form.resources[index];
    let mut head = Section::new(format!("resource {}", resource.name));
    head.say(format!("{}: {}, {}", resource.kind, resource.shape, bytes(resource.bytes)));
    if let (Some(format), Some([w, h])) = (&resource.format, resource.extent) {
        let count = |count: Option<u64>| count.unwrap_or(1);
        head.say(format!(
            "texture {format}, {w}x{h}, {} mips, {} layers, {} samples",
            count(resource.mips),
            count(resource.layers),
            count(resource.samples)
        ));
    }
    if !resource.usage.is_empty() {
        head.say(format!("used as {}", resource.usage.join(", ")));
    }
    match (resource.first_step, resource.last_step) {
        (Some(first), Some(last)) => head.say(format!("lives from step {first} to step {last}")),
        _ => head.say("not used by any running pass"),
    }
    if let Some(entry) = &resource.entry {
        let holds = if entry.defined { "defined contents" } else { "undefined contents" };
        head.say(format!("import with {holds}, state {}; stages {}", entry.state, entry.stages.join("+")));
    }
    if let Some(exit) = &resource.exit {
        head.say(format!("exit: {exit}"));
    }
    if !resource.may_alias.is_empty() {
        head.say(format!("may alias {}", resource.may_alias.join(", ")));
    }
    let mut place = Section::new("memory");
    place.say(match (resource.placement.as_str(), resource.offset, resource.slot) {
        ("slot", _, Some(slot)) => {
            let tenants = form.slots[slot].tenants.join(", ");
            format!("slot {slot} of the pool, {}, shared by: {tenants}", bytes(form.slots[slot].bytes))
        }
        ("heap", Some(offset), _) => format!("heap, offset {offset} ({})", bytes(offset)),
        ("external", ..) => "external: memory of its owner".into(),
        ("own", ..) => "own memory: outlives the frame".into(),
        ("memoryless", ..) => "none: memoryless, never leaves the tile".into(),
        ("inlined", ..) => "none: its reader is inlined, so it does not exist".into(),
        (other, ..) => other.into(),
    });
    if let Some([first, last]) = resource.held_steps {
        place.say(format!("holds its memory from step {first} to step {last}"));
    }
    if form.peak.as_ref().is_some_and(|peak| peak.resources.contains(&resource.name)) {
        place.say("live at the memory peak");
    }
    for history in form.histories.iter().filter(|h| h.name == resource.name) {
        place.say(format!("history of {} images, {} each", history.images, bytes(history.image_bytes)));
        for previous in &history.previous {
            place.say(format!("{} is its image from {} frames ago", previous.resource, previous.age));
        }
    }
    let mut why = Section::new("decisions");
    for decision in form.decisions.iter().filter(|d| d.resource.as_ref() == Some(&resource.name)) {
        let place = decision.step.map(|s| format!("{} in step {s}: ", decision.about)).unwrap_or_default();
        why.say(format!("{place}{}", decision.sentence));
        why.lines.extend(decision.hint.clone().map(Line::Hint));
    }
    let mut path = Section::new("accesses");
    for (at, pass) in form.passes.iter().enumerate() {
        for access in pass.accesses.iter().filter(|a| a.resource == resource.name) {
            let part = access.part.as_ref().map(|part| format!(" ({part})")).unwrap_or_default();
            let where_ = pass.step.filter(|_| !pass.culled).map_or("culled".into(), |s| format!("step {s}"));
            let words = format!("{}: {} {}{part}, {where_}", pass.name, access.mode, access.kind.replace('_', " "));
            path.link(Item::Pass(at), words);
        }
    }
    let barriers = step::barriers(plan, |b| b.resource == resource.name);
    vec![head, place, path, why, barriers]
}
