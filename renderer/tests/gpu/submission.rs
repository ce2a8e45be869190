//! Submission by the caller, warm-up, pipeline caches and shader reloading.

use crate::bench::{
    Bench, GREEN, RED, SHOW, TestResult, draw, draw_of, fill_corner, fill_full, on_adapter, on_every_device,
};
use framegraph::{DeclareError, Entry, Exit, Extent, Format, Intent, Texture, TextureDesc};
use framegraph_wgpu::{
    Cx, Executor, ExecutorOptions, Frame, FrameCommands, FrameLoop, Imports, ObjectCounts, PipelineCacheError, Raster,
    RecordError, Shader, ShaderError, read_texture, texture_2d,
};
use std::cell::Cell;

fn filled(frame: &mut Frame, color: [f32; 4]) -> Result<Texture, DeclareError> {
    let target = frame.graph_mut().texture("color", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
    let target = frame.add_fn("fill", |p| p.color(target, Intent::Overwrite), move |_, (), cx| fill_full(cx, color))?;
    frame.graph_mut().readback(target)?;
    Ok(target)
}

/// The caller's commands follow the graph's in one submission, see its results, and are awaited by its index.
#[test]
fn a_frame_is_submitted_with_commands_of_the_caller() -> TestResult {
    on_every_device("a_frame_is_submitted_with_commands_of_the_caller", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 64, 4);
        bench.run(|f| filled(f, GREEN))?;
        let target = bench.declare(|f| filled(f, RED))?;
        let texture = bench.executor.texture(&bench.plan, target).ok_or("no texture")?.clone();
        let size = wgpu::BufferDescriptor {
            label: Some("copy"),
            size: 1024,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        };
        let copy = gpu.device.create_buffer(&size);
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(256), rows_per_image: None };
        let into = wgpu::TexelCopyBufferInfo { buffer: &copy, layout };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), into, texture.size());
        let (queue, own, called) = (gpu.queue.clone(), encoder.finish(), Cell::new(false));
        let submit = |graph: FrameCommands| {
            called.set(true);
            graph.submit(&queue, [], [own])
        };
        let index = bench.executor.execute_with(&bench.plan, &bench.frame, &(), &bench.imports, submit)?;
        assert!(called.get());
        copy.map_async(wgpu::MapMode::Read, .., |_| ());
        gpu.device.poll(wgpu::PollType::Wait { submission_index: Some(index), timeout: None })?;
        let bytes = copy.get_mapped_range(..)?;
        assert!(!drawn || bytes.chunks_exact(4).all(|texel| texel == [255, 0, 0, 255]), "what this frame drew");
        Ok(())
    })
}

/// The caller submits the frame's command buffers between its own: one clears before, one copies after. The frame
/// counts as executed once it is reported.
#[test]
fn a_recorded_frame_is_submitted_between_other_commands() -> TestResult {
    on_every_device("a_recorded_frame_is_submitted_between_other_commands", |gpu, drawn| {
        let mut frames = FrameLoop::<()>::new(gpu);
        let image = gpu.device.create_texture(&texture_2d(
            "image",
            [64, 2],
            wgpu::TextureFormat::Rgba8Unorm,
            wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        ));
        let declare = |frame: &mut Frame, imports: &mut Imports| {
            let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
            let into = frame.graph_mut().import_texture("image", desc, Entry::Defined, Exit::Keep);
            imports.texture(into, &image);
            frame.add_fn("corner", |p| p.color(into, Intent::Modify), |_, (), cx| fill_corner(cx, GREEN))?;
            let history = frame.graph_mut().history("sum", TextureDesc::new(Extent::FRAME, Format::R8Unorm), 1);
            let earlier = frame.graph_mut().previous(history, 1)?;
            let read =
                |p: &mut framegraph::PassBuilder<'_>| Ok((p.sampled(earlier)?, p.color(history, Intent::Overwrite)?));
            frame.add_fn("sum", read, |(view, _), (), cx| draw_of(cx, &Raster::new(SHOW), *view))?;
            Ok::<_, DeclareError>(history)
        };
        let clear = || {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let view = image.create_view(&Default::default());
            let load = wgpu::LoadOp::Clear(wgpu::Color::BLUE);
            drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
                })],
                ..Default::default()
            }));
            encoder.finish()
        };
        for said in [true, false, true] {
            let (history, commands) = frames.record([64, 2], &(), declare)?.ok_or("skipped")?;
            let now = frames.executor().texture(frames.plan(), history).ok_or("no image")?.clone();
            let buffers = commands.into_buffers().map_err(|_| "nothing shares memory")?;
            let index = gpu.queue.submit([clear()].into_iter().chain(buffers));
            if said {
                frames.submitted(index);
            }
            let (again, _) = frames.record([64, 2], &(), declare)?.ok_or("skipped")?;
            let next = frames.executor().texture(frames.plan(), again).ok_or("no image")?;
            assert_eq!(now != *next, said, "a history moves when its frame counts");
        }
        let read = read_texture(gpu, &image)?;
        assert!(
            !drawn || (read.at(0, 1), read.at(63, 0)) == (Some(&[0, 255, 0, 255][..]), Some(&[0, 0, 255, 255][..]))
        );
        Ok(())
    })
}

#[test]
fn nothing_is_submitted_of_a_frame_that_failed() -> TestResult {
    on_every_device("nothing_is_submitted_of_a_frame_that_failed", |gpu, _| {
        let mut bench = Bench::new(gpu, 4, 4);
        let failures: [fn(&mut Cx<'_>) -> Result<(), RecordError>; 2] = [
            |_| Err(RecordError::custom("no camera")),
            |cx| {
                cx.render_pass()?.draw(0..3, 0..1);
                Ok(())
            },
        ];
        for record in failures {
            bench.declare(|frame| {
                let target = frame.graph_mut().texture("color", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
                let declare = |p: &mut framegraph::PassBuilder<'_>| p.color(target, Intent::Overwrite);
                let target = frame.add_fn("fill", declare, move |_, (), cx| record(cx))?;
                frame.graph_mut().export(target)?;
                Ok(())
            })?;
            let called = Cell::new(false);
            let submit = |commands: FrameCommands| {
                called.set(true);
                commands.submit(&gpu.queue, [], [])
            };
            let report = bench.executor.execute_with(&bench.plan, &bench.frame, &(), &bench.imports, submit);
            assert!(report.is_err() && !called.get(), "{report:?}");
        }
        Ok(())
    })
}

/// Warm-up creates everything that the frame needs, and neither draws nor advances histories.
#[test]
fn warm_up_creates_pipelines() -> TestResult {
    on_every_device("warm_up_creates_pipelines", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 4, 4);
        let declare = |frame: &mut Frame| {
            let history = frame.graph_mut().history("sum", TextureDesc::new(Extent::FRAME, Format::Rgba16Float), 1);
            let previous = frame.graph_mut().previous(history, 1)?;
            let read =
                |p: &mut framegraph::PassBuilder<'_>| Ok((p.sampled(previous)?, p.color(history, Intent::Overwrite)?));
            let (_, sum) = frame.add_fn("add", read, move |(view, _), (), cx| {
                let (texels, valid) = (cx.texels(*view)?, cx.is_valid(previous)?);
                fill_full(cx, if valid && texels == [4, 4] { GREEN } else { RED })
            })?;
            frame.graph_mut().readback(sum)?;
            let color = filled(frame, GREEN)?;
            Ok([sum, color])
        };
        let [sum, color] = bench.declare(declare)?;
        let mut report = Vec::new();
        bench.executor.warm_up(&bench.plan, &bench.frame, &(), &bench.imports, &mut |at| {
            report.push((at.done, at.total, at.pass.to_owned(), at.pipelines));
        })?;
        assert_eq!(report, [(1, 2, "add".to_owned(), 1), (2, 2, "fill".to_owned(), 2)]);
        let made = bench.executor.objects();
        assert_eq!((made.pipelines, made.shader_modules, made.textures, made.histories), (2, 1, 1, 2));
        bench.execute()?;
        assert_eq!(bench.executor.objects(), ObjectCounts { ..made }, "the first frame makes nothing");
        if drawn {
            let first = |bench: &Bench, texture| Ok::<_, Box<dyn std::error::Error>>(bench.pixels(texture)?.rgba()[0]);
            assert_eq!((first(&bench, sum)?, first(&bench, color)?), (RED, GREEN), "no earlier frame was drawn");
        }
        Ok(())
    })
}

/// A frame is recorded into the caller's encoder, between commands of the caller.
#[test]
fn a_frame_is_recorded_into_the_callers_encoder() -> TestResult {
    on_every_device("a_frame_is_recorded_into_the_callers_encoder", |gpu, drawn| {
        let mut frames = FrameLoop::<()>::new(gpu);
        let (mut copies, mut last) = (Vec::new(), None);
        for color in [RED, GREEN] {
            let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("copy"),
                size: 256,
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            });
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let declared = frames.record_into([4, 1], &(), &mut encoder, |frame, _| filled(frame, color))?;
            let target = declared.ok_or("no texels")?;
            assert_eq!(frames.executor().executed(), frames.plan().counts());
            let texture = frames.executor().texture(frames.plan(), target).ok_or("no texture")?;
            let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(256), rows_per_image: None };
            let copied = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
            encoder.copy_texture_to_buffer(texture.as_image_copy(), copied, texture.size());
            frames.submitted(gpu.queue.submit([encoder.finish()]));
            copies.push((buffer, color));
            last = Some(target);
        }
        assert_eq!((last.is_some(), frames.executor().objects().textures), (true, 1));
        for (buffer, color) in copies.iter().filter(|_| drawn) {
            let bytes = framegraph_wgpu::read_buffer(gpu, buffer, 256)?;
            assert_eq!(bytes[..4], color.map(|channel| (255.0 * channel) as u8));
        }
        Ok(())
    })
}

const TINT: Shader<'static> = Shader::new("tint", include_str!("tint.wgsl"));

fn tinted(frame: &mut Frame, format: Format) -> Result<Texture, DeclareError> {
    let target = frame.graph_mut().texture("color", TextureDesc::new(Extent::FRAME, format));
    let target = frame.add_fn(
        "tint",
        |p| p.color(target, Intent::Overwrite),
        |_, (), cx| {
            let tint = cx.uniform(&RED);
            draw(cx, &Raster::new(TINT), &[(0, tint)])
        },
    )?;
    frame.graph_mut().readback(target)?;
    Ok(target)
}

/// An invalid source keeps the old one in use and returns the reason. A valid one changes existing and future
/// pipelines.
#[test]
fn a_shader_is_reloaded_between_frames() -> TestResult {
    on_every_device("a_shader_is_reloaded_between_frames", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 4, 4);
        let shows = |bench: &mut Bench, format, expected: [f32; 4]| -> TestResult {
            let target = bench.run(|f| tinted(f, format))?;
            assert!(!drawn || bench.pixels(target)?.rgba().iter().all(|texel| *texel == expected));
            Ok(())
        };
        shows(&mut bench, Format::Rgba8Unorm, RED)?;
        let swapped = TINT.text().replace("return tint;", "return tint.grba;");
        assert_eq!(bench.executor.reload_shader(&TINT, &swapped)?, 1);
        shows(&mut bench, Format::Rgba8Unorm, GREEN)?;

        let broken = TINT.text().replace("return tint;", "return tnit;");
        let report = bench.executor.reload_shader(&TINT, &broken);
        assert!(
            matches!(&report, Err(ShaderError::Module { name, message }) if name == "tint" && message.contains("tnit"))
        );
        shows(&mut bench, Format::Rgba8Unorm, GREEN)?;
        let other = TINT.text().replace("fs_main", "fs_other");
        let report = bench.executor.reload_shader(&TINT, &other);
        assert!(
            matches!(&report, Err(ShaderError::Reload(change)) if change.old.contains("fs_main") && change.new.contains("fs_other")),
            "{report:?}"
        );
        shows(&mut bench, Format::Rgba8Unorm, GREEN)?;

        let made = bench.executor.objects();
        shows(&mut bench, Format::Rgba16Float, GREEN)?;
        shows(&mut bench, Format::Rgba8Unorm, GREEN)?;
        let now = bench.executor.objects().since(&made);
        assert_eq!((now.pipelines, now.shader_modules), (1, 0), "the new text in another format");
        assert_eq!(bench.executor.reload_shader(&TINT, TINT.text())?, 2);
        shows(&mut bench, Format::Rgba8Unorm, RED)
    })
}

#[test]
fn unused_pipelines_are_dropped() -> TestResult {
    on_every_device("unused_pipelines_are_dropped", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 4, 4);
        bench.executor = Executor::with(gpu, ExecutorOptions { max_pipeline_age: 5, ..ExecutorOptions::default() });
        let pipelines = |bench: &mut Bench, format, frames| -> Result<u64, Box<dyn std::error::Error>> {
            for _ in 0..frames {
                let target = bench.run(|f| tinted(f, format))?;
                assert!(!drawn || bench.pixels(target)?.rgba()[0] == RED);
            }
            Ok(bench.executor.objects().pipelines)
        };
        assert_eq!(pipelines(&mut bench, Format::Rgba8Unorm, 1)?, 1);
        assert_eq!(pipelines(&mut bench, Format::Rgba16Float, 3)?, 2);
        assert_eq!(pipelines(&mut bench, Format::Rgba8Unorm, 1)?, 2, "it is still there");
        assert_eq!(pipelines(&mut bench, Format::Rgba16Float, 12)?, 2, "what is asked for is never dropped");
        assert_eq!(pipelines(&mut bench, Format::Rgba8Unorm, 1)?, 3, "it was dropped");
        Ok(())
    })
}

#[test]
fn compiled_pipelines_are_kept_for_the_next_run() -> TestResult {
    on_adapter("compiled_pipelines_are_kept_for_the_next_run", |gpu| {
        let mut first = Bench::new(gpu, 4, 4);
        if !first.executor.use_pipeline_cache(None)? {
            assert_eq!(first.executor.pipeline_cache_data(), None);
            return crate::bench::skip("compiled_pipelines_are_kept_for_the_next_run", "the device keeps no pipelines");
        }
        first.run(|f| tinted(f, Format::Rgba8Unorm))?;
        let kept = first.executor.pipeline_cache_data().ok_or("nothing was kept")?;
        let empty = {
            let mut executor = Executor::new(gpu);
            executor.use_pipeline_cache(None)?;
            executor.pipeline_cache_data().ok_or("nothing was kept")?
        };
        // Mesa's software drivers have a cache, but store nothing in it.
        let grown = kept.len() > empty.len() || (gpu.is_software() && kept.len() == empty.len());
        assert!(grown, "{} bytes, {} without a pipeline", kept.len(), empty.len());
        let mut damaged = kept.clone();
        let middle = damaged.len() / 2;
        damaged[middle] ^= 1;
        for (bytes, sound) in [(&kept, true), (&damaged, false)] {
            let mut second = Bench::new(gpu, 4, 4);
            let report = second.executor.use_pipeline_cache(Some(bytes));
            assert!(if sound { report == Ok(true) } else { matches!(report, Err(PipelineCacheError::Damaged { .. })) });
            let target = second.run(|f| tinted(f, Format::Rgba8Unorm))?;
            assert!(second.pixels(target)?.rgba().iter().all(|texel| *texel == RED));
            assert!(second.executor.pipeline_cache_data().is_some_and(|bytes| bytes.len() >= kept.len()));
        }
        Ok(())
    })
}
