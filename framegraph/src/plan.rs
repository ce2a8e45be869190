//! The result of compiling: flat arrays that a back end executes and tools read.
//!
//! A plan shares the arrays of its graph, so it gives access to names, descriptors and accesses.

mod resolves;

use crate::access::Usage;
use crate::barrier::Barrier;
use crate::caps::Caps;
use crate::decision::{Decision, Reason, Subject};
use crate::enum_names::enum_names;
use crate::format::{Aspect, Format};
use crate::graph::{Graph, PassKind};
use crate::id::{PassId, ResourceId, SlotId, Span, StepId};
use crate::options::Options;
use crate::resolve::ResolveMode;
use crate::resource::Desc;

/// Load operation: how the contents of an attachment enter the tile at the start of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LoadOp {
    /// Reads the contents from memory. Counted as an **unresolve** in [`Counts`](crate::Counts).
    Load,
    /// Fills the attachment with the clear value.
    Clear,
    /// Leaves the contents undefined, because every texel is written.
    DontCare,
}

enum_names! { LoadOp: Load "load", Clear "clear", DontCare "dont_care" }

/// Store operation: what happens to the contents of an attachment at the end of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StoreOp {
    /// Writes the contents to memory. Counted as a **resolve** in [`Counts`](crate::Counts).
    Store,
    /// Drops the contents; memory is undefined afterwards.
    Discard,
    /// Does nothing: the attachment was only read, and memory still holds its contents.
    None,
}

enum_names! { StoreOp: Store "store", Discard "discard", None "none" }

/// Role of an attachment in its step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Role {
    /// Color attachment in this slot.
    Color(u8),
    /// Depth or depth-stencil attachment that is tested and written.
    Depth,
    /// Read-only depth or depth-stencil attachment.
    DepthReadOnly,
    /// Target of a resolve of the color attachment in this slot.
    ResolveTarget(u8, ResolveMode),
    /// Target of a resolve of the depth attachment.
    ResolveDepth(ResolveMode),
}

/// One attachment of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Attachment {
    /// The attached texture.
    pub resource: ResourceId,
    /// The attached mip level.
    pub mip: u8,
    /// The first attached layer.
    pub layer: u16,
    /// Number of attached layers.
    pub layers: u16,
    /// Format of the view if it is the sRGB twin of the texture's format; otherwise `None`.
    pub view: Option<Format>,
    /// Role in the step.
    pub role: Role,
    /// Load operation of the color or depth plane.
    pub load: LoadOp,
    /// Store operation of the color or depth plane.
    pub store: StoreOp,
    /// Load operation of the stencil plane; equal to `load` for formats without stencil.
    pub stencil_load: LoadOp,
    /// Store operation of the stencil plane; equal to `store` for formats without stencil.
    pub stencil_store: StoreOp,
    /// Index into [`Graph::clears`](crate::graph::Tables::clears) if an operation is `Clear`; [`Attachment::ZERO`] for
    /// zero.
    pub clear: u32,
}

impl Attachment {
    /// Stands for a clear to zero that no pass declares. Used for blending into contents that are not needed.
    pub const ZERO: u32 = u32::MAX;
}

/// Reason why a pass is part of its step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Join {
    /// First pass of the step.
    First,
    /// Uses attachments of the step.
    Attachments,
    /// Reads attachments of the step at the same pixel.
    SamePixel,
    /// Inlined as an epilogue into the shader of the previous pass. Records no commands.
    Inlined,
    /// Full-screen resolve on behalf of a pass that ran in an earlier step, because the device cannot resolve while
    /// storing. The back end records it.
    Resolve,
}

enum_names! {
    Join: First "first", Attachments "attachments", SamePixel "same_pixel", Inlined "inlined", Resolve "resolve"
}

/// A pass in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StepPass {
    /// The declared pass.
    pub pass: PassId,
    /// Reason why the pass is part of the step.
    pub join: Join,
}

/// A unit of execution: one render pass, or one compute or copy pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// Raster, compute or copy.
    pub kind: PassKind,
    /// Number of samples of the attachments; 1 for a step without attachments.
    pub samples: u8,
    /// Passes of the step in execution order, as a span of [`Plan::step_passes`].
    pub passes: Span,
    /// Attachments of the step: colors by slot, then depth, then resolve targets. A span of [`Plan::attachments`].
    pub attachments: Span,
    /// Width and height of the attachments in texels; 0 for a step without attachments.
    pub extent: [u32; 2],
    /// Number of layers of the attachments; 0 for a step without attachments.
    pub layers: u32,
}

/// Location of a resource's memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Placement {
    /// No memory: no kept pass accesses the resource.
    Unused,
    /// Tile memory only.
    Memoryless,
    /// No memory: the texture does not exist, because its reader was inlined into its writer's shader.
    Inlined,
    /// A slot of the pool.
    Slot(SlotId),
    /// A heap.
    Heap {
        /// Offset in the heap, in bytes.
        offset: u64,
    },
    /// Memory of the caller: the resource is imported.
    External,
    /// A separate allocation that outlives the frame: an exported resource, or an image of a history.
    Own,
}

enum_names! {
    Placement:
    Unused "unused", Memoryless "memoryless", Inlined "inlined", Slot "slot", Heap "heap", External "external", Own "own"
}

/// Decisions about one resource. Parallel to [`Graph::resources`](crate::graph::Tables::resources).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Planned {
    /// First step that accesses the resource; none if no kept pass does.
    pub first: StepId,
    /// Last step that accesses the resource. Contents that outlive the frame stay valid after it.
    pub last: StepId,
    /// All usages by kept passes.
    pub usage: Usage,
    /// Format of the physical texture: the declared one, unless an inlined epilogue replaced it.
    pub format: Option<Format>,
    /// A pass uses a view in the sRGB twin of the format, so the texture needs both view formats.
    pub srgb_views: bool,
    /// Size in bytes, without padding; 0 for memoryless and inlined resources.
    pub bytes: u64,
    /// Location of its memory.
    pub placement: Placement,
}

/// A physical texture or buffer of the pool, shared by resources with disjoint lifetimes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slot {
    /// Descriptor of the physical resource: that of the first resource in the slot.
    pub desc: Desc,
    /// All usages of the resources in the slot.
    pub usage: Usage,
    /// The slot needs both view formats: its resources differ in the sRGB transfer function, or one is viewed in its
    /// sRGB twin.
    pub srgb_views: bool,
    /// Size in bytes, without padding.
    pub bytes: u64,
}

/// Memory of the transient resources, compared with its lower bound.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Memory {
    /// Bytes needed without sharing, not counting memoryless and inlined resources.
    pub unaliased_bytes: u64,
    /// Bytes allocated: the sum of the slots, or the size of the heaps.
    pub bytes: u64,
    /// Lower bound for any placement: the maximum of the bytes that are live at once.
    pub lower_bound_bytes: u64,
    /// `bytes` is proved to be minimal for the chosen aliasing mode.
    pub optimal: bool,
    /// The step at which the most bytes are live.
    pub peak: StepId,
    /// Bytes saved by memoryless attachments and inlining.
    pub avoided_bytes: u64,
    /// Bytes of exported textures and history images. They outlive the frame and are never shared.
    pub own_bytes: u64,
}

/// The result of compiling a graph.
///
/// ```
/// use framegraph::{Caps, ClearValue, Extent, Format, Graph, Intent, LoadOp, Options, Plan, Scratch, TextureDesc, compile};
///
/// let mut graph = Graph::new();
/// let color = graph.add_fn("background", |pass| {
///     let color = pass.texture("color", TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb));
///     pass.color(color, Intent::Clear(ClearValue::BLACK))
/// })?;
/// graph.export(color)?;
///
/// let mut plan = Plan::new();
/// compile(&graph, &Caps::wgpu(), &Options::default(), &mut Scratch::new(), &mut plan)?;
/// for step in plan.step_ids() {
///     assert_eq!(plan.passes_of(step).len(), 1);
///     assert_eq!(plan.attachments_of(step)[0].load, LoadOp::Clear);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Plan {
    pub(crate) graph: Graph,
    pub(crate) caps: Caps,
    pub(crate) options: Options,
    /// 0 for a plan that nothing was compiled into.
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
    /// Creates an empty plan to compile into.
    pub fn new() -> Self {
        Self::default()
    }

    /// Returns the graph that was compiled.
    pub fn graph(&self) -> &Graph {
        &self.graph
    }

    /// Returns the device that the plan is for.
    pub fn caps(&self) -> &Caps {
        &self.caps
    }

    /// Returns the options of the compilation.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// Number of the compilation that made the plan, counted from 1 in each process; 0 for an empty plan. Plans with
    /// the same number are equal.
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

    /// Returns `true` if a pass was culled.
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

    /// The passes of one step, in execution order.
    ///
    /// # Panics
    /// Panics if `step` does not belong to this plan.
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
    /// Panics if `step` does not belong to this plan.
    pub fn attachments_of(&self, step: StepId) -> &[Attachment] {
        self.steps[step.index()].attachments.of(&self.attachments)
    }

    /// Decisions about each resource, parallel to [`Graph::resources`](crate::graph::Tables::resources).
    pub fn resources(&self) -> &[Planned] {
        &self.resources
    }

    /// The physical textures and buffers of the pool.
    pub fn slots(&self) -> &[Slot] {
        &self.slots
    }

    /// Allocated memory and its lower bound.
    pub fn memory(&self) -> Memory {
        self.memory
    }

    /// Layout transitions and aliasing barriers, each with the step it precedes. Empty for devices without explicit
    /// barriers.
    pub fn barriers(&self) -> &[Barrier] {
        &self.barriers
    }

    /// All decisions, in the order in which the phases made them.
    pub fn decisions(&self) -> &[Decision] {
        &self.decisions
    }

    /// Returns the decisions about one subject.
    pub fn reasons(&self, subject: Subject) -> impl Iterator<Item = Reason> {
        self.decisions.iter().filter(move |d| d.subject == subject).map(|d| d.reason)
    }

    /// Returns the format of the physical texture; `None` for a buffer.
    pub fn format(&self, resource: ResourceId) -> Option<Format> {
        let declared = self.graph.resources()[resource.index()].desc.texture().map(|t| t.format);
        self.resources[resource.index()].format.or(declared)
    }
}

impl Attachment {
    /// Returns the operations of a plane, or `None` if the format lacks it. Depth and color use the same fields.
    pub fn ops(&self, format: Format, aspect: Aspect) -> Option<(LoadOp, StoreOp)> {
        match aspect {
            Aspect::Stencil => format.has_stencil().then_some((self.stencil_load, self.stencil_store)),
            Aspect::Depth => format.has_depth().then_some((self.load, self.store)),
            Aspect::All => Some((self.load, self.store)),
        }
    }

    /// Returns `true` if any plane is loaded from memory.
    pub fn loads(&self) -> bool {
        self.load == LoadOp::Load || self.stencil_load == LoadOp::Load
    }

    /// Returns `true` if any plane is stored to memory.
    pub fn stores(&self) -> bool {
        self.store == StoreOp::Store || self.stencil_store == StoreOp::Store
    }
}
