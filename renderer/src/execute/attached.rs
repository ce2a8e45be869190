//! Attachments of a render pass as wgpu descriptors.

use framegraph::{Counts, LoadOp};
use wgpu::{Color, Operations, RenderPassColorAttachment, RenderPassDepthStencilAttachment, TextureView};

/// Attachments of one render pass. Reused from step to step to keep its memory.
#[derive(Debug, Default)]
pub(crate) struct Attached {
    /// Color attachments by slot, up to the last one in use.
    pub(crate) colors: Vec<Option<ColorTarget>>,
    pub(crate) depth: Option<DepthTarget>,
}

/// A color attachment.
#[derive(Clone, Debug)]
pub(crate) struct ColorTarget {
    pub(crate) view: TextureView,
    pub(crate) resolve: Option<TextureView>,
    pub(crate) ops: Operations<Color>,
    pub(crate) depth_slice: Option<u32>,
}

/// The depth-stencil attachment. A plane without operations is read-only.
#[derive(Clone, Debug)]
pub(crate) struct DepthTarget {
    pub(crate) view: TextureView,
    pub(crate) depth: Option<Operations<f32>>,
    pub(crate) stencil: Option<Operations<u32>>,
}

impl Attached {
    /// Removes all attachments but keeps the memory.
    pub(crate) fn clear(&mut self) {
        self.colors.clear();
        self.depth = None;
    }

    /// Returns the color attachment of a slot for a wgpu descriptor.
    pub(crate) fn color(&self, slot: usize) -> Option<RenderPassColorAttachment<'_>> {
        let ColorTarget { view, resolve, ops, depth_slice } = self.colors.get(slot)?.as_ref()?;
        Some(RenderPassColorAttachment { view, depth_slice: *depth_slice, resolve_target: resolve.as_ref(), ops: *ops })
    }

    /// Returns the depth-stencil attachment for a wgpu descriptor.
    pub(crate) fn depth(&self) -> Option<RenderPassDepthStencilAttachment<'_>> {
        let DepthTarget { view, depth, stencil } = self.depth.as_ref()?;
        Some(RenderPassDepthStencilAttachment { view, depth_ops: *depth, stencil_ops: *stencil })
    }

    /// Returns the load and store operations of a render pass with these attachments.
    pub(crate) fn counts(&self) -> Counts {
        let mut counts = Counts { render_passes: 1, ..Counts::default() };
        for color in self.colors.iter().flatten() {
            counts.unresolves += u32::from(matches!(color.ops.load, wgpu::LoadOp::Load));
            counts.clears += u32::from(matches!(color.ops.load, wgpu::LoadOp::Clear(_)));
            counts.resolves += u32::from(color.ops.store == wgpu::StoreOp::Store);
            counts.discards += u32::from(color.ops.store == wgpu::StoreOp::Discard);
            counts.resolves += u32::from(color.resolve.is_some());
            counts.multisample_resolves += u32::from(color.resolve.is_some());
        }
        if let Some(DepthTarget { depth, stencil, .. }) = &self.depth {
            let loads = [depth.map(|o| kind(&o.load)), stencil.map(|o| kind(&o.load))];
            let stores = [depth.map(|o| o.store), stencil.map(|o| o.store)];
            let any_load = |wanted| loads.iter().flatten().any(|l| *l == wanted);
            let read_only = stores.iter().all(Option::is_none);
            let stored = stores.iter().flatten().any(|s| *s == wgpu::StoreOp::Store);
            counts.unresolves += u32::from(read_only || any_load(LoadOp::Load));
            counts.clears += u32::from(any_load(LoadOp::Clear));
            counts.resolves += u32::from(stored);
            counts.discards += u32::from(!read_only && !stored);
        }
        counts
    }
}

const fn kind<V>(op: &wgpu::LoadOp<V>) -> LoadOp {
    match op {
        wgpu::LoadOp::Load => LoadOp::Load,
        wgpu::LoadOp::Clear(_) => LoadOp::Clear,
        wgpu::LoadOp::DontCare(_) => LoadOp::DontCare,
    }
}
