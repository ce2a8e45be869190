//! The `expect` section of a case, and the actual values of a plan.

use framegraph::{Alias, Order, Placement, Plan};
use serde::Deserialize;

/// Expected figures of one plan.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Preset of device capabilities.
    pub caps: String,
    /// Features that differ from the file's: `"a !b"`.
    #[serde(default)]
    pub set: String,
    #[serde(default)]
    pub order: Order,
    #[serde(default)]
    pub alias: Alias,
    /// Size of the frame in texels, if it differs from the file's.
    #[serde(default)]
    pub size: Option<(u32, u32)>,
    /// Disables merging, inlining and memoryless attachments, so that each pass is one step.
    #[serde(default)]
    pub plain: bool,
    pub loads: u64,
    pub stores: u64,
    #[serde(default)]
    steps: Option<u64>,
    #[serde(default)]
    culled: Option<u64>,
    #[serde(default)]
    memoryless: Option<u64>,
    #[serde(default)]
    inlined: Option<u64>,
    #[serde(default)]
    clears: Option<u64>,
    #[serde(default)]
    discards: Option<u64>,
    #[serde(default)]
    multisample_resolves: Option<u64>,
    #[serde(default)]
    heap_bytes: Option<u64>,
    #[serde(default)]
    lower_bound_bytes: Option<u64>,
    /// Alignment of resources in bytes, for the fields below.
    #[serde(default)]
    granularity: Option<u64>,
    /// Sum over transient resources that take memory, in bytes.
    #[serde(default)]
    rounded_bytes: Option<u64>,
    /// Peak of live bytes.
    #[serde(default)]
    rounded_peak_bytes: Option<u64>,
    /// Name, bytes, first and last step of resources.
    #[serde(default)]
    resources: Vec<(String, u64, u64, u64)>,
    /// Loads and stores of Filament for the same passes.
    #[serde(default)]
    pub filament: Option<(u64, u64)>,
    /// Explanation of the figures.
    #[serde(default)]
    pub note: String,
}

/// One expected figure of a case.
#[derive(Clone, Debug)]
pub struct Field {
    pub what: String,
    pub expected: u64,
    pub found: u64,
}

impl Case {
    /// Returns the features to switch.
    pub fn switches(&self) -> Vec<(String, bool)> {
        let switch = |word: &str| match word.strip_prefix('!') {
            Some(name) => (name.to_owned(), false),
            None => (word.to_owned(), true),
        };
        self.set.split_whitespace().map(switch).collect()
    }

    /// Returns the name of the case for errors.
    pub fn label(&self) -> String {
        let size = self.size.map(|(w, h)| format!(" at {w}x{h}")).unwrap_or_default();
        format!("caps {}, set `{}`, {:?}{size}", self.caps, self.set, self.order)
    }

    /// Returns every expected figure with the plan's.
    pub fn fields(&self, plan: &Plan) -> Vec<Field> {
        let totals = framegraph::dump::totals(plan);
        let total = |what: &str| totals.iter().find(|(name, _)| *name == what).map(|(_, v)| *v);
        let stated = [
            ("unresolves", Some(self.loads)),
            ("resolves", Some(self.stores)),
            ("steps", self.steps),
            ("culled", self.culled),
            ("memoryless", self.memoryless),
            ("inlined", self.inlined),
            ("clears", self.clears),
            ("discards", self.discards),
            ("multisample_resolves", self.multisample_resolves),
            ("heap_bytes", self.heap_bytes),
            ("lower_bound_bytes", self.lower_bound_bytes),
        ];
        let mut fields: Vec<_> = stated
            .into_iter()
            .filter_map(|(what, expected)| {
                let (expected, found) = (expected?, total(what).expect("the totals have the field"));
                Some(Field { what: what.into(), expected, found })
            })
            .collect();
        let (sum, peak) = self.rounded(plan);
        let rounded = [("rounded bytes", self.rounded_bytes, sum), ("rounded peak", self.rounded_peak_bytes, peak)];
        for (what, expected, found) in rounded {
            fields.extend(expected.map(|expected| Field { what: what.into(), expected, found }));
        }
        for (name, bytes, first, last) in &self.resources {
            let id = plan.graph().find_resource(name).unwrap_or_else(|| panic!("no resource {name}"));
            let row = &plan.resources()[id.index()];
            let found = [self.round(row.bytes), row.first.index() as u64, row.last.index() as u64];
            let what = ["bytes", "first step", "last step"];
            for (what, (expected, found)) in what.into_iter().zip([bytes, first, last].into_iter().zip(found)) {
                fields.push(Field { what: format!("{what} of {name}"), expected: *expected, found });
            }
        }
        fields
    }

    fn round(&self, bytes: u64) -> u64 {
        bytes.next_multiple_of(self.granularity.unwrap_or(1))
    }

    /// Returns sum and peak of aligned sizes over resources that take shared memory, in bytes.
    fn rounded(&self, plan: &Plan) -> (u64, u64) {
        let shared = |p| matches!(p, Placement::Slot(_) | Placement::Heap { .. });
        let rows = || plan.resources().iter().filter(|r| shared(r.placement));
        let sum = rows().map(|r| self.round(r.bytes)).sum();
        let live =
            |step| rows().filter(|r| r.first <= step && step <= r.last).map(|r| self.round(r.bytes)).sum::<u64>();
        (sum, plan.step_ids().map(live).max().unwrap_or(0))
    }

    /// Returns the case with one field of [`Case::fields`] changed by 1.
    pub fn mutated(&self, at: usize) -> Self {
        let mut case = self.clone();
        let mut left = at;
        let scalars = [
            Some(&mut case.loads),
            Some(&mut case.stores),
            case.steps.as_mut(),
            case.culled.as_mut(),
            case.memoryless.as_mut(),
            case.inlined.as_mut(),
            case.clears.as_mut(),
            case.discards.as_mut(),
            case.multisample_resolves.as_mut(),
            case.heap_bytes.as_mut(),
            case.lower_bound_bytes.as_mut(),
            case.rounded_bytes.as_mut(),
            case.rounded_peak_bytes.as_mut(),
        ];
        let rows = case.resources.iter_mut().flat_map(|(_, bytes, first, last)| [bytes, first, last]);
        for figure in scalars.into_iter().flatten().chain(rows) {
            if left == 0 {
                *figure += 1;
                break;
            }
            left -= 1;
        }
        case
    }
}
