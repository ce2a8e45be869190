//! Picture sequences: a turntable or consecutive frames.

use crate::args::Args;
use crate::decide::Sequence;
use crate::effects::enlarging;
use crate::kept_shadows::{OwnResources, declare};
use crate::load;
use crate::run::{Failure, Prepared, device, executed, input};
use framegraph::{Plan, Scratch};
use framegraph_passes::effects::exposure::Measuring;
use framegraph_passes::gpu_scene::view::ViewSettings;
use framegraph_passes::quality::{Controller, percents};
use framegraph_passes::{CameraView, FrameIndex, PreparedScene, Settings, ViewId};
use framegraph_scene::Scene;
use framegraph_scene::picture::encode_png;
use framegraph_wgpu::{Executor, read_texture};
use glam::{DQuat, DVec3};
use program::interrupt;
use program::outputs::Outputs;
use program::progress::Shown;
use std::f64::consts::TAU;
use std::path::PathBuf;
use std::time::Instant;

/// Returns the files of a sequence.
pub fn files(sequence: &Sequence) -> impl Iterator<Item = PathBuf> {
    let name = if sequence.turns { "turntable" } else { "frame" };
    let folder = sequence.folder.clone();
    (0..sequence.frames).map(move |index| folder.join(format!("{name}_{index:04}.png")))
}

/// Renders the pictures into `outputs`.
///
/// Feature culling decides for each frame, with the decisions and readbacks of earlier frames. If the camera turns or an
/// animation plays, temporal effects receive motion vectors. With dynamic resolution, earlier frame times choose the scale.
///
/// # Errors
/// An input or device failure with a one-line message, or a signal.
pub fn render(args: &Args, prepared: &mut Prepared, sequence: &Sequence, outputs: &mut Outputs) -> Result<(), Failure> {
    let (options, execute) = prepared.options(args);
    let (mut plan, mut scratch) = (Plan::new(), Scratch::new());
    let mut executor = prepared.executor(args, execute)?;
    let mut shown = Shown::default();
    let center = prepared.loaded.scene.bounds_above_ground().center();
    let mut placed = placed_on(&executor, &prepared.loaded.scene);
    let (mut plans, mut planned, mut measuring) = (0_u32, None, Measuring::new());
    let (mut drawn_at, mut times_ms) = (Vec::new(), Vec::new());
    let mut dynamic = args.effects.dynamic.map(|[target_ms, min]| {
        let scales = percents(min);
        (Controller::new(target_ms, scales.iter().map(|percent| percent * percent)), scales)
    });
    for (path, index) in files(sequence).zip(0..) {
        let plays = args.animation.plays() && !sequence.turns && index > 0;
        if plays {
            args.animation.apply(&mut prepared.loaded.scene, f64::from(index) / sequence.per_second).map_err(input)?;
            prepared.world.scene.repose(&prepared.gpu, &prepared.loaded.scene).map_err(device)?;
            if !prepared.loaded.scene.motion.rest.materials.is_empty() {
                prepared.culling.resurvey(&prepared.loaded.scene);
            }
            // The camera may be attached to an animated node.
            prepared.seen.camera = load::view(args, &prepared.loaded).map_err(input)?.camera;
        }
        let turned = if sequence.turns { f64::from(index) / f64::from(sequence.frames) * TAU } else { 0.0 };
        let mut seen = around(&prepared.seen, center, turned);
        if let Some((controller, scales)) = &dynamic {
            let next = scales[controller.level()];
            let asked = Settings { upscale: enlarging(args.frame.settings.upscale, next), ..prepared.asked };
            seen.size_px = asked.drawn_px(args.size_px);
            // A smaller picture has fewer mip levels.
            prepared.asked = asked.for_scene(&prepared.loaded.scene, seen.size_px);
            drawn_at.push(next);
        }
        let light = &prepared.world.lighting.image;
        let measured = measuring.known(&prepared.gpu).map_err(device)?;
        let facts = prepared.culling.facts(&prepared.loaded, light, &seen, &prepared.asked, measured);
        let mut settings = facts.apply(&prepared.asked);
        let seen = ViewSettings { shadows: settings.shadows, ..seen };
        if plays {
            placed = placed_on(&executor, &prepared.loaded.scene);
        }
        let view = CameraView::prepared(&prepared.loaded.scene, &placed, light, &prepared.loaded.background, &seen);
        let Prepared { gpu, world, loaded, dirt, .. } = &mut *prepared;
        // Temporal effects reproject from the view of the previous frame.
        let before = &world.views.get(ViewId::MAIN).map_err(device)?.view;
        let mut view = if index == 0 { view } else { view.after(before) };
        if plays {
            view = view.deformed(before, &loaded.scene);
        }
        if let Some(taa) = &settings.taa {
            view.jitter(taa.jitter_px(index));
        }
        settings.moving = (0..loaded.scene.instances.len()).any(|instance| view.moves(instance));
        let stand = view.stand();
        world.set_view(gpu, ViewId::MAIN, view).map_err(device)?;
        world.frame_index = FrameIndex(index);
        let own = OwnResources { kept: None, dirt: dirt.as_ref() };
        let (frame, io, imports) = declare(&settings, &facts, false, own)?;
        executor.compile(frame.graph(), &options, &mut scratch, &mut plan).map_err(input)?;
        plans += u32::from(planned.replace(settings) != Some(settings));
        let begun = Instant::now();
        executor.execute(&plan, &frame, world, &imports).map_err(executed)?;
        if let Some((controller, _)) = &mut dynamic {
            gpu.wait().map_err(device)?;
            times_ms.push(begun.elapsed().as_secs_f64() * 1e3);
            controller.report(controller.level(), times_ms[times_ms.len() - 1]);
        }
        measuring.begin(gpu, (&executor, &plan), io.measured, stand).map_err(device)?;
        let texture = executor.texture(&plan, io.output).ok_or_else(|| device("the frame has no picture"))?;
        let picture = read_texture(gpu, texture).map_err(device)?.rgba8();
        outputs.write(&path, |file| encode_png(file, args.size_px, &picture)).map_err(input)?;
        shown.step("rendering pictures", index as usize + 1, sequence.frames as usize, "");
        interrupt::check().map_err(device)?;
    }
    shown.clear();
    if let Some([target_ms, _]) = args.effects.dynamic {
        program::line(held(target_ms, &drawn_at, times_ms));
    }
    program::line(format_args!("{} pictures with {plans} different frame settings", sequence.frames));
    Ok(())
}

/// Prepares the scene for views on the recording threads.
fn placed_on(executor: &Executor, scene: &Scene) -> PreparedScene {
    let mut placed = PreparedScene::new(scene);
    placed.workers = executor.workers().cloned();
    placed
}

/// Describes the range of scales, and the frame time against its target.
fn held(target_ms: f64, percents: &[f64], mut times_ms: Vec<f64>) -> String {
    times_ms.sort_by(f64::total_cmp);
    let median = times_ms.get(times_ms.len() / 2).copied().unwrap_or(0.0);
    let (min, max) = percents.iter().fold((100.0_f64, 0.0_f64), |(min, max), p| (min.min(*p), max.max(*p)));
    let last = percents.last().copied().unwrap_or(100.0);
    format!(
        "rendered at {min:.0} to {max:.0} % of the sides, the last at {last:.0} %; median frame time {median:.1} ms, \
         target {target_ms:.1} ms"
    )
}

/// Rotates a view about the vertical axis through `center`.
fn around(seen: &ViewSettings, center: DVec3, angle_rad: f64) -> ViewSettings {
    let turn = DQuat::from_rotation_y(angle_rad);
    let mut seen = seen.clone();
    seen.camera.eye = center + turn * (seen.camera.eye - center);
    seen.camera.world_from_view = turn * seen.camera.world_from_view;
    seen
}
