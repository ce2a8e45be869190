//! Benchmark of whole frames of large scenes.

use super::cpu_ms;
use super::workload::{Moving, Workload};
use framegraph::{Options, Plan, Scratch, Target, compile};
use framegraph_passes::gpu_scene::view::{Background, ViewSettings};
use framegraph_passes::light::ibl::cache::Cache;
use framegraph_passes::light::ibl::{DfgSettings, IblSettings};
use framegraph_passes::light::shading::LightSettings;
use framegraph_passes::{CameraView, Lighting, PreparedScene, Settings, ViewId, World, standard};
use framegraph_scene::{Environment, Scene, progress};
use framegraph_wgpu::{Executor, Frame, Gpu, Imports};
use glam::DVec3;
use std::error::Error;
use std::time::Instant;

const SIZE_PX: [u32; 2] = [1280, 720];
const FRAMES: usize = 60;
/// Number of warm-up frames, which fill caches.
const WARM_UP: usize = 3;

const WORKLOADS: [Workload; 7] = [
    Workload::alike(10_000),
    Workload::alike(100_000),
    Workload::alike(1_000_000),
    Workload { meshes: 1000, materials: 2000, ..Workload::alike(100_000) },
    Workload { meshes: 1000, materials: 2000, mixed: true, ..Workload::alike(100_000) },
    Workload { moving: Moving::FirstQuarter, ..Workload::alike(100_000) },
    Workload { moving: Moving::EveryFourth, ..Workload::alike(100_000) },
];

/// Prints the table.
pub fn print() -> Result<(), Box<dyn Error>> {
    program::line("### Large scenes\n");
    program::line(
        "| nodes | meshes × materials | draws | prepare once, ms | update, ms | view, ms | upload, ms | execute, ms | frame, ms |",
    );
    program::line("| --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    let gpu = Gpu::noop()?;
    for workload in &WORKLOADS {
        row(&gpu, workload)?;
    }
    program::line("");
    Ok(())
}

fn row(gpu: &Gpu, workload: &Workload) -> Result<(), Box<dyn Error>> {
    let mut scene = workload.scene();
    let settings = Settings::DEFAULT.for_scene(&scene, SIZE_PX);
    let light = LightSettings {
        image: IblSettings { cube_texels: 64, bands: settings.shading.bands, ..IblSettings::default() },
        dfg: DfgSettings { texels: 32, visibility: settings.shading.table },
    };
    let even = Environment::uniform(DVec3::splat(1000.0))?;
    let lighting = Lighting::new(gpu, &even, &light, &Cache::off(), &mut progress::silent)?;
    let origin = Instant::now();
    let begun = cpu_ms(origin);
    let mut prepared = PreparedScene::new(&scene);
    let prepare_ms = cpu_ms(origin) - begun;
    let seen = |frame| ViewSettings {
        camera: workload.camera(frame),
        size_px: SIZE_PX,
        shadows: settings.shadows,
        ..ViewSettings::default()
    };
    let background = Background::Constant(glam::Vec3::ONE);
    let view = |frame, scene: &Scene, prepared: &PreparedScene, lighting: &Lighting| {
        CameraView::prepared(scene, prepared, &lighting.image, &background, &seen(frame))
    };
    let first = view(0, &scene, &prepared, &lighting);
    let draws = first.draws.count();
    let mut world = World::new(gpu, &scene, lighting, [first], &mut progress::silent)?;
    let mut frame = Frame::<World>::new();
    let io = standard(&mut frame, &settings, Target::New)?;
    frame.graph_mut().readback(io.output)?;
    let (mut plan, options) = (Plan::new(), Options::for_frame(SIZE_PX[0], SIZE_PX[1]));
    compile(frame.graph(), &gpu.caps(), &options, &mut Scratch::new(), &mut plan)?;
    let mut executor = Executor::new(gpu);
    // CPU time advances in ticks of the system, so only the sum over frames is meaningful.
    let (mut spans, mut least_ms) = ([0.0; 4], f64::INFINITY);
    for number in 0..WARM_UP + FRAMES {
        let moved = workload.turn(&mut scene, number);
        let start = Instant::now();
        let begun = cpu_ms(origin);
        if !moved.is_empty() {
            prepared.update(&scene, &moved);
        }
        let updated = cpu_ms(origin);
        let own = view(number, &scene, &prepared, &world.lighting);
        let viewed = cpu_ms(origin);
        world.set_view(gpu, ViewId::MAIN, own)?;
        let uploaded = cpu_ms(origin);
        executor.execute(&plan, &frame, &world, &Imports::new())?;
        gpu.wait()?;
        if number >= WARM_UP {
            let ended = cpu_ms(origin);
            least_ms = least_ms.min(1e3 * start.elapsed().as_secs_f64());
            let own = [updated - begun, viewed - updated, uploaded - viewed, ended - uploaded];
            spans.iter_mut().zip(own).for_each(|(sum, own)| *sum += own / FRAMES as f64);
        }
    }
    let ([update_ms, view_ms, upload_ms, execute_ms], frame_ms) = (spans, spans.iter().sum::<f64>());
    program::line(format_args!(
        "| {} | {} | {draws} | {prepare_ms:.1} | {update_ms:.2} | {view_ms:.2} | {upload_ms:.2} | {execute_ms:.2} | {frame_ms:.2} ({least_ms:.2}) |",
        workload.nodes,
        workload.name(),
    ));
    Ok(())
}
