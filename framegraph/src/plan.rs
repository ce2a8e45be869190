//! What compiling produces: flat arrays that a back end executes and tools read.
//!
//! A plan shares the arrays of the graph it was made from, so names, shapes and accesses are at hand wherever the plan goes.

mod resolves;

use crate::access::Usage;
use crate::barrier::Barrier;
use crate::caps::Caps;
use crate::decision::{Decision, Reason, Subject};
use crate::format::{Aspect, Format};
use crate::graph::{Graph, PassKind};
use crate::id::{PassId, ResourceId, SlotId, Span, StepId};
use crate::options::Options;
use crate::resolve::ResolveMode;
use crate::resource::Desc;
use crate::words::words;

/// How an attachment's contents come into the tile at the start of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LoadOp {
    /// From memory: an **unresolve**.
    Load,
    /// Filled with the clear value.
    Clear,
    /// Anything may be there; every texel is written.
    DontCare,
}

words! { LoadOp: Load "load", Clear "clear", DontCare "dont_care" }

/// What becomes of an attachment's contents at the end of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StoreOp {
    /// Written to memory: a **resolve**.
    Store,
    /// Dropped: memory holds nothing of use afterwards.
    Discard,
    /// Neither: it was only read, and memory still holds it.
    None,
}

words! { StoreOp: Store "store", Discard "discard", None "none" }

/// What an attachment is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Role {
    /// Color attachment of this slot.
    Color(u8),
    /// Depth or depth-stencil attachment.
    Depth,
    /// Depth or depth-stencil attachment that is only tested.
    DepthReadOnly,
    /// Receives what the mode makes of the samples of the color attachment of this slot.
    ResolveTarget(u8, ResolveMode),
    /// Receives what the mode makes of the samples of the depth attachment.
    ResolveDepth(ResolveMode),
}

/// One attachment of one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Attachment {
    /// The texture that is attached.
    pub resource: ResourceId,
    /// The mip level that is attached.
    pub mip: u8,
    /// Its first layer.
    pub layer: u16,
    /// Number of layers, all of them when the whole texture is attached.
    pub layers: u16,
    /// The format that it is attached through: the sRGB twin of the texture's own; none for its own.
    pub view: Option<Format>,
    /// What it is for.
    pub role: Role,
    /// Color or depth plane at the start of the step.
    pub load: LoadOp,
    /// Color or depth plane at the end of the step.
    pub store: StoreOp,
    /// Stencil plane at the start; equal to `load` where the format has none.
    pub stencil_load: LoadOp,
    /// Stencil plane at the end; equal to `store` where the format has none.
    pub stencil_store: StoreOp,
    /// Index into [`Graph::clears`](crate::graph::Tables::clears) when an op is `Clear`; [`Attachment::ZERO`] for zero.
    pub clear: u32,
}

impl Attachment {
    /// In place of the index of a clear value: zero, which no pass declares, in place of contents that are not needed.
    pub const ZERO: u32 = u32::MAX;
}

/// How a pass came into its step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Join {
    /// It opens the step.
    First,
    /// It has the step's attachments.
    Attachments,
    /// It reads the step's attachments at the same pixel.
    SamePixel,
    /// It is an epilogue of the shader of the pass before it, and records nothing itself.
    Inlined,
    /// It ran in an earlier step. This one is a full-screen pass, which records itself: it makes the resolves of the pass that
    /// the device does not make in its store.
    Resolve,
}

words! {
    Join: First "first", Attachments "attachments", SamePixel "same_pixel", Inlined "inlined", Resolve "resolve"
}

/// A pass within a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StepPass {
    /// The declared pass.
    pub pass: PassId,
    /// How it came into the step.
    pub join: Join,
}

/// What a back end runs as one unit: one render pass, or one compute or copy pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// Raster, compute or copy.
    pub kind: PassKind,
    /// Samples of the attachments; 1 without attachments.
    pub samples: u8,
    /// Its passes, in order: a span of [`Plan::step_passes`].
    pub passes: Span,
    /// Its attachments, colors by slot, then depth, then resolve targets: a span of [`Plan::attachments`].
    pub attachments: Span,
    /// Width and height of the attachments in texels; 0 without attachments.
    pub extent: [u32; 2],
    /// Layers of the attachments; 0 without attachments.
    pub layers: u32,
}

/// Where a resource lives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Placement {
    /// Nowhere: no kept pass touches it.
    Unused,
    /// In tile memory only.
    Memoryless,
    /// Nowhere: its reader was inlined into its writer's shader.
    Inlined,
    /// In a slot of the pool.
    Slot(SlotId),
    /// In the heap of its kind, at this offset in bytes.
    Heap {
        /// Bytes from the start of the heap.
        offset: u64,
    },
    /// Owned outside of the graph: imported.
    External,
    /// In an image of its own that outlives the frame: exported contents, or one of a history's ring.
    Own,
}

words! {
    Placement:
    Unused "unused", Memoryless "memoryless", Inlined "inlined", Slot "slot", Heap "heap", External "external", Own "own"
}

/// What was decided about one resource. Rows are parallel to [`Graph::resources`](crate::graph::Tables::resources).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Planned {
    /// First step that touches it; none when no kept pass does.
    pub first: StepId,
    /// Last step that touches it. Contents that outlive the frame live on after it.
    pub last: StepId,
    /// Every use that survives culling.
    pub usage: Usage,
    /// The format it is made with: the declared one, unless an inlined epilogue replaced it.
    pub format: Option<Format>,
    /// A pass sees it through the sRGB twin of its format: views need both formats.
    pub srgb_views: bool,
    /// Bytes it takes, without padding; 0 for memoryless and inlined ones.
    pub bytes: u64,
    /// Where it lives.
    pub placement: Placement,
}

/// A physical texture or buffer of the pool, shared by resources that are never live at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slot {
    /// Its shape: that of its first tenant.
    pub desc: Desc,
    /// Every use by any tenant.
    pub usage: Usage,
    /// Tenants differ in the sRGB transfer function, or one is seen through its twin: views need both formats.
    pub srgb_views: bool,
    /// Bytes, without padding.
    pub bytes: u64,
}

/// How much memory the transient resources take, and how good that is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Memory {
    /// Bytes that would be taken if nothing were shared (memoryless and inlined ones left out).
    pub unaliased_bytes: u64,
    /// Bytes taken: the sum of the slots, or the size of the heap.
    pub bytes: u64,
    /// No placement can take less: the peak of live bytes.
    pub lower_bound_bytes: u64,
    /// The bytes are proved to be the least possible under the chosen aliasing mode.
    pub optimal: bool,
    /// The step at which the most bytes are live.
    pub peak: StepId,
    /// Bytes that memoryless attachments and inlining keep out of memory.
    pub avoided_bytes: u64,
    /// Bytes of exported textures and of the rings of histories, which outlive the frame and are never shared.
    pub own_bytes: u64,
}

/// The result of compiling.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    pub(crate) graph: Graph,
    pub(crate) caps: Caps,
    pub(crate) options: Options,
    /// 0 where nothing was compiled.
    pub(crate) compilation: u64,
    pub(crate) pass_steps: Vec<StepId>,
    pub(crate) steps: Vec<Step>,
    pub(crate) step_passes: Vec<StepPass>,
    pub(crate) attachments: Vec<Attachment>,
    pub(crate) resources: Vec<Planned>,
    pub(crate) slots: Vec<Slot>,
    pub(crate) memory: Memory,
    pub(crate) barriers: Vec<Barrier>,
    pub(crate) decisions: Vec<Decision>,
}

impl Plan {
    /// An empty plan, to compile into.
    pub fn new() -> Self {
        Self::default()
    }

    /// What was declared.
    pub fn graph(&self) -> &Graph {
        &self.graph
    }

    /// The device the plan is for.
    pub fn caps(&self) -> &Caps {
        &self.caps
    }

    /// The options it was compiled with.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// The number of the compilation that made it, from 1 in each process; 0 of an empty plan. Plans of one number are equal.
    pub fn compilation(&self) -> u64 {
        self.compilation
    }

    /// Width and height of the frame, in texels.
    pub fn frame(&self) -> [u32; 2] {
        self.options.frame
    }

    /// The step of each declared pass; none for culled passes.
    pub fn pass_steps(&self) -> &[StepId] {
        &self.pass_steps
    }

    /// Whether a pass was culled.
    pub fn is_culled(&self, pass: PassId) -> bool {
        self.pass_steps[pass.index()].is_none()
    }

    /// The steps, in execution order.
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// The ids of the steps, in execution order.
    pub fn step_ids(&self) -> impl DoubleEndedIterator<Item = StepId> + ExactSizeIterator + use<> {
        (0..self.steps.len()).map(StepId::at)
    }

    /// The passes of all steps; each step owns a span.
    pub fn step_passes(&self) -> &[StepPass] {
        &self.step_passes
    }

    /// The passes of one step, in order.
    ///
    /// # Panics
    /// When `step` is not of this plan.
    pub fn passes_of(&self, step: StepId) -> &[StepPass] {
        self.steps[step.index()].passes.of(&self.step_passes)
    }

    /// The attachments of all steps; each step owns a span.
    pub fn attachments(&self) -> &[Attachment] {
        &self.attachments
    }

    /// The attachments of one step: colors by slot, then depth, then resolve targets.
    ///
    /// # Panics
    /// When `step` is not of this plan.
    pub fn attachments_of(&self, step: StepId) -> &[Attachment] {
        self.steps[step.index()].attachments.of(&self.attachments)
    }

    /// What was decided about each resource, parallel to [`Graph::resources`](crate::graph::Tables::resources).
    pub fn resources(&self) -> &[Planned] {
        &self.resources
    }

    /// The physical textures and buffers of the pool.
    pub fn slots(&self) -> &[Slot] {
        &self.slots
    }

    /// Memory taken, with its lower bound.
    pub fn memory(&self) -> Memory {
        self.memory
    }

    /// Layout transitions and hand-overs of memory, in front of which step each; empty for devices that do without.
    pub fn barriers(&self) -> &[Barrier] {
        &self.barriers
    }

    /// Every decision, in the order in which the phases took them.
    pub fn decisions(&self) -> &[Decision] {
        &self.decisions
    }

    /// The decisions about one subject.
    pub fn reasons(&self, subject: Subject) -> impl Iterator<Item = Reason> {
        self.decisions.iter().filter(move |d| d.subject == subject).map(|d| d.reason)
    }

    /// The format that a texture is made with; `None` for a buffer.
    pub fn format(&self, resource: ResourceId) -> Option<Format> {
        let declared = self.graph.resources()[resource.index()].desc.texture().map(|t| t.format);
        self.resources[resource.index()].format.or(declared)
    }
}

impl Attachment {
    /// The plane's ops, if the format has that plane: depth and color share one place.
    pub fn ops(&self, format: Format, aspect: Aspect) -> Option<(LoadOp, StoreOp)> {
        match aspect {
            Aspect::Stencil => format.has_stencil().then_some((self.stencil_load, self.stencil_store)),
            Aspect::Depth => format.has_depth().then_some((self.load, self.store)),
            Aspect::All => Some((self.load, self.store)),
        }
    }

    /// Whether any plane is loaded from memory.
    pub fn loads(&self) -> bool {
        self.load == LoadOp::Load || self.stencil_load == LoadOp::Load
    }

    /// Whether any plane is written to memory.
    pub fn stores(&self) -> bool {
        self.store == StoreOp::Store || self.stencil_store == StoreOp::Store
    }
}
