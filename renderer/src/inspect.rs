//! Inspection of a frame: reads any version of any texture as numbers and as an image. Level, layer, plane and sample
//! can be chosen.
//!
//! An [`Inspector`] compiles a second frame and executes it with its own executor. The second frame ends with the requested
//! version ([`framegraph::Graph::ending_with`]) and one added pass that reads it. Memoryless attachments and inlined
//! intermediates exist in memory in the second plan, since the added pass reads them. The original plan and its
//! executor are not changed.
//!
//! The inspected frame is the one that would be executed next: recorders receive the current world, and histories are
//! as the last frame left them.
//!
//! ```
//! # use framegraph::{ClearValue, Extent, Format, Intent, Options, Plan, Scratch, TextureDesc};
//! # use framegraph_wgpu::inspect::{Inspector, DisplayMode};
//! # use framegraph_wgpu::{Executor, Gpu, Imports};
//! # use framegraph_wgpu::Frame;
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let gpu = Gpu::noop()?;
//! # let mut frame = Frame::<()>::new();
//! # let hdr = frame.graph_mut().texture("hdr", TextureDesc::new(Extent::FRAME, Format::Rgba16Float));
//! # let hdr = frame.add_fn("color", |p| p.color(hdr, Intent::Clear(ClearValue::BLACK)), |_, _, _| Ok(()))?;
//! # frame.graph_mut().export(hdr)?;
//! # let (mut plan, options, imports) = (Plan::new(), Options::for_frame(8, 8), Imports::new());
//! # framegraph::compile(frame.graph(), &gpu.caps(), &options, &mut Scratch::new(), &mut plan)?;
//! # let executor = Executor::new(&gpu);
//! let mut inspector = Inspector::new(&gpu);
//! let found = inspector.inspect(&executor, &plan, &frame, &(), &imports, &"hdr@color".parse()?)?;
//! println!("{}: {} texels are not finite", found.title(), found.texels.non_finite(4));
//! let picture = found.texels.display(DisplayMode::Color { stops: 2.0 }, 0.1);
//! # assert_eq!(picture.rgba8.len(), 8 * 8 * 4);
//! # Ok(())
//! # }
//! ```

mod display;
mod error;
mod false_color;
mod import_copies;
mod pass;
mod request;
mod target;
mod texels;

pub use display::{Channel, DisplayImage, DisplayMode, DisplayModeError};
pub use error::{InspectError, MissingPart, VersionName};
pub use request::{Request, RequestError, VersionSelector};
pub use target::{InspectTarget, all_targets, find};
pub use texels::Texels;

use crate::device::gpu::Gpu;
use crate::device::pixels::Pixels;
use crate::device::readback::{Readback, ReadbackError, Subresource};
use crate::execute::executor::{Executor, ExecutorOptions};
use crate::execute::steps::{Extra, Passes};
use crate::frame::Frame;
use crate::named::Named;
use crate::resources::imports::Imports;
use framegraph::{Alias, CompileErrors, Extent, Graph, Plan, Scratch, compile};

/// Compiles and executes frames that end with an inspected texture. See the [module documentation](self).
#[derive(Debug)]
pub struct Inspector {
    executor: Executor,
    scratch: Scratch,
}

/// Result of an inspection.
#[derive(Clone, Debug)]
pub struct Inspection {
    /// Part of a texture that was inspected.
    pub target: InspectTarget,
    /// Texel values as a shader reads them.
    pub texels: Texels,
    /// Plan of the inspected frame, up to the pass that reads the target.
    pub plan: Plan,
}

impl Inspection {
    /// Returns a title such as `hdr@color, level 2`.
    pub fn title(&self) -> String {
        self.target.title()
    }
}

impl Inspector {
    /// Creates an inspector with its own resource pools, which are freed with it.
    pub fn new(gpu: &Gpu) -> Self {
        let options = ExecutorOptions { timing: false, ..ExecutorOptions::default() };
        Self { executor: Executor::with(gpu, options), scratch: Scratch::new() }
    }

    /// Inspects the texture that `request` names, in the frame that `executor` would execute next.
    ///
    /// Imports that the inspected passes write are copied first, so the caller's imports stay unchanged. Undeclared
    /// writes of recorders are not covered.
    ///
    /// # Errors
    /// Fails with [`InspectError`]. If a name does not exist, the error lists the names that do.
    pub fn inspect<W: ?Sized>(
        &mut self,
        executor: &Executor,
        plan: &Plan,
        frame: &Frame<W>,
        world: &W,
        imports: &Imports,
        request: &Request,
    ) -> Result<Inspection, InspectError> {
        self.inspect_target(executor, plan, frame, world, imports, find(plan, request)?)
    }

    /// Inspects one of [`all_targets`] like [`Inspector::inspect`].
    ///
    /// # Errors
    /// Fails like [`Inspector::inspect`].
    pub fn inspect_target<W: ?Sized>(
        &mut self,
        executor: &Executor,
        plan: &Plan,
        frame: &Frame<W>,
        world: &W,
        imports: &Imports,
        target: InspectTarget,
    ) -> Result<Inspection, InspectError> {
        self.start_target(executor, plan, frame, world, imports, target)?.wait(executor.gpu())
    }

    /// Submits an inspection like [`Inspector::inspect_target`], without waiting for the texels.
    ///
    /// # Errors
    /// Fails like [`Inspector::inspect`].
    pub(crate) fn start_target<W: ?Sized>(
        &mut self,
        executor: &Executor,
        plan: &Plan,
        frame: &Frame<W>,
        world: &W,
        imports: &Imports,
        target: InspectTarget,
    ) -> Result<Started, InspectError> {
        let name = || target.name.clone();
        let requested = VersionSelector::Number(target.number);
        let missing =
            || InspectError::NoVersion { name: name(), requested: requested.clone(), steps: 0, known: Vec::new() };
        let (mut graph, handle) = plan.graph().ending_with(target.version).ok_or_else(missing)?;
        let mut part = target.part();
        let resource = plan.graph().versions()[target.version.index()].resource;
        if let Some([width, height]) = executor.earlier_texels(plan, frame.key(), resource) {
            part.desc.extent = Extent::absolute(width, height);
        }
        let inspection = part
            .declare(&mut graph, handle, plan.frame())
            .map_err(|error| InspectError::Declare { name: name(), error: error.into() })?;
        let mut inspected = Plan::new();
        let compiled = self.compile(&graph, plan, &mut inspected);
        compiled.map_err(|errors| {
            let error = errors.listed.into_iter().next();
            error.map_or_else(missing, |error| InspectError::Compile { name: name(), error: error.into() })
        })?;

        let gpu = executor.gpu().clone();
        let own = import_copies::import_copies(&gpu, plan.graph(), &inspected, imports)
            .map_err(|import| InspectError::Import { name: name(), import: Named::resource(&inspected, import) })?;
        self.executor.borrow(executor);
        let record = |cx: &mut crate::execute::cx::Cx<'_>| part.record(&inspection, cx);
        let extra = Extra { pass: inspection.pass, record: &record };
        let passes = Passes { frame, world, extra: Some(extra) };
        self.executor
            .run(&inspected, &passes, &own, |commands| commands.submit(&gpu.queue, [], []))
            .map_err(|error| InspectError::Execute { name: name(), error: error.into() })?;

        let texture = self.executor.texture(&inspected, inspection.out).ok_or_else(missing)?;
        let readback = Readback::start(&gpu, texture, Subresource::FIRST).map_err(|error| unread(&target, error))?;
        Ok(Started { target, size: inspection.size, plan: inspected, readback })
    }

    /// Compiles with the options of `plan`. Heap placement is computed again, since usages differ in the inspected
    /// graph.
    fn compile(&mut self, graph: &Graph, plan: &Plan, inspected: &mut Plan) -> Result<(), CompileErrors> {
        if plan.options().alias == Alias::Heap && plan.caps().placed {
            return self.executor.compile(graph, plan.options(), &mut self.scratch, inspected);
        }
        compile(graph, plan.caps(), plan.options(), &mut self.scratch, inspected)
    }
}

/// Submitted inspection whose texels have not arrived.
#[derive(Debug)]
pub(crate) struct Started {
    target: InspectTarget,
    size: [u32; 2],
    plan: Plan,
    readback: Readback,
}

/// Texels of a [`Started`] inspection.
#[cfg(feature = "remote")]
#[derive(Debug)]
pub(crate) struct Arrived {
    /// Part of a texture that was inspected.
    pub(crate) target: InspectTarget,
    /// Width and height in texels.
    pub(crate) size: [u32; 2],
    /// Bytes of [`Texels::bits`], little-endian.
    pub(crate) bits: Vec<u8>,
}

impl Started {
    /// Waits for the texels.
    fn wait(self, gpu: &Gpu) -> Result<Inspection, InspectError> {
        let Self { target, size, plan, readback } = self;
        let pixels = readback.wait(gpu).map_err(|error| unread(&target, error))?;
        Ok(Inspection { texels: texels(&target, size, &pixels), target, plan })
    }

    /// Returns the texels if they have arrived, otherwise the started inspection. Never waits.
    #[cfg(feature = "remote")]
    pub(crate) fn try_take(self, gpu: &Gpu) -> Result<Result<Arrived, Self>, InspectError> {
        let Self { target, size, plan, readback } = self;
        Ok(match readback.try_take(gpu).map_err(|error| unread(&target, error))? {
            Ok(pixels) => Ok(Arrived { target, size, bits: pixels.bytes }),
            Err(readback) => Err(Self { target, size, plan, readback }),
        })
    }
}

fn unread(target: &InspectTarget, error: ReadbackError) -> InspectError {
    InspectError::Readback { name: target.name.clone(), error: error.into() }
}

fn texels(target: &InspectTarget, size: [u32; 2], pixels: &Pixels) -> Texels {
    let words = pixels.bytes.as_chunks::<4>().0.iter().map(|b| u32::from_le_bytes(*b)).collect::<Vec<_>>();
    Texels { format: target.format, aspect: target.aspect, size, bits: words.as_chunks::<4>().0.to_vec() }
}
