//! Finds the pass whose commands wgpu refuses.
//!
//! A frame that is well opens one set of error scopes for all passes, and wgpu says at the end that something was wrong. Then
//! each step is recorded once more, into an encoder and scopes of its own, and the step that is refused with one more of
//! its passes each time, until wgpu refuses it: the last of these passes is the one.

use crate::device::error::{DeviceError, ErrorScopes};
use crate::execute::prepared::Prepared;
use crate::execute::recording::Recording;
use crate::execute::steps::{Passes, record_members};
use framegraph::{Join, PassId, StepId, StepPass};
use wgpu::CommandEncoderDescriptor;

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
