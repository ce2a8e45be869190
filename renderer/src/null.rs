//! A back end that writes down what it is told: plans and frames are tested with it, without a GPU.

use crate::backend::{Backend, run};
use crate::frame::Frame;
use framegraph::{LoadOp, PassId, PassKind, Placement, Plan, ResourceId, SlotId, StepId, StoreOp};
use std::fmt::Write;

/// One thing that a back end is told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// Make the texture or buffer of a slot of the pool.
    Slot(SlotId),
    /// Make a texture that lives in the tile.
    Memoryless(ResourceId),
    /// Make, or find, an image that outlives the frame.
    Own(ResourceId),
    /// Use what somebody else owns.
    External(ResourceId),
    /// Open a step.
    Begin(StepId, PassKind),
    /// Attach to the open step; color or depth ops.
    Attach(ResourceId, LoadOp, StoreOp),
    /// Record a pass into the open step.
    Record(PassId),
    /// Close the step.
    End(StepId),
    /// Hand everything over.
    Submit,
}

/// Writes commands down. See the [module](self).
#[derive(Clone, Debug, Default)]
pub struct Null {
    commands: Vec<Command>,
}

/// A pass has no recorder.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("pass `{pass}` has no recorder; add it with `Frame::add` instead of `Graph::add`")]
pub struct NoRecorder {
    /// The pass.
    pub pass: String,
}

impl Null {
    /// The commands that a frame is executed with. The world is not needed: no recorder runs.
    ///
    /// # Errors
    /// When a pass that survived has no recorder.
    pub fn commands<W: ?Sized + 'static>(plan: &Plan, frame: &Frame<W>, world: &W) -> Result<Vec<Command>, NoRecorder> {
        let mut null = Self::default();
        run(&mut null, plan, frame, world)?;
        Ok(null.commands)
    }
}

impl Backend for Null {
    type Error = NoRecorder;

    fn realize(&mut self, plan: &Plan) -> Result<(), NoRecorder> {
        let mut slots = vec![false; plan.slots().len()];
        for (resource, row) in plan.graph().resource_ids().zip(plan.resources()) {
            let command = match row.placement {
                Placement::Slot(slot) if !std::mem::replace(&mut slots[slot.index()], true) => Command::Slot(slot),
                Placement::Memoryless => Command::Memoryless(resource),
                Placement::Own => Command::Own(resource),
                Placement::External => Command::External(resource),
                Placement::Slot(_) | Placement::Unused | Placement::Inlined | Placement::Heap { .. } => continue,
            };
            self.commands.push(command);
        }
        Ok(())
    }

    fn begin(&mut self, plan: &Plan, step: StepId) -> Result<(), NoRecorder> {
        self.commands.push(Command::Begin(step, plan.steps()[step.index()].kind));
        let attachments = plan.attachments_of(step).iter();
        self.commands.extend(attachments.map(|a| Command::Attach(a.resource, a.load, a.store)));
        Ok(())
    }

    fn record<W: ?Sized + 'static>(
        &mut self,
        plan: &Plan,
        _: StepId,
        pass: PassId,
        frame: &Frame<W>,
        _: &W,
    ) -> Result<(), NoRecorder> {
        if !frame.has_recorder(pass) {
            return Err(NoRecorder { pass: plan.graph().pass_name(pass).to_owned() });
        }
        self.commands.push(Command::Record(pass));
        Ok(())
    }

    fn end(&mut self, _: &Plan, step: StepId) -> Result<(), NoRecorder> {
        self.commands.push(Command::End(step));
        Ok(())
    }

    fn submit(&mut self, _: &Plan) -> Result<(), NoRecorder> {
        self.commands.push(Command::Submit);
        Ok(())
    }
}

/// The commands with names, one a line.
pub fn text(commands: &[Command], plan: &Plan) -> String {
    let graph = plan.graph();
    let resource = |r: ResourceId| graph.resource_name(r);
    let mut out = String::new();
    for command in commands {
        let written = match *command {
            Command::Slot(slot) => writeln!(out, "slot {}", slot.index()),
            Command::Memoryless(r) => writeln!(out, "memoryless {}", resource(r)),
            Command::Own(r) => writeln!(out, "own {}", resource(r)),
            Command::External(r) => writeln!(out, "external {}", resource(r)),
            Command::Begin(step, kind) => writeln!(out, "begin {} {}", step.index(), kind.word()),
            Command::Attach(r, load, store) => {
                writeln!(out, "  attach {} {load:?} {store:?}", resource(r))
            }
            Command::Record(pass) => writeln!(out, "  record {}", graph.pass_name(pass)),
            Command::End(step) => writeln!(out, "end {}", step.index()),
            Command::Submit => writeln!(out, "submit"),
        };
        // Writing to a string does not fail.
        debug_assert!(written.is_ok());
    }
    out
}
