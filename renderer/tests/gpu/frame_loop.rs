//! The frame loop: what it keeps, which frames it skips, and how it continues after errors.

use crate::bench::{Bench, GREEN, RED, TestResult, fill_full, on_every_device};
use framegraph::{
    Alias, Counts, DeclareError, Entry, Exit, Extent, Format, Intent, Pass, PassBuilder, Texture, TextureDesc, Warning,
};
use framegraph_wgpu::{
    Cx, Frame, FrameError, FrameLoop, FramesInFlight, Imports, Record, RecordError, read_texture, texture_2d,
};
use std::num::NonZeroU32;

/// Declares a chain of two passes into a texture of the caller.
fn declare(frame: &mut Frame<[f32; 4]>, imports: &mut Imports, image: &wgpu::Texture) -> Result<(), DeclareError> {
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
    let screen = frame.graph_mut().import_texture("screen", desc, Entry::Undefined, Exit::Keep);
    imports.texture(screen, image);
    let screen = frame.add_fn("red", |p| p.color(screen, Intent::Overwrite), |_, _, cx| fill_full(cx, RED))?;
    frame.add_fn("world", |p| p.color(screen, Intent::Modify), |_, world, cx| fill_full(cx, *world))?;
    Ok(())
}

#[test]
fn a_loop_continues_after_skipped_and_failed_frames() -> TestResult {
    on_every_device("a_loop_continues_after_skipped_and_failed_frames", |gpu, drawn| {
        let image = |side| {
            gpu.device.create_texture(&texture_2d(
                "image",
                [side, side],
                wgpu::TextureFormat::Rgba8Unorm,
                wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            ))
        };
        let (small, large) = (image(4), image(8));
        let mut frames = FrameLoop::<[f32; 4]>::new(gpu);
        let shows = |frames: &mut FrameLoop<[f32; 4]>, image: &wgpu::Texture, color: [f32; 4]| -> TestResult {
            let size = [image.width(), image.height()];
            let ran = frames.run(size, &color, |frame, imports| declare(frame, imports, image))?;
            assert!(ran.is_some());
            assert_eq!(frames.executor().executed(), frames.plan().counts());
            assert!(!drawn || read_texture(gpu, image)?.rgba().iter().all(|texel| *texel == color));
            Ok(())
        };
        frames.declare([4, 4], |frame, imports| declare(frame, imports, &small))?;
        let mut steps = 0;
        frames.warm_up(&RED, &mut |at| steps += at.total)?;
        let made = frames.executor().objects();
        shows(&mut frames, &small, GREEN)?;
        assert_eq!((steps, frames.executor().objects()), (1, made), "the first frame makes nothing");

        let called = std::cell::Cell::new(false);
        for size in [[0, 4], [4, 0], [0, 0]] {
            let ran = frames.run(size, &GREEN, |_, _| {
                called.set(true);
                Ok::<_, DeclareError>(())
            })?;
            assert!(ran.is_none() && !called.get(), "{size:?}");
        }
        shows(&mut frames, &large, GREEN)?;

        let message = frames.run([4, 4], &GREEN, |_, _| Err::<(), _>("no scene"));
        assert!(matches!(message, Err(FrameError::Declare("no scene"))));
        let message = frames.run([4, 4], &GREEN, |frame, imports| declare(frame, imports, &large)).map(|_| ());
        assert!(format!("{message:?}").contains("the import `screen` was declared with 4×4 texels"), "{message:?}");
        assert!(matches!(message, Err(FrameError::Execute(_))), "{message:?}");
        let message = frames.run([4, 4], &GREEN, |frame, _| {
            let texture = frame.graph_mut().texture("none", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
            frame.graph_mut().export(texture)?;
            Ok::<_, DeclareError>(())
        });
        assert!(matches!(message, Err(FrameError::Compile(_))));
        shows(&mut frames, &small, RED)?;
        shows(&mut frames, &large, GREEN)
    })
}

/// A frame whose passes have no effect is an error; a frame without passes is not.
#[test]
fn a_frame_without_exports_is_an_error() -> TestResult {
    let gpu = framegraph_wgpu::Gpu::noop()?;
    let mut frames = FrameLoop::<()>::new(&gpu);
    let mut run = |exported: bool| {
        frames.run([8, 8], &(), |frame, _| {
            let sky = frame.graph_mut().texture("sky", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
            let sky = frame.add_fn("sky", |p| p.color(sky, Intent::Overwrite), |_, (), cx| fill_full(cx, RED))?;
            if exported { frame.graph_mut().export(sky) } else { Ok(()) }
        })
    };
    assert!(run(true)?.is_some());
    let message = run(false);
    assert!(matches!(message, Err(FrameError::Idle(Warning::NothingRuns))), "{message:?}");
    let message = format!("{message:?}");
    assert!(message.contains("the frame does nothing: no pass runs") && message.contains("export"), "{message}");
    assert!(run(true)?.is_some());
    let ran = frames.run([8, 8], &(), |_, _| Ok::<_, DeclareError>(()))?;
    assert!(ran.is_some() && frames.executor().executed() == Counts::default());
    Ok(())
}

/// A loop with heap aliasing reports why nothing is placed, with each frame for which it is requested.
#[test]
fn a_loop_reports_why_nothing_is_placed() -> TestResult {
    let gpu = framegraph_wgpu::Gpu::noop()?;
    let mut frames = FrameLoop::<()>::new(&gpu);
    for alias in [Alias::Pool, Alias::Heap, Alias::Heap, Alias::Off] {
        frames.options_mut().alias = alias;
        let ran = frames.run([8, 8], &(), |frame, _| {
            let sky = frame.graph_mut().texture("sky", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
            let sky = frame.add_fn("sky", |p| p.color(sky, Intent::Overwrite), |_, (), cx| fill_full(cx, RED))?;
            frame.graph_mut().export(sky)
        })?;
        let message = ran.ok_or("no frame")?.not_placed.map(|why| why.to_string());
        assert_eq!(message.is_some_and(|why| why.contains("Vulkan")), alias == Alias::Heap, "{alias:?}");
    }
    Ok(())
}

/// Layers of an image, whose number is known at declaration.
struct Layers(usize);

impl Pass for Layers {
    // Implements `Clone` but not `Copy`.
    type Io = Vec<Texture>;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Self::Io, DeclareError> {
        let layer = |n| format!("layer {n}");
        (0..self.0)
            .map(|n| {
                let layer = pass.texture(&layer(n), TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
                pass.color(layer, Intent::Overwrite)
            })
            .collect()
    }
}

impl<W: ?Sized> Record<W> for Layers {
    fn record(&self, layers: &Vec<Texture>, _: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let views = layers.iter().map(|layer| cx.view_of(*layer)).collect::<Result<Vec<_>, _>>()?;
        if views.len() != self.0 {
            return Err(RecordError::custom("its handles are others"));
        }
        cx.render_pass().map(|_| ())
    }
}

#[test]
fn handles_of_a_pass_need_not_be_copies() -> TestResult {
    let gpu = framegraph_wgpu::Gpu::noop()?;
    let mut frames = FrameLoop::<()>::new(&gpu);
    for layers in [1, 3] {
        let ran = frames.run([8, 8], &(), |frame, _| {
            let drawn = frame.add("layers", Layers(layers))?;
            drawn.iter().try_for_each(|layer| frame.graph_mut().export(*layer))?;
            Ok::<_, DeclareError>(drawn)
        })?;
        assert_eq!(ran.ok_or("skipped")?.io.len(), layers);
        assert_eq!(frames.executor().executed(), frames.plan().counts());
    }
    Ok(())
}

/// The queue never exceeds its maximum, and each finished frame is counted once.
#[test]
fn a_loop_queues_at_most_the_maximum_of_frames() -> TestResult {
    on_every_device("a_loop_queues_at_most_the_maximum_of_frames", |gpu, _| {
        let mut frames = FrameLoop::<()>::new(gpu);
        assert_eq!(frames.frames_in_flight().max(), FramesInFlight::DEFAULT);
        assert!(frames.frames_in_flight().latency().is_none());
        let run = |frames: &mut FrameLoop<()>, size| {
            frames.run(size, &(), |frame, _| {
                let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
                let sky = frame.graph_mut().texture("sky", desc);
                let sky = frame.add_fn("sky", |p| p.color(sky, Intent::Overwrite), |_, (), cx| fill_full(cx, RED))?;
                frame.graph_mut().export(sky)?;
                Ok::<_, DeclareError>(())
            })
        };
        let mut ran = 0;
        for most in [2, 1, 3] {
            frames.frames_in_flight_mut().set_max(NonZeroU32::new(most).ok_or("none")?);
            for _ in 0..6 {
                run(&mut frames, [512, 512])?;
                ran += 1;
                assert!(frames.frames_in_flight().queued() <= most as usize, "{most}");
                assert!(run(&mut frames, [0, 0])?.is_none(), "a skipped frame is not queued");
            }
        }
        gpu.wait()?;
        frames.frames_in_flight_mut().begin()?;
        let flight = frames.frames_in_flight();
        assert_eq!((flight.queued(), flight.latency().map(|l| l.count)), (0, Some(ran)));
        assert!(flight.waits() <= ran as u64, "one for each frame at most");
        Ok(())
    })
}

/// World that borrows, and that threads cannot share.
struct Borrowing<'a> {
    colors: &'a [[f32; 4]],
    used: std::cell::Cell<usize>,
}

/// A world may borrow data that changes between frames. Neither executor nor frame loop need `'static` or `Sync`.
#[test]
fn the_world_may_borrow() -> TestResult {
    on_every_device("the_world_may_borrow", |gpu, drawn| {
        let (mut frames, mut bench) = (FrameLoop::<()>::new(gpu), Bench::new(gpu, 4, 4));
        // Workers are not used for this world.
        bench.executor.record_on(Some(framegraph_wgpu::Workers::with_threads(2)?));
        let (mut colors, mut kept) = (Vec::new(), Frame::new());
        for color in [RED, GREEN, RED] {
            colors.push(color);
            let world = Borrowing { colors: &colors, used: std::cell::Cell::new(0) };
            let declare = |frame: &mut Frame<Borrowing<'_>>| {
                let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
                let sum = frame.graph_mut().history("sum", desc, 1);
                let age = frame.graph_mut().previous(sum, 1)?;
                let accesses = |p: &mut PassBuilder<'_>| Ok((p.sampled(age)?, p.color(sum, Intent::Overwrite)?));
                let record = move |_: &(_, _), world: &Borrowing<'_>, cx: &mut Cx<'_>| {
                    world.used.set(world.colors.len());
                    assert_eq!(cx.is_valid(age)?, world.colors.len() > 1, "the history belongs to the kept frame");
                    fill_full(cx, *world.colors.last().unwrap_or(&[0.0; 4]))
                };
                let (_, drawn) = frame.add_fn("fill", accesses, record)?;
                frame.graph_mut().readback(drawn)?;
                Ok::<_, DeclareError>(drawn)
            };
            let output = frames.run_for([4, 4], &world, |frame, _| declare(frame))?.ok_or("no texels")?;
            assert_eq!(world.used.replace(0), colors.len());

            let mut frame: Frame<Borrowing<'_>> = kept.for_world();
            let picture = declare(&mut frame)?;
            let options = framegraph::Options::for_frame(4, 4);
            bench.executor.compile(frame.graph(), &options, &mut framegraph::Scratch::new(), &mut bench.plan)?;
            bench.executor.execute(&bench.plan, &frame, &world, &bench.imports)?;
            assert_eq!((world.used.get(), bench.executor.recording_threads()), (colors.len(), 1));
            kept = frame.for_world::<()>();
            if drawn {
                let texture = frames.executor().texture(frames.plan(), output.io).ok_or("no picture")?;
                assert_eq!([read_texture(gpu, texture)?.rgba()[0], bench.pixels(picture)?.rgba()[0]], [color; 2]);
            }
        }
        Ok(())
    })
}
