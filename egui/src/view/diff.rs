//! Differences between two plans: passes, culling, merging, totals and resources.
//!
//! [`framegraph::diff()`] compares plans of this process, while here one or both may be saved. A test compares the results
//! of both.

use super::format::{bytes, change, cost_ink, label};
use crate::drawing::{Align, Drawing, Ink, Item, text_width, wrapped};
use crate::plan_data::{Pass, PlanData, Resource, Step};
use std::collections::BTreeSet;

/// Differences between two plans.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Changes {
    /// Passes only in the second plan.
    pub passes_added: Vec<String>,
    /// Passes only in the first plan.
    pub passes_removed: Vec<String>,
    /// Passes culled in only one plan: name, whether it is culled now, and the reason.
    pub culls: Vec<(String, bool, String)>,
    /// Passes that run in both plans, with the other passes of their steps before and after, if these differ.
    pub merges: Vec<(String, Vec<String>, Vec<String>)>,
    /// Changed totals: name, before, after, and whether they count bytes.
    pub totals: Vec<(&'static str, u64, u64, bool)>,
    /// Resources only in the second plan.
    pub resources_added: Vec<String>,
    /// Resources only in the first plan.
    pub resources_removed: Vec<String>,
    /// Resources in both plans with different shape, size or placement: name, before, after.
    pub resources: Vec<(String, String, String)>,
}

impl Changes {
    /// Returns whether nothing changed.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// Compares two plans. Passes and resources are matched by name.
pub fn changes(before: &PlanData, after: &PlanData) -> Changes {
    let (b, a) = (&before.form, &after.form);
    let pass_names = |of: &[Pass]| of.iter().map(|p| p.name.clone()).collect::<Vec<_>>();
    let resource_names = |of: &[Resource]| of.iter().map(|r| r.name.clone()).collect::<Vec<_>>();
    let (passes_removed, passes_added) = apart(&pass_names(&b.passes), &pass_names(&a.passes));
    let (resources_removed, resources_added) = apart(&resource_names(&b.resources), &resource_names(&a.resources));
    let mut out = Changes { passes_added, passes_removed, resources_added, resources_removed, ..Changes::default() };
    for old in &b.passes {
        let Some(new) = after.pass(&old.name).map(|index| &a.passes[index]) else { continue };
        if old.culled != new.culled {
            out.culls.push((old.name.clone(), new.culled, new.reason.clone()));
        }
        let (Some(was), Some(is)) = (old.step, new.step) else { continue };
        let (was, is) = (others(&b.steps[was], old), others(&a.steps[is], new));
        if was != is && !old.culled && !new.culled {
            out.merges.push((old.name.clone(), was, is));
        }
    }
    for ((name, was, is_bytes), (_, is, _)) in b.totals.rows().into_iter().zip(a.totals.rows()) {
        if was != is {
            out.totals.push((name, was, is, is_bytes));
        }
    }
    for old in &b.resources {
        let Some(new) = after.resource(&old.name).map(|index| &a.resources[index]) else { continue };
        let words = |r: &Resource| format!("{}, {}, {}", r.shape, bytes(r.bytes), r.placement);
        if (&old.shape, old.bytes, &old.placement) != (&new.shape, new.bytes, &new.placement) {
            out.resources.push((old.name.clone(), words(old), words(new)));
        }
    }
    out
}

/// Returns the unmatched names of both lists, once per missing match.
fn apart(before: &[String], after: &[String]) -> (Vec<String>, Vec<String>) {
    let only = |these: &[String], others: &[String]| {
        let mut left = std::collections::HashMap::<&str, usize>::new();
        others.iter().for_each(|name| *left.entry(name).or_default() += 1);
        let unmatched = |name: &&String| match left.get_mut(name.as_str()) {
            Some(count) if *count > 0 => {
                *count -= 1;
                false
            }
            _ => true,
        };
        these.iter().filter(unmatched).cloned().collect()
    };
    (only(before, after), only(after, before))
}

/// Returns the other passes of a step.
fn others(step: &Step, pass: &Pass) -> Vec<String> {
    step.passes.iter().filter(|name| **name != pass.name).cloned().collect()
}

/// Draws the differences as lists and a table.
pub fn drawing(before: Option<&PlanData>, after: &PlanData) -> Drawing {
    let mut drawing = Drawing::default();
    let Some(before) = before else {
        let words = "Nothing to compare with: open a second plan for comparison, or change the what-if";
        drawing.text([0.0, 10.0], 12.0, Ink::Faint, words);
        return drawing;
    };
    let called = |plan: &PlanData| {
        let form = &plan.form;
        let [w, h] = form.frame;
        let name = if form.name.is_empty() { "frame" } else { &form.name };
        format!("{name}, {} at {w}x{h}, {} steps", form.caps, form.totals.steps)
    };
    drawing.text([0.0, 10.0], 15.0, Ink::Text, format!("before: {}", called(before)));
    drawing.text([0.0, 32.0], 15.0, Ink::Text, format!("after:  {}", called(after)));
    let changes = changes(before, after);
    if changes.is_empty() {
        drawing.text([0.0, 64.0], 13.0, Ink::Text, "no differences");
        return drawing;
    }
    let y = figures(&changes, &mut drawing, 66.0);
    lists(&changes, after, &mut drawing, y + 12.0);
    drawing
}

/// Draws the changed totals.
fn figures(changes: &Changes, drawing: &mut Drawing, mut y: f32) -> f32 {
    const COLUMNS: [f32; 3] = [360.0, 480.0, 600.0];
    for (x, name) in COLUMNS.into_iter().zip(["before", "after", "change"]) {
        drawing.aligned([x, y], 12.0, Align::Right, Ink::Faint, name);
    }
    drawing.text([0.0, y], 12.0, Ink::Faint, "total");
    for &(name, was, is, is_bytes) in &changes.totals {
        y += 19.0;
        drawing.text([0.0, y], 12.0, Ink::Text, label(name));
        let word = |count: u64| if is_bytes { bytes(count) } else { count.to_string() };
        let ink = cost_ink(name, was, is);
        drawing.aligned([COLUMNS[0], y], 12.0, Align::Right, Ink::Text, word(was));
        drawing.aligned([COLUMNS[1], y], 12.0, Align::Right, Ink::Text, word(is));
        drawing.aligned([COLUMNS[2], y], 12.0, Align::Right, ink, change(was, is, is_bytes));
    }
    y + 26.0
}

/// Draws the lists of changed passes and resources.
fn lists(changes: &Changes, after: &PlanData, drawing: &mut Drawing, mut y: f32) {
    let plain = |names: &[String]| names.iter().map(|n| (n.clone(), n.clone())).collect::<Vec<_>>();
    let with = |names: &[String]| if names.is_empty() { "alone".into() } else { format!("with {}", names.join(", ")) };
    let culls = |culled: bool| {
        let of = changes.culls.iter().filter(move |(_, now, _)| *now == culled);
        of.map(|(name, _, why)| (name.clone(), format!("{name}: {why}"))).collect::<Vec<_>>()
    };
    let merges = changes.merges.iter();
    let merges = merges.map(|(name, was, is)| (name.clone(), format!("{name}: {}, now {}", with(was), with(is))));
    let resources = changes.resources.iter();
    let resources = resources.map(|(name, was, is)| (name.clone(), format!("{name}: {was} → {is}")));
    let lists = [
        ("added passes", '+', plain(&changes.passes_added)),
        ("removed passes", '-', plain(&changes.passes_removed)),
        ("passes no longer culled", '+', culls(false)),
        ("newly culled passes", '-', culls(true)),
        ("passes merged differently", '~', merges.collect()),
        ("added resources", '+', plain(&changes.resources_added)),
        ("removed resources", '-', plain(&changes.resources_removed)),
        ("changed resources", '~', resources.collect()),
    ];
    for (title, sign, rows) in lists.into_iter().filter(|(.., rows)| !rows.is_empty()) {
        drawing.text([0.0, y], 13.0, Ink::Text, format!("{title} ({})", rows.len()));
        y += 20.0;
        let mut shown = BTreeSet::new();
        for (name, row) in rows.into_iter().filter(|(name, _)| shown.insert(name.clone())) {
            let item = after.pass(&name).map(Item::Pass).or(after.resource(&name).map(Item::Resource));
            for (line, words) in wrapped(&row, 120).into_iter().enumerate() {
                let sign = if line == 0 { sign } else { ' ' };
                let words = format!("{sign} {words}");
                let bounds = [0.0, y - 8.0, text_width(&words, 12.0), y + 8.0];
                drawing.text([0.0, y], 12.0, Ink::Text, words);
                drawing.hit(bounds, item, "");
                y += 17.0;
            }
        }
        y += 10.0;
    }
}
