//! What the oracle reports: violations, which make a plan wrong, and waste, which makes it slower than it has to be.

use crate::graph::Graph;
use crate::id::{PassId, ResourceId, StepId};
use std::cell::RefCell;
use std::fmt;

/// One level of one layer of one plane of a resource: the unit whose contents are followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Subresource {
    /// Mip level, from 0.
    pub mip: u32,
    /// Array layer, from 0; of a buffer, which of the pieces that ranges of bytes cut it into.
    pub layer: u32,
    /// 0 for color, depth or a buffer; 1 for the stencil of a format that has depth too.
    pub plane: u32,
}

/// Where something was found; what does not apply is none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// The step of the plan.
    pub step: StepId,
    /// The declared pass.
    pub pass: PassId,
    /// The declared resource.
    pub resource: ResourceId,
    /// The part of the resource.
    pub part: Option<Subresource>,
}

/// What a plan must not do. Each rule is one sentence that a good plan makes true.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Rule {
    /// The arrays of the plan fit each other: lengths, spans, ids, kinds.
    Structure,
    /// Passes run in an order that the options allow.
    Order,
    /// Passes that the frame needs run, and all passes do when culling is off.
    Culling,
    /// Passes share a step only where options, caps and flags allow it, and the join says how.
    Merging,
    /// An inlined pass can be an epilogue, and its input is nothing but what its producers draw.
    Inlining,
    /// Attachments are those that the passes declare: range, role, slot, order, one size, no overlap.
    Attachments,
    /// The device's limits hold for the step.
    Limits,
    /// No read sees garbage: discarded, don't-care, handed over, or never written contents.
    Garbage,
    /// Every read sees the version that it sees when passes run as declared.
    Version,
    /// A pass that clears finds the clear value that it declares.
    ClearValue,
    /// A plane that a pass of the step changes is stored or discarded, one that is only read is left or discarded, one
    /// that no pass touches is left.
    StoreOp,
    /// A multisample resolve averages what the pass that declares it left.
    Resolve,
    /// Two passes of one step touch a part in memory only if neither writes it.
    Hazard,
    /// What has no memory is never read from or written to memory.
    NoMemory,
    /// What must survive the frame does, in the right version.
    Exit,
    /// First and last step, format and bytes of each resource are what the steps make of them.
    Lifetime,
    /// The usage flags allow every use.
    Usage,
    /// Each resource lives where its kind and the options allow.
    Placement,
    /// A slot has the shape and the uses of its tenants.
    Slot,
    /// Two resources in one place are never live at once.
    Overlap,
    /// Bytes, lower bound, peak and optimality are what the placements make of them.
    Memory,
    /// Where the device needs barriers, each use is in its layout and waits for what it must not overtake; no barrier is
    /// needless.
    Barrier,
    /// The decision log has its rows, and they are true.
    Decision,
}

/// What a plan could do without.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum WasteKind {
    /// A pass runs that is not needed.
    Pass,
    /// Contents are loaded into the tile, and no pass of the step uses them.
    Load,
    /// The tile is cleared, and no pass of the step declares a clear.
    Clear,
    /// Contents are stored to memory, and no pass reads them there.
    Store,
    /// Contents that were only read are left in memory or stored once more, and no pass reads them there.
    Discard,
    /// A multisample resolve is made, and nothing needs the average.
    Resolve,
    /// An attachment that never leaves the tile has memory.
    Memory,
    /// A usage flag that no use asks for.
    Usage,
}

/// A plan is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Violation {
    /// The rule that it breaks.
    pub rule: Rule,
    /// The step, pass, resource and part where it was found.
    pub place: Place,
    /// How, with names.
    pub sentence: String,
}

/// A plan costs more than it has to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Waste {
    /// What is too much.
    pub kind: WasteKind,
    /// The step, pass, resource and part where it was found.
    pub place: Place,
    /// How, with names.
    pub sentence: String,
}

/// Everything that was found about one plan, in the order in which it was found.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// Why the plan is wrong; empty for a sound plan.
    pub violations: Vec<Violation>,
    /// Why the plan is not the best of its kind; empty for an optimal one.
    pub wastes: Vec<Waste>,
}

impl Report {
    /// Neither a violation nor waste.
    pub fn is_clean(&self) -> bool {
        self.violations.is_empty() && self.wastes.is_empty()
    }
}

impl From<()> for Place {
    /// The plan as a whole.
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
    /// Both together: where one says nothing, the other holds.
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
    /// The place in words, with a colon behind it; empty for the plan as a whole.
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

/// Where the phases of the oracle put what they find: through a shared reference, since what is examined holds it.
pub(super) struct Findings<'p> {
    graph: &'p Graph,
    report: RefCell<Report>,
}

impl<'p> Findings<'p> {
    pub(super) fn new(graph: &'p Graph) -> Self {
        Self { graph, report: RefCell::default() }
    }

    /// Notes a violation.
    #[cold]
    pub(super) fn violation(&self, rule: Rule, place: impl Into<Place>, detail: impl fmt::Display) {
        let place = place.into();
        let sentence = format!("{}{detail}", place.prefix(self.graph));
        self.report.borrow_mut().violations.push(Violation { rule, place, sentence });
    }

    /// Notes waste.
    #[cold]
    pub(super) fn waste(&self, kind: WasteKind, place: impl Into<Place>, detail: impl fmt::Display) {
        let place = place.into();
        let sentence = format!("{}{detail}", place.prefix(self.graph));
        self.report.borrow_mut().wastes.push(Waste { kind, place, sentence });
    }

    /// Notes a violation unless `holds`.
    pub(super) fn require(&self, holds: bool, rule: Rule, place: impl Into<Place>, detail: impl fmt::Display) {
        if !holds {
            self.violation(rule, place, detail);
        }
    }

    /// Notes a violation unless two values are equal.
    pub(super) fn equal<T: PartialEq + fmt::Debug>(
        &self,
        found: T,
        expected: T,
        rule: Rule,
        place: impl Into<Place>,
        what: &str,
    ) {
        if found != expected {
            self.violation(rule, place, format_args!("{what} is {found:?}, should be {expected:?}"));
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
            writeln!(f, "violation, {violation}")?;
        }
        for waste in &self.wastes {
            writeln!(f, "waste, {waste}")?;
        }
        Ok(())
    }
}
