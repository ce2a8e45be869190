//! Inspector sections of a pass.

use super::section::{Line, Section};
use super::step;
use crate::drawing::Item;
use crate::plan_data::PlanData;

pub(super) fn sections(plan: &PlanData, index: usize) -> Vec<Section> {
    let pass = &plan.form.passes[index];
    let mut head = Section::new(format!("pass {}", pass.name));
    head.say(format!("{} pass", pass.kind));
    match (pass.culled, pass.step) {
        (false, Some(at)) => {
            let step = &plan.form.steps[at];
            let others: Vec<_> = step.passes.iter().filter(|name| **name != pass.name).map(String::as_str).collect();
            let with = if others.is_empty() { String::new() } else { format!(", with {}", others.join(", ")) };
            let how = match pass.join.as_deref() {
                Some("attachments") => ", merged: shared attachments",
                Some("same_pixel") => ", merged: same-pixel reads in the tile",
                Some("inlined") => ", inlined into the shader of the previous pass",
                _ => "",
            };
            head.link(Item::Step(at), format!("runs in step {at}{with}{how}"));
        }
        _ => head.say("culled: does not run"),
    }
    if let Some(place) = plan.declared_at.get(index).filter(|place| !place.is_empty()) {
        head.lines.push(Line::Source(place.clone()));
    }
    let mut why = Section::new("decisions");
    let of_pass = |pass: &Option<String>, name: &str| pass.as_deref() == Some(name);
    for decision in plan.form.decisions.iter().filter(|d| d.about == "pass" && of_pass(&d.pass, &pass.name)) {
        why.decide(decision);
    }
    let mut elsewhere = Section::new("mentioned by other decisions");
    for decision in plan.form.decisions.iter().filter(|d| of_pass(&d.other_pass, &pass.name)) {
        let about = decision.pass.as_ref().or(decision.resource.as_ref());
        elsewhere.say(format!("{}: {}", about.map_or("", |a| a), decision.sentence));
    }
    let mut accesses = Section::new("accesses");
    for access in &pass.accesses {
        let part = access.part.as_ref().map(|part| format!(" ({part})")).unwrap_or_default();
        let words = format!("{} {} {}{part}", access.mode, access.kind.replace('_', " "), access.resource);
        accesses.lines.push(match plan.resource(&access.resource) {
            Some(resource) => Line::Link(Item::Resource(resource), words),
            None => Line::Plain(words),
        });
    }
    let mut sections = vec![head, why, accesses];
    if let Some(row) = pass.step.filter(|_| !pass.culled).map(|at| &plan.form.steps[at]) {
        let used = |resource: &str| pass.accesses.iter().any(|a| a.resource == resource);
        let attached = row.attachments.iter().filter(|a| used(&a.resource));
        sections.push(step::attachments(plan, row, attached));
        sections.push(step::barriers(plan, |b| b.before_step == row.index && used(&b.resource)));
    }
    sections.push(elsewhere);
    sections
}
