//! Limits on the cost of a plan, for tests and CI.
//!
//! A [`Budget`] is a list of limits, from code or from text. [`Budget::check`] returns an error that names each
//! exceeded limit, its value, and the decisions that add to it, the largest first.
//!
//! ```
//! use framegraph::{Caps, ClearValue, Extent, Format, Graph, Intent, Options, Plan, Scratch, TextureDesc, compile};
//! use framegraph_check::Budget;
//!
//! let mut graph = Graph::new();
//! let color = graph.add_fn("background", |pass| {
//!     let color = pass.texture("color", TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb));
//!     pass.color(color, Intent::Clear(ClearValue::BLACK))
//! })?;
//! graph.export(color)?;
//! let mut plan = Plan::new();
//! compile(&graph, &Caps::tiler(), &Options::for_frame(64, 32), &mut Scratch::new(), &mut plan)?;
//!
//! Budget::new().loads(0).stores(1).traffic_bytes(8192).check(&plan)?;
//! let error = Budget::new().stores(0).check(&plan).unwrap_err();
//! assert!(error.to_string().starts_with("budget exceeded: stores 1, limit 0\n  store of `color` in step 0: "));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bytes;

pub use bytes::bytes;

use framegraph::resource::Kind;
use framegraph::{Attachment, Decision, Join, Placement, Plan, Reason, Subject};
use std::fmt;

/// Kind of cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cost {
    /// Number of attachments loaded from memory (*unresolves*).
    Loads,
    /// Number of attachments stored to memory (*resolves*), including targets of multisample resolves.
    Stores,
    /// Number of multisample resolves performed while storing.
    MultisampleResolves,
    /// Number of full-screen passes that resolve samples, because the device cannot do so while storing.
    FullScreenResolves,
    /// Number of raster, compute and copy steps.
    Steps,
    /// Number of culled passes.
    Culled,
    /// Memory of transient resources, and of histories in placed memory, in bytes.
    Bytes,
    /// Memory of exported textures and history images, in bytes.
    OwnBytes,
    /// Bytes loaded at the start of steps.
    LoadedBytes,
    /// Bytes stored at the end of steps.
    StoredBytes,
    /// Bytes loaded and stored.
    Traffic,
}

impl Cost {
    /// Names of every kind of cost in texts of budgets. The first name of a kind is used in errors.
    pub const NAMES: [(&'static str, Self); 15] = [
        ("loads", Self::Loads),
        ("unresolves", Self::Loads),
        ("stores", Self::Stores),
        ("resolves", Self::Stores),
        ("multisample_resolves", Self::MultisampleResolves),
        ("full_screen_resolves", Self::FullScreenResolves),
        ("steps", Self::Steps),
        ("culled", Self::Culled),
        ("bytes", Self::Bytes),
        ("memory", Self::Bytes),
        ("own_bytes", Self::OwnBytes),
        ("loaded_bytes", Self::LoadedBytes),
        ("stored_bytes", Self::StoredBytes),
        ("traffic", Self::Traffic),
        ("traffic_bytes", Self::Traffic),
    ];

    /// Returns `true` if the cost is a number of bytes.
    pub const fn is_bytes(self) -> bool {
        matches!(self, Self::Bytes | Self::OwnBytes | Self::LoadedBytes | Self::StoredBytes | Self::Traffic)
    }

    /// Returns the cost of a plan.
    pub fn of(self, plan: &Plan) -> u64 {
        let (counts, traffic) = (plan.counts(), plan.traffic(plan.frame()));
        match self {
            Self::Loads => counts.unresolves.into(),
            Self::Stores => counts.resolves.into(),
            Self::MultisampleResolves => counts.multisample_resolves.into(),
            Self::FullScreenResolves => plan.step_passes().iter().filter(|m| m.join == Join::Resolve).count() as u64,
            Self::Steps => counts.steps.into(),
            Self::Culled => counts.culled.into(),
            Self::Bytes => plan.memory().bytes,
            Self::OwnBytes => plan.memory().own_bytes,
            Self::LoadedBytes => traffic.loaded_bytes,
            Self::StoredBytes => traffic.stored_bytes,
            Self::Traffic => traffic.total_bytes(),
        }
    }

    /// Returns `true` if a decision adds to this cost.
    fn is_due_to(self, plan: &Plan, decision: &Decision) -> bool {
        let loads = matches!(decision.reason, Reason::LoadWritten(_) | Reason::LoadEntry);
        let stores = matches!(
            decision.reason,
            Reason::StoreReadBy(_)
                | Reason::StoreResolved(_)
                | Reason::StoreExport
                | Reason::StoreImport
                | Reason::StoreHistory
        );
        match (self, decision.subject) {
            (Self::Loads | Self::LoadedBytes, _) => loads,
            (Self::Stores | Self::StoredBytes, _) => stores,
            (Self::MultisampleResolves, Subject::Store(step, resource)) => {
                let target = |a: &Attachment| a.resource == resource && a.role.is_resolve();
                stores && plan.attachments_of(step).iter().any(target)
            }
            (Self::FullScreenResolves, _) => matches!(decision.reason, Reason::ResolvePass(_)),
            (Self::Traffic, _) => loads || stores,
            (Self::Steps, _) => matches!(decision.reason, Reason::Split(..)),
            (Self::Culled, _) => matches!(
                decision.reason,
                Reason::CulledUnread(_)
                    | Reason::CulledReaderCulled(..)
                    | Reason::CulledOverwritten(..)
                    | Reason::CulledNoOutput
            ),
            (Self::Bytes, Subject::Resource(resource)) => {
                let row = &plan.resources()[resource.index()];
                let peak = plan.memory().peak;
                let live = !row.first.is_none() && row.first <= peak && peak <= row.last;
                let shared = matches!(row.placement, Placement::Slot(_) | Placement::Heap { .. });
                // Histories keep their place in every frame.
                shared && (live && is_placement(decision.reason) || decision.reason == Reason::Persistent)
            }
            (Self::OwnBytes, Subject::Resource(resource)) => {
                let own = plan.resources()[resource.index()].placement == Placement::Own;
                own && plan.reasons(decision.subject).next() == Some(decision.reason)
            }
            _ => false,
        }
    }
}

/// Returns `true` if a reason says where a resource is placed in shared memory.
const fn is_placement(reason: Reason) -> bool {
    matches!(
        reason,
        Reason::SlotFirst | Reason::SlotAfter(_) | Reason::Placed | Reason::PlacedAfter(_) | Reason::AliasingOff
    )
}

/// Limits on the cost of a plan.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Budget {
    limits: Vec<(&'static str, Cost, u64)>,
}

impl Budget {
    /// Creates a budget without limits.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the limit of a kind of cost, replacing an earlier one.
    #[must_use]
    pub fn max(mut self, cost: Cost, max: u64) -> Self {
        self.limits.retain(|(_, known, _)| *known != cost);
        let (name, _) = Cost::NAMES.into_iter().find(|(_, named)| *named == cost).unwrap_or(("cost", cost));
        self.limits.push((name, cost, max));
        self
    }

    /// Limits the attachments that are loaded from memory.
    #[doc(alias = "unresolves")]
    #[must_use]
    pub fn loads(self, max: u32) -> Self {
        self.max(Cost::Loads, max.into())
    }

    /// Limits the attachments that are stored to memory.
    #[doc(alias = "resolves")]
    #[must_use]
    pub fn stores(self, max: u32) -> Self {
        self.max(Cost::Stores, max.into())
    }

    /// Limits the multisample resolves that are performed while storing.
    #[must_use]
    pub fn multisample_resolves(self, max: u32) -> Self {
        self.max(Cost::MultisampleResolves, max.into())
    }

    /// Limits the full-screen passes that resolve samples.
    #[must_use]
    pub fn full_screen_resolves(self, max: u32) -> Self {
        self.max(Cost::FullScreenResolves, max.into())
    }

    /// Limits the raster, compute and copy steps.
    #[must_use]
    pub fn steps(self, max: u32) -> Self {
        self.max(Cost::Steps, max.into())
    }

    /// Limits the culled passes. Zero finds passes whose result is used by no other pass.
    #[must_use]
    pub fn culled(self, max: u32) -> Self {
        self.max(Cost::Culled, max.into())
    }

    /// Limits the memory of transient resources, in bytes.
    #[must_use]
    pub fn allocated_bytes(self, max: u64) -> Self {
        self.max(Cost::Bytes, max)
    }

    /// Limits the memory of exported textures and history images, in bytes.
    #[must_use]
    pub fn own_bytes(self, max: u64) -> Self {
        self.max(Cost::OwnBytes, max)
    }

    /// Limits the bytes loaded and stored in one frame.
    #[must_use]
    pub fn traffic_bytes(self, max: u64) -> Self {
        self.max(Cost::Traffic, max)
    }

    /// Parses `NAME=MAX` with the names of [`Cost::NAMES`], separated by commas or line feeds. Ignores blank lines, and
    /// text from `#` to the end of a line.
    ///
    /// # Errors
    /// One line that names the limit and the expected value.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut limits: Vec<(&str, Cost, u64)> = Vec::new();
        let lines = text.lines().map(|line| line.split('#').next().unwrap_or_default().trim());
        for limit in lines.filter(|line| !line.is_empty()).flat_map(|line| line.split(',')) {
            let limit = limit.trim();
            let (name, max) =
                limit.split_once('=').ok_or_else(|| format!("`{limit}`: missing `=`; expected NAME=MAX"))?;
            let (name, max) = (name.trim(), max.trim());
            let Some(&(name, cost)) = Cost::NAMES.iter().find(|(n, _)| *n == name) else {
                let names: Vec<_> = Cost::NAMES.iter().map(|(n, _)| *n).collect();
                return Err(format!("unknown limit `{name}`; expected {}", names.join(", ")));
            };
            let value = if cost.is_bytes() { bytes(max) } else { max.parse().ok() };
            let expected = if cost.is_bytes() { "bytes, like 200MB or 1.5GiB" } else { "a whole number" };
            let value = value.ok_or_else(|| format!("{name}: invalid value `{max}`; expected {expected}"))?;
            if limits.iter().any(|(_, c, _)| *c == cost) {
                return Err(format!("{name}: specified twice; remove one"));
            }
            limits.push((name, cost, value));
        }
        if limits.is_empty() {
            return Err("no limits; expected NAME=MAX".into());
        }
        Ok(Self { limits })
    }

    /// Compares a plan with all limits.
    ///
    /// # Errors
    /// Lists the exceeded limits with the decisions that add to them.
    pub fn check(&self, plan: &Plan) -> Result<(), BudgetError> {
        let exceeded = self.limits.iter().filter_map(|&(name, cost, limit)| {
            let value = cost.of(plan);
            (value > limit).then(|| Exceeded { name, cost, value, limit, due_to: due_to(plan, cost) })
        });
        let exceeded: Vec<_> = exceeded.collect();
        if exceeded.is_empty() { Ok(()) } else { Err(BudgetError { exceeded }) }
    }
}

/// An exceeded limit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exceeded {
    /// Name of the limit, as it was written.
    pub name: &'static str,
    /// Kind of cost.
    pub cost: Cost,
    /// Cost of the plan.
    pub value: u64,
    /// The limit.
    pub limit: u64,
    /// Decisions that add to the cost, with their bytes and how to avoid them. The largest is first.
    pub due_to: Vec<String>,
}

/// Error: a plan exceeds limits of a budget. `Debug` prints the sentences of `Display`, for tests that unwrap.
#[derive(Clone, PartialEq, Eq)]
pub struct BudgetError {
    /// The exceeded limits, in the order of the budget.
    pub exceeded: Vec<Exceeded>,
}

impl fmt::Display for BudgetError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (at, Exceeded { name, cost, value, limit, due_to }) in self.exceeded.iter().enumerate() {
            let unit = if cost.is_bytes() { " B" } else { "" };
            let feed = if at == 0 { "" } else { "\n" };
            write!(f, "{feed}budget exceeded: {name} {value}{unit}, limit {limit}{unit}")?;
            due_to.iter().try_for_each(|line| write!(f, "\n  {line}"))?;
            if *cost == Cost::Steps && due_to.is_empty() {
                write!(f, "\n  every step holds one pass with no earlier pass to merge with")?;
            }
        }
        Ok(())
    }
}

impl fmt::Debug for BudgetError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for BudgetError {}

/// Returns the decisions that add to a cost, with bytes and hints, by decreasing bytes.
fn due_to(plan: &Plan, cost: Cost) -> Vec<String> {
    let decisions = plan.decisions().iter().filter(|decision| cost.is_due_to(plan, decision));
    let mut rows: Vec<_> = decisions.map(|decision| (bytes_of(plan, decision.subject), decision)).collect();
    rows.sort_by_key(|(bytes, _)| std::cmp::Reverse(*bytes));
    let line = |(bytes, decision): (Option<u64>, &Decision)| {
        let (sentence, hint) = (plan.explained(decision), plan.hint(decision));
        let bytes = bytes.map(|bytes| format!(" ({bytes} B)")).unwrap_or_default();
        let hint = if hint.is_empty() || sentence.ends_with(hint) { String::new() } else { format!("; {hint}") };
        format!("{sentence}{bytes}{hint}")
    };
    rows.into_iter().map(line).collect()
}

/// Returns the bytes of a resource, a load or a store; `None` for a pass.
fn bytes_of(plan: &Plan, subject: Subject) -> Option<u64> {
    let moved = |step, resource, loaded: bool| {
        let own = plan.attachments_of(step).iter().filter(|a| a.resource == resource);
        let traffic = own.map(|a| plan.attachment_traffic(a, plan.frame()));
        traffic.map(|t| if loaded { t.loaded_bytes } else { t.stored_bytes }).fold(0, u64::saturating_add)
    };
    match subject {
        Subject::Resource(resource) => {
            let images = match plan.graph().resources()[resource.index()].kind {
                Kind::HistoryCurrent { frames } => u64::from(frames) + 1,
                Kind::HistoryPrevious { .. } => 0,
                _ => 1,
            };
            Some(plan.resources()[resource.index()].bytes.saturating_mul(images))
        }
        Subject::Load(step, resource) => Some(moved(step, resource, true)),
        Subject::Store(step, resource) => Some(moved(step, resource, false)),
        Subject::Pass(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_read_and_mistakes_named() {
        let lines = "# phone\nloads=0, stores = 3\n\nbytes=200MB # all of it\n";
        for text in ["loads=0, stores=3,bytes=200MB", lines] {
            let budget = Budget::parse(text).expect("the limits are sound");
            assert_eq!(budget, Budget::new().loads(0).stores(3).allocated_bytes(200_000_000));
        }
        for (text, named) in [
            ("", "no limits"),
            ("loads=1,", "``: missing `=`"),
            ("loads", "expected NAME=MAX"),
            ("load=0", "unknown limit `load`"),
            ("loads=1MB", "loads: invalid value `1MB`; expected a whole number"),
            ("bytes=x", "bytes: invalid value `x`; expected bytes"),
            ("loads=1\nunresolves=2", "unresolves: specified twice"),
        ] {
            let error = Budget::parse(text).expect_err(text);
            assert!(error.contains(named), "{text}: {error}");
        }
    }
}
