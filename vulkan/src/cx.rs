//! Context of a recorder: the command buffer, and what the pass declared as Vulkan objects.

use crate::driver::Thing;
use crate::error::Error;
use crate::gpu::Gpu;
use crate::imports::Imports;
use crate::layouts::Layouts;
use crate::prepared::PreparedStep;
use crate::render_pass::input_layout;
use crate::resources::Resources;
use crate::shape::Part;
use crate::subpass::is_in_tile;
use crate::views::{ViewShape, Viewed, Views};
use ash::vk;
use framegraph::{
    Access, AccessKind, Aspect, Buffer, BufferView, Format, Join, PassId, Plan, ResourceId, StepId, Texture, View,
};

/// Error of a recorder.
pub type RecordError = Box<dyn std::error::Error + Send + Sync>;

/// A texture as a descriptor binds it.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct BoundImage {
    /// The image, for copies.
    pub image: vk::Image,
    /// A view of the accessed levels, layers and planes; null for copies.
    pub view: vk::ImageView,
    /// The layout during the pass.
    pub layout: vk::ImageLayout,
    /// Index of the input attachment if the pass reads the texture in the tile. Otherwise the texture is sampled.
    pub input: Option<u32>,
}

/// The accessed part of a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoundBuffer {
    /// The buffer.
    pub buffer: vk::Buffer,
    /// Offset of the part in bytes.
    pub offset: u64,
    /// Size of the part in bytes.
    pub bytes: u64,
}

/// Context of one call of the recorder. See [`Executor::execute`](crate::Executor::execute).
pub struct Cx<'a> {
    pub(crate) gpu: &'a Gpu,
    pub(crate) plan: &'a Plan,
    pub(crate) resources: &'a Resources,
    pub(crate) imports: &'a Imports,
    pub(crate) layouts: &'a Layouts,
    pub(crate) views: &'a mut Views,
    pub(crate) prepared: &'a PreparedStep,
    pub(crate) commands: vk::CommandBuffer,
    pub(crate) step: StepId,
    /// Position in the step.
    pub(crate) at: usize,
    pub(crate) queue: usize,
}

impl std::fmt::Debug for Cx<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Cx").field("pass", &self.pass_name()).field("subpass", &self.subpass()).finish_non_exhaustive()
    }
}

impl<'a> Cx<'a> {
    /// The plan that is executed.
    #[must_use]
    pub fn plan(&self) -> &'a Plan {
        self.plan
    }

    /// The device's functions.
    #[must_use]
    pub fn device(&self) -> &'a ash::Device {
        self.gpu.device()
    }

    /// The pass to record.
    #[must_use]
    pub fn pass(&self) -> PassId {
        self.plan.passes_of(self.step)[self.at].pass
    }

    /// Full name of the pass.
    #[must_use]
    pub fn pass_name(&self) -> &'a str {
        self.plan.graph().pass_name(self.pass())
    }

    /// The step that contains the pass.
    #[must_use]
    pub fn step(&self) -> StepId {
        self.step
    }

    /// The reason why the pass is part of its step. For [`Join::Resolve`], the recorder has to draw the resolves of
    /// [`Plan::full_screen_resolves`] instead of the pass.
    #[must_use]
    pub fn join(&self) -> Join {
        self.plan.passes_of(self.step)[self.at].join
    }

    /// Index of the queue on which the pass is recorded.
    #[must_use]
    pub fn queue(&self) -> usize {
        self.queue
    }

    /// The command buffer, inside the render pass of a raster step. Viewport and scissor cover the attachments.
    #[must_use]
    pub fn commands(&self) -> vk::CommandBuffer {
        self.commands
    }

    /// The render pass of a raster step, for pipelines; null for other steps. It stays the same until another plan is
    /// prepared or a frame fails.
    #[must_use]
    pub fn render_pass(&self) -> vk::RenderPass {
        self.prepared.render_pass.unwrap_or_default()
    }

    /// Index of the pass's subpass in its render pass, for pipelines; 0 for compute and copies.
    #[must_use]
    pub fn subpass(&self) -> u32 {
        self.prepared.subpass_of[self.at]
    }

    /// Number of color attachments of the pass's subpass, including unused slots, for pipelines.
    #[must_use]
    pub fn color_slots(&self) -> usize {
        self.prepared.subpasses[self.subpass() as usize].colors.len()
    }

    /// Width and height of the attachments in texels; 0 for a step without attachments.
    #[must_use]
    pub fn extent(&self) -> [u32; 2] {
        self.plan.steps()[self.step.index()].extent
    }

    /// Number of samples of the attachments, for pipelines.
    #[must_use]
    pub fn samples(&self) -> vk::SampleCountFlags {
        vk::SampleCountFlags::from_raw(self.plan.steps()[self.step.index()].samples.max(1).into())
    }

    /// Binds the texture of a read.
    ///
    /// # Errors
    /// Fails if the token belongs to another graph or the texture has no memory.
    pub fn texture(&mut self, view: View) -> Result<BoundImage, Error> {
        let access = self.plan.graph().access_of(view).ok_or_else(|| self.no_access())?;
        self.bind(access, ViewShape::default())
    }

    /// Binds the texture that the pass writes through storage, copies, or as an attachment.
    ///
    /// # Errors
    /// Fails if the handle belongs to another graph or the texture has no memory.
    pub fn target(&mut self, texture: Texture) -> Result<BoundImage, Error> {
        let access = self.plan.graph().writer_of(texture).ok_or_else(|| self.no_access())?;
        self.bind(access, ViewShape::default())
    }

    /// Returns the part of a buffer that the pass reads.
    ///
    /// # Errors
    /// Fails if the token belongs to another graph or the buffer has no memory.
    pub fn buffer(&self, view: BufferView) -> Result<BoundBuffer, Error> {
        let access = self.plan.graph().access_of_buffer(view).ok_or_else(|| self.no_access())?;
        self.buffer_of(access)
    }

    /// Returns the part of a buffer that the pass writes.
    ///
    /// # Errors
    /// Fails if the handle belongs to another graph or the buffer has no memory.
    pub fn target_buffer(&self, buffer: Buffer) -> Result<BoundBuffer, Error> {
        let access = self.plan.graph().writer_of_buffer(buffer).ok_or_else(|| self.no_access())?;
        self.buffer_of(access)
    }

    /// Binds the texture of any access of the pass ([`framegraph::graph::Tables::accesses_of`]).
    ///
    /// # Errors
    /// Fails if the access is of a buffer or the texture has no memory.
    pub fn bind(&mut self, access: &Access, shape: ViewShape) -> Result<BoundImage, Error> {
        let thing = self.thing(access.resource).ok_or_else(|| self.no_access())?;
        let Thing::Image(image) = thing else { return Err(self.no_access()) };
        let imported = self.imports.rows.contains_key(&access.resource);
        let viewed = Viewed { image, resource: access.resource, imported };
        let storage = matches!(access.kind, AccessKind::StorageRead | AccessKind::StorageWrite);
        let view = match access.kind {
            AccessKind::CopySource | AccessKind::CopyTarget => vk::ImageView::null(),
            _ => self.views.bound(&self.gpu.shared.driver, self.plan, viewed, &access.range, storage, shape)?,
        };
        let input = self.input(access);
        let layout = match input {
            Some(index) => {
                let mut reference = self.prepared.subpasses[self.subpass() as usize].inputs[index as usize];
                reference.aspect = shape.aspect.unwrap_or(reference.aspect);
                input_layout(self.plan.format(access.resource).unwrap_or(Format::R8Unorm), &reference)
            }
            None => self.layout(thing, access, shape),
        };
        Ok(BoundImage { image, view, layout, input })
    }

    /// Returns the buffer of any access of the pass.
    ///
    /// # Errors
    /// Fails if the access is of a texture or the buffer has no memory.
    pub fn buffer_of(&self, access: &Access) -> Result<BoundBuffer, Error> {
        let Some(Thing::Buffer(buffer)) = self.thing(access.resource) else { return Err(self.no_access()) };
        let graph = self.plan.graph();
        let whole = graph.resources()[access.resource.index()].desc.bytes(self.plan.frame());
        let (offset, bytes) = graph.bytes_of(access).map_or((0, whole), |part| (part.offset, part.bytes));
        Ok(BoundBuffer { buffer, offset, bytes })
    }

    /// Returns the index of the input attachment of an access; `None` if it is not read in the tile.
    fn input(&self, access: &Access) -> Option<u32> {
        let members = self.plan.passes_of(self.step);
        let in_tile = |other: &&Access| is_in_tile(self.plan, members, self.at, other);
        let own = self.plan.graph().accesses_of(self.pass()).iter();
        own.filter(in_tile).position(|other| other == access).map(|index| index as u32)
    }

    fn layout(&self, thing: Thing, access: &Access, shape: ViewShape) -> vk::ImageLayout {
        let desc = self.plan.graph().resources()[access.resource.index()].desc;
        let Some(desc) = desc.texture() else { return vk::ImageLayout::UNDEFINED };
        let format = self.plan.format(access.resource).unwrap_or(desc.format);
        let stencil = shape.aspect.unwrap_or(access.range.aspect) == Aspect::Stencil && format.planes() > 1;
        let mip = u32::from(shape.mip.unwrap_or(access.range.mip));
        let part = Part { mip, layer: access.range.layer.into(), plane: stencil.into() };
        self.layouts.get(thing, part.index(desc, self.plan.frame()))
    }

    fn thing(&self, id: ResourceId) -> Option<Thing> {
        // The identifier may be that of another graph.
        self.plan.graph().resources().get(id.index())?;
        self.imports.rows.get(&id).map(|row| row.thing).or_else(|| self.resources.of(id))
    }

    fn no_access(&self) -> Error {
        Error::Access { pass: self.pass_name().to_owned() }
    }
}
