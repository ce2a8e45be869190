//! Recorders for passes that have none: a graph read from a file, or declared without recorders, is executed on a
//! device with its true attachments, bindings and copies, before a single shader of its own is written.
//!
//! A stand-in keeps every promise that its pass declares: it reads everything that is read, writes every texel of what it
//! overwrites, and builds upon what it modifies. What it writes is arithmetic over what it reads, between 0 and 1, so a
//! picture made by stand-ins depends on every pass that was not culled, and a NaN that a pass reads is a NaN that it
//! writes.
//!
//! What a device cannot bind is looked up and left at that: more storage textures than a shader may have, formats that
//! cannot be stored to. A stand-in whose plan inlines other passes draws into their target and leaves it at that.
//!
//! ```
//! use framegraph::file::{GraphFile, Registry};
//! use framegraph::{Options, Plan, Scratch};
//! use framegraph_wgpu::{Executor, Gpu};
//! use framegraph_wgpu::{Frame, stand_in};
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
//! stand_in::fill_in(&mut frame);
//! framegraph::compile(frame.graph(), &gpu.caps(), &Options::for_frame(64, 64), &mut Scratch::new(), &mut plan)?;
//! let mut executor = Executor::new(&gpu);
//! executor.execute(&plan, &frame, &(), &stand_in::imports(&gpu, &plan)?.bound)?;
//! assert_eq!(executor.executed(), plan.counts());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bind;
mod copy;
mod imports;
mod shader;

pub use imports::{Imported, imports};

use crate::execute::cx::Cx;
use crate::execute::error::RecordError;
use crate::frame::Frame;
use crate::pipelines::shader::Shader;
use crate::pipelines::state::{Compute, Depth, Raster};
use bind::{Bindings, WORKGROUP};
use framegraph::{Access, AccessKind, Aspect, Mode, PassId, PassKind};
use shader::{compute_wgsl, raster_wgsl};
use wgpu::{CompareFunction, StencilFaceState, StencilOperation, StencilState};

/// Gives every pass that has no recorder one that keeps the pass's promises.
pub fn fill_in<W: ?Sized + 'static>(frame: &mut Frame<W>) {
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

/// Draws one triangle: over everything where something is overwritten, over the lower left half where all is built upon.
fn raster(pass: PassId, cx: &mut Cx<'_>) -> Result<(), RecordError> {
    // A pass that takes epilogues has to ask for them.
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

/// How depth is tested: not at all where every texel has to be written, and otherwise so that the outcome depends on what
/// is there. The planes that the access does not name are left alone.
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

/// One dispatch for each level that is written.
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
