//! What changed between two plans: of two versions of a frame, two settings, two devices or two sizes.
//!
//! Passes and resources are matched by name (of several with one name, the first with the first), decisions by what they
//! are about; the decisions of a step go by the name of its first pass, since step numbers shift. [`diff`] gives data,
//! its `Display` a text of a line a change.

mod text;

use crate::dump::json::{DecisionView, PassView, ResourceView, View};
use crate::plan::Plan;
use std::collections::{BTreeMap, HashMap, HashSet};

/// Everything that changed from one plan, the *before*, to another, the *after*.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize))]
pub struct Diff {
    /// Passes that only the second has.
    pub passes_added: Vec<String>,
    /// Passes that only the first has.
    pub passes_removed: Vec<String>,
    /// Passes of both that run in one of them only.
    pub culls: Vec<CullChange>,
    /// Passes that run in both, and share their step with others than before.
    pub merges: Vec<MergeChange>,
    /// Counts and bytes of the whole plan that differ, in the order of the totals of the JSON form.
    pub totals: Vec<TotalChange>,
    /// Resources that only the second has.
    pub resources_added: Vec<String>,
    /// Resources that only the first has.
    pub resources_removed: Vec<String>,
    /// Resources of both that take other bytes, or live elsewhere.
    pub resources: Vec<ResourceChange>,
    /// Decisions about what both have, that were taken otherwise or for another reason.
    pub reasons: Vec<ReasonChange>,
}

/// A pass that was culled, or is no longer.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize))]
pub struct CullChange {
    /// The pass.
    pub pass: String,
    /// Whether it is culled now.
    pub culled: bool,
    /// Why, in the second plan.
    pub reason: String,
}

/// A pass whose step has other passes.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize))]
pub struct MergeChange {
    /// The pass.
    pub pass: String,
    /// The other passes of its step in the first plan.
    pub before: Vec<String>,
    /// The other passes of its step in the second plan.
    pub after: Vec<String>,
}

/// A sum over the plan that changed.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize))]
pub struct TotalChange {
    /// The field of [`Totals`](crate::dump::json::Totals).
    pub what: &'static str,
    /// In the first plan.
    pub before: u64,
    /// In the second plan.
    pub after: u64,
}

/// A resource that takes other bytes, or lives elsewhere.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize))]
pub struct ResourceChange {
    /// The resource.
    pub resource: String,
    /// Shape, bytes and kind of placement in the first plan.
    pub before: String,
    /// Shape, bytes and kind of placement in the second plan.
    pub after: String,
}

/// Decisions about one thing that changed.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize))]
pub struct ReasonChange {
    /// About what.
    pub about: String,
    /// The sentences of the first plan.
    pub before: Vec<String>,
    /// The sentences of the second plan.
    pub after: Vec<String>,
}

/// Compares two plans.
pub fn diff(before: &Plan, after: &Plan) -> Diff {
    diff_views(&View::new(before, ""), &View::new(after, ""))
}

/// Compares two plans by their views.
pub fn diff_views(before: &View, after: &View) -> Diff {
    let passes = Matched::new(&before.passes, &after.passes, |p| &p.name);
    let resources = Matched::new(&before.resources, &after.resources, |r| &r.name);
    Diff {
        culls: passes.both.iter().filter_map(|(a, b)| cull(a, b)).collect(),
        merges: passes.both.iter().filter_map(|(a, b)| merge(before, a, after, b)).collect(),
        totals: totals(before, after),
        resources: resources.both.iter().filter_map(|(a, b)| resource(a, b)).collect(),
        reasons: reasons(before, after, &passes, &resources),
        passes_added: passes.added,
        passes_removed: passes.removed,
        resources_added: resources.added,
        resources_removed: resources.removed,
    }
}

/// The version of the JSON form of a diff; it counts up whenever a field changes its meaning or goes.
pub const DIFF_VERSION: u32 = 1;

impl Diff {
    /// The diff as JSON text, indented, ending in a line feed; `docs/plan-json.md` documents the fields.
    #[cfg(feature = "files")]
    pub fn json(&self) -> String {
        #[derive(serde::Serialize)]
        struct Document<'d> {
            schema: &'static str,
            version: u32,
            #[serde(flatten)]
            diff: &'d Diff,
        }
        let document = Document { schema: "framegraph-diff", version: DIFF_VERSION, diff: self };
        // Structs of strings, numbers and arrays cannot fail to be written.
        let mut text = serde_json::to_string_pretty(&document).unwrap_or_default();
        text.push('\n');
        text
    }

    /// Whether nothing changed that a plan decides.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// What both sides have, and what one has alone.
struct Matched<'v, T> {
    both: Vec<(&'v T, &'v T)>,
    added: Vec<String>,
    removed: Vec<String>,
}

impl<'v, T> Matched<'v, T> {
    /// Matches by name; the first of several with the first, the second with the second.
    fn new(before: &'v [T], after: &'v [T], name: fn(&T) -> &String) -> Self {
        let mut waiting: HashMap<&str, Vec<&T>> = HashMap::new();
        for row in before.iter().rev() {
            waiting.entry(name(row)).or_default().push(row);
        }
        let (mut both, mut added) = (Vec::new(), Vec::new());
        for row in after {
            match waiting.get_mut(name(row).as_str()).and_then(Vec::pop) {
                Some(was) => both.push((was, row)),
                None => added.push(name(row).clone()),
            }
        }
        let mut removed = Vec::new();
        let mut matched: Vec<*const T> = both.iter().map(|(was, _)| std::ptr::from_ref(*was)).collect();
        matched.sort_unstable();
        for row in before {
            if matched.binary_search(&std::ptr::from_ref(row)).is_err() {
                removed.push(name(row).clone());
            }
        }
        Self { both, added, removed }
    }
}

fn cull(before: &PassView, after: &PassView) -> Option<CullChange> {
    (before.culled != after.culled).then(|| CullChange {
        pass: after.name.clone(),
        culled: after.culled,
        reason: after.reason.clone(),
    })
}

fn merge(before: &View, was: &PassView, after: &View, is: &PassView) -> Option<MergeChange> {
    let mates = |view: &View, pass: &PassView| -> Option<Vec<String>> {
        let mut mates = view.steps[pass.step?].passes.clone();
        let own = mates.iter().position(|p| *p == pass.name)?;
        mates.remove(own);
        Some(mates)
    };
    let (was, now) = (mates(before, was)?, mates(after, is)?);
    (was != now).then(|| MergeChange { pass: is.name.clone(), before: was, after: now })
}

fn totals(before: &View, after: &View) -> Vec<TotalChange> {
    let rows = before.totals.rows().into_iter().zip(after.totals.rows());
    let changed = rows.filter(|((_, a), (_, b))| a != b);
    changed.map(|((what, before), (_, after))| TotalChange { what, before, after }).collect()
}

fn resource(before: &ResourceView, after: &ResourceView) -> Option<ResourceChange> {
    let described = |r: &ResourceView| {
        let ResourceView { shape, bytes, placement, .. } = r;
        match *placement {
            "memoryless" | "inlined" | "unused" => format!("{shape}, {placement}"),
            _ => format!("{shape}, {bytes} B, {placement}"),
        }
    };
    let (was, is) = (described(before), described(after));
    (was != is).then(|| ResourceChange { resource: after.name.clone(), before: was, after: is })
}

/// Decisions about passes and resources that both plans have, and about steps that begin with such a pass.
fn reasons(
    before: &View,
    after: &View,
    passes: &Matched<'_, PassView>,
    resources: &Matched<'_, ResourceView>,
) -> Vec<ReasonChange> {
    let known_pass: HashSet<&str> = passes.both.iter().map(|(_, p)| p.name.as_str()).collect();
    let known_resource: HashSet<&str> = resources.both.iter().map(|(_, r)| r.name.as_str()).collect();
    let known = |pass: Option<&str>, resource: Option<&str>| {
        pass.is_none_or(|p| known_pass.contains(p)) && resource.is_none_or(|r| known_resource.contains(r))
    };
    let mut changes: BTreeMap<Key<'_>, (Vec<String>, Vec<String>)> = BTreeMap::new();
    for (side, view) in [before, after].into_iter().enumerate() {
        for decision in &view.decisions {
            let key = key(view, decision);
            if known(key.pass, key.resource) {
                let (was, is) = changes.entry(key).or_default();
                let list = if side == 0 { was } else { is };
                list.push(decision.sentence.clone());
            }
        }
    }
    let changed = changes.into_iter().filter(|(_, (was, is))| was != is);
    changed.map(|(key, (before, after))| ReasonChange { about: key.words(), before, after }).collect()
}

/// What a decision is about, in terms that two plans share.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Key<'v> {
    about: &'static str,
    /// The pass, or the first pass of the step.
    pass: Option<&'v str>,
    resource: Option<&'v str>,
}

fn key<'v>(view: &'v View, decision: &'v DecisionView) -> Key<'v> {
    let first = decision.step.and_then(|step| view.steps[step].passes.first());
    Key {
        about: decision.about,
        pass: decision.pass.as_deref().or(first.map(String::as_str)),
        resource: decision.resource.as_deref(),
    }
}

impl Key<'_> {
    fn words(&self) -> String {
        match (self.about, self.pass, self.resource) {
            ("pass", Some(pass), _) => format!("pass `{pass}`"),
            (about, Some(pass), Some(resource)) => {
                format!("{about} of `{resource}` in the step of `{pass}`")
            }
            (_, _, resource) => format!("resource `{}`", resource.unwrap_or_default()),
        }
    }
}
