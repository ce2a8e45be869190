//! What one frame asks for: of the pools an object for each slot of the plan, each exported transient, and each memoryless
//! attachment of a step; of a heap what the plan places there.

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

/// The requests of a frame and what they got; kept for its memory.
#[derive(Debug, Default)]
pub(crate) struct Requests {
    textures: Asked<PhysicalTextureDesc>,
    buffers: Asked<PhysicalBufferDesc>,
    /// For each slot, the request that serves it; where views cannot change the transfer function, a second one for its
    /// sRGB tenants.
    slots: Vec<[usize; 2]>,
    /// For each resource, its request.
    served_by: Vec<usize>,
    /// For each resource, uses that no access names.
    extra: Vec<Usage>,
    /// What lies in a heap, and for each resource its number there.
    placed: Vec<PlacedRequest>,
    placed_at: Vec<usize>,
}

/// A texture or buffer at an offset of a heap.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlacedRequest {
    pub(crate) resource: ResourceId,
    pub(crate) shape: Shape,
    pub(crate) offset: u64,
}

/// Requests to one pool, the resource that names each, and what they got.
#[derive(Debug)]
struct Asked<S: Pooled> {
    requests: Vec<Request<S>>,
    named: Vec<ResourceId>,
    served: Vec<S::Object>,
}

impl<S: Pooled> Default for Asked<S> {
    fn default() -> Self {
        Self { requests: Vec::new(), named: Vec::new(), served: Vec::new() }
    }
}

impl<S: Pooled> Asked<S> {
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
    /// Forgets what was asked and served, so that no object is kept alive.
    pub(crate) fn clear(&mut self) {
        self.textures.clear();
        self.buffers.clear();
        self.placed.clear();
    }

    /// What lies in a heap.
    pub(crate) fn placed(&self) -> &[PlacedRequest] {
        &self.placed
    }

    /// The number of a resource among [`Requests::placed`]; none of what lies elsewhere.
    pub(crate) fn placed_at(&self, resource: ResourceId) -> Option<usize> {
        self.placed_at.get(resource.index()).copied().filter(|at| *at != NONE)
    }

    /// Uses of a resource that no access names.
    pub(crate) fn extra(&self, resource: ResourceId) -> Usage {
        self.extra[resource.index()]
    }

    /// Works out what the plan needs; with `poison`, contents can be filled.
    ///
    /// # Errors
    /// When the plan places images of a history in a heap.
    pub(crate) fn collect(&mut self, plan: &Plan, gpu: &Gpu, poison: bool) -> Result<(), ExecuteError> {
        self.clear();
        extra_usage(plan, &mut self.extra);
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
                    if takes_wgpus_clear(plan, resource, &shape) {
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

    /// Gets everything from the pools.
    ///
    /// # Errors
    /// When the device offers no such texture or buffer.
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

    /// The texture that serves a resource, with its shape.
    pub(crate) fn texture(&self, resource: ResourceId) -> (Texture, PhysicalTextureDesc) {
        let request = self.served_by[resource.index()];
        (self.textures.served[request].clone(), self.textures.requests[request].shape)
    }

    /// The buffer that serves a resource.
    pub(crate) fn buffer(&self, resource: ResourceId) -> Buffer {
        self.buffers.served[self.served_by[resource.index()]].clone()
    }

    /// The request that serves a tenant of a slot: a new one for the first tenant, which later ones widen.
    fn slot_request(&mut self, plan: &Plan, resource: ResourceId, slot: SlotId, usage: Usage, gpu: &Gpu) -> usize {
        let shared = &plan.slots()[slot.index()];
        // One that is seen through its twin needs both formats whoever shares its slot; else tenants can go apart.
        let apart = shared.srgb_views && !gpu.has_view_formats() && !plan.resources()[resource.index()].srgb_views;
        let form = usize::from(apart && plan.format(resource).is_some_and(Format::is_srgb));
        let known = self.slots[slot.index()][form];
        if known != NONE {
            self.widen(known, &shared.desc, usage);
            return known;
        }
        // Apart, a tenant has its own uses alone: sRGB formats lack some that linear ones have.
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

    /// Adds uses to a request that serves several tenants.
    fn widen(&mut self, request: usize, desc: &Desc, usage: Usage) {
        match desc {
            Desc::Texture(_) => {
                self.textures.requests[request].shape.usage |= texture_usages(usage);
            }
            Desc::Buffer(_) => self.buffers.requests[request].shape.usage |= buffer_usages(usage),
        }
    }

    /// Allows sampling and copying of an exported texture after the frame, where the format allows that.
    fn offer(&mut self, plan: &Plan, resource: ResourceId, request: usize, gpu: &Gpu) {
        if let Some(format) = plan.format(resource) {
            self.textures.requests[request].shape.usage |= offered(gpu, format);
        }
    }

    /// The request of a memoryless attachment: one of equal shape that serves other steps alone, because nothing stays in
    /// it between steps; otherwise a new one.
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

/// Whether wgpu's own clear may be asked of a texture, which it does not have for what is placed: by a copy pass, whose recorder
/// has the encoder; or by the executor, for a pass that declares storage as cleared that cannot be cleared by drawing.
fn takes_wgpus_clear(plan: &Plan, resource: ResourceId, shape: &Shape) -> bool {
    let Shape::Texture(shape) = shape else { return false };
    let drawn = shape.usage.contains(TextureUsages::RENDER_ATTACHMENT) && shape.dimension == Dimension::D2;
    let passes = plan.running().flat_map(|m| plan.graph().accesses_of(m.pass));
    let mut cleared = passes.filter(|a| a.resource == resource && a.mode == Mode::Clear && !a.kind.is_attachment());
    plan.resources()[resource.index()].usage.contains(Usage::COPY_TARGET) || !drawn && cleared.next().is_some()
}

/// Copying and sampling, where the format allows them: what readers outside of the frame need.
pub(crate) fn offered(gpu: &Gpu, format: Format) -> TextureUsages {
    gpu.format_features(format).allowed_usages & (TextureUsages::COPY_SRC | TextureUsages::TEXTURE_BINDING)
}

/// The shape of a resource in the format that the plan gave it.
pub(crate) fn shaped(plan: &Plan, resource: ResourceId) -> Desc {
    let desc = plan.graph().resources()[resource.index()].desc;
    match (desc, plan.format(resource)) {
        (Desc::Texture(t), Some(format)) => Desc::Texture(t.format(format)),
        _ => desc,
    }
}

/// Uses that no access names but that executing needs: a clear outside of a render pass is made by one, and what is read
/// back is copied.
fn extra_usage(plan: &Plan, extra: &mut Vec<Usage>) {
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
        let drawable = |format: Format| format.is_color_renderable() || format.is_depth_stencil();
        if stored && access.mode == Mode::Clear && texture.is_some_and(|t| drawable(t.format)) {
            add(access.resource, Usage::ATTACHMENT);
        }
    }
    for export in graph.exports().iter().filter(|e| e.kind == ExportKind::Readback) {
        add(export.resource, Usage::COPY_SOURCE);
    }
}

/// Adds the uses that filling undefined contents takes ([`poison`](crate::debug::poison)).
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
