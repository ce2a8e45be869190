//! What a back end is: five verbs, called in one order.

use crate::frame::Frame;
use framegraph::{Join, PassId, Plan, StepId};

/// Executes plans. See [`run`] for the order of calls.
///
/// A back end is made for one frame. Whatever a failed frame left open is dropped with it.
pub trait Backend {
    /// Why it could not.
    type Error;

    /// Makes, or finds again, what the plan names.
    ///
    /// # Errors
    /// When something cannot be made.
    fn realize(&mut self, plan: &Plan) -> Result<(), Self::Error>;

    /// Opens a step with its attachments.
    ///
    /// # Errors
    /// When the device cannot.
    fn begin(&mut self, plan: &Plan, step: StepId) -> Result<(), Self::Error>;

    /// Records a pass into the open step.
    ///
    /// # Errors
    /// What the recorder returned, or that there is none.
    fn record<W: ?Sized + 'static>(
        &mut self,
        plan: &Plan,
        step: StepId,
        pass: PassId,
        frame: &Frame<W>,
        world: &W,
    ) -> Result<(), Self::Error>;

    /// Closes the open step.
    ///
    /// # Errors
    /// When the device cannot.
    fn end(&mut self, plan: &Plan, step: StepId) -> Result<(), Self::Error>;

    /// Hands everything recorded to the device.
    ///
    /// # Errors
    /// When the device refuses.
    fn submit(&mut self, plan: &Plan) -> Result<(), Self::Error>;
}

/// Executes a plan: realize, then each step with its passes in order, then submit. Inlined passes record nothing.
///
/// # Errors
/// The first that the back end returned; nothing is submitted then.
pub fn run<B: Backend, W: ?Sized + 'static>(
    backend: &mut B,
    plan: &Plan,
    frame: &Frame<W>,
    world: &W,
) -> Result<(), B::Error> {
    backend.realize(plan)?;
    for step in plan.step_ids() {
        backend.begin(plan, step)?;
        for member in plan.passes_of(step).iter().filter(|m| m.join != Join::Inlined) {
            backend.record(plan, step, member.pass, frame, world)?;
        }
        backend.end(plan, step)?;
    }
    backend.submit(plan)
}
