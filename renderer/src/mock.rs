//! Mock recorders for passes that have none, and mock imports.
//!
//! They execute a graph before any of its shaders is written, for example one read from a file. Attachments, bindings
//! and copies are the real ones.
//!
//! A mock recorder fulfills the declaration of its pass: it reads every input, writes every texel that is overwritten,
//! and modifies what is modified. Outputs are arithmetic over the inputs, between 0 and 1. The final image therefore
//! depends on every pass that was not culled, and NaN inputs propagate to the outputs.
//!
//! Resources that the device cannot bind are looked up but not bound, for example storage textures beyond the limit or
//! formats without storage support. A mock recorder ignores the epilogues that the plan inlines into its pass.
//!
//! ```
//! use framegraph::file::{GraphFile, Registry};
//! use framegraph::{Options, Plan, Scratch};
//! use framegraph_wgpu::{Executor, Gpu};
//! use framegraph_wgpu::{Frame, mock};
//!
//! let text = r#"(version: 1,
//!     resources: [
//!         Texture(name: "screen", format: Rgba8UnormSrgb, kind: Import(entry: Undefined, exit: Keep)),
//!         Texture(name: "hdr", format: Rgba16Float),
//!     ],
//!     passes: [
//!         Raster(name: "scene", accesses: [Color(to: "hdr", intent: ClearColor(0, 0, 0, 1))]),
//!         Raster(name: "tonemap", accesses: [Sampled(of: "hdr"), Color(to: "screen", intent: Overwrite)]),
//!     ],
//! )"#;
//! let (gpu, mut frame, mut plan) = (Gpu::noop()?, Frame::<()>::new(), Plan::new());
//! GraphFile::parse("frame.ron", text)?.declare(&[], &Registry::new(), &mut frame)?;
//! mock::add_recorders(&mut frame);
//! framegraph::compile(frame.graph(), &gpu.caps(), &Options::for_frame(64, 64), &mut Scratch::new(), &mut plan)?;
//! let mut executor = Executor::new(&gpu);
//! executor.execute(&plan, &frame, &(), &mock::imports(&gpu, &plan)?.bound)?;
//! assert_eq!(executor.executed(), plan.counts());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bind;
mod copy;
mod imports;
mod shader;

pub use imports::{MockImports, imports};

use crate::execute::cx::Cx;
use crate::execute::error::RecordError;
use crate::frame::Frame;
use crate::pipelines::shader::Shader;
use crate::pipelines::state::{Compute, Depth, Raster};
use bind::{Bindings, WORKGROUP};
use framegraph::{Access, AccessKind, Aspect, Mode, PassId, PassKind};
use shader::{compute_wgsl, raster_wgsl};
use wgpu::{CompareFunction, StencilFaceState, StencilOperation, StencilState};

/// Adds a mock recorder to every pass without a recorder. See the [module documentation](self).
pub fn add_recorders<W: ?Sized>(frame: &mut Frame<W>) {
    for pass in frame.graph().pass_ids() {
        if !frame.has_recorder(pass) {
            let kind = frame.graph().passes()[pass.index()].kind;
            frame.set_recorder(pass, move |pass, _, cx| record(*pass, kind, cx));
        }
    }
}

fn record(pass: PassId, kind: PassKind, cx: &mut Cx<'_>) -> Result<(), RecordError> {
    match kind {
        PassKind::Raster => raster(pass, cx),
        PassKind::Compute => compute(cx),
        PassKind::Copy => copy::record(cx),
    }
}

/// Draws one triangle. It covers the whole target if any attachment is overwritten, otherwise the lower left half.
fn raster(pass: PassId, cx: &mut Cx<'_>) -> Result<(), RecordError> {
    // Epilogues must be requested, even though they are not used here.
    drop(cx.inlined());
    let own = cx.plan().graph().accesses_of(pass);
    let whole = own.iter().any(|a| a.mode == Mode::Overwrite);
    let bindings = Bindings::of(cx, 0)?;
    let text = raster_wgsl(cx, own, &bindings, whole);
    let depth = own.iter().find(|a| a.kind.is_depth()).map_or(Depth::NONE, |a| tested(cx, a, whole));
    let draws = bindings.is_empty() && !own.iter().any(|a| a.kind == AccessKind::Color);
    let fragment = (!draws).then_some("fs_main");
    let pipeline =
        cx.raster_pipeline(&Raster { fragment, depth, ..Raster::new(Shader::new(cx.pass_name(), &text)) })?;
    let group = (!bindings.is_empty()).then(|| cx.bind_group(pipeline.group(0), &bindings.rows));
    let pass = cx.render_pass()?;
    pass.set_pipeline(&pipeline);
    if let Some(group) = &group {
        pass.set_bind_group(0, group, &[]);
    }
    if let Some(buffer) = &bindings.vertices {
        pass.set_vertex_buffer(0, buffer.slice());
    }
    if let Some(buffer) = &bindings.indices {
        pass.set_index_buffer(buffer.slice(), wgpu::IndexFormat::Uint32);
    }
    pass.draw(0..3, 0..1);
    Ok(())
}

/// Returns the depth state. The test always passes if every texel must be written; otherwise the result depends on the
/// old contents. Planes outside of the access are not written.
fn tested(cx: &Cx<'_>, access: &Access, whole: bool) -> Depth {
    let writes = access.mode.writes();
    let named = |aspect| matches!(access.range.aspect, Aspect::All) || access.range.aspect == aspect;
    let format = cx.targets().depth;
    let stencil = format.is_some_and(|f| f.has_stencil()) && named(Aspect::Stencil) && writes;
    let face = StencilFaceState { pass_op: StencilOperation::Replace, ..StencilFaceState::IGNORE };
    Depth {
        compare: if whole { CompareFunction::Always } else { CompareFunction::GreaterEqual },
        write: writes && named(Aspect::Depth),
        stencil: if stencil {
            StencilState { front: face, back: face, read_mask: 0xff, write_mask: 0xff }
        } else {
            Depth::NONE.stencil
        },
        ..Depth::NONE
    }
}

/// Records one dispatch for each written mip level.
fn compute(cx: &mut Cx<'_>) -> Result<(), RecordError> {
    let levels = bind::levels_written(cx);
    for level in 0..levels {
        let bindings = Bindings::of(cx, level)?;
        let text = compute_wgsl(cx.pass_name(), &bindings, level);
        let pipeline = cx.compute_pipeline(&Compute::new(Shader::new(cx.pass_name(), &text)))?;
        let group = (!bindings.is_empty()).then(|| cx.bind_group(pipeline.group(0), &bindings.rows));
        let pass = cx.compute_pass()?;
        pass.set_pipeline(&pipeline);
        if let Some(group) = &group {
            pass.set_bind_group(0, group, &[]);
        }
        let [x, y] = bindings.extent.map(|side| side.div_ceil(WORKGROUP));
        pass.dispatch_workgroups(x, y, 1);
    }
    Ok(())
}
