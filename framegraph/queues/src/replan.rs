//! The plan that queues ask for.

use framegraph::{Alias, Caps, CompileErrors, Options, Plan, Scratch, compile};

/// The frame of `plan` for a device with several queues: nothing shares memory, which [`share_memory`](crate::share_memory) does by the
/// schedule, and transitions are said, since two queues that read one texture must agree on its layout.
///
/// # Errors
/// None but those of compiling `plan` itself.
pub fn replan(plan: &Plan) -> Result<Plan, CompileErrors> {
    let caps = Caps { explicit_barriers: true, ..plan.caps().clone() };
    let options = Options { alias: Alias::Off, ..*plan.options() };
    let mut own = Plan::new();
    compile(plan.graph(), &caps, &options, &mut Scratch::new(), &mut own)?;
    Ok(own)
}
