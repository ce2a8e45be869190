//! Finds the pass whose commands wgpu refuses.
//!
//! A frame that is well opens one set of error scopes for all passes, and wgpu says at the end that something was wrong. Then
//! each step is recorded once more, into an encoder and scopes of its own, and the step that is refused with one more of
//! its passes each time, until wgpu refuses it: the last of these passes is the one.

use crate::device::error::{DeviceError, ErrorScopes};
use crate::execute::prepared::Prepared;
use crate::execute::recording::Recording;
use crate::execute::steps::{Passes, record_members, recorded_members};
use framegraph::{PassId, StepId};
use wgpu::CommandEncoderDescriptor;

/// The first pass that wgpu refuses, with its reason; none when it refuses none of them alone.
pub(crate) fn refused_pass<W: ?Sized + 'static>(
    frame: &Prepared<'_>,
    passes: &Passes<'_, W>,
    recording: &mut Recording,
) -> Option<(PassId, String)> {
    let mut refused = |step: StepId, count: usize| {
        let scopes = ErrorScopes::open(&frame.gpu.device);
        let descriptor = CommandEncoderDescriptor { label: Some("frame") };
        let mut encoder = frame.gpu.device.create_command_encoder(&descriptor);
        let recorded = record_members(frame, passes, (step, count), recording, &mut encoder);
        drop(encoder.finish());
        match (recorded, scopes.close("a pass")) {
            (Ok(()), Err(DeviceError::Refused { message, .. })) => Some(message),
            _ => None,
        }
    };
    let step = frame.plan.step_ids().find(|step| refused(*step, usize::MAX).is_some())?;
    let mut members = recorded_members(frame.plan, step).enumerate();
    members.find_map(|(before, member)| refused(step, before + 1).map(|message| (member.pass, message)))
}
