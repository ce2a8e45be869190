//! Two threads record one frame.

use super::*;
use crate::device::adapter::AdapterRequest;
use crate::device::gpu::OpenError;
use crate::device::readback::read_texture;
use crate::execute::cx::Cx;
use crate::execute::error::RecordError;
use crate::pipelines::shader::Shader;
use crate::pipelines::state::{Constants, Raster};
use framegraph::{DeclareError, Extent, Format, Intent, Options, Scratch, Texture, TextureDesc, compile};
use wgpu::{CommandBuffer, CommandEncoderDescriptor};

type TestResult = Result<(), Box<dyn std::error::Error>>;

const FILL: Shader<'static> = Shader::new(
    "fill",
    "override RED: f32;
     @group(0) @binding(0) var<uniform> rest: vec4f;
     @vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
       return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.5, 1.0);
     }
     @fragment fn fs_main() -> @location(0) vec4f { return vec4f(RED, rest.yzw); }",
);

fn fill(red: f64, cx: &mut Cx<'_>) -> Result<(), RecordError> {
    let pipeline = cx.raster_pipeline(&Raster { constants: Constants(&[("RED", red)]), ..Raster::new(FILL) })?;
    let rest = cx.uniform(&[0.0, red as f32 / 2.0, 0.0, 1.0]);
    let group = cx.bind_group(pipeline.group(0), &[(0, rest)]);
    let pass = cx.render_pass()?;
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.draw(0..3, 0..1);
    Ok(())
}

/// Two steps that draw into textures of their own.
fn declare(frame: &mut Frame) -> Result<[Texture; 2], DeclareError> {
    let mut add = |name: &str, red: f64| {
        let target = frame.graph_mut().texture(name, TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
        let drawn = frame.add_fn(name, |p| p.color(target, Intent::Overwrite), move |_, (), cx| fill(red, cx))?;
        frame.graph_mut().readback(drawn)?;
        Ok(drawn)
    };
    Ok([add("a", 0.2)?, add("b", 0.4)?])
}

fn needs_send<T: Send>() {}
fn needs_sync<T: Sync>() {}

/// A recorder's context goes to another thread, and what contexts share is shared by reference.
#[test]
fn contexts_of_one_frame_may_live_on_several_threads() {
    needs_send::<Cx<'_>>();
    needs_send::<Recording>();
    needs_sync::<Prepared<'_>>();
    needs_sync::<Passes<'_, ()>>();
}

/// Each step is recorded by a thread of its own into an encoder of its own, several frames in a row; the pictures and
/// counts are those of the executor, and nothing is made twice.
#[test]
fn two_threads_record_two_steps_of_one_frame() -> TestResult {
    let gpu = Gpu::open(&AdapterRequest::from_env()).or_else(|_: OpenError| Gpu::noop())?;
    let (mut frame, mut plan) = (Frame::new(), Plan::new());
    let targets = declare(&mut frame)?;
    let (options, imports) = (Options::for_frame(4, 4), Imports::new());
    compile(frame.graph(), &gpu.caps(), &options, &mut Scratch::new(), &mut plan)?;
    let mut expected = Executor::new(&gpu);
    expected.execute(&plan, &frame, &(), &imports)?;

    let mut executor = Executor::with(&gpu, ExecutorOptions { timing: false, ..ExecutorOptions::default() });
    let mut recordings = [Recording::new(&gpu.device, false), Recording::new(&gpu.device, false)];
    let passes = Passes { frame: &frame, world: &(), extra: None };
    for _ in 0..3 {
        executor.caches.begin_frame(30, 30);
        recordings.iter_mut().for_each(Recording::begin_frame);
        executor.prepare(&plan, &imports)?;
        let Executor { realized, caches, timing, touched, .. } = &executor;
        let prepared = Prepared { gpu: &gpu, plan: &plan, realized, caches, timing, touched, poison: false };
        let record = |step, recording: &mut Recording| -> Result<CommandBuffer, ExecuteError> {
            let mut encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
            record_step(&prepared, &passes, step, recording, &mut encoder)?;
            Ok(encoder.finish())
        };
        let commands = std::thread::scope(|threads| {
            let both = plan.step_ids().zip(&mut recordings);
            let both: Vec<_> = both.map(|(step, own)| threads.spawn(move || record(step, own))).collect();
            both.into_iter().map(|thread| thread.join().map_err(|_| "a recorder panicked")).collect::<Vec<_>>()
        });
        recordings.iter().for_each(|own| own.uniforms.upload(&gpu.queue));
        gpu.queue.submit(commands.into_iter().collect::<Result<Result<Vec<_>, _>, _>>()??);
    }
    for target in targets {
        let picture = |executor: &Executor| executor.texture(&plan, target).map(|t| read_texture(&gpu, t));
        assert_eq!(picture(&executor).transpose()?, picture(&expected).transpose()?);
    }
    let steps = recordings.each_ref().map(|own| (own.executed.steps, own.executed.passes));
    assert_eq!(steps, [(1, 1); 2], "each thread recorded one");
    let (made, alone) = (executor.objects(), expected.objects());
    assert_eq!((made.pipelines, made.shader_modules, made.bind_groups), (2, 1, 2), "{made:?}");
    assert_eq!((made.pipelines, made.views), (alone.pipelines, alone.views));
    Ok(())
}
