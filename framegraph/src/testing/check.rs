//! The oracle: is a plan right, and is it as cheap as its kind can be?
//!
//! [`check`] shares no code with the compiler. It knows what was declared, interprets it once as it stands (the
//! *reference*), then runs the plan step by step on symbols with tile memory and main memory apart, and compares every
//! read. The model is the checker of the register allocator regalloc2 (Fallin, `src/checker.rs`), which proves an
//! allocation right by following symbolic values through it.
//!
//! # Symbols
//!
//! Contents are followed for each *part*: one level of one layer of one plane of a resource. The value of a part is an
//! element of a flat lattice:
//!
//! ```text
//!                        Garbage(cause)                     no pass may rely on it
//!        /              |              \           \
//!    Written(p0)   Written(p1) …    Entry      Cleared(c)   one of these, exactly
//! ```
//!
//! `Written(p)` is what pass `p` wrote. A pass's output depends on all that it reads, so an output is a term over other
//! outputs; the terms need not be built, since every read of `p` is compared with what `p` reads in the reference: by
//! induction over the steps two values `Written(p)` are the same term. There are no joins, because a plan has no branches.
//!
//! # Reference semantics
//!
//! Passes run as declared, none is culled. On entry a part is `Entry` when it is imported with contents or is of an earlier
//! frame, else `Garbage`. Each read sees the value of its parts. Then each write (`Clear`, `Overwrite`, `Modify`) sets its
//! parts to `Written(p)`; `Modify` is a read as well. What must survive (exports, imports to keep, histories) is the value
//! of its parts behind the last pass.
//!
//! # Transfer functions of the plan
//!
//! `main` is main memory, `tile` the tile of the open raster step, both by part.
//!
//! | | effect |
//! |---|---|
//! | load op `Load` | `tile := main` |
//! | load op `Clear` | `tile := Cleared(c)`, of a declared value or zero |
//! | load op `DontCare` | `tile := Garbage` |
//! | attachment access that reads or modifies, same-pixel read of what an earlier pass attached of the step | `tile` must be the reference's value |
//! | color attachment that is added to, and the sum is not needed | `tile` must be zero, or what an earlier pass of the step left |
//! | attachment access that clears | `tile` must be `Cleared` with the declared bits |
//! | attachment access that writes | `tile := Written(p)` |
//! | resolve | target's `tile := Written(p)`; at the end of the step the samples must still be what they are behind `p` |
//! | full-screen resolve of `p` | `main` of the samples must be what they are behind `p`; target's `tile := Written(p)` |
//! | every other read | `main` must be the reference's value |
//! | every other write | `main := Written(p)` |
//! | inlined pass | reads where its producers draw in its input's place, then that place becomes `Written(p)` |
//! | store op `Store` | `main := tile` |
//! | store op `Discard` | `main := Garbage` |
//! | store op `None` | `main` stays, unless the tile was written: then `Garbage` |
//! | end of the frame | what must survive must be in `main` |
//!
//! Memoryless and inlined resources have no `main` at all: touching it is a violation. A plane with load op `DontCare` and
//! store op `None` is one that no pass of the step touches: memory keeps it (a read-only plane in WebGPU, load op `NONE`
//! in Vulkan). A clear of an attachment that inlining put in another's place has the value that the producer declares; the
//! back end passes it through the epilogue, as every fragment.
//!
//! Beside the run, flat facts are worked out anew and compared: attachments and their shape, limits, hazards inside of
//! steps, lifetimes, uses, slots, overlaps in memory, sums, barriers, and the truth of each row of the decision log. What
//! shares memory is never live at once, so the run needs to know of no hand-over.
//!
//! # Waste
//!
//! A right plan can still do too much. Ops and passes that are not needed, memory for what never leaves the
//! tile are listed apart ([`Report::wastes`]): the compiler is to make none, a plan made by hand may.

mod attachments;
mod barriers;
mod case;
mod decisions;
mod finding;
mod hazards;
mod lifetimes;
mod machine;
mod memory;
mod reference;
mod resolves;
mod run;
mod stores;
mod structure;
mod subresource;
mod tenants;
mod tile;
mod totals;

pub use finding::{Place, Report, Rule, Subresource, Violation, Waste, WasteKind};

use crate::access::AccessKind;
use crate::graph::PassFlags;
use crate::id::PassId;
use crate::options::Order;
use crate::plan::{Plan, StepPass};
use case::Case;
use finding::Findings;

/// Whether a plan is right: it does what was declared, and says truly what it does.
///
/// Never panics, whatever the plan: a plan whose arrays do not fit each other is reported as such and examined no further.
///
/// # Errors
/// Every violation, in the order in which the phases of the oracle find them.
pub fn check(plan: &Plan) -> Result<(), Vec<Violation>> {
    let Report { violations, .. } = examine(plan);
    if violations.is_empty() { Ok(()) } else { Err(violations) }
}

/// Everything that can be said against a plan: violations and waste.
///
/// ```
/// use framegraph::{Caps, Entry, Exit, Extent, Format, Graph, Intent, Options, Plan, Scratch, TextureDesc, check, compile};
///
/// let mut graph = Graph::new();
/// let screen = TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb);
/// let screen = graph.import_texture("screen", screen, Entry::Undefined, Exit::Keep);
/// graph.add_fn("draw", |pass| pass.color(screen, Intent::Overwrite))?;
/// let mut plan = Plan::new();
/// compile(&graph, &Caps::wgpu(), &Options::default(), &mut Scratch::new(), &mut plan)?;
/// assert!(check::examine(&plan).is_clean());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn examine(plan: &Plan) -> Report {
    let findings = Findings::new(plan.graph());
    structure::structure(plan, &findings);
    if !findings.is_sound() {
        return findings.into_report();
    }
    let case = Case::new(plan);
    culling(&case);
    order(&case);
    attachments::attachments(&case);
    hazards::hazards(&case);
    let trace = run::run(&case);
    lifetimes::lifetimes(&case);
    tenants::tenants(&case);
    totals::totals(&case);
    let earlier = tenants::earlier_tenants(&case);
    barriers::barriers(&case, &earlier);
    decisions::decisions(&case, &trace, &earlier);
    case.report.into_report()
}

/// Passes that are needed run; passes that are not do not, unless culling is off.
fn culling(case: &Case<'_>) {
    let cull = case.plan.options().cull;
    for pass in case.graph.pass_ids() {
        let runs = case.position[pass.index()].is_some();
        let needed = case.reference.needed[pass.index()];
        let why = "culled, and what must survive or a side effect depends on it";
        case.report.require(runs || !needed, Rule::Culling, pass, why);
        case.report.require(runs || cull, Rule::Culling, pass, "culled, and culling is off");
        if runs && cull && !needed {
            let why = "it runs, and nothing that must survive depends on it";
            case.report.waste(WasteKind::Pass, pass, why);
        }
        if let Some(at) = case.position[pass.index()] {
            averages(case, case.running[at]);
        }
    }
}

/// A multisample resolve is left out only by culling, and made only where something needs it. That what is needed is there
/// shows in the run.
fn averages(case: &Case<'_>, member: StepPass) {
    let cull = case.plan.options().cull;
    for (id, access) in case.accesses_of(member.pass).filter(|(_, a)| a.kind == AccessKind::Resolve) {
        let place = (member.pass, access.resource);
        if case.dropped[id] {
            let why = "declared as `resolve`, and not attached so";
            case.report.require(cull, Rule::Attachments, place, why);
        } else if cull && !case.covered(access).any(|part| case.is_needed(member.pass, part)) {
            case.report.waste(WasteKind::Resolve, place, "it is resolved, and nothing needs that");
        }
    }
}

/// Declaration order, where it is asked for; passes with side effects keep their order always.
fn order(case: &Case<'_>) {
    let declared = case.plan.options().order == Order::Declared;
    let fixed = |p: &&PassId| declared || case.flag(**p, PassFlags::SIDE_EFFECT);
    let ordered: Vec<_> = case.order.iter().filter(fixed).collect();
    for pair in ordered.windows(2) {
        let name = case.graph.pass_name(*pair[0]);
        let why = format_args!("it runs after `{name}`, which is declared later");
        case.report.require(pair[0] < pair[1], Rule::Order, *pair[1], why);
    }
}
