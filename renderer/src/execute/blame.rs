//! Finds the pass whose commands wgpu rejected, or the import that prevented a submission.
//!
//! A successful frame has only one [`Watch`](crate::device::error::Watch) for all passes. If it reports an error, each
//! step is recorded again with its own encoder and error scopes. The failing step is then recorded with one more pass
//! each time, until wgpu rejects it; the last pass added is at fault.

use crate::device::error::{DeviceError, ErrorScopes};
use crate::device::gpu::Gpu;
use crate::execute::error::ExecuteError;
use crate::execute::prepared::Prepared;
use crate::execute::recording::Recording;
use crate::execute::steps::{Passes, record_members};
use crate::named::Named;
use crate::resources::imports::Imports;
use framegraph::{Join, PassId, Plan, ResourceId, StepId, StepPass};
use wgpu::{BufferTransition, BufferUses, CommandEncoderDescriptor, TextureTransition, TextureViewDescriptor};

/// Returns the first pass that wgpu rejects, with its reason. `None` if every pass is accepted on its own.
pub(crate) fn refused_pass<W: ?Sized>(
    frame: &Prepared<'_>,
    passes: &Passes<'_, W>,
    recording: &mut Recording,
) -> Option<(PassId, String)> {
    let mut refused = |step: StepId, members: &[StepPass]| {
        let scopes = ErrorScopes::open(&frame.gpu.device);
        let descriptor = CommandEncoderDescriptor { label: Some("frame") };
        let mut encoder = frame.gpu.device.create_command_encoder(&descriptor);
        let recorded = record_members(frame, passes, (step, members), recording, &mut encoder);
        drop(encoder.finish());
        match (recorded, scopes.close("a pass")) {
            (Ok(()), Err(DeviceError::Refused { message, .. })) => Some(message),
            _ => None,
        }
    };
    let members = |step: StepId| frame.plan.passes_of(step);
    let step = frame.plan.step_ids().find(|step| refused(*step, members(*step)).is_some())?;
    let mut recorded = members(step).iter().enumerate().filter(|(_, member)| member.join != Join::Inlined);
    recorded.find_map(|(at, member)| refused(step, &members(step)[..=at]).map(|message| (member.pass, message)))
}

/// Returns the error of a recorded frame that could not be submitted, with the unusable import if there is one.
pub(crate) fn not_submitted(gpu: &Gpu, plan: &Plan, imports: &Imports, message: String) -> ExecuteError {
    let import = plan.graph().resource_ids().find(|resource| is_unusable(gpu, plan, imports, *resource));
    ExecuteError::Submission { import: import.map(|import| Named::resource(plan, import)), message }
}

/// Returns whether a resource is an import that wgpu does not accept. A view of a destroyed texture cannot be created.
/// Commands that use a destroyed or mapped buffer cannot be submitted.
fn is_unusable(gpu: &Gpu, plan: &Plan, imports: &Imports, resource: ResourceId) -> bool {
    let scopes = ErrorScopes::open(&gpu.device);
    if let Some((texture, _)) = imports.texture_of(plan.graph(), resource) {
        drop(texture.create_view(&TextureViewDescriptor::default()));
    }
    if let Some(buffer) = imports.buffer_of(plan.graph(), resource) {
        let mut encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor { label: Some("import") });
        let named = BufferTransition { buffer, state: BufferUses::COPY_SRC };
        encoder.transition_resources([named].into_iter(), std::iter::empty::<TextureTransition<&wgpu::Texture>>());
        gpu.queue.submit([encoder.finish()]);
    }
    scopes.close("an import").is_err()
}
