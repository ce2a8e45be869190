//! Differences between two plans: of two versions of a frame, two settings, two devices or two frame sizes.
//!
//! Passes and resources are matched by name; duplicates of a name are matched in order. Decisions are matched by their
//! subject. Steps are identified by the name of their first pass, because step numbers shift. [`Diff`] is data, and its
//! `Display` prints one line per change.

mod text;

use crate::decision::Subject;
use crate::dump::{self, Json, field, object};
use crate::id::{PassId, ResourceId, StepId};
use crate::plan::{Placement, Plan};
use std::collections::{BTreeMap, HashMap, HashSet, VecDeque};

/// All changes between two plans.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Diff {
    /// Passes that exist only in the second plan.
    pub passes_added: Vec<String>,
    /// Passes that exist only in the first plan.
    pub passes_removed: Vec<String>,
    /// Passes that run in one plan and are culled in the other.
    pub culls: Vec<CullChange>,
    /// Passes that run in both plans but share their steps with different passes.
    pub merges: Vec<Change<Vec<String>>>,
    /// Changed totals, named and ordered as in [`totals`](crate::dump::totals).
    pub totals: Vec<Change<u64>>,
    /// Resources that exist only in the second plan.
    pub resources_added: Vec<String>,
    /// Resources that exist only in the first plan.
    pub resources_removed: Vec<String>,
    /// Resources whose shape, size or kind of placement changed.
    pub resources: Vec<Change<String>>,
    /// Decisions that changed, or that have another reason, as sentences.
    pub reasons: Vec<Change<Vec<String>>>,
}

/// A pass that is culled in exactly one of two plans.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CullChange {
    /// The pass.
    pub pass: String,
    /// The pass is culled in the second plan.
    pub culled: bool,
    /// Reason in the second plan.
    pub reason: String,
}

/// A changed property that both plans have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change<V> {
    /// Name of the pass, resource or total; for decisions, a description of their subject.
    pub what: String,
    /// Value in the first plan.
    pub before: V,
    /// Value in the second plan.
    pub after: V,
}

/// Compares two plans.
pub fn diff(before: &Plan, after: &Plan) -> Diff {
    let pass_names = |plan: &Plan| plan.graph().pass_ids().map(|p| plan.graph().pass_name(p).to_owned()).collect();
    let resource_names =
        |plan: &Plan| plan.graph().resource_ids().map(|r| plan.graph().resource_name(r).to_owned()).collect();
    let passes = Matched::new(pass_names(before), pass_names(after));
    let resources = Matched::new(resource_names(before), resource_names(after));
    let pass_pairs = || passes.both.iter().map(|(a, b)| (PassId::at(*a), PassId::at(*b)));
    let resource_pairs = resources.both.iter().map(|(a, b)| (ResourceId::at(*a), ResourceId::at(*b)));
    Diff {
        culls: pass_pairs().filter_map(|(a, b)| cull(before, a, after, b)).collect(),
        merges: pass_pairs().filter_map(|(a, b)| merge(before, a, after, b)).collect(),
        totals: totals(before, after),
        resources: resource_pairs.filter_map(|(a, b)| resource(before, a, after, b)).collect(),
        reasons: reasons(before, after, &passes, &resources),
        passes_added: passes.added,
        passes_removed: passes.removed,
        resources_added: resources.added,
        resources_removed: resources.removed,
    }
}

/// Version of the JSON form of a diff. Increases when a field changes its meaning or is removed.
pub const DIFF_VERSION: u32 = 1;

impl Diff {
    /// Returns the diff as indented JSON text, ending in a line feed. `docs/reference/plan-json.md` documents the fields.
    pub fn json(&self) -> String {
        let culls = self.culls.iter().map(|c| {
            object([field("pass", c.pass.as_str()), field("culled", c.culled), field("reason", c.reason.as_str())])
        });
        let document = object([
            field("schema", "framegraph-diff"),
            field("version", DIFF_VERSION),
            field("passes_added", self.passes_added.clone()),
            field("passes_removed", self.passes_removed.clone()),
            field("culls", Json::list(culls)),
            field("merges", changes("pass", &self.merges)),
            field("totals", changes("what", &self.totals)),
            field("resources_added", self.resources_added.clone()),
            field("resources_removed", self.resources_removed.clone()),
            field("resources", changes("resource", &self.resources)),
            field("reasons", changes("about", &self.reasons)),
        ]);
        document.text()
    }

    /// Returns `true` if the plans do not differ.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// Returns changes as JSON objects; `key` is the field for the name of the changed item.
fn changes<V: Clone + Into<Json>>(key: &'static str, rows: &[Change<V>]) -> Json {
    Json::list(rows.iter().map(|Change { what, before, after }| {
        object([field(key, what.as_str()), field("before", before.clone()), field("after", after.clone())])
    }))
}

/// Items of both sides as pairs of indices, and items of one side as names.
struct Matched {
    both: Vec<(usize, usize)>,
    added: Vec<String>,
    removed: Vec<String>,
    /// Names that occur on both sides.
    known: HashSet<String>,
}

impl Matched {
    /// Matches by name; duplicates are matched in order.
    fn new(before: Vec<String>, after: Vec<String>) -> Self {
        let mut waiting: HashMap<String, VecDeque<usize>> = HashMap::new();
        for (index, name) in before.iter().enumerate() {
            waiting.entry(name.clone()).or_default().push_back(index);
        }
        let mut out = Self { both: Vec::new(), added: Vec::new(), removed: Vec::new(), known: HashSet::new() };
        let mut matched = vec![false; before.len()];
        for (index, name) in after.into_iter().enumerate() {
            match waiting.get_mut(&name).and_then(VecDeque::pop_front) {
                Some(was) => {
                    out.both.push((was, index));
                    matched[was] = true;
                    out.known.insert(name);
                }
                None => out.added.push(name),
            }
        }
        let removed = before.into_iter().zip(matched).filter(|(_, matched)| !matched);
        out.removed = removed.map(|(name, _)| name).collect();
        out
    }
}

/// Returns the change, or `None` if both values are equal.
fn change<V: PartialEq>(what: &str, before: V, after: V) -> Option<Change<V>> {
    (before != after).then(|| Change { what: what.to_owned(), before, after })
}

fn cull(before: &Plan, was: PassId, after: &Plan, is: PassId) -> Option<CullChange> {
    let culled = after.is_culled(is);
    (before.is_culled(was) != culled).then(|| CullChange {
        pass: after.graph().pass_name(is).to_owned(),
        culled,
        reason: after.verdict(is).map(|r| r.sentence(after.graph())).unwrap_or_default(),
    })
}

fn merge(before: &Plan, was: PassId, after: &Plan, is: PassId) -> Option<Change<Vec<String>>> {
    let mates = |plan: &Plan, pass: PassId| -> Option<Vec<String>> {
        let step = plan.pass_steps()[pass.index()].some()?;
        let others = plan.passes_of(step).iter().filter(|m| m.pass != pass);
        Some(others.map(|m| plan.graph().pass_name(m.pass).to_owned()).collect())
    };
    change(after.graph().pass_name(is), mates(before, was)?, mates(after, is)?)
}

fn totals(before: &Plan, after: &Plan) -> Vec<Change<u64>> {
    let rows = dump::totals(before).into_iter().zip(dump::totals(after));
    rows.filter_map(|((what, before), (_, after))| change(what, before, after)).collect()
}

fn resource(before: &Plan, was: ResourceId, after: &Plan, is: ResourceId) -> Option<Change<String>> {
    let described = |plan: &Plan, resource: ResourceId| {
        let row = &plan.resources()[resource.index()];
        let shape = dump::shape(plan, &plan.graph().resources()[resource.index()].desc, row.format);
        let placement = row.placement.word();
        match row.placement {
            Placement::Memoryless | Placement::Inlined | Placement::Unused => format!("{shape}, {placement}"),
            _ => format!("{shape}, {} B, {placement}", row.bytes),
        }
    };
    change(after.graph().resource_name(is), described(before, was), described(after, is))
}

/// Compares decisions about passes and resources of both plans, and about steps that begin with such a pass.
fn reasons(before: &Plan, after: &Plan, passes: &Matched, resources: &Matched) -> Vec<Change<Vec<String>>> {
    let mut changes: BTreeMap<Key<'_>, [Vec<String>; 2]> = BTreeMap::new();
    for (side, plan) in [before, after].into_iter().enumerate() {
        for decision in plan.decisions() {
            let key = key(plan, decision.subject);
            let known = key.pass.is_none_or(|p| passes.known.contains(p))
                && key.resource.is_none_or(|r| resources.known.contains(r));
            if known {
                changes.entry(key).or_default()[side].push(decision.reason.sentence(plan.graph()));
            }
        }
    }
    changes.into_iter().filter_map(|(key, [before, after])| change(&key.words(), before, after)).collect()
}

/// Subject of a decision, in terms that both plans share.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Key<'p> {
    about: &'static str,
    /// The pass, or the first pass of the step.
    pass: Option<&'p str>,
    resource: Option<&'p str>,
}

fn key(plan: &Plan, subject: Subject) -> Key<'_> {
    let graph = plan.graph();
    let first = |s: StepId| plan.passes_of(s).first().map(|m| graph.pass_name(m.pass));
    let (about, pass, resource) = match subject {
        Subject::Pass(p) => ("pass", Some(graph.pass_name(p)), None),
        Subject::Load(s, r) => ("load", first(s), Some(graph.resource_name(r))),
        Subject::Store(s, r) => ("store", first(s), Some(graph.resource_name(r))),
        Subject::Resource(r) => ("resource", None, Some(graph.resource_name(r))),
    };
    Key { about, pass, resource }
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
