//! Recording of one step: begins its pass, runs its recorders in order, and ends it.

use crate::debug::poison;
use crate::execute::cached_step::CachedStep;
use crate::execute::clear::clear_stored;
use crate::execute::cx::{Cx, StepEncoder};
use crate::execute::epilogue::{Inlined, inlined_after};
use crate::execute::error::{ExecuteError, RecordError};
use crate::execute::full_screen_resolve;
use crate::execute::prepared::Prepared;
use crate::execute::recording::Recording;
use crate::execute::targets::Targets;
use crate::frame::Frame;
use crate::measure::timing::TimestampWrites;
use crate::named::Named;
use crate::spans::span;
use framegraph::{Join, MAX_COLORS, PassFlags, PassId, PassKind, Plan, StepId, StepPass};
use wgpu::{
    CommandEncoder, ComputePassDescriptor, ComputePassTimestampWrites, RenderPass, RenderPassDescriptor,
    RenderPassTimestampWrites,
};

/// Pass that an inspection adds, with its recorder.
#[derive(Clone, Copy)]
pub(crate) struct Extra<'x> {
    pub(crate) pass: PassId,
    pub(crate) record: &'x (dyn Fn(&mut Cx<'_>) -> Result<(), RecordError> + Sync),
}

/// Recorders of the passes of a plan.
pub(crate) struct Passes<'x, W: ?Sized> {
    pub(crate) frame: &'x Frame<W>,
    pub(crate) world: &'x W,
    pub(crate) extra: Option<Extra<'x>>,
}

/// Records `step` into `encoder`.
///
/// # Errors
/// Fails if an attachment or clear is not supported, or a recorder fails. The encoder must be dropped in that case.
pub(crate) fn record_step<W: ?Sized>(
    frame: &Prepared<'_>,
    passes: &Passes<'_, W>,
    step: StepId,
    recording: &mut Recording,
    encoder: &mut CommandEncoder,
) -> Result<(), ExecuteError> {
    record_members(frame, passes, (step, frame.plan.passes_of(step)), recording, encoder)
}

/// Records the first passes of a step.
pub(crate) fn record_members<W: ?Sized>(
    frame: &Prepared<'_>,
    passes: &Passes<'_, W>,
    (step, members): (StepId, &[StepPass]),
    recording: &mut Recording,
    encoder: &mut CommandEncoder,
) -> Result<(), ExecuteError> {
    let _span = span!(
        "step",
        name = label(frame.plan, step),
        index = step.index(),
        kind = frame.plan.steps()[step.index()].kind.word(),
        loaded_bytes = frame.plan.step_traffic(step, frame.plan.frame()).loaded_bytes,
        stored_bytes = frame.plan.step_traffic(step, frame.plan.frame()).stored_bytes
    );
    recording.requests.begin(step);
    if frame.poison {
        recording.poisoned += poison::at_first_use(frame, step, encoder);
    }
    let cached = &mut recording.requests.step().cached;
    let found = cached.begin(frame, step)?;
    let CachedStep { targets, poisoned, clears_stored: clears, .. } = *cached;
    recording.requests.views_found += found as u64;
    recording.poisoned += poisoned;
    if clears {
        clear_stored(frame, step, encoder)?;
    }
    let begun = recording.now();
    let timestamps = frame.timing.writes(step);
    let each = |recording: &mut Recording, mut encoder: StepEncoder<'_>| {
        recording.took_in_wgpu(begun);
        recording.requests.step().cached.close();
        recording.executed.steps += 1;
        let mut recorded = members.iter().filter(|m| m.join != Join::Inlined);
        recorded.try_for_each(|member| {
            record_pass(frame, passes, (step, *member), &targets, recording, encoder.reborrow())
        })?;
        // The pass ends when it is dropped; wgpu validates its commands then.
        Ok::<_, ExecuteError>(recording.now())
    };
    let label = Some(label(frame.plan, step));
    let closing = match frame.plan.steps()[step.index()].kind {
        PassKind::Raster => {
            let cached = &recording.requests.step().cached;
            let mut pass = begin_raster(cached, label, timestamps.as_ref(), encoder);
            recording.executed += cached.counts;
            each(recording, StepEncoder::Raster(&mut pass))?
        }
        PassKind::Compute => {
            let timestamp_writes = timestamps.as_ref().map(|t| ComputePassTimestampWrites {
                query_set: &t.queries,
                beginning_of_pass_write_index: Some(t.begin),
                end_of_pass_write_index: Some(t.end),
            });
            let mut pass =
                encoder.begin_compute_pass(&ComputePassDescriptor { label, timestamp_writes }).forget_lifetime();
            each(recording, StepEncoder::Compute(&mut pass))?
        }
        PassKind::Copy => {
            let write = |encoder: &mut CommandEncoder, index: fn(&TimestampWrites) -> u32| {
                timestamps.iter().for_each(|t| encoder.write_timestamp(&t.queries, index(t)));
            };
            write(encoder, |t| t.begin);
            let closing = each(recording, StepEncoder::Copy(&mut *encoder))?;
            write(encoder, |t| t.end);
            closing
        }
    };
    recording.end_step(step, begun, closing);
    if frame.poison {
        recording.poisoned += poison::at_end(frame, step, encoder);
    }
    // Two passes that draw into one target both run the epilogues that follow.
    if !recording.inlined.is_empty() {
        recording.inlined.sort_unstable();
        recording.inlined.dedup();
        recording.executed.inlined += recording.inlined.len() as u32;
        recording.executed.passes += recording.inlined.len() as u32;
        recording.inlined.clear();
    }
    Ok(())
}

/// Begins the render pass of a step. The encoder must not be used before the pass is dropped.
// Inlined, since a render pass is large and would be copied.
#[inline(always)]
fn begin_raster(
    CachedStep { attached, targets, .. }: &CachedStep,
    label: Option<&str>,
    timestamps: Option<&TimestampWrites>,
    encoder: &mut CommandEncoder,
) -> RenderPass<'static> {
    let timestamp_writes = timestamps.map(|t| RenderPassTimestampWrites {
        query_set: &t.queries,
        beginning_of_pass_write_index: Some(t.begin),
        end_of_pass_write_index: Some(t.end),
    });
    // Most passes have one color attachment; an array of eight is expensive to fill.
    let (one, all);
    let color_attachments: &[_] = match attached.colors.len() {
        0 => &[],
        1 => {
            one = [attached.color(0)];
            &one
        }
        count => {
            all = std::array::from_fn::<_, { MAX_COLORS as usize }, _>(|slot| attached.color(slot));
            &all[..count]
        }
    };
    let descriptor = RenderPassDescriptor {
        label,
        color_attachments,
        depth_stencil_attachment: attached.depth(),
        timestamp_writes,
        multiview_mask: targets.multiview_mask(),
        ..Default::default()
    };
    encoder.begin_render_pass(&descriptor).forget_lifetime()
}

fn record_pass<W: ?Sized>(
    frame: &Prepared<'_>,
    passes: &Passes<'_, W>,
    (step, StepPass { pass, join }): (StepId, StepPass),
    targets: &Targets,
    recording: &mut Recording,
    mut encoder: StepEncoder<'_>,
) -> Result<(), ExecuteError> {
    let _span = span!("pass", name = frame.plan.graph().pass_name(pass));
    let Passes { frame: declared, world, extra } = *passes;
    if let (StepEncoder::Raster(raster), true) = (&mut encoder, frame.plan.passes_of(step)[0].pass != pass) {
        reset_state(raster, targets.extent);
    }
    // The label of a render or compute pass with one pass of the graph is its debug group.
    let grouped = frame.plan.passes_of(step).len() > 1 || matches!(encoder, StepEncoder::Copy(_));
    if grouped {
        encoder.push_debug_group(frame.plan.graph().pass_name(pass));
    }
    let resolves = join == Join::Resolve;
    let takes_epilogue = frame.plan.graph().passes()[pass.index()].flags.has(PassFlags::TAKES_EPILOGUE);
    let mut inlined = Vec::new();
    if takes_epilogue && !resolves {
        let (inlined_yet, requested_inlined) = (&[][..], false);
        let (recording, encoder) = (&mut *recording, encoder.reborrow());
        let mut cx = Cx { frame, step, pass, targets, recording, encoder, inlined: inlined_yet, requested_inlined };
        inlined = inlined_into(&mut cx, declared, world)?;
    }
    let (own, requested_inlined) = (&*inlined, false);
    let (recording_of, encoder_of) = (&mut *recording, encoder.reborrow());
    let mut cx = Cx {
        frame,
        step,
        pass,
        targets,
        recording: recording_of,
        encoder: encoder_of,
        inlined: own,
        requested_inlined,
    };
    let recorded = match extra {
        _ if resolves => Some(full_screen_resolve::record(&mut cx)),
        Some(extra) if extra.pass == pass => Some((extra.record)(&mut cx)),
        _ => declared.recorders().record(pass, world, &mut cx),
    };
    let requested = cx.requested_inlined;
    let name = || Named::pass(frame.plan, pass);
    // A stored error is closer to the cause than the recorder's result.
    let recorded = if recording.refused.is_some() { recording.refused.take().map(Err) } else { recorded };
    match recorded {
        None => return Err(ExecuteError::NoRecorder { pass: name() }),
        Some(Err(RecordError::Device(error))) => return Err(ExecuteError::Device(error)),
        Some(Err(error)) => return Err(ExecuteError::Record { pass: name(), error }),
        Some(Ok(())) if !requested && !inlined.is_empty() => {
            return Err(ExecuteError::EpilogueIgnored { pass: name() });
        }
        Some(Ok(())) => {}
    }
    if grouped {
        encoder.pop_debug_group();
    }
    recording.inlined.extend(inlined.iter().map(|i| i.pass));
    recording.executed.passes += u32::from(!resolves);
    Ok(())
}

/// Returns the inlined passes of the current pass with their epilogues.
fn inlined_into<W: ?Sized>(cx: &mut Cx<'_>, declared: &Frame<W>, world: &W) -> Result<Vec<Inlined>, ExecuteError> {
    let (plan, producer) = (cx.frame.plan, cx.pass);
    let mut inlined = Vec::new();
    for (pass, slot) in inlined_after(plan, cx.step, producer) {
        cx.pass = pass;
        let epilogue = declared.recorders().epilogue(pass, world, cx).map_err(|error| {
            let pass = Named::pass(plan, pass);
            ExecuteError::Record { pass, error }
        })?;
        inlined.push(Inlined { pass, slot, epilogue });
    }
    cx.pass = producer;
    Ok(inlined)
}

/// Returns the label of a step for debuggers and errors: the name of its first pass.
fn label(plan: &Plan, step: StepId) -> &str {
    plan.passes_of(step).first().map_or("", |m| plan.graph().pass_name(m.pass))
}

/// Resets state that earlier passes of a merged step may have set.
fn reset_state(pass: &mut RenderPass<'_>, [width, height]: [u32; 2]) {
    pass.set_viewport(0.0, 0.0, width as f32, height as f32, 0.0, 1.0);
    pass.set_scissor_rect(0, 0, width, height);
    pass.set_blend_constant(wgpu::Color::TRANSPARENT);
    pass.set_stencil_reference(0);
}
