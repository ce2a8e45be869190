//! Collects the objects that a plan needs: pool objects for slots, exported transients and memoryless attachments, and
//! placed resources.

use crate::device::format::{buffer_usages, texture_usages};
use crate::device::gpu::Gpu;
use crate::execute::error::ExecuteError;
use crate::hash::fnv;
use crate::named::Named;
use crate::placed::shape::Shape;
use crate::resources::physical::{PhysicalBufferDesc, PhysicalTextureDesc};
use crate::resources::pool::{Pool, Pooled, Request};
use framegraph::{
    AccessKind, Desc, Dimension, ExportKind, Format, Join, Kind, Mode, Placement, Plan, ResourceId, SlotId, Usage,
};
use wgpu::{Buffer, Texture, TextureUsages};

const NONE: usize = usize::MAX;

/// Requests of a frame and their results. Reused to keep the memory.
#[derive(Debug, Default)]
pub(crate) struct Requests {
    textures: PoolRequests<PhysicalTextureDesc>,
    buffers: PoolRequests<PhysicalBufferDesc>,
    /// Request of each slot. If texture views cannot change between linear and sRGB, sRGB tenants get the second one.
    slots: Vec<[usize; 2]>,
    /// Request of each resource.
    served_by: Vec<usize>,
    /// Usages of each resource that no access declares.
    extra: Vec<Usage>,
    /// Placed resources.
    placed: Vec<PlacedRequest>,
    /// Index of each resource in `placed`.
    placed_at: Vec<usize>,
}

/// A texture or buffer at an offset in a heap.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlacedRequest {
    pub(crate) resource: ResourceId,
    pub(crate) shape: Shape,
    pub(crate) offset: u64,
}

/// Requests to one pool, the resource that labels each, and the results.
#[derive(Debug)]
struct PoolRequests<S: Pooled> {
    requests: Vec<Request<S>>,
    named: Vec<ResourceId>,
    served: Vec<S::Object>,
}

impl<S: Pooled> Default for PoolRequests<S> {
    fn default() -> Self {
        Self { requests: Vec::new(), named: Vec::new(), served: Vec::new() }
    }
}

impl<S: Pooled> PoolRequests<S> {
    fn clear(&mut self) {
        self.requests.clear();
        self.named.clear();
        self.served.clear();
    }

    fn push(&mut self, plan: &Plan, resource: ResourceId, shape: S) -> usize {
        let tenant = fnv(plan.graph().resource_name(resource).bytes());
        self.requests.push(Request { shape, tenant });
        self.named.push(resource);
        self.requests.len() - 1
    }

    fn serve(&mut self, gpu: &Gpu, plan: &Plan, pool: &mut Pool<S>) -> Result<(), ExecuteError> {
        let Self { requests, named, served } = self;
        Ok(pool.acquire(gpu, requests, |at| plan.graph().resource_name(named[at]), served)?)
    }
}

impl Requests {
    /// Removes requests and results, so that no object is kept alive.
    pub(crate) fn clear(&mut self) {
        self.textures.clear();
        self.buffers.clear();
        self.placed.clear();
    }

    /// Returns the placed resources.
    pub(crate) fn placed(&self) -> &[PlacedRequest] {
        &self.placed
    }

    /// Returns the index of a resource in [`Requests::placed`]; `None` if it is not placed.
    pub(crate) fn placed_at(&self, resource: ResourceId) -> Option<usize> {
        self.placed_at.get(resource.index()).copied().filter(|at| *at != NONE)
    }

    /// Returns usages of a resource that no access declares.
    pub(crate) fn extra(&self, resource: ResourceId) -> Usage {
        self.extra[resource.index()]
    }

    /// Collects the requests of a plan. `poison` adds the usages for filling undefined contents.
    ///
    /// # Errors
    /// Fails if the plan places history images in a heap.
    pub(crate) fn collect(&mut self, plan: &Plan, gpu: &Gpu, poison: bool) -> Result<(), ExecuteError> {
        self.clear();
        extra_usage(plan, gpu, &mut self.extra);
        if poison {
            poison_usage(plan, gpu, &mut self.extra);
        }
        self.slots.clear();
        self.slots.resize(plan.slots().len(), [NONE; 2]);
        self.served_by.clear();
        self.served_by.resize(plan.resources().len(), NONE);
        self.placed_at.clear();
        self.placed_at.resize(plan.resources().len(), NONE);
        let graph = plan.graph();
        for resource in graph.resource_ids() {
            let row = &plan.resources()[resource.index()];
            let usage = row.usage.union(self.extra(resource));
            match row.placement {
                Placement::Slot(slot) => {
                    self.served_by[resource.index()] = self.slot_request(plan, resource, slot, usage, gpu);
                }
                Placement::Memoryless => {
                    self.served_by[resource.index()] = self.memoryless_request(plan, resource);
                }
                Placement::Own if graph.resources()[resource.index()].kind == Kind::Transient => {
                    let request = self.push(plan, resource, shaped(plan, resource), usage, row.srgb_views);
                    self.served_by[resource.index()] = request;
                    self.offer(plan, resource, request, gpu);
                }
                Placement::Heap { offset } if graph.resources()[resource.index()].kind == Kind::Transient => {
                    let shape = match shaped(plan, resource) {
                        Desc::Texture(t) => {
                            let shape = PhysicalTextureDesc::new(&t, plan.frame(), usage, row.srgb_views);
                            Shape::Texture(shape)
                        }
                        Desc::Buffer(b) => Shape::Buffer(PhysicalBufferDesc::new(b.bytes(plan.frame()), usage)),
                    };
                    if needs_wgpu_clear(plan, resource, &shape) {
                        let request = self.push(plan, resource, shaped(plan, resource), usage, row.srgb_views);
                        self.served_by[resource.index()] = request;
                    } else {
                        self.placed_at[resource.index()] = self.placed.len();
                        self.placed.push(PlacedRequest { resource, shape, offset });
                    }
                }
                Placement::Heap { .. } => {
                    return Err(ExecuteError::Heap { resource: Named::resource(plan, resource) });
                }
                Placement::Own | Placement::Unused | Placement::Inlined | Placement::External => {}
            }
        }
        Ok(())
    }

    /// Gets all objects from the pools.
    ///
    /// # Errors
    /// Fails if the device does not support a texture or buffer.
    pub(crate) fn serve(
        &mut self,
        gpu: &Gpu,
        plan: &Plan,
        textures: &mut Pool<PhysicalTextureDesc>,
        buffers: &mut Pool<PhysicalBufferDesc>,
    ) -> Result<(), ExecuteError> {
        self.textures.serve(gpu, plan, textures)?;
        self.buffers.serve(gpu, plan, buffers)
    }

    /// Returns the texture of a resource, with its description.
    pub(crate) fn texture(&self, resource: ResourceId) -> (Texture, PhysicalTextureDesc) {
        let request = self.served_by[resource.index()];
        (self.textures.served[request].clone(), self.textures.requests[request].shape)
    }

    /// Returns the buffer of a resource.
    pub(crate) fn buffer(&self, resource: ResourceId) -> Buffer {
        self.buffers.served[self.served_by[resource.index()]].clone()
    }

    /// Returns the request of a slot's tenant. The first tenant creates it; later ones add their usages.
    fn slot_request(&mut self, plan: &Plan, resource: ResourceId, slot: SlotId, usage: Usage, gpu: &Gpu) -> usize {
        let shared = &plan.slots()[slot.index()];
        // A tenant with views in both forms needs both; other tenants can be separated by form.
        let apart = shared.srgb_views && !gpu.has_view_formats() && !plan.resources()[resource.index()].srgb_views;
        let form = usize::from(apart && plan.format(resource).is_some_and(Format::is_srgb));
        let known = self.slots[slot.index()][form];
        if known != NONE {
            self.widen(known, &shared.desc, usage);
            return known;
        }
        // A separated tenant has only its own usages, since sRGB formats lack some that linear ones have.
        let request = if apart {
            self.push(plan, resource, shaped(plan, resource), usage, false)
        } else {
            self.push(plan, resource, shared.desc, shared.usage.union(usage), shared.srgb_views)
        };
        self.slots[slot.index()][form] = request;
        request
    }

    fn push(&mut self, plan: &Plan, resource: ResourceId, desc: Desc, usage: Usage, srgb_views: bool) -> usize {
        let frame = plan.frame();
        match desc {
            Desc::Texture(t) => {
                self.textures.push(plan, resource, PhysicalTextureDesc::new(&t, frame, usage, srgb_views))
            }
            Desc::Buffer(b) => self.buffers.push(plan, resource, PhysicalBufferDesc::new(b.bytes(frame), usage)),
        }
    }

    /// Adds usages to a request that serves several tenants.
    fn widen(&mut self, request: usize, desc: &Desc, usage: Usage) {
        match desc {
            Desc::Texture(_) => {
                self.textures.requests[request].shape.usage |= texture_usages(usage);
            }
            Desc::Buffer(_) => self.buffers.requests[request].shape.usage |= buffer_usages(usage),
        }
    }

    /// Adds sampling and copying to an exported texture, if the format allows it.
    fn offer(&mut self, plan: &Plan, resource: ResourceId, request: usize, gpu: &Gpu) {
        if let Some(format) = plan.format(resource) {
            self.textures.requests[request].shape.usage |= offered(gpu, format);
        }
    }

    /// Returns the request of a memoryless attachment. Requests of equal description are shared between steps, since
    /// memoryless contents do not outlive a step.
    fn memoryless_request(&mut self, plan: &Plan, resource: ResourceId) -> usize {
        let Desc::Texture(desc) = shaped(plan, resource) else {
            unreachable!("only attachments are memoryless");
        };
        let views = plan.resources()[resource.index()].srgb_views;
        let shape = PhysicalTextureDesc::new(&desc, plan.frame(), Usage::ATTACHMENT, views).memoryless();
        let rows = plan.resources();
        let busy = |request: usize| {
            let others = self.served_by.iter().zip(rows).filter(|(asked, _)| **asked == request);
            others
                .into_iter()
                .any(|(_, row)| row.placement == Placement::Memoryless && row.first == rows[resource.index()].first)
        };
        let equal = |request: &usize| self.textures.requests[*request].shape == shape;
        let free = (0..self.textures.requests.len()).filter(equal).find(|request| !busy(*request));
        free.unwrap_or_else(|| self.textures.push(plan, resource, shape))
    }
}

/// Returns whether wgpu's clear may be used on a texture, which does not work for placed textures. Copy passes may call
/// it, since they access the encoder. The executor calls it for cleared storage textures that cannot be cleared by
/// rendering.
fn needs_wgpu_clear(plan: &Plan, resource: ResourceId, shape: &Shape) -> bool {
    let Shape::Texture(shape) = shape else { return false };
    let drawn = shape.usage.contains(TextureUsages::RENDER_ATTACHMENT);
    let passes = plan.running().flat_map(|m| plan.graph().accesses_of(m.pass));
    let mut cleared = passes.filter(|a| a.resource == resource && a.mode == Mode::Clear && !a.kind.is_attachment());
    plan.resources()[resource.index()].usage.contains(Usage::COPY_TARGET) || !drawn && cleared.next().is_some()
}

/// Returns the usages for readers outside of the frame (copying and sampling), if the format allows them.
pub(crate) fn offered(gpu: &Gpu, format: Format) -> TextureUsages {
    gpu.format_features(format).allowed_usages & (TextureUsages::COPY_SRC | TextureUsages::TEXTURE_BINDING)
}

/// Returns the description of a resource with the format that the plan chose.
pub(crate) fn shaped(plan: &Plan, resource: ResourceId) -> Desc {
    let desc = plan.graph().resources()[resource.index()].desc;
    match (desc, plan.format(resource)) {
        (Desc::Texture(t), Some(format)) => Desc::Texture(t.format(format)),
        _ => desc,
    }
}

/// Adds usages that execution needs and no access declares: clears outside of render passes, and readback.
fn extra_usage(plan: &Plan, gpu: &Gpu, extra: &mut Vec<Usage>) {
    let graph = plan.graph();
    extra.clear();
    extra.resize(graph.resources().len(), Usage::NONE);
    let mut add = |resource: ResourceId, usage: Usage| {
        extra[resource.index()] = extra[resource.index()].union(usage);
    };
    let recorded = plan.running().filter(|m| m.join != Join::Inlined);
    for access in recorded.flat_map(|m| graph.accesses_of(m.pass)) {
        let stored = matches!(access.kind, AccessKind::StorageWrite | AccessKind::CopyTarget);
        let texture = graph.resources()[access.resource.index()].desc.texture();
        let drawable =
            |format: Format| gpu.format_features(format).allowed_usages.contains(TextureUsages::RENDER_ATTACHMENT);
        if stored && access.mode == Mode::Clear && texture.is_some_and(|t| drawable(t.format)) {
            add(access.resource, Usage::ATTACHMENT);
        }
    }
    for export in graph.exports().iter().filter(|e| e.kind == ExportKind::Readback) {
        add(export.resource, Usage::COPY_SOURCE);
    }
}

/// Adds the usages for filling undefined contents ([`poison`](crate::debug::poison)).
fn poison_usage(plan: &Plan, gpu: &Gpu, extra: &mut [Usage]) {
    for resource in plan.graph().resource_ids() {
        let row = &plan.graph().resources()[resource.index()];
        let (Some(desc), Some(format)) = (row.desc.texture(), plan.format(resource)) else {
            continue;
        };
        let allowed = gpu.format_features(format).allowed_usages;
        let attachable = desc.dimension == Dimension::D2 && allowed.contains(TextureUsages::RENDER_ATTACHMENT);
        let used = !plan.resources()[resource.index()].first.is_none();
        if used && !row.kind.defined_on_entry() && !matches!(row.kind, Kind::Imported { .. }) {
            let added = if attachable { Usage::ATTACHMENT } else { Usage::COPY_TARGET };
            extra[resource.index()] = extra[resource.index()].union(added);
        }
    }
}
