//! What a recorder works with: the open step, the physical resources behind its handles, and the caches.

use crate::device::error::DeviceError;
use crate::device::gpu::Gpu;
use crate::execute::epilogue::{Epilogue, Inlined};
use crate::execute::error::RecordError;
use crate::execute::prepared::Prepared;
use crate::execute::recording::Recording;
use crate::execute::targets::Targets;
use crate::named::Named;
use crate::pipelines::bind_groups::Binding;
use crate::pipelines::pipeline::{ComputePipeline, Group, RasterPipeline};
use crate::pipelines::samplers::SamplerDesc;
use crate::pipelines::state::{Compute, Raster};
use framegraph::{AccessKind, PassId, PassKind, Plan, StepId};
use wgpu::{BindGroup, BindGroupDescriptor, BindGroupLayoutDescriptor, CommandEncoder, ComputePass, RenderPass};

/// What the commands of a step go into. Passes are long, and not moved.
#[derive(Debug)]
pub(crate) enum Open<'a> {
    /// A render pass.
    Raster(&'a mut RenderPass<'static>),
    /// A compute pass.
    Compute(&'a mut ComputePass<'static>),
    /// The encoder itself, for copies.
    Copy(&'a mut CommandEncoder),
}

impl Open<'_> {
    /// The same for one pass of the step.
    pub(crate) fn reborrow(&mut self) -> Open<'_> {
        match self {
            Open::Raster(pass) => Open::Raster(pass),
            Open::Compute(pass) => Open::Compute(pass),
            Open::Copy(encoder) => Open::Copy(encoder),
        }
    }
}

/// What the recorder of one pass works with: the open pass, views of declared resources, pipelines, bind groups. Everything it hands out is a cheap clone, so that the render pass can be borrowed
/// while bindings are at hand.
///
/// ```
/// use framegraph::View;
/// use framegraph_wgpu::{Cx, Raster, RecordError, SamplerDesc, Shader};
///
/// # const COPY: Shader<'static> = Shader::new("copy", "");
/// /// Draws one triangle over everything, which samples what the pass declared as `source`.
/// fn draw(source: View, brightness: f32, cx: &mut Cx<'_>) -> Result<(), RecordError> {
///     let pipeline = cx.raster_pipeline(&Raster::new(COPY))?;
///     let bindings = [
///         (0, cx.view(source)?.into()),
///         (1, cx.sampler(SamplerDesc::LINEAR).into()),
///         (2, cx.uniform(&[brightness; 4])),
///     ];
///     let group = cx.bind_group(pipeline.group(0), &bindings);
///     let pass = cx.render_pass()?;
///     pass.set_pipeline(&pipeline);
///     pass.set_bind_group(0, &group, &[]);
///     pass.draw(0..3, 0..1);
///     Ok(())
/// }
/// ```
#[derive(Debug)]
pub struct Cx<'a> {
    pub(crate) frame: &'a Prepared<'a>,
    pub(crate) step: StepId,
    pub(crate) pass: PassId,
    pub(crate) targets: &'a Targets,
    pub(crate) recording: &'a mut Recording,
    pub(crate) open: Open<'a>,
    /// What the plan put at the end of this pass's fragment shader.
    pub(crate) inlined: &'a [Inlined],
    /// Whether the recorder asked for them.
    pub(crate) asked_inlined: bool,
}

impl<'a> Cx<'a> {
    /// The device and its queue.
    pub fn gpu(&self) -> &'a Gpu {
        self.frame.gpu
    }

    /// The full name of the pass.
    pub fn pass_name(&self) -> &'a str {
        self.frame.plan.graph().pass_name(self.pass)
    }

    /// The plan that is being executed.
    pub fn plan(&self) -> &'a Plan {
        self.frame.plan
    }

    /// Width and height of the frame in texels.
    pub fn frame_texels(&self) -> [u32; 2] {
        self.frame.plan.frame()
    }

    /// Formats, samples and size of the attachments of the open step.
    pub fn targets(&self) -> &'a Targets {
        self.targets
    }

    /// The open render pass. Viewport and scissor cover the attachments, stencil reference and blend constant are 0,
    /// whatever the passes before set.
    ///
    /// # Errors
    /// When the pass is no raster pass.
    pub fn render_pass(&mut self) -> Result<&mut RenderPass<'static>, RecordError> {
        match &mut self.open {
            Open::Raster(pass) => Ok(pass),
            Open::Compute(_) => Err(wrong_kind(PassKind::Raster, PassKind::Compute)),
            Open::Copy(_) => Err(wrong_kind(PassKind::Raster, PassKind::Copy)),
        }
    }

    /// The open compute pass.
    ///
    /// # Errors
    /// When the pass is no compute pass.
    pub fn compute_pass(&mut self) -> Result<&mut ComputePass<'static>, RecordError> {
        match &mut self.open {
            Open::Compute(pass) => Ok(pass),
            Open::Raster(_) => Err(wrong_kind(PassKind::Compute, PassKind::Raster)),
            Open::Copy(_) => Err(wrong_kind(PassKind::Compute, PassKind::Copy)),
        }
    }

    /// The command encoder, for copies.
    ///
    /// # Errors
    /// When the pass is no copy pass: the encoder is locked while a render or compute pass is open.
    pub fn encoder(&mut self) -> Result<&mut CommandEncoder, RecordError> {
        match &mut self.open {
            Open::Copy(encoder) => Ok(encoder),
            Open::Raster(_) => Err(wrong_kind(PassKind::Copy, PassKind::Raster)),
            Open::Compute(_) => Err(wrong_kind(PassKind::Copy, PassKind::Compute)),
        }
    }

    /// Uploads a block of constants for this frame and returns what to bind. The layout is the shader's (the rules of WGSL's
    /// uniform address space are the caller's business), and so is the size: fewer bytes than the shader's type has are
    /// refused when they are bound.
    pub fn uniform<T: bytemuck::NoUninit>(&mut self, value: &T) -> Binding {
        self.recording.uniforms.push(&self.frame.gpu.device, bytemuck::bytes_of(value))
    }

    /// As [`Cx::uniform`], for several values in a row.
    pub fn uniforms<T: bytemuck::NoUninit>(&mut self, values: &[T]) -> Binding {
        self.recording.uniforms.push(&self.frame.gpu.device, bytemuck::cast_slice(values))
    }

    /// The sampler of that description, made when it is first asked for.
    pub fn sampler(&mut self, shape: SamplerDesc) -> wgpu::Sampler {
        self.frame.caches.samplers.get(&self.frame.gpu.device, shape)
    }

    /// The bind group of that layout, each binding beside its `@binding` number. What wgpu refuses of it fails the pass when
    /// its recorder returns, with the names of shader, group, binding and variable ([`RecordError::Binding`]).
    pub fn bind_group<'l>(&mut self, group: impl Into<Group<'l>>, bindings: &[(u32, Binding)]) -> BindGroup {
        let (group, device) = (group.into(), &self.frame.gpu.device);
        let (frame, pass) = (self.frame, self.pass);
        let label = || {
            let pass = frame.plan.graph().pass_name(pass);
            format!("{pass}: group {} of {}", group.index(), group.shader())
        };
        let last = self.recording.remembered.step().groups.next();
        let made = match group.layout() {
            Ok(layout) => frame.caches.groups.get(last, device, layout, bindings, label),
            Err(error) => return self.no_group(error.into()),
        };
        match made {
            Ok(made) => made,
            Err(DeviceError::Refused { message, .. }) => self.no_group(group.explain(bindings, message).into()),
            Err(error) => self.no_group(error.into()),
        }
    }

    /// Notes why there is no bind group, and returns an empty one.
    fn no_group(&mut self, error: RecordError) -> BindGroup {
        self.recording.refused.get_or_insert(error);
        let device = &self.frame.gpu.device;
        let layout =
            device.create_bind_group_layout(&BindGroupLayoutDescriptor { label: Some("refused"), entries: &[] });
        device.create_bind_group(&BindGroupDescriptor { label: Some("refused"), layout: &layout, entries: &[] })
    }

    /// The raster pipeline for the targets of the open step. Color slots that this pass does not declare are left alone.
    ///
    /// # Errors
    /// A shader that does not compile or does not fit, with its name.
    pub fn raster_pipeline(&mut self, raster: &Raster<'_>) -> Result<RasterPipeline, RecordError> {
        let Prepared { gpu, plan, caches, .. } = *self.frame;
        let own_slots = || {
            let own = plan.graph().accesses_of(self.pass).iter().filter(|a| a.kind == AccessKind::Color);
            own.fold(0, |slots, access| slots | 1 << access.slot)
        };
        let targets = ((plan.compilation(), self.pass), self.targets);
        let last = self.recording.remembered.step().rasters.next();
        Ok(caches.pipelines.raster(last, &gpu.device, raster, targets, own_slots)?)
    }

    /// The compute pipeline.
    ///
    /// # Errors
    /// As [`Cx::raster_pipeline`].
    pub fn compute_pipeline(&mut self, compute: &Compute<'_>) -> Result<ComputePipeline, RecordError> {
        let last = self.recording.remembered.step().computes.next();
        Ok(self.frame.caches.pipelines.compute(last, &self.frame.gpu.device, compute)?)
    }

    /// The passes that became epilogues of this pass's shader, in order; they record nothing themselves. A recorder whose
    /// pass declares `takes_epilogue` has to ask, here or with [`Cx::epilogues`], and to run them at the end of its
    /// fragment shader.
    pub fn inlined(&mut self) -> impl Iterator<Item = PassId> + use<'a> {
        self.asked_inlined = true;
        self.inlined.iter().map(|i| i.pass)
    }

    /// What to do at the end of this pass's fragment shader: for each inlined pass, in order, the color output that it
    /// works on and what it does.
    ///
    /// # Errors
    /// When an inlined pass does not say what it does ([`Record::epilogue`](crate::Record::epilogue)).
    pub fn epilogues(&mut self) -> Result<Vec<(u8, &'a Epilogue)>, RecordError> {
        self.asked_inlined = true;
        let said = |i: &'a Inlined| {
            let pass = || Named::pass(self.frame.plan, i.pass);
            i.epilogue.as_ref().map(|e| (i.slot, e)).ok_or_else(|| RecordError::NoEpilogue { pass: pass() })
        };
        self.inlined.iter().map(said).collect()
    }
}

const fn wrong_kind(asked: PassKind, open: PassKind) -> RecordError {
    RecordError::WrongKind { asked, open }
}
