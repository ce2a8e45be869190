//! Compiles a plan again, for scheduling on several queues.

use framegraph::{Alias, Caps, CompileErrors, Options, Plan, Scratch, compile};

/// Compiles the frame of `plan` for a device with several queues.
///
/// Disables aliasing, because [`share_memory`](crate::share_memory) shares memory according to the schedule. Enables
/// explicit barriers, because queues that read the same texture must agree on its layout.
///
/// # Errors
/// Returns the errors of compiling `plan` itself.
pub fn replan(plan: &Plan) -> Result<Plan, CompileErrors> {
    let caps = Caps { explicit_barriers: true, ..plan.caps().clone() };
    let options = Options { alias: Alias::Off, ..*plan.options() };
    let mut own = Plan::new();
    compile(plan.graph(), &caps, &options, &mut Scratch::new(), &mut own)?;
    Ok(own)
}
