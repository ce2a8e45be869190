//! Finds the pass whose commands wgpu refuses, and the import that it refuses to submit.
//!
//! A frame that is well has one [`Watch`](crate::device::error::Watch) for all passes, which says at the end that something was wrong. Then
//! each step is recorded once more, into an encoder and scopes of its own, and the step that is refused with one more of
//! its passes each time, until wgpu refuses it: the last of these passes is the one.

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

/// The first pass that wgpu refuses, with its reason; none when it refuses none of them alone.
pub(crate) fn refused_pass<W: ?Sized + 'static>(
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

/// Why a frame that was recorded was not submitted: the import that cannot be used, or none of them.
pub(crate) fn not_submitted(gpu: &Gpu, plan: &Plan, imports: &Imports, message: String) -> ExecuteError {
    let import = plan.graph().resource_ids().find(|resource| is_unusable(gpu, plan, imports, *resource));
    ExecuteError::Submission { import: import.map(|import| Named::resource(plan, import)), message }
}

/// Whether a resource is an import that wgpu does not take: a view is not made of a destroyed texture, and commands that do
/// nothing but name a buffer are not submitted when it is destroyed or mapped.
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
