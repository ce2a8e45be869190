//! Temporal anti-aliasing: loads and stores of frames with it, convergence, and rejection of history.

use crate::stage::{self, Set, Shot, declared, gpu};
use framegraph::{Caps, Counts, Options, Plan, Scratch, compile};
use framegraph_passes::SettingsTable;
use framegraph_passes::effects::taa::Clipping;
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::{Settings, Shading, TaaSettings, ViewId};
use framegraph_scene::Scene;
use framegraph_wgpu::{Executor, Gpu, Imports, read_texture};
use std::error::Error;
use tests::executors;
use tests::measure::temporal::{Painted, Stage, ghost, still, table};

type TestResult = Result<(), Box<dyn Error>>;

const PAINTED: Painted = Painted { disc: [24.3, 22.8, 14.0, 0.9], ground: [0.05, 0.4] };

fn taa(text: &str) -> Result<TaaSettings, Box<dyn Error>> {
    Ok(TaaSettings::from_text(text)?.ok_or("it is on")?)
}

/// step                  attachment       load       store
/// prepass + color       hdr              clear      STORE   (taa reads it)
///                       depth            clear      STORE   (taa reads it)
/// taa                   taa              don't care STORE   (post reads it, and the next frame)
/// post                  ldr              don't care STORE
/// fxaa                  output           don't care STORE
///
/// With four samples, depth is stored per sample and resolved by a step that stores once: 6 stores, as in Filament on a
/// device without depth resolves. There is no load in either.
#[test]
fn counts_are_filaments() {
    let counts = |settings: Settings| stage::plan(&settings, &Caps::wgpu(), &Options::for_frame(1280, 720)).counts();
    for (samples, resolves) in [(1, 5), (4, 6)] {
        let frame = Settings { samples, shadows: None, taa: Some(TaaSettings::DEFAULT), ..Settings::DEFAULT };
        let multisampled = u32::from(samples > 1);
        let expected = Counts {
            unresolves: 0,
            resolves,
            clears: 2,
            discards: multisampled,
            multisample_resolves: multisampled,
            memoryless: multisampled,
            inlined: 0,
            steps: 4 + multisampled,
            render_passes: 4 + multisampled,
            passes: 5 + multisampled,
            culled: 0,
        };
        assert_eq!(counts(frame), expected, "{samples} samples");
        let sharp = Settings { taa: Some(TaaSettings { sharpness: 0.5, ..TaaSettings::DEFAULT }), ..frame };
        assert_eq!(counts(sharp).resolves, resolves + 1, "a pass that sharpens stores once");
    }
}

/// The rows of `docs/design/taa.md`, with a tolerance for other devices of half a decibel and 0.01.
#[test]
fn the_document_has_what_is_printed() -> TestResult {
    let Some(gpu) = gpu("the_document_has_what_is_printed") else { return Ok(()) };
    let cells = |row: &str| -> Vec<String> {
        row.trim_matches('|').split('|').map(|cell| cell.trim().trim_matches('`').to_owned()).collect()
    };
    let documented = include_str!("../../../docs/design/taa.md").lines().filter(|line| line.starts_with("| "));
    let documented: Vec<Vec<String>> = documented.filter(|line| !line.contains("---")).map(cells).collect();
    let found: Vec<Vec<String>> =
        table(&gpu)?.iter().filter(|row| !row.contains("---")).map(|row| cells(row)).collect();
    assert_eq!(
        documented.len(),
        found.len(),
        "renew docs/design/taa.md: cargo run --release -p tests --bin measure -- taa"
    );
    for (old, new) in documented.iter().zip(&found) {
        let near = |(old, new): (&String, &String)| match (old.parse::<f64>(), new.parse::<f64>()) {
            (Ok(old), Ok(new)) => (old - new).abs() <= if old > 5.0 { 0.5 } else { 0.01 },
            _ => old == new,
        };
        assert!(old.iter().zip(new).all(near), "docs/design/taa.md has {old:?}, and this is {new:?}");
    }
    Ok(())
}

/// Still light: the mean of 32 frames is within 40 dB of 256 samples per pixel, a single frame is not. Filament's
/// accumulation, which never converges, has more temporal noise.
#[test]
fn still_light_comes_near_the_truth() -> TestResult {
    let Some(gpu) = gpu("still_light_comes_near_the_truth") else { return Ok(()) };
    let [near, _] = still(&gpu, &taa("on:converge=on,filter-input=off,jitter=halton32")?, 32)?;
    let [alone, _] = still(&gpu, &taa("on:feedback=1,filter-input=off")?, 32)?;
    assert!(near > 40.0 && alone < 30.0, "{near} dB, and alone {alone} dB");
    Ok(())
}

/// Returns the radiance of a built-in scene after several frames.
fn shown(gpu: &Gpu, taa: Option<TaaSettings>, size_px: [u32; 2], frames: u32) -> Result<Vec<[f32; 4]>, Box<dyn Error>> {
    // Specular anti-aliasing is off, since it depends on the size of a pixel, which differs between the pictures.
    let shading = Shading { specular_aa: None, ..Settings::DEFAULT.shading };
    let settings = Settings { taa, shading, fxaa: false, ..Settings::DEFAULT };
    let options = Options::for_frame(size_px[0], size_px[1]);
    let shot = Shot { size_px, options, ..Shot::small(settings) };
    let mut set = Set::new(gpu, "columns", &shot, &Background::Environment)?;
    let (mut frame, io) = declared(&settings);
    frame.graph_mut().readback(io.hdr)?;
    let mut plan = Plan::new();
    compile(frame.graph(), &gpu.caps(), &shot.options, &mut Scratch::new(), &mut plan)?;
    let mut executor = executors::lend(gpu);
    for index in 0..frames {
        let jitter_px = taa.map_or_else(Default::default, |taa| taa.jitter_px(index));
        set.world_mut().views.again(ViewId::MAIN, jitter_px)?;
        executor.execute(&plan, &frame, set.world(), &Imports::new())?;
        assert_eq!(executor.executed(), plan.counts(), "executed against planned");
    }
    let texture = executor.texture(&plan, io.hdr).ok_or("no picture")?;
    Ok(read_texture(gpu, texture)?.rgba())
}

/// A scene rendered by the whole frame, compared with the linear average of sixteen times the width and height.
#[test]
fn a_still_scene_comes_near_supersampling() -> TestResult {
    let Some(gpu) = gpu("a_still_scene_comes_near_supersampling") else { return Ok(()) };
    let ([width, height], n) = ([64_u32, 36_u32], 16);
    let fine = shown(&gpu, None, [width * n, height * n], 1)?;
    let mut truth = vec![[0.0_f64; 3]; (width * height) as usize];
    for (index, texel) in fine.iter().enumerate() {
        let (x, y) = (index as u32 % (width * n), index as u32 / (width * n));
        let block = &mut truth[(y / n * width + x / n) as usize];
        (0..3).for_each(|c| block[c] += f64::from(texel[c]) / f64::from(n * n));
    }
    let psnr = |taa| -> Result<f64, Box<dyn Error>> {
        let sum = shown(&gpu, taa, [width, height], 32)?;
        let encoded = |light: f64| light.clamp(0.0, 1.0).powf(1.0 / 2.2);
        let off = |(a, b): (&[f32; 4], &[f64; 3])| {
            (0..3).map(|c| (encoded(a[c].into()) - encoded(b[c])).powi(2)).sum::<f64>()
        };
        let squares: f64 = sum.iter().zip(&truth).map(off).sum();
        Ok(-10.0 * (squares / (3 * truth.len()) as f64).log10())
    };
    let [near, alone] = [psnr(Some(taa("on:converge=on,filter-input=off,jitter=halton32")?))?, psnr(None)?];
    assert!(near > 40.0 && alone < 30.0, "{near} dB, and alone {alone} dB");
    Ok(())
}

/// A still scene whose window is enlarged after 24 frames. The next frame reuses the history, so it is closer to the
/// converged picture at the new size than a first frame. The gain is 5.5 dB, less than at a constant size, since the
/// history has fewer pixels. Without the history, it would be 0.
#[test]
fn a_resize_keeps_the_history() -> TestResult {
    let Some(gpu) = gpu("a_resize_keeps_the_history") else { return Ok(()) };
    let taa = taa("on:filter-input=off,jitter=halton16")?;
    let shading = Shading { specular_aa: None, ..Settings::DEFAULT.shading };
    let settings = Settings { taa: Some(taa), shading, fxaa: false, ..Settings::DEFAULT };
    let of = |size_px: [u32; 2]| Shot {
        size_px,
        options: Options::for_frame(size_px[0], size_px[1]),
        ..Shot::small(settings)
    };
    let (small, large) = (of([64, 36]), of([80, 45]));
    let scene = Scene::open("columns", &mut framegraph_scene::progress::silent)?;
    let mut set = Set::of(&gpu, scene.clone(), &small, &Background::Environment)?;
    let (mut frame, io) = declared(&settings);
    frame.graph_mut().readback(io.hdr)?;
    // Returns the last of several frames at each of these sizes, drawn in sequence by one executor.
    let mut shown = |sizes: &[(Shot, u32)]| -> Result<Vec<[f32; 4]>, Box<dyn Error>> {
        let (mut executor, mut plan, mut index) = (Executor::new(&gpu), Plan::new(), 0);
        for (shot, frames) in sizes {
            let world = set.world_mut();
            let mut view = stage::view_of(&scene, &world.lighting.image, &Background::Environment, shot);
            if index > 0 {
                view = view.after(&world.views.get(ViewId::MAIN)?.view.clone());
            }
            view.jitter(taa.jitter_px(index));
            world.set_view(&gpu, ViewId::MAIN, view)?;
            compile(frame.graph(), &gpu.caps(), &shot.options, &mut Scratch::new(), &mut plan)?;
            for n in 0..*frames {
                if n > 0 {
                    world.views.again(ViewId::MAIN, taa.jitter_px(index))?;
                }
                executor.execute(&plan, &frame, world, &Imports::new())?;
                index += 1;
            }
        }
        Ok(read_texture(&gpu, executor.texture(&plan, io.hdr).ok_or("no picture")?)?.rgba())
    };
    let converged = shown(&[(large, 32)])?;
    let resized = shown(&[(small, 24), (large, 1)])?;
    let first = shown(&[(large, 1)])?;
    let off = |picture: &[[f32; 4]]| -> f64 {
        let encoded = |light: f32| f64::from(light.clamp(0.0, 1.0)).powf(1.0 / 2.2);
        let texels = picture.iter().zip(&converged);
        let squares: f64 = texels.flat_map(|(a, b)| (0..3).map(|c| (encoded(a[c]) - encoded(b[c])).powi(2))).sum();
        -10.0 * (squares / (3 * picture.len()) as f64).log10()
    };
    let (resized, first) = (off(&resized), off(&first));
    assert!(resized > first + 4.0, "{resized} dB, and a first frame {first} dB");
    Ok(())
}

/// The first frame, one after a camera cut, and frames with full weight equal the input, bit for bit.
#[test]
fn without_a_sum_a_frame_is_itself() -> TestResult {
    let Some(gpu) = gpu("without_a_sum_a_frame_is_itself") else { return Ok(()) };
    let (mut stage, size) = (Stage::new(&gpu)?, [33, 17]);
    let plain = taa("on:filter-input=off")?;
    let [painted, sum] = stage.frame(&plain, PAINTED, size)?;
    assert_eq!(painted, sum, "the first frame");
    let [painted, sum] = stage.frame(&plain, PAINTED, size)?;
    assert_ne!(painted, sum, "the second adds");
    let [painted, sum] = stage.frame(&taa("on:filter-input=off,feedback=1")?, PAINTED, size)?;
    assert_eq!(painted, sum, "it counts whole");
    stage.cut();
    let [painted, sum] = stage.frame(&plain, PAINTED, size)?;
    assert_eq!(painted, sum, "after a cut");
    Ok(())
}

/// Constant light with a halved exposure: the history is rescaled, and nothing of the previous exposure remains.
#[test]
fn sums_follow_the_exposure() -> TestResult {
    let Some(gpu) = gpu("sums_follow_the_exposure") else { return Ok(()) };
    let (mut stage, size, settings) = (Stage::new(&gpu)?, [24, 24], taa("on:clip=none,filter-input=off")?);
    let even = |light| Painted { disc: [0.0; 4], ground: [light, 0.0] };
    stage.frame(&settings, even(0.4), size)?;
    stage.exposure *= 0.5;
    let [painted, sum] = stage.frame(&settings, even(0.2), size)?;
    // One step of half floats; without rescaling, it would be 0.38.
    let off = |(a, b): (&[f32; 4], &[f32; 4])| (a[0] - b[0]).abs();
    let most = painted.iter().zip(&sum).map(off).fold(0.0, f32::max);
    assert!(most < 2e-4, "{most}");
    Ok(())
}

/// Invalid history is discarded within one frame, and so is the history of another size, down to one pixel (hard cases
/// 51 and 52). The result stays between the minimum and maximum light of the picture.
#[test]
fn spoilt_sums_are_gone_after_a_frame() -> TestResult {
    let Some(gpu) = gpu("spoilt_sums_are_gone_after_a_frame") else { return Ok(()) };
    for text in ["on", "on:filter-history=off,clip=clamp", "on:box=both,ycocg=on,steady=on", "on:clip=none"] {
        let settings = taa(text)?;
        // Without clipping, the spline's overshoot of an eighth of an edge remains.
        let over = if settings.clipping == Clipping::None { 0.125 } else { 0.001 };
        let sound = |sum: &[[f32; 4]]| sum.iter().all(|texel| texel[0] > 0.05 - over && texel[0] < 0.9 + over);
        for number in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let (mut stage, size) = (Stage::new(&gpu)?, [24, 24]);
            stage.frame(&settings, PAINTED, size)?;
            stage.spoil(number, size)?;
            let [_, sum] = stage.frame(&settings, PAINTED, size)?;
            assert!(sound(&sum), "{text} after {number}");
        }
        let mut stage = Stage::new(&gpu)?;
        for size in [[24, 24], [40, 12], [1, 1], [1, 31], [3, 2], [64, 64]] {
            let [_, sum] = stage.frame(&settings, PAINTED, size)?;
            assert!(sound(&sum), "{text} at {size:?}");
        }
    }
    // Invalid pixels of the frame itself count as black, and are gone in the next frame.
    let mut stage = Stage::new(&gpu)?;
    let broken = Painted { ground: [f32::NAN, 0.0], ..PAINTED };
    let [_, sum] = stage.frame(&taa("on")?, broken, [24, 24])?;
    assert!(sum.iter().all(|texel| texel[..3].iter().all(|c| c.is_finite())));
    Ok(())
}

/// A moving ball leaves no ghost on a uniform background, and less than 0.01 on average on stripes. Negative control:
/// without clipping, the ghost remains.
#[test]
fn moving_light_leaves_no_ghost() -> TestResult {
    let Some(gpu) = gpu("moving_light_leaves_no_ghost") else { return Ok(()) };
    let (even, stripes) = ([0.05, 0.0], [0.05, 0.4]);
    for text in ["on", "on:clip=clamp", "on:box=variance", "on:box=both,ycocg=on"] {
        // Half an 8-bit step at this light.
        assert!(ghost(&gpu, &taa(text)?, even, 3.0)?[0] < 1e-3, "{text}");
        assert!(ghost(&gpu, &taa(text)?, stripes, 3.0)?[1] < 0.01, "{text}");
    }
    assert!(ghost(&gpu, &taa("on:clip=none")?, even, 3.0)?[0] > 0.1, "what is not clipped stays");
    Ok(())
}
