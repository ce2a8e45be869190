//! Each kind of faulty pass is found by the debug mode that removes what it relies on, and by no other.

use crate::stage::gpu;
use framegraph::{
    AccessKind, ClearValue, DeclareError, Extent, Format, Intent, Options, Order, PassBuilder, Plan, Scratch, Texture,
    TextureDesc, compile,
};
use framegraph_wgpu::Frame;
use framegraph_wgpu::debug::{Mode, Outcome, bisect};
use framegraph_wgpu::{
    Compute, Cx, Executor, ExecutorOptions, Gpu, Imports, Raster, RecordError, Shader, read_texture,
};
use std::error::Error;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

type Failure = Box<dyn Error>;

const FILL: Shader<'static> = Shader::new(
    "fill",
    "@group(0) @binding(0) var<uniform> color: vec4f;
     @vertex fn full(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
       return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.5, 1.0);
     }
     @vertex fn half(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
       return vec4f(f32(i & 1) * 2.0 - 1.0, f32(i >> 1) * 2.0 - 1.0, 0.5, 1.0);
     }
     @fragment fn fs_main() -> @location(0) vec4f { return color; }",
);

fn fill(cx: &mut Cx<'_>, vertex: &str, red: f32) -> Result<(), RecordError> {
    let pipeline = cx.raster_pipeline(&Raster { vertex, ..Raster::new(FILL) })?;
    let color = cx.uniform(&[red, 0.0, 0.25, 1.0]);
    let group = cx.bind_group(pipeline.group(0), &[(0, color)]);
    let pass = cx.render_pass()?;
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.draw(0..3, 0..1);
    Ok(())
}

/// Returns the picture `out` of the declared frame under a debug mode.
fn picture(
    gpu: &Gpu,
    declare: &impl Fn(&mut Frame) -> Result<Texture, DeclareError>,
    mode: Option<Mode>,
) -> Result<Vec<u8>, Failure> {
    let mut frame = Frame::new();
    let out = declare(&mut frame)?;
    let mut options = Options { order: Order::Optimized, ..Options::for_frame(16, 16) };
    let mut execute = ExecutorOptions::default();
    mode.iter().for_each(|mode| mode.apply(&mut options, &mut execute));
    let mut plan = Plan::new();
    compile(frame.graph(), &gpu.caps(), &options, &mut Scratch::new(), &mut plan)?;
    let mut executor = Executor::with(gpu, execute);
    executor.execute(&plan, &frame, &(), &Imports::new())?;
    let texture = executor.texture(&plan, out).ok_or("no picture")?;
    Ok(read_texture(gpu, texture)?.rgba8())
}

/// Returns the names of the debug modes that change the picture.
fn found(
    gpu: &Gpu,
    declare: impl Fn(&mut Frame) -> Result<Texture, DeclareError>,
) -> Result<Vec<&'static str>, Failure> {
    let outcomes = bisect(|mode| picture(gpu, &declare, mode))?;
    Ok(outcomes.iter().filter(|o| !o.is_same()).map(Outcome::name).collect())
}

const DESC: TextureDesc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
const BLACK: Intent = Intent::Clear(ClearValue::BLACK);

const SUMS: Shader<'static> = Shader::new(
    "sums",
    "@group(0) @binding(0) var<storage, read_write> sums: array<f32>;
     @compute @workgroup_size(16) fn all(@builtin(global_invocation_id) id: vec3u) { sums[id.x] = 1.0; }
     @compute @workgroup_size(16) fn half(@builtin(global_invocation_id) id: vec3u) {
       if id.x < 8u { sums[id.x] = 1.0; }
     }",
);

const SHOW: Shader<'static> = Shader::new(
    "show",
    "@group(0) @binding(0) var<storage, read> sums: array<f32>;
     @vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
       return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.5, 1.0);
     }
     @fragment fn fs_main(@builtin(position) at: vec4f) -> @location(0) vec4f {
       let sum = sums[u32(at.x) % 16u];
       return select(vec4f(1.0), vec4f(sum, 0.0, 0.0, 1.0), sum <= 1.0);
     }",
);

/// Declares a pass that overwrites a buffer, and one that displays it. If `faulty`, the first pass writes only half and
/// relies on zeros in the rest. On devices that clear memory, only poisoning shows this.
fn promised(frame: &mut Frame, faulty: bool) -> Result<Texture, DeclareError> {
    let sums = frame.graph_mut().buffer("sums", 64);
    let entry = if faulty { "half" } else { "all" };
    let write = |p: &mut PassBuilder<'_>| p.write_buffer(sums, AccessKind::StorageWrite, Intent::Overwrite);
    let sums = frame.add_fn("sum", write, move |sums, (), cx| {
        let pipeline = cx.compute_pipeline(&Compute { entry, ..Compute::new(SUMS) })?;
        let bound = cx.buffer_of(*sums)?;
        let group = cx.bind_group(pipeline.group(0), &[(0, bound.into())]);
        let pass = cx.compute_pass()?;
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(1, 1, 1);
        Ok(())
    })?;
    let out = frame.graph_mut().texture("out", DESC);
    let read =
        |p: &mut PassBuilder<'_>| Ok((p.read_buffer(sums, AccessKind::StorageRead)?, p.color(out, Intent::Overwrite)?));
    let (_, out) = frame.add_fn("show", read, |(sums, _), (), cx| {
        let pipeline = cx.raster_pipeline(&Raster::new(SHOW))?;
        let bound = cx.buffer(*sums)?;
        let group = cx.bind_group(pipeline.group(0), &[(0, bound.into())]);
        let pass = cx.render_pass()?;
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    })?;
    frame.graph_mut().readback(out)?;
    Ok(out)
}

#[test]
fn an_uninitialized_read_is_found_by_poison() -> Result<(), Failure> {
    let Some(gpu) = gpu("an_uninitialized_read_is_found_by_poison") else { return Ok(()) };
    assert_eq!(found(&gpu, |f| promised(f, true))?, ["poison"]);
    // Negative control: a correct frame looks the same under every mode.
    assert!(found(&gpu, |f| promised(f, false))?.is_empty());
    Ok(())
}

/// A target that is declared as overwritten but only half covered. The rest is undefined and may vary, but never equals
/// the poison value.
#[test]
fn a_target_that_is_not_covered_is_found_by_poison() -> Result<(), Failure> {
    let Some(gpu) = gpu("a_target_that_is_not_covered_is_found_by_poison") else { return Ok(()) };
    let covered = |frame: &mut Frame, vertex: &'static str| {
        let out = frame.graph_mut().texture("out", DESC);
        let out = frame.add_fn("draw", |p| p.color(out, Intent::Overwrite), move |_, (), cx| fill(cx, vertex, 0.5))?;
        frame.graph_mut().readback(out)?;
        Ok(out)
    };
    assert!(found(&gpu, |f| covered(f, "half"))?.contains(&"poison"));
    assert!(found(&gpu, |f| covered(f, "full"))?.is_empty());
    Ok(())
}

/// `late` and `early` share a step if `other` follows both. If `faulty`, a counter outside the graph tells `late` how
/// many passes were recorded before it.
fn ordered(frame: &mut Frame, faulty: bool) -> Result<Texture, DeclareError> {
    let graph = frame.graph_mut();
    let (out, other) = (graph.texture("out", DESC), graph.texture("other", DESC));
    let counter = Arc::new(AtomicU32::new(0));
    let count = move |counter: &AtomicU32| counter.fetch_add(1, Ordering::Relaxed) as f32;
    let (a, b, c) = (counter.clone(), counter.clone(), counter);
    let out = frame.add_fn(
        "early",
        |p| p.color(out, BLACK),
        move |_, (), cx| {
            count(&a);
            fill(cx, "full", 0.25)
        },
    )?;
    let other = frame.add_fn(
        "other",
        |p| p.color(other, BLACK),
        move |_, (), cx| {
            count(&b);
            fill(cx, "full", 0.5)
        },
    )?;
    let out = frame.add_fn(
        "late",
        |p| p.color(out, Intent::Modify),
        move |_, (), cx| {
            let before = count(&c);
            fill(cx, "half", if faulty { before / 4.0 } else { 1.0 })
        },
    )?;
    frame.graph_mut().readback(out)?;
    frame.graph_mut().export(other)?;
    Ok(out)
}

#[test]
fn an_order_that_was_not_declared_is_found_by_immediate() -> Result<(), Failure> {
    let Some(gpu) = gpu("an_order_that_was_not_declared_is_found_by_immediate") else { return Ok(()) };
    let modes = found(&gpu, |f| ordered(f, true))?;
    // Without merging, there is no reason to reorder the two passes, so this mode shows the fault too.
    assert_eq!(modes, ["no-merge", "immediate"]);
    assert!(found(&gpu, |f| ordered(f, false))?.is_empty());
    Ok(())
}
