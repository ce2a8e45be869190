//! Inspecting a frame: any version of any texture, any level, layer, plane and sample, as numbers and as a picture.
//!
//! The plan under study does not change, and neither does anything that its executor holds: an [`Inspector`] plans a
//! second frame, which ends with the version that was asked for ([`framegraph::Graph::ending_with`]) and one pass that
//! reads it, and executes that with an executor of its own. Attachments that never leave the tile and intermediates that
//! became part of a shader are in memory in that second plan, because the added pass reads them.
//!
//! The inspected frame is the one that would be executed next: recorders get the world as it is now, and histories are as
//! the last frame left them.
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
use crate::device::readback::{ReadbackError, read_texture};
use crate::execute::executor::{Executor, ExecutorOptions};
use crate::execute::steps::{Extra, Passes};
use crate::frame::Frame;
use crate::named::Named;
use crate::resources::imports::Imports;
use framegraph::{Alias, CompileErrors, Extent, Graph, Plan, Scratch, compile};

/// Executes inspected plans, beside the executor of the frame under study. See the [module](self).
#[derive(Debug)]
pub struct Inspector {
    executor: Executor,
    scratch: Scratch,
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Inspection {
    /// What was inspected.
    pub target: InspectTarget,
    /// Its texels, as a shader reads them.
    pub texels: Texels,
    /// The second plan: that of the frame up to there, with the pass that reads the target.
    pub plan: Plan,
}

impl Inspection {
    /// What was inspected, in words: `hdr@color, level 2`.
    pub fn title(&self) -> String {
        self.target.title()
    }
}

impl Inspector {
    /// An inspector with pools of its own; what it holds is given up with it.
    pub fn new(gpu: &Gpu) -> Self {
        let options = ExecutorOptions { timing: false, ..ExecutorOptions::default() };
        Self { executor: Executor::with(gpu, options), scratch: Scratch::new() }
    }

    /// Looks at what `request` names, of the frame that `executor` executes with `plan`, `frame`, `world` and `imports`.
    ///
    /// Imports that the inspected passes write are copied first, so that the caller's stay as they are; a copy pass or a
    /// recorder that writes what it did not declare is beyond that care.
    ///
    /// # Errors
    /// [`InspectError`]; a name that is not there comes with those that are.
    pub fn inspect<W: ?Sized + Sync + 'static>(
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

    /// As [`Inspector::inspect`], of one of [`all_targets`] that there is.
    ///
    /// # Errors
    /// As [`Inspector::inspect`].
    pub fn inspect_target<W: ?Sized + Sync + 'static>(
        &mut self,
        executor: &Executor,
        plan: &Plan,
        frame: &Frame<W>,
        world: &W,
        imports: &Imports,
        target: InspectTarget,
    ) -> Result<Inspection, InspectError> {
        let name = || target.name.clone();
        let asked = VersionSelector::Number(target.number);
        let missing = || InspectError::NoVersion { name: name(), asked: asked.clone(), steps: 0, known: Vec::new() };
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

        let unread = |error: ReadbackError| InspectError::Readback { name: name(), error: error.into() };
        let texture = self.executor.texture(&inspected, inspection.out).ok_or_else(missing)?;
        let pixels = read_texture(&gpu, texture).map_err(unread)?;
        let words = pixels.bytes.as_chunks::<4>().0.iter().map(|b| u32::from_le_bytes(*b)).collect::<Vec<_>>();
        let bits = words.as_chunks::<4>().0.to_vec();
        let texels = Texels { format: target.format, aspect: target.aspect, size: inspection.size, bits };
        Ok(Inspection { target, texels, plan: inspected })
    }

    /// Compiles as `plan` was. What is placed has other uses here, of which the driver is asked again.
    fn compile(&mut self, graph: &Graph, plan: &Plan, inspected: &mut Plan) -> Result<(), CompileErrors> {
        if plan.options().alias == Alias::Heap && plan.caps().placed {
            return self.executor.compile(graph, plan.options(), &mut self.scratch, inspected);
        }
        compile(graph, plan.caps(), plan.options(), &mut self.scratch, inspected)
    }
}
