//! The standard frame over time: equal pictures from every plan, through resizes and toggles, and no new objects once
//! warm.

use crate::stage::{Shot, declared, gpu, lighting, view_of};
use framegraph::{Alias, Options, Order, Placement, Plan, Scratch};
use framegraph_passes::gpu_scene::shadow_views::ShadowSettings;
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::{Preset, Settings, ViewId, World};
use framegraph_scene::environment::Sky;
use framegraph_scene::{Scene, progress};
use framegraph_wgpu::{Executor, Gpu, Imports, ObjectCounts, Workers, read_texture};
use std::error::Error;

/// A scene with everything that an executor caches between frames.
struct Film {
    gpu: Gpu,
    scene: Scene,
    world: World,
    executor: Executor,
    plan: Plan,
    scratch: Scratch,
}

impl Film {
    fn new(gpu: &Gpu, name: &str) -> Result<Self, Box<dyn Error>> {
        let scene = Scene::open(name, &mut progress::silent)?;
        let environment = Sky::default().environment(64)?;
        let settings = Settings::default();
        let lighting = lighting(gpu, &environment, &settings.shading)?;
        let view = view_of(&scene, &lighting.image, &Background::Environment, &Shot::small(settings));
        let world = World::new(gpu, &scene, lighting, [view], &mut progress::silent)?;
        let executor = Executor::new(gpu);
        let (plan, scratch) = (Plan::new(), Scratch::new());
        Ok(Self { gpu: gpu.clone(), scene, world, executor, plan, scratch })
    }

    /// Discards everything cached from earlier frames.
    fn forget(&mut self) {
        self.executor = Executor::new(&self.gpu);
    }

    /// Declares and draws one frame; returns its picture.
    fn shoot(&mut self, shot: &Shot) -> Result<Vec<u8>, Box<dyn Error>> {
        let view = view_of(&self.scene, &self.world.lighting.image, &Background::Environment, shot);
        self.world.set_view(&self.gpu, ViewId::MAIN, view)?;
        let (frame, io) = declared(&shot.settings.for_scene(&self.scene, shot.size_px));
        let options = Options { frame: shot.size_px, ..shot.options };
        self.executor.compile(frame.graph(), &options, &mut self.scratch, &mut self.plan)?;
        self.executor.execute(&self.plan, &frame, &self.world, &Imports::new())?;
        assert_eq!(self.executor.executed(), self.plan.counts(), "executed against planned");
        let texture = self.executor.texture(&self.plan, io.output).ok_or("the frame left no picture")?;
        Ok(read_texture(&self.gpu, texture)?.rgba8())
    }
}

/// Returns ten frames that all look different, with a resize to an odd size in the middle.
fn ten(settings: Settings) -> Vec<Shot> {
    let shot = |index: u8| Shot {
        size_px: if index < 5 { [64, 36] } else { [51, 43] },
        ev100: 13.5 + f32::from(index) / 8.0,
        ..Shot::small(settings)
    };
    (0..10).map(shot).collect()
}

/// Returns true if most of the picture is lit, and it has many colors.
fn is_picture(rgba8: &[u8]) -> bool {
    let lit = rgba8.chunks_exact(4).filter(|t| t[0] > 8).count() * 4 > rgba8.len() / 2;
    let mut colors: Vec<_> = rgba8.chunks_exact(4).collect();
    colors.sort_unstable();
    colors.dedup();
    lit && colors.len() > 100
}

#[test]
fn ten_frames_with_a_resize_are_the_same_however_they_are_planned() -> Result<(), Box<dyn Error>> {
    let Some(gpu) = gpu("ten_frames_with_a_resize_are_the_same_however_they_are_planned") else { return Ok(()) };
    let mut film = Film::new(&gpu, "spheres")?;
    let base = Options::default();
    // Inlining grades each sample. At one sample, and with the rounding of a store, it is bit-exact, as `inline` tests.
    let base = Options { inline: false, ..base };
    let ways = [
        base,
        Options { order: Order::Optimized, ..base },
        Options { merge: false, ..base },
        Options { alias: Alias::Off, ..base },
        Options { memoryless: false, ..base },
        Options { order: Order::Optimized, merge: false, alias: Alias::Off, ..base },
        Options { alias: Alias::Heap, ..base },
        Options { alias: Alias::Heap, merge: false, memoryless: false, ..base },
        base.immediate(),
    ];
    let shots = ten(Settings { samples: 4, shadows: Some(ShadowSettings::texels(256)), ..Settings::default() });
    let mut expected: Vec<Vec<u8>> = Vec::new();
    for options in test_report::share(ways) {
        film.forget();
        for (index, shot) in shots.iter().enumerate() {
            let found = film.shoot(&Shot { options, ..*shot })?;
            match expected.get(index) {
                Some(picture) => assert!(found == *picture, "frame {index} of {options:?}"),
                None => {
                    assert!(is_picture(&found), "frame {index}");
                    // Each frame has its own exposure, so a stale frame is detected.
                    assert!(expected.last() != Some(&found), "frame {index} is the one before it");
                    expected.push(found);
                }
            }
        }
    }
    Ok(())
}

/// Places frames with every effect and its histories in one block of memory, and records them on three threads. They
/// equal frames with separate textures recorded on one thread. The first frames of every other variant are equal too.
#[test]
fn frames_in_one_block_of_memory_are_the_frames_apart() -> Result<(), Box<dyn Error>> {
    const NAME: &str = "frames_in_one_block_of_memory_are_the_frames_apart";
    let Some(gpu) = gpu(NAME) else { return Ok(()) };
    let settings = Settings { shadows: Some(ShadowSettings::texels(256)), ..Preset::Ultra.frame().settings };
    let shots: Vec<_> = test_report::share(0..24_u8)
        .into_iter()
        .map(|index| Shot { ev100: 13.5 + f32::from(index) / 16.0, ..Shot::small(settings) })
        .collect();
    let mut film = Film::new(&gpu, "spheres")?;
    let mut apart = Vec::new();
    let few = shots.len().min(3);
    let ways = [(Alias::Off, 1, shots.len()), (Alias::Heap, 3, shots.len())];
    let others = [(Alias::Heap, 1, few), (Alias::Pool, 3, few), (Alias::Off, 3, few)];
    for (alias, threads, count) in ways.into_iter().chain(others) {
        film.forget();
        film.executor.force_record_on(Workers::with_threads(threads)?);
        for (index, shot) in shots[..count].iter().enumerate() {
            let found = film.shoot(&Shot { options: Options { alias, ..shot.options }, ..*shot })?;
            match apart.get(index) {
                Some(picture) => assert!(found == *picture, "frame {index}, {alias:?} on {threads} threads"),
                None => apart.push(found),
            }
        }
        if let Some(why) = film.executor.not_placed() {
            test_report::skip(NAME, &why.to_string());
            return Ok(());
        }
        let rows = film.plan.resources().iter();
        let placed = rows.filter(|r| matches!(r.placement, Placement::Heap { .. })).count();
        assert_eq!(
            (placed > 5, film.executor.recording_threads()),
            (alias == Alias::Heap, threads),
            "{placed} are placed"
        );
        // Sharing needs less memory than separate textures.
        let given = film.executor.allocated();
        assert_eq!(given.placed > 0 && given.placed < given.unshared, alias == Alias::Heap, "{given:?}");
    }
    assert!(is_picture(&apart[0]));
    Ok(())
}

#[test]
fn toggles_and_odd_sizes_show_neither_black_nor_stale_frames() -> Result<(), Box<dyn Error>> {
    let Some(gpu) = gpu("toggles_and_odd_sizes_show_neither_black_nor_stale_frames") else { return Ok(()) };
    let mut film = Film::new(&gpu, "spheres")?;
    // The frames that each is compared with are recorded on one thread.
    film.executor.force_record_on(Workers::with_threads(2)?);
    let base = Settings { samples: 1, shadows: Some(ShadowSettings::texels(256)), ..Settings::default() };
    let sequence = [
        (base, [64, 36]),
        (Settings { fxaa: false, ..base }, [64, 36]),
        (Settings { samples: 4, ..base }, [63, 37]),
        (Settings { shadows: None, ..base }, [63, 37]),
        (Settings { samples: 4, fxaa: false, shadows: None, ..base }, [101, 17]),
        (base, [64, 36]),
        (Settings { samples: 4, ..base }, [41, 59]),
        (base, [41, 59]),
    ];
    let shot = |index: usize| {
        let (settings, size_px) = sequence[index];
        Shot { size_px, ev100: 13.5 + index as f32 / 8.0, ..Shot::small(settings) }
    };
    let kept = (0..sequence.len()).map(|index| film.shoot(&shot(index))).collect::<Result<Vec<_>, _>>()?;
    for (index, found) in kept.iter().enumerate() {
        film.forget();
        assert!(is_picture(found), "frame {index}");
        assert!(film.shoot(&shot(index))? == *found, "frame {index} differs from the first frame of a new executor");
    }
    Ok(())
}

#[test]
fn a_warm_frame_makes_no_object() -> Result<(), Box<dyn Error>> {
    let Some(gpu) = gpu("a_warm_frame_makes_no_object") else { return Ok(()) };
    // Up to forty frames for basic scenes; a few for those with more passes or shaders.
    let most = test_report::share(0..40_u8).len() as u8;
    for (scene, frames) in [("materials", most), ("glass", 4), ("lobes", 4)] {
        warm_frames_make_no_object(&gpu, scene, frames).map_err(|error| format!("{scene}: {error}"))?;
    }
    Ok(())
}

fn warm_frames_make_no_object(gpu: &Gpu, scene: &str, frames: u8) -> Result<(), Box<dyn Error>> {
    let mut film = Film::new(gpu, scene)?;
    for settings in [Settings::default(), Settings { samples: 4, ..Settings::default() }] {
        if scene == "glass" && settings.samples > 1 && gpu.info().backend == wgpu::Backend::Gl {
            continue; // It is an error there.
        }
        let settings = Settings { shadows: Some(ShadowSettings::texels(256)), ..settings };
        let shot =
            |frame: u8| Shot { size_px: [64, 36], ev100: 13.0 + f32::from(frame) / 16.0, ..Shot::small(settings) };
        for frame in 0..2 {
            film.shoot(&shot(frame))?;
        }
        let (before, counts) = (film.executor.objects(), film.executor.caches().map(|(_, counts)| counts));
        let pool = film.executor.texture_pool();
        for frame in 2..2 + frames {
            film.shoot(&shot(frame))?;
        }
        let made = film.executor.objects().since(&before);
        assert_eq!(made, ObjectCounts::default(), "{scene}: made in {frames} frames");
        // Every cache lookup hits: views, bind groups and pipelines of each pass, textures of the plan.
        for ((name, after), before) in film.executor.caches().into_iter().zip(counts) {
            let hits = after.hits - before.hits;
            let each = u64::from(film.plan.counts().passes);
            assert!(after.created == before.created && hits >= each * u64::from(frames), "{scene} {name}: {hits} hits");
        }
        let found = film.executor.texture_pool().hits - pool.hits;
        assert!(found >= 3 * u64::from(frames), "{found} textures were found");
    }
    Ok(())
}
