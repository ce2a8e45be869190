//! The recording context of a pass: the current step, resources and caches.

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

/// Encoder of the current step. wgpu's pass types are large, so they are borrowed instead of moved.
#[derive(Debug)]
pub(crate) enum StepEncoder<'a> {
    /// A render pass.
    Raster(&'a mut RenderPass<'static>),
    /// A compute pass.
    Compute(&'a mut ComputePass<'static>),
    /// Command encoder, for copies.
    Copy(&'a mut CommandEncoder),
}

impl StepEncoder<'_> {
    /// Borrows the encoder for one pass of the step.
    pub(crate) fn reborrow(&mut self) -> StepEncoder<'_> {
        match self {
            StepEncoder::Raster(pass) => StepEncoder::Raster(pass),
            StepEncoder::Compute(pass) => StepEncoder::Compute(pass),
            StepEncoder::Copy(encoder) => StepEncoder::Copy(encoder),
        }
    }

    /// Begins a group of commands with a name for debuggers such as RenderDoc.
    pub(crate) fn push_debug_group(&mut self, name: &str) {
        match self {
            StepEncoder::Raster(pass) => pass.push_debug_group(name),
            StepEncoder::Compute(pass) => pass.push_debug_group(name),
            StepEncoder::Copy(encoder) => encoder.push_debug_group(name),
        }
    }

    /// Ends the last group.
    pub(crate) fn pop_debug_group(&mut self) {
        match self {
            StepEncoder::Raster(pass) => pass.pop_debug_group(),
            StepEncoder::Compute(pass) => pass.pop_debug_group(),
            StepEncoder::Copy(encoder) => encoder.pop_debug_group(),
        }
    }
}

/// Context of a recorder: gives access to the current render or compute pass, views of declared resources, pipelines
/// and bind groups.
///
/// Returned objects are cheap clones, so they can be used while the render pass is borrowed.
///
/// ```
/// use framegraph::View;
/// use framegraph_wgpu::{Cx, Raster, RecordError, SamplerDesc, Shader};
///
/// # const COPY: Shader<'static> = Shader::new("copy", "");
/// /// Draws a fullscreen triangle that samples the texture declared as `source`.
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
    pub(crate) encoder: StepEncoder<'a>,
    /// Passes that the plan inlined into this pass's fragment shader.
    pub(crate) inlined: &'a [Inlined],
    /// True if the recorder requested them.
    pub(crate) requested_inlined: bool,
}

impl<'a> Cx<'a> {
    /// Returns the device and its queue.
    pub fn gpu(&self) -> &'a Gpu {
        self.frame.gpu
    }

    /// Returns the full name of the pass.
    pub fn pass_name(&self) -> &'a str {
        self.frame.plan.graph().pass_name(self.pass)
    }

    /// Returns the plan that is being executed.
    pub fn plan(&self) -> &'a Plan {
        self.frame.plan
    }

    /// Returns width and height of the frame in texels.
    pub fn frame_texels(&self) -> [u32; 2] {
        self.frame.plan.frame()
    }

    /// Returns formats, samples and size of the current step's attachments.
    pub fn targets(&self) -> &'a Targets {
        self.targets
    }

    /// Returns the current render pass. Viewport and scissor cover the attachments, and stencil reference and blend
    /// constant are 0, even after other passes of the step.
    ///
    /// # Errors
    /// Fails if the pass is not a raster pass.
    pub fn render_pass(&mut self) -> Result<&mut RenderPass<'static>, RecordError> {
        match &mut self.encoder {
            StepEncoder::Raster(pass) => Ok(pass),
            StepEncoder::Compute(_) => Err(wrong_kind(PassKind::Raster, PassKind::Compute)),
            StepEncoder::Copy(_) => Err(wrong_kind(PassKind::Raster, PassKind::Copy)),
        }
    }

    /// Returns the current compute pass.
    ///
    /// # Errors
    /// Fails if the pass is not a compute pass.
    pub fn compute_pass(&mut self) -> Result<&mut ComputePass<'static>, RecordError> {
        match &mut self.encoder {
            StepEncoder::Compute(pass) => Ok(pass),
            StepEncoder::Raster(_) => Err(wrong_kind(PassKind::Compute, PassKind::Raster)),
            StepEncoder::Copy(_) => Err(wrong_kind(PassKind::Compute, PassKind::Copy)),
        }
    }

    /// Returns the command encoder, for copies.
    ///
    /// # Errors
    /// Fails if the pass is not a copy pass, since wgpu locks the encoder during render and compute passes.
    pub fn encoder(&mut self) -> Result<&mut CommandEncoder, RecordError> {
        match &mut self.encoder {
            StepEncoder::Copy(encoder) => Ok(encoder),
            StepEncoder::Raster(_) => Err(wrong_kind(PassKind::Copy, PassKind::Raster)),
            StepEncoder::Compute(_) => Err(wrong_kind(PassKind::Copy, PassKind::Compute)),
        }
    }

    /// Uploads a value to a uniform buffer of this frame and returns its binding.
    ///
    /// The type must follow the layout rules of WGSL's uniform address space. A value smaller than the shader's type is
    /// rejected when it is bound.
    pub fn uniform<T: bytemuck::NoUninit>(&mut self, value: &T) -> Binding {
        self.recording.uniforms.push(&self.frame.gpu.device, bytemuck::bytes_of(value))
    }

    /// Uploads an array of values like [`Cx::uniform`].
    pub fn uniforms<T: bytemuck::NoUninit>(&mut self, values: &[T]) -> Binding {
        self.recording.uniforms.push(&self.frame.gpu.device, bytemuck::cast_slice(values))
    }

    /// Returns the sampler with this description. Samplers are cached.
    pub fn sampler(&mut self, shape: SamplerDesc) -> wgpu::Sampler {
        self.frame.caches.samplers.get(&self.frame.gpu.device, shape)
    }

    /// Returns a bind group with the layout `group`. Each binding has its `@binding` number. Bind groups are cached.
    ///
    /// If wgpu rejects the bind group, the pass fails when its recorder returns. The error names shader, group, binding
    /// and variable ([`RecordError::Binding`]).
    pub fn bind_group<'l>(&mut self, group: impl Into<Group<'l>>, bindings: &[(u32, Binding)]) -> BindGroup {
        let (group, device) = (group.into(), &self.frame.gpu.device);
        let (frame, pass) = (self.frame, self.pass);
        let label = || {
            let pass = frame.plan.graph().pass_name(pass);
            format!("{pass}: group {} of {}", group.index(), group.shader())
        };
        let last = self.recording.requests.step().groups.next();
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

    /// Stores the error for the end of the pass and returns an empty bind group.
    fn no_group(&mut self, error: RecordError) -> BindGroup {
        self.recording.refused.get_or_insert(error);
        let device = &self.frame.gpu.device;
        let layout =
            device.create_bind_group_layout(&BindGroupLayoutDescriptor { label: Some("refused"), entries: &[] });
        device.create_bind_group(&BindGroupDescriptor { label: Some("refused"), layout: &layout, entries: &[] })
    }

    /// Returns the render pipeline for the targets of the current step. Write masks are zero for color slots that this
    /// pass does not declare. Pipelines are cached.
    ///
    /// # Errors
    /// Fails with the shader's name if it does not compile or does not match the targets.
    pub fn raster_pipeline(&mut self, raster: &Raster<'_>) -> Result<RasterPipeline, RecordError> {
        let Prepared { gpu, plan, caches, .. } = *self.frame;
        let own_slots = || {
            let own = plan.graph().accesses_of(self.pass).iter().filter(|a| a.kind == AccessKind::Color);
            own.fold(0, |slots, access| slots | 1 << access.slot)
        };
        let targets = ((plan.compilation(), self.pass), self.targets);
        let last = self.recording.requests.step().rasters.next();
        Ok(caches.pipelines.raster(last, &gpu.device, raster, targets, own_slots)?)
    }

    /// Returns the compute pipeline. Pipelines are cached.
    ///
    /// # Errors
    /// Fails like [`Cx::raster_pipeline`].
    pub fn compute_pipeline(&mut self, compute: &Compute<'_>) -> Result<ComputePipeline, RecordError> {
        let last = self.recording.requests.step().computes.next();
        Ok(self.frame.caches.pipelines.compute(last, &self.frame.gpu.device, compute)?)
    }

    /// Returns the passes that the plan inlined into this pass's shader, in order. These passes record nothing
    /// themselves.
    ///
    /// If the pass declares `takes_epilogue`, its recorder must call this function or [`Cx::epilogues`], and run the
    /// epilogues at the end of its fragment shader.
    pub fn inlined(&mut self) -> impl Iterator<Item = PassId> + use<'a> {
        self.requested_inlined = true;
        self.inlined.iter().map(|i| i.pass)
    }

    /// Returns the epilogues to run at the end of this pass's fragment shader, in order, each with the color slot that
    /// it modifies.
    ///
    /// # Errors
    /// Fails if an inlined pass returns no epilogue ([`Record::epilogue`](crate::Record::epilogue)).
    pub fn epilogues(&mut self) -> Result<Vec<(u8, &'a Epilogue)>, RecordError> {
        self.requested_inlined = true;
        let said = |i: &'a Inlined| {
            let pass = || Named::pass(self.frame.plan, i.pass);
            i.epilogue.as_ref().map(|e| (i.slot, e)).ok_or_else(|| RecordError::NoEpilogue { pass: pass() })
        };
        self.inlined.iter().map(said).collect()
    }
}

const fn wrong_kind(requested: PassKind, actual: PassKind) -> RecordError {
    RecordError::WrongKind { requested, actual }
}
