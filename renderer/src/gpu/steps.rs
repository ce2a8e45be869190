//! The steps of one frame: wgpu's side of [`Backend`].

use super::attachments::Attached;
use super::cx::{Cx, Open};
use super::epilogue::{Inlined, inlined_after};
use super::error::{ExecuteError, RecordError};
use super::executor::Executor;
use super::fill::clear_stored;
use super::imports::Imports;
use super::poison;
use super::realize::Sources;
use super::targets::Targets;
use super::timing::Stamps;
use crate::backend::Backend;
use crate::frame::Frame;
use framegraph::{
    AccessKind, Aspect, Attachment, Format, Join, PassFlags, PassId, PassKind, Plan, Range, Role, StepId,
};
use std::time::Instant;
use wgpu::{
    CommandEncoder, CommandEncoderDescriptor, ComputePassDescriptor, ComputePassTimestampWrites, RenderPass,
    RenderPassDescriptor, RenderPassTimestampWrites,
};

/// A pass whose recorder is not in the frame: the one that an inspection adds.
#[derive(Clone, Copy)]
pub(crate) struct Extra<'x> {
    pub(crate) pass: PassId,
    pub(crate) record: &'x dyn Fn(&mut Cx<'_>) -> Result<(), RecordError>,
}

/// One frame in the making.
pub(crate) struct Steps<'x> {
    executor: &'x mut Executor,
    imports: &'x Imports,
    extra: Option<Extra<'x>>,
    /// Taken by `submit`.
    encoder: Option<CommandEncoder>,
    open: Option<Open>,
    targets: Targets,
    stamps: Option<Stamps>,
    /// The passes of the open step that went into the shader of another one.
    taken: Vec<PassId>,
}

impl<'x> Steps<'x> {
    pub(crate) fn new(executor: &'x mut Executor, imports: &'x Imports, extra: Option<Extra<'x>>) -> Self {
        let begun = Instant::now();
        let encoder = executor.gpu.device.create_command_encoder(&CommandEncoderDescriptor { label: Some("frame") });
        executor.timing.was_in_wgpu(begun);
        let (encoder, open, targets, stamps, taken) = (Some(encoder), None, Targets::default(), None, Vec::new());
        Self { executor, imports, extra, encoder, open, targets, stamps, taken }
    }

    fn begin_raster(&mut self, plan: &Plan, step: StepId) -> Result<(), ExecuteError> {
        let Executor { gpu, caches, realized, executed, options, poisoned, .. } = &mut *self.executor;
        if plan.attachments_of(step).is_empty() {
            let pass = label(plan, step).to_owned();
            return Err(ExecuteError::NoAttachment { pass });
        }
        let both = |a: &&Attachment| a.role == Role::Depth && is_sampled(plan, step, a);
        if let Some(attachment) = plan.attachments_of(step).iter().find(both) {
            let resource = plan.graph().resource_name(attachment.resource).to_owned();
            return Err(ExecuteError::Planes { resource });
        }
        let mut attached = Attached::of(plan, step, gpu, realized, &mut caches.views)?;
        attached.count(executed);
        if options.poison {
            *poisoned += poison::at_start(&mut attached, plan, step);
        }
        let timestamp_writes = self.stamps.as_ref().map(|s| RenderPassTimestampWrites {
            query_set: &s.queries,
            beginning_of_pass_write_index: Some(s.begin),
            end_of_pass_write_index: Some(s.end),
        });
        let begun = Instant::now();
        let encoder = recording(&mut self.encoder);
        let pass = attached.with_descriptor(|color_attachments, depth_stencil_attachment| {
            encoder.begin_render_pass(&RenderPassDescriptor {
                label: Some(label(plan, step)),
                color_attachments,
                depth_stencil_attachment,
                timestamp_writes,
                multiview_mask: self.targets.multiview_mask(),
                ..Default::default()
            })
        });
        // The encoder is not touched again before the pass is dropped in `end`.
        self.open = Some(Open::Raster(pass.forget_lifetime()));
        self.executor.timing.was_in_wgpu(begun);
        Ok(())
    }
}

impl Backend for Steps<'_> {
    type Error = ExecuteError;

    fn realize(&mut self, plan: &Plan) -> Result<(), ExecuteError> {
        let Executor { gpu, textures, buffers, histories, realized, executed, options, .. } = &mut *self.executor;
        let poison = options.poison;
        realized.realize(plan, &mut Sources { gpu, textures, buffers, histories, imports: self.imports, poison })?;
        executed.memoryless = realized.memoryless();
        Ok(())
    }

    fn begin(&mut self, plan: &Plan, step: StepId) -> Result<(), ExecuteError> {
        self.targets = Targets::of(plan, step);
        let Executor { gpu, caches, realized, options, poisoned, .. } = &mut *self.executor;
        let encoder = recording(&mut self.encoder);
        if options.poison {
            *poisoned += poison::at_first_use(plan, step, gpu, realized, &mut caches.views, encoder);
        }
        clear_stored(plan, step, realized, &mut caches.views, encoder, gpu.device.features())?;
        self.stamps = self.executor.timing.begin_step(step);
        match plan.steps()[step.index()].kind {
            PassKind::Raster => self.begin_raster(plan, step)?,
            PassKind::Compute => {
                let timestamp_writes = self.stamps.as_ref().map(|s| ComputePassTimestampWrites {
                    query_set: &s.queries,
                    beginning_of_pass_write_index: Some(s.begin),
                    end_of_pass_write_index: Some(s.end),
                });
                let descriptor = ComputePassDescriptor { label: Some(label(plan, step)), timestamp_writes };
                let begun = Instant::now();
                let pass = recording(&mut self.encoder).begin_compute_pass(&descriptor);
                self.open = Some(Open::Compute(pass.forget_lifetime()));
                self.executor.timing.was_in_wgpu(begun);
            }
            PassKind::Copy => {
                if let Some(stamps) = &self.stamps {
                    recording(&mut self.encoder).write_timestamp(&stamps.queries, stamps.begin);
                }
                self.open = Some(Open::Copy);
            }
        }
        self.executor.executed.steps += 1;
        Ok(())
    }

    fn record<W: ?Sized + 'static>(
        &mut self,
        plan: &Plan,
        step: StepId,
        pass: PassId,
        frame: &Frame<W>,
        world: &W,
    ) -> Result<(), ExecuteError> {
        let members = plan.passes_of(step);
        let Self { executor, extra, encoder: Some(encoder), open: Some(open), targets, taken, .. } = self else {
            unreachable!("a pass is recorded between `begin` and `end`");
        };
        if let (Open::Raster(raster), true) = (&mut *open, members[0].pass != pass) {
            reset_state(raster, targets.extent);
        }
        let Executor { gpu, caches, realized, touched, executed, .. } = &mut **executor;
        let (inlined, asked_inlined) = (&[][..], false);
        let mut cx =
            Cx { gpu, plan, step, pass, targets, realized, caches, encoder, open, touched, inlined, asked_inlined };
        let inlined = inlined_into(&mut cx, frame, world)?;
        let mut cx = Cx { inlined: &inlined, ..cx };
        let name = || plan.graph().pass_name(pass).to_owned();
        let recorded = match extra {
            Some(extra) if extra.pass == pass => Some((extra.record)(&mut cx)),
            _ => frame.recorders().record(pass, world, &mut cx),
        };
        let asked = cx.asked_inlined;
        match recorded {
            None => return Err(ExecuteError::NoRecorder { pass: name() }),
            Some(Err(RecordError::Device(error))) => return Err(ExecuteError::Device(error)),
            Some(Err(error)) => {
                return Err(ExecuteError::Record { pass: name(), error });
            }
            Some(Ok(())) => {}
        }
        if !asked && !inlined.is_empty() {
            return Err(ExecuteError::EpilogueIgnored { pass: name() });
        }
        taken.extend(inlined.iter().map(|i| i.pass));
        executed.passes += 1;
        Ok(())
    }

    fn end(&mut self, plan: &Plan, step: StepId) -> Result<(), ExecuteError> {
        if let (Some(Open::Copy), Some(stamps)) = (&self.open, &self.stamps) {
            recording(&mut self.encoder).write_timestamp(&stamps.queries, stamps.end);
        }
        // Dropping the pass ends it, and has wgpu look at everything that was recorded into it.
        let begun = Instant::now();
        self.open = None;
        self.executor.timing.was_in_wgpu(begun);
        self.stamps = None;
        let Executor { timing, options, realized, caches, executed, poisoned, .. } = &mut *self.executor;
        timing.end_step(step);
        if options.poison {
            *poisoned += poison::at_end(plan, step, realized, &mut caches.views, recording(&mut self.encoder));
        }
        // Two passes that draw into one target both take what comes after them.
        self.taken.sort_unstable();
        self.taken.dedup();
        executed.inlined += self.taken.len() as u32;
        executed.passes += self.taken.len() as u32;
        self.taken.clear();
        Ok(())
    }

    fn submit(&mut self, plan: &Plan) -> Result<(), ExecuteError> {
        let Executor { gpu, timing, caches, executed, .. } = &mut *self.executor;
        executed.culled = plan.graph().passes().len() as u32 - executed.passes;
        if let Some(mut encoder) = self.encoder.take() {
            let begun = Instant::now();
            timing.resolve(&mut encoder);
            let commands = encoder.finish();
            caches.uniforms.upload(&gpu.queue);
            gpu.queue.submit([commands]);
            timing.was_in_wgpu(begun);
        }
        Ok(())
    }
}

/// What the plan put at the end of the shader of the pass of `cx`, as the recorders tell.
fn inlined_into<W: ?Sized + 'static>(
    cx: &mut Cx<'_>,
    frame: &Frame<W>,
    world: &W,
) -> Result<Vec<Inlined>, ExecuteError> {
    let producer = cx.pass;
    if !cx.plan.graph().passes()[producer.index()].flags.has(PassFlags::TAKES_EPILOGUE) {
        return Ok(Vec::new());
    }
    let mut inlined = Vec::new();
    for (pass, slot) in inlined_after(cx.plan, cx.step, producer) {
        cx.pass = pass;
        let epilogue = frame.recorders().epilogue(pass, world, cx).map_err(|error| {
            let pass = cx.plan.graph().pass_name(pass).to_owned();
            ExecuteError::Record { pass, error }
        })?;
        inlined.push(Inlined { pass, slot, epilogue });
    }
    cx.pass = producer;
    Ok(inlined)
}

/// The encoder, until it is submitted.
fn recording(encoder: &mut Option<CommandEncoder>) -> &mut CommandEncoder {
    let Some(encoder) = encoder else {
        unreachable!("nothing is recorded after `submit`");
    };
    encoder
}

/// What debuggers and errors call a step: its first pass.
fn label(plan: &Plan, step: StepId) -> &str {
    plan.passes_of(step).first().map_or("", |m| plan.graph().pass_name(m.pass))
}

/// Whether a pass of the step reads the attached level and layers other than as an attachment, in whichever plane. What an
/// inlined pass reads at the same pixel is no attachment any more.
fn is_sampled(plan: &Plan, step: StepId, attachment: &Attachment) -> bool {
    let Attachment { mip, layer, layers, .. } = *attachment;
    let attached = Range { mip, mips: 1, layer, layers, aspect: Aspect::All };
    let format = plan.format(attachment.resource).unwrap_or(Format::Depth32Float);
    plan.passes_of(step).iter().any(|member| {
        let inlined = member.join == Join::Inlined;
        let mut accesses = plan.graph().accesses_of(member.pass).iter();
        accesses.any(|a| {
            a.resource == attachment.resource
                && a.range.overlaps(&attached, format)
                && !a.kind.is_attachment()
                && !(inlined && a.kind == AccessKind::SamePixel)
        })
    })
}

/// Undoes what an earlier pass of a merged step set.
fn reset_state(pass: &mut RenderPass<'_>, [width, height]: [u32; 2]) {
    pass.set_viewport(0.0, 0.0, width as f32, height as f32, 0.0, 1.0);
    pass.set_scissor_rect(0, 0, width, height);
    pass.set_blend_constant(wgpu::Color::TRANSPARENT);
    pass.set_stencil_reference(0);
}
