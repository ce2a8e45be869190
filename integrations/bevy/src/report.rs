//! Report of a frame: recorded loads, stores and memory, against plans for devices.

use crate::declare::{Declared, POINTWISE, declare};
use crate::observed::{Load, Observed, ObservedAttachment, ObservedPass, Slot, Work};
use crate::trace::{TraceError, read};
use crate::window::observe;
use framegraph::file::to_ron;
use framegraph::{
    Alias, Caps, CompileErrors, Decision, Exit, Join, LoadOp, Options, PassId, Placement, Plan, ResourceId, Scratch,
    StoreOp, Subject, compile,
};
use std::fmt::Write;
use std::path::Path;

/// Loads and stores as they were recorded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Recorded {
    /// Number of render passes.
    pub render_passes: u32,
    /// Number of attachments loaded.
    pub loads: u32,
    /// Bytes loaded.
    pub loaded_bytes: u64,
    /// Number of attachments stored, including targets of multisample resolves.
    pub stores: u32,
    /// Bytes stored.
    pub stored_bytes: u64,
    /// Bytes of textures whose contents live only within the frame.
    pub transient_bytes: u64,
}

/// A recorded load or store that a plan does without.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unneeded {
    /// `load` or `store`.
    pub operation: &'static str,
    /// Name of the pass.
    pub pass: String,
    /// Name of the texture.
    pub texture: String,
    /// Bytes moved.
    pub bytes: u64,
    /// Cause, as a part of a sentence.
    pub cause: String,
}

/// A plan of the observed frame for one device.
#[derive(Debug)]
pub struct Planned {
    /// Column title.
    pub title: String,
    /// The plan.
    pub plan: Plan,
    /// Recorded loads and stores that the plan does without, in recorded order.
    pub unneeded: Vec<Unneeded>,
}

/// Report of one frame.
#[derive(Debug)]
pub struct Report {
    /// The frame as recorded.
    pub frame: Observed,
    /// Totals of the recorded frame.
    pub recorded: Recorded,
    /// The frame as a graph.
    pub declared: Declared,
    /// Plans, one per device.
    pub plans: Vec<Planned>,
}

/// Failure to make a report.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// The trace cannot be read.
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// The observed frame does not compile for a device.
    #[error("frame: {0}; report it with the trace")]
    Compile(#[from] CompileErrors),
}

impl Report {
    /// Reads frame `frame` from the trace in `folder`, and plans it for `device` and for [`Caps::tiler`].
    ///
    /// # Errors
    /// Fails if the trace cannot be read, or if its frame does not compile.
    pub fn of_trace(folder: &Path, frame: u32, device: &Caps) -> Result<Self, ReportError> {
        Self::new(observe(&read(folder)?, frame)?, device)
    }

    fn new(frame: Observed, device: &Caps) -> Result<Self, ReportError> {
        let declared = declare(&frame, &[]);
        let merged = declare(&frame, POINTWISE);
        let columns = [
            (format!("plan, {}", device.name), device.clone(), &declared),
            ("plan, tiler".into(), Caps::tiler(), &declared),
            ("plan, tiler, same-pixel reads".into(), Caps::tiler(), &merged),
        ];
        let mut plans = Vec::new();
        for (title, caps, declared) in columns {
            let alias = if caps.placed { Alias::Heap } else { Alias::Pool };
            let options = Options { frame: frame.frame_size(), alias, ..Options::default() };
            let mut plan = Plan::new();
            compile(&declared.graph, &caps, &options, &mut Scratch::new(), &mut plan)?;
            let unneeded = unneeded(&frame, declared, &plan);
            plans.push(Planned { title, plan, unneeded });
        }
        Ok(Self { recorded: recorded(&frame), frame, declared, plans })
    }

    /// Returns the graph as a file that `plan` and the viewer open.
    pub fn ron(&self, name: &str) -> String {
        to_ron(&self.declared.graph, name, self.frame.frame_size())
    }

    /// Returns the report as Markdown.
    pub fn markdown(&self) -> String {
        let mut out = String::new();
        self.write(&mut out).expect("writing to a string cannot fail");
        out
    }

    fn write(&self, out: &mut String) -> std::fmt::Result {
        let [width, height] = self.frame.frame_size();
        let own = self.recorded;
        writeln!(out, "Frame of {width}×{height}: {} passes.\n", self.frame.passes.len())?;
        write!(out, "| | recorded |")?;
        self.plans.iter().try_for_each(|plan| write!(out, " {} |", plan.title))?;
        writeln!(out, "\n| --- |{}", " --- |".repeat(1 + self.plans.len()))?;
        let mut row = |name: &str, recorded: String, of: &dyn Fn(&Plan) -> String| {
            write!(out, "| {name} | {recorded} |")?;
            self.plans.iter().try_for_each(|planned| write!(out, " {} |", of(&planned.plan)))?;
            writeln!(out)
        };
        let frame = self.frame.frame_size();
        row("render passes", own.render_passes.to_string(), &|p| p.counts().render_passes.to_string())?;
        row("loads", own.loads.to_string(), &|p| p.counts().unresolves.to_string())?;
        row("loaded", mib(own.loaded_bytes), &|p| mib(p.traffic(frame).loaded_bytes))?;
        row("stores", own.stores.to_string(), &|p| p.counts().resolves.to_string())?;
        row("stored", mib(own.stored_bytes), &|p| mib(p.traffic(frame).stored_bytes))?;
        row("memoryless textures", "0".into(), &|p| p.counts().memoryless.to_string())?;
        row("transient memory", mib(own.transient_bytes), &|p| mib(allocated(p)))?;
        self.write_lists(out)
    }

    fn write_lists(&self, out: &mut String) -> std::fmt::Result {
        for planned in &self.plans {
            writeln!(out, "\n## {}\n", planned.title)?;
            for own in &planned.unneeded {
                let Unneeded { operation, pass, texture, bytes, cause } = own;
                writeln!(out, "- {operation} of `{texture}` in `{pass}`, {}: {cause}", mib(*bytes))?;
            }
            for (name, bytes) in memoryless(&planned.plan) {
                let saves = planned.plan.caps().memoryless_saves;
                let note = if saves { "" } else { "; this device allocates it anyway" };
                writeln!(out, "- memoryless: `{name}`, {}{note}", mib(bytes))?;
            }
            for names in merged(&planned.plan) {
                writeln!(out, "- one render pass: {}", names.join(", "))?;
            }
            let memory = planned.plan.memory();
            let (apart, shared) = (mib(memory.unaliased_bytes), mib(memory.bytes));
            writeln!(out, "- aliasing: {apart} without sharing, {shared} shared")?;
        }
        if !self.declared.left_out.is_empty() {
            writeln!(out, "\n## Left out of the graph\n")?;
            self.declared.left_out.iter().try_for_each(|own| writeln!(out, "- {own}"))?;
        }
        Ok(())
    }
}

/// Returns the totals of a recorded frame.
fn recorded(frame: &Observed) -> Recorded {
    let mut sum = Recorded::default();
    for pass in frame.passes.iter().filter(|pass| pass.work == Work::Raster) {
        sum.render_passes += 1;
        for own in &pass.attachments {
            let bytes = own.bytes(&frame.textures);
            if own.load == Load::Load {
                sum.loads += 1;
                sum.loaded_bytes += bytes;
            }
            if own.stores {
                sum.stores += 1;
                sum.stored_bytes += bytes;
            }
        }
    }
    let transient = frame.textures.iter().enumerate().filter(|(index, texture)| {
        texture.entry == framegraph::Entry::Undefined && texture.exit == Exit::Discard && frame.uses(*index)
    });
    sum.transient_bytes = transient.map(|(_, texture)| texture.desc.bytes([1, 1])).sum();
    sum
}

/// Returns the recorded loads and stores that `plan` does without.
fn unneeded(frame: &Observed, declared: &Declared, plan: &Plan) -> Vec<Unneeded> {
    let mut out = Vec::new();
    for (pass, id) in frame.passes.iter().zip(&declared.passes) {
        for own in &pass.attachments {
            let Some(resource) = declared.textures[own.region.texture] else { continue };
            let mut add = |operation, cause| {
                out.push(Unneeded {
                    operation,
                    pass: pass.name.clone(),
                    texture: frame.textures[own.region.texture].name.clone(),
                    bytes: own.bytes(&frame.textures),
                    cause,
                });
            };
            let [load, store] = causes(plan, *id, resource, own, pass);
            if let Some(cause) = load.filter(|_| own.load == Load::Load) {
                add("load", cause);
            }
            if let Some(cause) = store.filter(|_| own.stores) {
                add("store", cause);
            }
        }
    }
    out
}

/// Returns why the plan neither loads nor stores an attachment of a pass. `None` for an operation that it performs.
fn causes(
    plan: &Plan,
    pass: Option<PassId>,
    resource: ResourceId,
    own: &ObservedAttachment,
    observed: &ObservedPass,
) -> [Option<String>; 2] {
    let both = |cause: String| [Some(cause.clone()), Some(cause)];
    if observed.draws == 0 && own.load == Load::Load {
        return both("the pass draws nothing".into());
    }
    let Some(pass) = pass else { return both("the pass writes nothing".into()) };
    let step = plan.pass_steps()[pass.index()];
    if step.is_none() {
        return both(plan.verdict(pass).map_or_else(String::new, |reason| reason.sentence(plan.graph())));
    }
    let same = |a: &&framegraph::Attachment| {
        a.resource == resource
            && a.mip == own.region.mip
            && (a.role.is_resolve() == matches!(own.slot, Slot::Resolve(_)))
    };
    let Some(planned) = plan.attachments_of(step).iter().find(same) else { return [None, None] };
    let reason = |subject| {
        let reason = plan.reasons(subject).next()?;
        let sentence = Decision { subject, reason }.sentence(plan.graph());
        Some(sentence.split_once(": ").map_or(sentence.clone(), |(_, cause)| cause.to_owned()))
    };
    let members = plan.passes_of(step);
    let uses = |member: &framegraph::StepPass| {
        plan.graph().accesses_of(member.pass).iter().any(|access| access.resource == resource)
    };
    let earlier = members.iter().take_while(|member| member.pass != pass).find(|member| uses(member));
    let later = members.iter().skip_while(|member| member.pass != pass).skip(1).find(|member| uses(member));
    let name = |member: &framegraph::StepPass| plan.graph().pass_name(member.pass).to_owned();
    let load = match earlier {
        Some(member) => Some(format!("the contents stay in the tile after `{}`", name(member))),
        None if planned.load == LoadOp::Load => None,
        None => Some(reason(Subject::Load(step, resource)).unwrap_or_else(|| "the contents are not used".into())),
    };
    let store = match later {
        Some(member) => Some(format!("the contents stay in the tile for `{}`", name(member))),
        None if planned.store == StoreOp::Store => None,
        None => Some(reason(Subject::Store(step, resource)).unwrap_or_else(|| "the contents are not used".into())),
    };
    [load, store]
}

/// Returns the bytes of transient memory, with memoryless textures where the device allocates them.
fn allocated(plan: &Plan) -> u64 {
    let memory = plan.memory();
    memory.bytes + if plan.caps().memoryless_saves { 0 } else { memory.avoided_bytes }
}

/// Returns names and sizes in bytes of the memoryless textures.
fn memoryless(plan: &Plan) -> Vec<(String, u64)> {
    let graph = plan.graph();
    let own = plan.resources().iter().zip(graph.resource_ids());
    let own = own.filter(|(planned, _)| planned.placement == Placement::Memoryless);
    own.map(|(_, id)| (graph.resource_name(id).to_owned(), graph.resources()[id.index()].desc.bytes(plan.frame())))
        .collect()
}

/// Returns the names of passes that share a render pass, for each render pass of several.
fn merged(plan: &Plan) -> Vec<Vec<String>> {
    let steps = plan.step_ids().map(|step| plan.passes_of(step));
    let several = steps.filter(|passes| passes.iter().filter(|own| own.join != Join::Resolve).count() > 1);
    several.map(|passes| passes.iter().map(|own| format!("`{}`", plan.graph().pass_name(own.pass))).collect()).collect()
}

/// Returns a size in MiB.
fn mib(bytes: u64) -> String {
    format!("{:.2} MiB", bytes as f64 / f64::from(1 << 20))
}
