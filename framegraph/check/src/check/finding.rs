//! Findings of the oracle: violations, which make a plan incorrect, and waste, which makes it slower than necessary.

use framegraph::graph::Graph;
use framegraph::id::{PassId, ResourceId, StepId};
use std::cell::RefCell;
use std::fmt;

/// One level of one layer of one plane of a resource: the unit of tracking.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Subresource {
    /// Mip level, starting at 0.
    pub mip: u32,
    /// Array layer, starting at 0. For a buffer, the index of a section between ends of byte ranges.
    pub layer: u32,
    /// 0 for color, depth or a buffer; 1 for stencil of a format that also has depth.
    pub plane: u32,
}

/// Location of a finding; fields that do not apply are none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// Step of the plan.
    pub step: StepId,
    /// Declared pass.
    pub pass: PassId,
    /// Declared resource.
    pub resource: ResourceId,
    /// Part of the resource.
    pub part: Option<Subresource>,
}

/// Rules for plans. Each is stated as a property of correct plans.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Rule {
    /// The arrays of the plan are consistent: lengths, spans, ids, kinds.
    Structure,
    /// Passes run in an order that the options allow.
    Order,
    /// Needed passes run; with culling disabled, all passes run.
    Culling,
    /// Passes share a step only if options, caps and flags allow it, and their joins are correct.
    Merging,
    /// An inlined pass is a valid epilogue, and its input is used only by its producers and itself.
    Inlining,
    /// Attachments match the declared accesses: range, role, slot, order, size, no overlap.
    Attachments,
    /// The step is within the limits of the device.
    Limits,
    /// No read sees garbage: discarded, don't-care, aliased or unwritten contents.
    Garbage,
    /// Every read sees the same version as in declaration order.
    Version,
    /// A pass that clears finds the clear value that it declares.
    ClearValue,
    /// A written plane is stored or discarded; a plane that is only read is left unchanged or discarded; an unused
    /// plane is left unchanged.
    StoreOp,
    /// A multisample resolve uses the output of the pass that declares it.
    Resolve,
    /// Two passes of one step access the same part in memory only if neither writes it.
    Hazard,
    /// Resources without memory are never read from or written to memory.
    NoMemory,
    /// Contents that must survive the frame do, in the right version.
    Exit,
    /// Lifetime, format and size of each resource match the steps.
    Lifetime,
    /// The usage flags include every use.
    Usage,
    /// The placement of each resource matches its kind and the options.
    Placement,
    /// A slot has the shape and the usages of its resources.
    Slot,
    /// Two resources in the same memory are never live at the same time.
    Overlap,
    /// Size, lower bound, peak and optimality match the placements.
    Memory,
    /// On devices with explicit barriers, each use has its layout and waits for conflicting uses, and no barrier is
    /// unnecessary.
    Barrier,
    /// The decision log contains the required rows, and they are true.
    Decision,
}

/// Kinds of unnecessary work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum WasteKind {
    /// A pass runs although its results are not used.
    Pass,
    /// Contents are loaded into the tile, but no pass of the step uses them.
    Load,
    /// The tile is cleared, but no pass of the step declares a clear.
    Clear,
    /// Contents are stored to memory, but no pass reads them there.
    Store,
    /// Contents that were only read are kept or stored again, but no later pass reads them.
    Discard,
    /// A multisample resolve is performed, but its result is not used.
    Resolve,
    /// An attachment that never leaves the tile has memory.
    Memory,
    /// A usage flag is set that no use requires.
    Usage,
}

/// An error in a plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Violation {
    /// The violated rule.
    pub rule: Rule,
    /// Location.
    pub place: Place,
    /// Description with names.
    pub sentence: String,
}

/// Unnecessary work in a plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Waste {
    /// The kind of work.
    pub kind: WasteKind,
    /// Location.
    pub place: Place,
    /// Description with names.
    pub sentence: String,
}

/// All findings about one plan, in the order in which they were found.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// Errors of the plan; empty for a correct one.
    pub violations: Vec<Violation>,
    /// Unnecessary work; empty for an optimal plan.
    pub wastes: Vec<Waste>,
}

impl Report {
    /// Returns `true` if there are no findings.
    pub fn is_clean(&self) -> bool {
        self.violations.is_empty() && self.wastes.is_empty()
    }
}

impl From<()> for Place {
    /// Returns the place of the plan as a whole.
    fn from((): ()) -> Self {
        Self::default()
    }
}

impl From<StepId> for Place {
    fn from(step: StepId) -> Self {
        Self { step, ..Self::default() }
    }
}

impl From<PassId> for Place {
    fn from(pass: PassId) -> Self {
        Self { pass, ..Self::default() }
    }
}

impl From<ResourceId> for Place {
    fn from(resource: ResourceId) -> Self {
        Self { resource, ..Self::default() }
    }
}

impl From<Subresource> for Place {
    fn from(part: Subresource) -> Self {
        Self { part: Some(part), ..Self::default() }
    }
}

impl<A: Into<Self>, B: Into<Self>> From<(A, B)> for Place {
    /// Combines two places: the first takes precedence.
    fn from((a, b): (A, B)) -> Self {
        let (a, b): (Self, Self) = (a.into(), b.into());
        Self {
            step: a.step.some().unwrap_or(b.step),
            pass: a.pass.some().unwrap_or(b.pass),
            resource: a.resource.some().unwrap_or(b.resource),
            part: a.part.or(b.part),
        }
    }
}

impl<A: Into<Self>, B: Into<Self>, C: Into<Self>> From<(A, B, C)> for Place {
    fn from((a, b, c): (A, B, C)) -> Self {
        ((a, b), c).into()
    }
}

impl Place {
    /// Describes the place, followed by a colon; empty for the plan as a whole.
    fn prefix(&self, graph: &Graph) -> String {
        let mut words = Vec::new();
        if let Some(step) = self.step.some() {
            words.push(format!("step {}", step.index()));
        }
        if let Some(pass) = self.pass.some().filter(|p| p.index() < graph.passes().len()) {
            words.push(format!("pass `{}`", graph.pass_name(pass)));
        }
        let known = |r: &ResourceId| r.index() < graph.resources().len();
        if let Some(resource) = self.resource.some().filter(known) {
            words.push(format!("`{}`", graph.resource_name(resource)));
        }
        if let Some(Subresource { mip, layer, plane }) = self.part {
            words.push(format!("mip {mip}, layer {layer}, plane {plane}"));
        }
        if words.is_empty() { String::new() } else { words.join(", ") + ": " }
    }
}

/// Collects the findings of all phases. Uses interior mutability, because the examined plan is shared.
pub(super) struct Findings<'p> {
    graph: &'p Graph,
    report: RefCell<Report>,
}

impl<'p> Findings<'p> {
    pub(super) fn new(graph: &'p Graph) -> Self {
        Self { graph, report: RefCell::default() }
    }

    /// Adds a violation.
    #[cold]
    pub(super) fn violation(&self, rule: Rule, place: impl Into<Place>, detail: impl fmt::Display) {
        let place = place.into();
        let sentence = format!("{}{detail}", place.prefix(self.graph));
        self.report.borrow_mut().violations.push(Violation { rule, place, sentence });
    }

    /// Adds waste.
    #[cold]
    pub(super) fn waste(&self, kind: WasteKind, place: impl Into<Place>, detail: impl fmt::Display) {
        let place = place.into();
        let sentence = format!("{}{detail}", place.prefix(self.graph));
        self.report.borrow_mut().wastes.push(Waste { kind, place, sentence });
    }

    /// Adds a violation unless `holds`.
    pub(super) fn require(&self, holds: bool, rule: Rule, place: impl Into<Place>, detail: impl fmt::Display) {
        if !holds {
            self.violation(rule, place, detail);
        }
    }

    /// Adds a violation unless two values are equal.
    pub(super) fn equal<T: PartialEq + fmt::Debug>(
        &self,
        found: T,
        expected: T,
        rule: Rule,
        place: impl Into<Place>,
        what: &str,
    ) {
        if found != expected {
            self.violation(rule, place, format_args!("{what} is {found:?}, expected {expected:?}"));
        }
    }

    pub(super) fn is_sound(&self) -> bool {
        self.report.borrow().violations.is_empty()
    }

    pub(super) fn into_report(self) -> Report {
        self.report.into_inner()
    }
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}: {}", self.rule, self.sentence)
    }
}

impl fmt::Display for Waste {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}: {}", self.kind, self.sentence)
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for violation in &self.violations {
            writeln!(f, "violation: {violation}")?;
        }
        for waste in &self.wastes {
            writeln!(f, "waste: {waste}")?;
        }
        Ok(())
    }
}
