//! The oracle: checks that a plan is correct, and reports unnecessary work.
//!
//! [`check`] shares no code with the compiler. It interprets the declared graph once without optimizations (the
//! *reference*). Then it runs the plan step by step on symbolic values, with separate tile memory and main memory, and
//! compares every read. The approach follows the checker of the register allocator regalloc2 (Fallin,
//! `src/checker.rs`), which proves an allocation correct by tracking symbolic values.
//!
//! # Symbols
//!
//! Contents are tracked for each *part*: one level of one layer of one plane of a resource. The value of a part is an
//! element of a flat lattice:
//!
//! ```text
//!                        Garbage(cause)                     no pass may rely on it
//!        /              |              \           \
//!    Written(p0)   Written(p1) …    Entry      Cleared(c)   one of these, exactly
//! ```
//!
//! `Written(p)` is the output of pass `p`. An output depends on everything the pass reads, so it is a term over other
//! outputs. The terms need not be built: every read of `p` is compared with the same read in the reference. By
//! induction over the steps, two values `Written(p)` are the same term. Joins do not occur, because a plan has no
//! branches.
//!
//! # Reference semantics
//!
//! Passes run in declaration order, without culling. Initially a part is `Entry` if it is imported with contents or
//! belongs to an earlier frame, otherwise `Garbage`. Each read sees the value of its parts. Then each write (`Clear`,
//! `Overwrite`, `Modify`) sets its parts to `Written(p)`; `Modify` is also a read. The final values of exports, kept
//! imports and histories must survive.
//!
//! # Transfer functions of the plan
//!
//! `main` is main memory, `tile` is the tile memory of the current raster step; both are indexed by part.
//!
//! | | effect |
//! |---|---|
//! | load op `Load` | `tile := main` |
//! | load op `Clear` | `tile := Cleared(c)`, with a declared value or zero |
//! | load op `DontCare` | `tile := Garbage` |
//! | attachment access that reads or modifies, same-pixel read of an attachment of an earlier pass of the step | `tile` must be the reference's value |
//! | color attachment that is blended into, and the result is not used | `tile` must be zero, or the value left by an earlier pass of the step |
//! | attachment access that clears | `tile` must be `Cleared` with the declared bits |
//! | attachment access that writes | `tile := Written(p)` |
//! | resolve | target's `tile := Written(p)`; at the end of the step the samples must still have their value after `p` |
//! | full-screen resolve of `p` | `main` of the samples must have its value after `p`; target's `tile := Written(p)` |
//! | every other read | `main` must be the reference's value |
//! | every other write | `main := Written(p)` |
//! | inlined pass | reads the attachment that replaces its input, which then becomes `Written(p)` |
//! | store op `Store` | `main := tile` |
//! | store op `Discard` | `main := Garbage` |
//! | store op `None` | `main` is unchanged, unless the tile was written: then `Garbage` |
//! | end of the frame | contents that must survive must be in `main` |
//!
//! Memoryless and inlined resources have no `main`: accessing it is a violation. A plane with load op `DontCare` and
//! store op `None` is not used by any pass of the step, and memory keeps it. It is a read-only plane in WebGPU and has
//! load op `NONE` in Vulkan.
//!
//! A clear of an attachment that inlining replaced has the value declared by the producer. The back end passes it
//! through the epilogue, like every fragment.
//!
//! Other properties are recomputed and compared: attachments and their shapes, limits, hazards inside of steps,
//! lifetimes, usages, slots, overlaps in memory, sums, barriers, and each row of the decision log. Resources that share
//! memory are never live at the same time, so the run does not model aliasing.
//!
//! # Waste
//!
//! A correct plan can still do unnecessary work: operations, passes, or memory for resources that never leave the tile.
//! It is listed separately ([`Report::wastes`]). Plans of the compiler must not contain any; plans made by hand may.

mod attachments;
mod barriers;
mod decisions;
mod finding;
mod hazards;
mod lifetimes;
mod machine;
mod memory;
mod reference;
mod resolves;
mod rule_input;
mod run;
mod stores;
mod structure;
mod subresource;
mod tenants;
mod tile;
mod totals;

pub use finding::{Place, Report, Rule, Subresource, Violation, Waste, WasteKind};

use finding::Findings;
use framegraph::access::AccessKind;
use framegraph::graph::PassFlags;
use framegraph::id::PassId;
use framegraph::options::Order;
use framegraph::plan::{Plan, StepPass};
use rule_input::RuleInput;

/// Checks that a plan is correct: it does what was declared, and describes itself correctly.
///
/// Never panics: a plan with inconsistent arrays is reported as such and not examined further.
///
/// # Errors
/// Returns every violation, in the order in which the phases of the oracle find them.
pub fn check(plan: &Plan) -> Result<(), Vec<Violation>> {
    let Report { violations, .. } = examine(plan);
    if violations.is_empty() { Ok(()) } else { Err(violations) }
}

/// Returns everything found in a plan: violations and waste.
///
/// ```
/// use framegraph::{Caps, Entry, Exit, Extent, Format, Graph, Intent, Options, Plan, Scratch, TextureDesc, compile};
/// use framegraph_check::check;
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
    let ctx = RuleInput::new(plan);
    culling(&ctx);
    order(&ctx);
    attachments::attachments(&ctx);
    hazards::hazards(&ctx);
    let trace = run::run(&ctx);
    lifetimes::lifetimes(&ctx);
    tenants::tenants(&ctx);
    totals::totals(&ctx);
    let earlier = tenants::earlier_tenants(&ctx);
    barriers::barriers(&ctx, &earlier);
    decisions::decisions(&ctx, &trace, &earlier);
    ctx.report.into_report()
}

/// Checks that needed passes run, and that others do not, unless culling is disabled.
fn culling(ctx: &RuleInput<'_>) {
    let cull = ctx.plan.options().cull;
    for pass in ctx.graph.pass_ids() {
        let runs = ctx.position[pass.index()].is_some();
        let needed = ctx.reference.needed[pass.index()];
        let why = "culled, but an exported result or a side effect depends on it";
        ctx.report.require(runs || !needed, Rule::Culling, pass, why);
        ctx.report.require(runs || cull, Rule::Culling, pass, "culled, but culling is disabled");
        if runs && cull && !needed {
            let why = "it runs, but no exported result depends on it";
            ctx.report.waste(WasteKind::Pass, pass, why);
        }
        if let Some(at) = ctx.position[pass.index()] {
            averages(ctx, ctx.running[at]);
        }
    }
}

/// Checks that multisample resolves are dropped only by culling, and performed only if used. The run shows that used
/// results exist.
fn averages(ctx: &RuleInput<'_>, member: StepPass) {
    let cull = ctx.plan.options().cull;
    for (id, access) in ctx.accesses_of(member.pass).filter(|(_, a)| a.kind == AccessKind::Resolve) {
        let place = (member.pass, access.resource);
        if ctx.dropped[id] {
            let why = "declared as `resolve`, but not attached as such";
            ctx.report.require(cull, Rule::Attachments, place, why);
        } else if cull && !ctx.covered(access).any(|part| ctx.is_needed(member.pass, part)) {
            ctx.report.waste(WasteKind::Resolve, place, "it is resolved, but the result is not used");
        }
    }
}

/// Checks declaration order if requested, and the order of passes with side effects in any case.
fn order(ctx: &RuleInput<'_>) {
    let declared = ctx.plan.options().order == Order::Declared;
    let fixed = |p: &&PassId| declared || ctx.flag(**p, PassFlags::SIDE_EFFECT);
    let ordered: Vec<_> = ctx.order.iter().filter(fixed).collect();
    for pair in ordered.windows(2) {
        let name = ctx.graph.pass_name(*pair[0]);
        let why = format_args!("it runs after `{name}`, which is declared later");
        ctx.report.require(pair[0] < pair[1], Rule::Order, *pair[1], why);
    }
}
