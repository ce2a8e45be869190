//! From the calls of a trace to the passes of a frame.

use crate::observed::{Binding, Effect, Load, ObservedAttachment, ObservedPass, Slot, Use, Used, Work};
use crate::state::{Pipeline, State, key};
use crate::trace::Action;
use framegraph::ClearValue;
use std::convert::Infallible;
use wgpu_core::command::{
    BasePass, ColorAttachments, Command, ComputeCommand, PointerReferences, RenderCommand, ResolvedPassChannel,
    ResolvedRenderPassDepthStencilAttachment,
};
use wgpu_core::id::{PointerId, markers};

type TextureViewId = PointerId<markers::TextureView>;
type Copied = (Option<Used>, Effect);

/// Passes recorded so far, and objects of the device.
#[derive(Debug, Default)]
pub(crate) struct Recorder {
    pub(crate) state: State,
    pub(crate) passes: Vec<ObservedPass>,
    pub(crate) left_out: Vec<String>,
}

impl Recorder {
    /// Processes one call.
    pub(crate) fn apply(&mut self, action: &Action) {
        self.state.apply(action);
        match action {
            Action::WriteTexture { to, size, .. } => {
                let to = self.texture_copy(key(&to.texture), to.mip_level, to.origin, *size, true);
                self.upload(to);
            }
            Action::WriteBuffer { id, offset, size, .. } => {
                let to = self.buffer_copy(key(id), *offset, Some(*size));
                self.upload(to);
            }
            Action::Submit(_, commands) => commands.iter().for_each(|command| self.command(command)),
            _ => {}
        }
    }

    fn command(&mut self, command: &Command<PointerReferences>) {
        match command {
            Command::RunRenderPass { pass, color_attachments, depth_stencil_attachment, .. } => {
                self.render_pass(pass, color_attachments, depth_stencil_attachment.as_ref());
            }
            Command::RunComputePass { pass, .. } => self.compute_pass(pass),
            Command::CopyBufferToBuffer { src, dst, dst_offset, size, .. } => {
                let to = self.buffer_copy(key(dst), *dst_offset, *size);
                self.copy("copy buffer", [self.buffer_read(key(src)), to]);
            }
            Command::CopyBufferToTexture { src, dst, size } => {
                let to = self.texture_copy(key(&dst.texture), dst.mip_level, dst.origin, *size, true);
                self.copy("copy to texture", [self.buffer_read(key(&src.buffer)), to]);
            }
            Command::CopyTextureToBuffer { src, dst, size } => {
                let from = self.texture_copy(key(&src.texture), src.mip_level, src.origin, *size, false);
                let to = self.buffer_copy(key(&dst.buffer), 0, None);
                self.copy("copy to buffer", [from, to]);
            }
            Command::CopyTextureToTexture { src, dst, size } => {
                let from = self.texture_copy(key(&src.texture), src.mip_level, src.origin, *size, false);
                let to = self.texture_copy(key(&dst.texture), dst.mip_level, dst.origin, *size, true);
                self.copy("copy texture", [from, to]);
            }
            Command::ClearBuffer { dst, offset, size } => {
                let to = self.buffer_copy(key(dst), *offset, *size);
                self.copy("clear buffer", [to]);
            }
            Command::ResolveQuerySet { destination, destination_offset, .. } => {
                let to = self.buffer_copy(key(destination), *destination_offset, Some(1));
                self.copy("resolve queries", [to]);
            }
            Command::ClearTexture { .. } => self.left_out.push("a texture cleared outside of a pass".into()),
            Command::BuildAccelerationStructures { .. } => {
                self.left_out.push("acceleration structures that are built".into());
            }
            _ => {}
        }
    }

    fn render_pass(
        &mut self,
        pass: &BasePass<RenderCommand<PointerReferences>, Infallible>,
        colors: &ColorAttachments<TextureViewId>,
        depth: Option<&ResolvedRenderPassDepthStencilAttachment<TextureViewId>>,
    ) {
        let mut draws = Draws::default();
        for command in &pass.commands {
            draws.apply(command, &self.state);
        }
        let mut attachments = Vec::new();
        for (slot, color) in colors.iter().enumerate() {
            let Some(color) = color else { continue };
            let load = match color.load_op {
                wgpu::LoadOp::Load => Load::Load,
                wgpu::LoadOp::Clear(c) => Load::Clear(ClearValue::Color([c.r, c.g, c.b, c.a])),
                wgpu::LoadOp::DontCare(_) => Load::DontCare,
            };
            let stores = color.store_op == wgpu::StoreOp::Store;
            let written = draws.count > 0 || load != Load::Load;
            let mut add = |view: &TextureViewId, slot, load, stores| match self.state.view(key(view)) {
                Some(region) => attachments.push(ObservedAttachment { region, slot, load, stores, written }),
                None => self.left_out.push(format!("an attachment of `{}` with an unknown format", label(&pass.label))),
            };
            add(&color.view, Slot::Color(slot as u8), load, stores);
            if let Some(target) = &color.resolve_target {
                add(target, Slot::Resolve(slot as u8), Load::DontCare, true);
            }
        }
        if let Some(depth) = depth
            && let Some(region) = self.state.view(key(&depth.view))
        {
            let stencil_clear = match &depth.stencil {
                ResolvedPassChannel::Operational(wgpu::Operations { load: wgpu::LoadOp::Clear(value), .. }) => *value,
                _ => 0,
            };
            let (load, stores, read_only) = match &depth.depth {
                ResolvedPassChannel::ReadOnly => (Load::Load, false, true),
                ResolvedPassChannel::Operational(ops) => {
                    let load = match ops.load {
                        wgpu::LoadOp::Load => Load::Load,
                        wgpu::LoadOp::Clear(value) => Load::Clear(ClearValue::DepthStencil(value, stencil_clear)),
                        wgpu::LoadOp::DontCare(_) => Load::DontCare,
                    };
                    (load, ops.store == wgpu::StoreOp::Store, false)
                }
            };
            let written = !read_only && (draws.writes_depth || load != Load::Load);
            attachments.push(ObservedAttachment { region, slot: Slot::Depth, load, stores, written });
        }
        if draws.bundles {
            self.left_out.push(format!("bindings of render bundles in `{}`", label(&pass.label)));
        }
        self.passes.push(ObservedPass {
            name: label(&pass.label),
            work: Work::Raster,
            attachments,
            full_screen: draws.is_full_screen(),
            draws: draws.count,
            uses: draws.uses,
        });
    }

    fn compute_pass(&mut self, pass: &BasePass<ComputeCommand<PointerReferences>, Infallible>) {
        let mut groups = [const { None }; 8];
        for command in &pass.commands {
            let mut uses = Vec::new();
            match command {
                ComputeCommand::SetBindGroup { index, bind_group, .. } => {
                    groups[*index as usize % 8] = bind_group.as_ref().map(key);
                    continue;
                }
                ComputeCommand::DispatchWorkgroups(_) => {}
                ComputeCommand::DispatchWorkgroupsIndirect { buffer, .. } => {
                    uses.extend(self.indirect(key(buffer)));
                }
                _ => continue,
            }
            for own in groups.iter().flatten().filter_map(|group| self.state.groups.get(group)) {
                merge(&mut uses, own);
            }
            self.push(label(&pass.label), Work::Compute, uses);
        }
    }

    fn indirect(&self, buffer: usize) -> Option<Use> {
        indirect(&self.state, buffer)
    }

    fn push(&mut self, name: String, work: Work, uses: Vec<Use>) {
        self.passes.push(ObservedPass { name, work, attachments: Vec::new(), uses, draws: 0, full_screen: false });
    }

    fn copy(&mut self, name: &str, copied: impl IntoIterator<Item = Copied>) {
        self.push_copy(name, Work::Copy, copied);
    }

    fn upload(&mut self, to: Copied) {
        self.push_copy("upload", Work::Upload, [to]);
    }

    fn push_copy(&mut self, name: &str, work: Work, copied: impl IntoIterator<Item = Copied>) {
        let uses = copied.into_iter().filter_map(|(of, effect)| Some(Use { of: of?, binding: Binding::Copy, effect }));
        let uses: Vec<Use> = uses.collect();
        if uses.iter().any(|used| used.effect != Effect::Read) {
            self.push(name.into(), work, uses);
        }
    }

    fn buffer_read(&self, id: usize) -> Copied {
        (self.state.buffer(id).map(Used::Buffer), Effect::Read)
    }

    fn buffer_copy(&self, id: usize, offset: u64, size: Option<u64>) -> Copied {
        let buffer = self.state.buffer(id);
        let bytes = buffer.map_or(0, |buffer| self.state.buffers[buffer].bytes);
        let whole = offset == 0 && size.is_none_or(|size| size >= bytes);
        (buffer.map(Used::Buffer), if whole { Effect::Overwrite } else { Effect::Modify })
    }

    fn texture_copy(&self, id: usize, mip: u32, origin: wgpu::Origin3d, size: wgpu::Extent3d, writes: bool) -> Copied {
        let Some((region, whole)) = self.state.copied(id, mip, origin, size) else { return (None, Effect::Read) };
        let effect = match (writes, whole) {
            (false, _) => Effect::Read,
            (true, true) => Effect::Overwrite,
            (true, false) => Effect::Modify,
        };
        (Some(Used::Texture(region)), effect)
    }
}

/// State of a render pass while its commands are read.
#[derive(Debug, Default)]
struct Draws {
    groups: [Option<usize>; 8],
    pipeline: Pipeline,
    uses: Vec<Use>,
    count: u32,
    triangles: u32,
    writes_depth: bool,
    bundles: bool,
    restricted: bool,
}

impl Draws {
    fn apply(&mut self, command: &RenderCommand<PointerReferences>, state: &State) {
        match command {
            RenderCommand::SetBindGroup { index, bind_group, .. } => {
                self.groups[*index as usize % 8] = bind_group.as_ref().map(key);
            }
            RenderCommand::SetPipeline(id) => {
                self.pipeline = state.pipelines.get(&key(id)).copied().unwrap_or_default();
            }
            RenderCommand::SetViewport { .. } | RenderCommand::SetScissor(_) => self.restricted = true,
            RenderCommand::SetVertexBuffer { .. } => self.restricted = true,
            RenderCommand::Draw { vertex_count: 3, instance_count: 1, .. } => {
                self.triangles += 1;
                self.draw(state);
            }
            RenderCommand::Draw { .. } | RenderCommand::DrawIndexed { .. } | RenderCommand::DrawMeshTasks { .. } => {
                self.draw(state);
            }
            RenderCommand::DrawIndirect { buffer, .. } => {
                self.uses_arguments(key(buffer), state);
                self.draw(state);
            }
            RenderCommand::MultiDrawIndirectCount { buffer, count_buffer, .. } => {
                self.uses_arguments(key(buffer), state);
                self.uses_arguments(key(count_buffer), state);
                self.draw(state);
            }
            RenderCommand::ExecuteBundle(_) => (self.bundles, self.count) = (true, self.count + 1),
            _ => {}
        }
    }

    fn uses_arguments(&mut self, buffer: usize, state: &State) {
        merge(&mut self.uses, &indirect(state, buffer).into_iter().collect::<Vec<_>>());
    }

    fn draw(&mut self, state: &State) {
        self.count += 1;
        self.writes_depth |= self.pipeline.writes_depth;
        self.restricted |= self.pipeline.partial || self.pipeline.tests_depth;
        for own in self.groups.iter().flatten().filter_map(|group| state.groups.get(group)) {
            merge(&mut self.uses, own);
        }
    }

    const fn is_full_screen(&self) -> bool {
        self.count == 1 && self.triangles == 1 && !self.restricted
    }
}

fn indirect(state: &State, buffer: usize) -> Option<Use> {
    let of = Used::Buffer(state.buffer(buffer)?);
    Some(Use { of, binding: Binding::Indirect, effect: Effect::Read })
}

fn merge(uses: &mut Vec<Use>, more: &[Use]) {
    for own in more {
        if !uses.contains(own) {
            uses.push(*own);
        }
    }
}

fn label(label: &Option<String>) -> String {
    let label = label.as_deref().map(std::borrow::Cow::Borrowed);
    crate::state::name(&label, "pass")
}
