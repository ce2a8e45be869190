//! Looking into a frame: any version of any texture, any level, layer, plane and sample, as numbers and as a picture.
//!
//! The plan under study does not change, and neither does anything that its executor holds: an [`Inspector`] plans a
//! second frame, which ends with the version that was asked for ([`framegraph::Graph::ending_with`]) and one pass that
//! reads it, and executes that with an executor of its own. Attachments that never leave the tile and intermediates that
//! became part of a shader are real in that second plan, because somebody reads them.
//!
//! What is seen is the frame that would be executed next: the recorders are handed the world as it is now, and histories
//! are as the last frame left them.
//!
//! ```
//! # use framegraph::{ClearValue, Extent, Format, Intent, Options, Plan, Scratch, TextureDesc};
//! # use framegraph_wgpu::inspect::{Inspector, ViewMode};
//! # use framegraph_wgpu::{Executor, Gpu, Imports};
//! # use framegraph_wgpu::Frame;
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let gpu = Gpu::noop()?;
//! # let mut frame = Frame::<()>::new();
//! # let hdr = frame.graph_mut().texture("hdr", TextureDesc::new(Extent::FRAME, Format::Rgba16Float));
//! # let hdr = frame.add_fn("color", |p| p.color(hdr, Intent::Clear(ClearValue::BLACK)), |_, _, _| Ok(()))?;
//! # frame.graph_mut().export(hdr);
//! # let (mut plan, options, imports) = (Plan::new(), Options::for_frame(8, 8), Imports::new());
//! # framegraph::compile(frame.graph(), &gpu.caps(), &options, &mut Scratch::new(), &mut plan)?;
//! # let executor = Executor::new(&gpu);
//! let mut inspector = Inspector::new(&gpu);
//! let seen = inspector.inspect(&executor, &plan, &frame, &(), &imports, &"hdr@color".parse()?)?;
//! println!("{}: {} texels are not finite", seen.title(), seen.texels.non_finite(4));
//! let picture = seen.texels.shown(ViewMode::Color { stops: 2.0 }, 0.1);
//! # assert_eq!(picture.rgba8.len(), 8 * 8 * 4);
//! # Ok(())
//! # }
//! ```

mod error;
mod false_color;
mod look;
mod request;
mod resolve;
mod texels;
mod twins;
mod view;

pub use error::InspectError;
pub use false_color::turbo;
pub use request::{Request, RequestError, Which};
pub use resolve::{Seen, everything, find};
pub use texels::Texels;
pub use view::{Channel, ModeError, Shown, ViewMode};

use crate::device::gpu::Gpu;
use crate::device::readback::{ReadbackError, read_texture};
use crate::execute::executor::{Executor, ExecutorOptions};
use crate::execute::steps::Extra;
use crate::frame::Frame;
use crate::resources::imports::Imports;
use framegraph::{Plan, Scratch, compile};

/// Executes inspected plans, beside the executor of the frame under study. See the [module](self).
#[derive(Debug)]
pub struct Inspector {
    executor: Executor,
    scratch: Scratch,
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Inspection {
    /// What was looked at.
    pub seen: Seen,
    /// Its numbers.
    pub texels: Texels,
    /// The second plan: that of the frame up to there, with the pass that looks.
    pub plan: Plan,
}

impl Inspection {
    /// What was looked at, in words.
    pub fn title(&self) -> String {
        self.seen.title()
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
    pub fn inspect<W: ?Sized + 'static>(
        &mut self,
        executor: &Executor,
        plan: &Plan,
        frame: &Frame<W>,
        world: &W,
        imports: &Imports,
        request: &Request,
    ) -> Result<Inspection, InspectError> {
        self.look(executor, plan, frame, world, imports, find(plan, request)?)
    }

    /// As [`Inspector::inspect`], of one of [`everything`] that there is.
    ///
    /// # Errors
    /// As [`Inspector::inspect`].
    pub fn look<W: ?Sized + 'static>(
        &mut self,
        executor: &Executor,
        plan: &Plan,
        frame: &Frame<W>,
        world: &W,
        imports: &Imports,
        seen: Seen,
    ) -> Result<Inspection, InspectError> {
        let name = || seen.name.clone();
        let missing = || InspectError::NoVersion { name: name(), asked: seen.number.to_string(), known: String::new() };
        let (mut graph, handle) = plan.graph().ending_with(seen.version).ok_or_else(missing)?;
        let part = seen.part();
        let look = part
            .declare(&mut graph, handle, plan.frame())
            .map_err(|error| InspectError::Declare { name: name(), error: error.into() })?;
        let mut inspected = Plan::new();
        compile(&graph, plan.caps(), plan.options(), &mut self.scratch, &mut inspected).map_err(|errors| {
            let error = errors.0.into_iter().next();
            error.map_or_else(missing, |error| InspectError::Compile { name: name(), error: error.into() })
        })?;

        let gpu = executor.gpu().clone();
        let own = twins::twins(&gpu, plan.graph(), &inspected, imports).map_err(|import| InspectError::Import {
            name: name(),
            import: inspected.graph().resource_name(import).to_owned(),
        })?;
        self.executor.borrow(executor);
        let record = |cx: &mut crate::execute::cx::Cx<'_>| part.record(&look, cx);
        let extra = Extra { pass: look.pass, record: &record };
        self.executor
            .run(&inspected, frame, world, &own, Some(extra))
            .map_err(|error| InspectError::Execute { name: name(), error: error.into() })?;

        let unread = |error: ReadbackError| InspectError::Readback { name: name(), error: error.into() };
        let texture = self.executor.texture(&inspected, look.out).ok_or_else(missing)?;
        let pixels = read_texture(&gpu, texture).map_err(unread)?;
        let words = pixels.bytes.as_chunks::<4>().0.iter().map(|b| u32::from_le_bytes(*b)).collect::<Vec<_>>();
        let bits = words.as_chunks::<4>().0.to_vec();
        let texels = Texels { format: seen.format, aspect: seen.aspect, size: look.size, bits };
        Ok(Inspection { seen, texels, plan: inspected })
    }
}
