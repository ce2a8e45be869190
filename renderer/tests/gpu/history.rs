//! Histories: images that one frame writes and later frames read.

use crate::bench::{Bench, RED, TestResult, draw, draw_of, fill_full, on_every_device};
use framegraph::{DeclareError, Extent, Format, Intent, PassBuilder, Previous, Texture, TextureDesc, View};
use framegraph_wgpu::Frame;
use framegraph_wgpu::inspect::Inspector;
use framegraph_wgpu::{Cx, ExecutorOptions, Raster, RecordError, Shader};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex};

/// Adds one to the sum of the two previous images: 1, 2, 4, 7, 12 …
const ADD: Shader<'static> = Shader::new(
    "add",
    "@group(0) @binding(0) var one: texture_2d<f32>;
     @group(0) @binding(1) var two: texture_2d<f32>;
     @vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
       return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.5, 1.0);
     }
     @fragment fn fs_main() -> @location(0) vec4f {
       return textureLoad(one, vec2u(), 0) + textureLoad(two, vec2u(), 0) + 1.0;
     }",
);

/// Adds one to the center of the previous image, for any size.
const ADD_LAST: Shader<'static> = Shader::new(
    "add last",
    "@group(0) @binding(0) var last: texture_2d<f32>;
     @vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
       return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.5, 1.0);
     }
     @fragment fn fs_main() -> @location(0) vec4f {
       return textureLoad(last, textureDimensions(last) / 2, 0) + 1.0;
     }",
);

#[derive(Clone, Copy)]
struct Io {
    one: View,
    two: View,
    previous: [Previous; 2],
    current: Texture,
}

fn record(io: &Io, cx: &mut Cx<'_>) -> Result<(), RecordError> {
    let (one, two) = (cx.view(io.one)?, cx.view(io.two)?);
    draw(cx, &Raster::new(ADD), &[(0, one.into()), (1, two.into())])
}

fn declare(frame: &mut Frame, valid: &Arc<AtomicU32>) -> Result<Texture, DeclareError> {
    let history = frame.graph_mut().history("sum", TextureDesc::new(Extent::FRAME, Format::Rgba16Float), 2);
    let previous = [frame.graph_mut().previous(history, 1)?, frame.graph_mut().previous(history, 2)?];
    let valid = valid.clone();
    let io = frame.add_fn(
        "add",
        |p| {
            let (one, two) = (p.sampled(previous[0])?, p.sampled(previous[1])?);
            Ok(Io { one, two, previous, current: p.color(history, Intent::Overwrite)? })
        },
        move |io: &Io, (), cx| {
            let count = io.previous.iter().map(|p| cx.is_valid(*p)).collect::<Result<Vec<_>, _>>()?;
            valid.store(count.into_iter().map(u32::from).sum(), Ordering::Relaxed);
            record(io, cx)
        },
    )?;
    frame.graph_mut().readback(io.current)?;
    Ok(io.current)
}

#[test]
fn previous_images_are_read_without_copies() -> TestResult {
    on_every_device("previous_images_are_read_without_copies", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 4, 4);
        let valid = Arc::new(AtomicU32::new(9));
        for (frame, sum) in [1.0, 2.0, 4.0, 7.0, 12.0, 20.0].into_iter().enumerate() {
            let current = bench.run(|f| declare(f, &valid))?;
            assert_eq!(valid.load(Ordering::Relaxed), (frame as u32).min(2), "valid images in frame {frame}");
            if drawn {
                assert_eq!(bench.pixels(current)?.rgba()[5][0], sum, "frame {frame}");
            }
        }
        assert_eq!(bench.executor.objects().histories, 3);
        bench.executor.reset_history("sum");
        bench.run(|f| declare(f, &valid))?;
        assert_eq!(valid.load(Ordering::Relaxed), 0, "after a camera cut");
        bench.options.frame = [8, 8];
        let current = bench.run(|f| declare(f, &valid))?;
        assert_eq!(valid.load(Ordering::Relaxed), 1, "a resize keeps what was written since");
        if drawn {
            assert_eq!(bench.pixels(current)?.rgba()[60][0], 2.0, "one from the frame before, and zeros before that");
        }
        Ok(())
    })
}

#[test]
fn a_failed_frame_does_not_advance_histories() -> TestResult {
    on_every_device("a_failed_frame_does_not_advance_histories", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 4, 4);
        let valid = Arc::new(AtomicU32::new(0));
        for _ in 0..2 {
            bench.run(|f| declare(f, &valid))?;
        }
        let failed = bench.run(|f| {
            declare(f, &valid)?;
            f.add_fn(
                "fails",
                |p| {
                    p.side_effect();
                    Ok(())
                },
                |(), (), _| Err(RecordError::custom("on purpose")),
            )
        });
        assert!(failed.is_err_and(|e| e.to_string() == "pass `fails`: on purpose"));
        let current = bench.run(|f| declare(f, &valid))?;
        assert_eq!(valid.load(Ordering::Relaxed), 2);
        if drawn {
            assert_eq!(bench.pixels(current)?.rgba()[0][0], 4.0, "the third frame that succeeded");
        }
        Ok(())
    })
}

/// The image that a frame writes is the texture that the next frame reads, and that is written again two frames later.
/// Three textures alternate, without copies or allocations.
#[test]
fn a_ring_rotates_without_copies_and_is_reset() -> TestResult {
    on_every_device("a_ring_rotates_without_copies_and_is_reset", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 4, 4);
        let valid = Arc::new(AtomicU32::new(9));
        let mut images = Vec::new();
        for frame in 0..9 {
            let current = bench.run(|f| declare(f, &valid))?;
            images.push(bench.executor.texture(&bench.plan, current).ok_or("no image")?.clone());
            let executed = bench.executor.executed();
            assert_eq!((executed.steps, executed.render_passes, executed.passes), (1, 1, 1), "nothing but the pass");
            assert!(frame < 3 || images[frame] == images[frame - 3], "frame {frame}");
            assert!(frame < 1 || images[frame] != images[frame - 1], "frame {frame}");
        }
        assert_eq!(bench.executor.objects().histories, 3);
        for _ in 0..2 {
            bench.executor.reset_histories();
            let current = bench.run(|f| declare(f, &valid))?;
            assert_eq!(valid.load(Ordering::Relaxed), 0, "the first frame after a cut");
            if drawn {
                assert_eq!(bench.pixels(current)?.rgba()[5][0], 1.0, "nothing of before the cut is in it");
            }
            bench.run(|f| declare(f, &valid))?;
            assert_eq!(valid.load(Ordering::Relaxed), 1, "the second frame after a cut");
        }
        Ok(())
    })
}

/// Simulates window resizing and dynamic resolution: each frame has another size, and the sum continues. Passes query
/// the size of the previous image.
#[test]
fn a_history_continues_while_sizes_change() -> TestResult {
    on_every_device("a_history_continues_while_sizes_change", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 4, 4);
        let mut before = None;
        for (size, sum) in [[40, 20], [41, 20], [38, 23], [38, 23], [1, 1], [64, 64]].into_iter().zip(1u8..) {
            bench.options.frame = size;
            let seen = Arc::new(Mutex::new(None));
            let note = seen.clone();
            let current = bench.run(|frame| {
                let history = frame.graph_mut().history("sum", TextureDesc::new(Extent::FRAME, Format::Rgba16Float), 1);
                let previous = frame.graph_mut().previous(history, 1)?;
                let declare =
                    |p: &mut PassBuilder<'_>| Ok((p.sampled(previous)?, p.color(history, Intent::Overwrite)?));
                let (_, current) = frame.add_fn("add", declare, move |(view, _), (), cx| {
                    let image = cx.history(previous)?;
                    let message = image.valid.then_some(image.texels);
                    *note.lock().map_err(|_| RecordError::custom("poisoned"))? = Some((message, cx.texels(*view)?));
                    draw_of(cx, &Raster::new(ADD_LAST), *view)
                })?;
                frame.graph_mut().readback(current)?;
                Ok(current)
            })?;
            let seen = seen.lock().map_err(|_| "poisoned")?.take();
            assert_eq!(seen, Some((before, before.unwrap_or(size))), "frame {sum}");
            before = Some(size);
            if drawn {
                let texels = bench.pixels(current)?.rgba();
                assert!(texels.len() == (size[0] * size[1]) as usize && texels.iter().all(|t| t[0] == f32::from(sum)));
            }
        }
        Ok(())
    })
}

/// Declares a frame without a history.
fn blank(frame: &mut Frame) -> Result<(), DeclareError> {
    let out = frame.graph_mut().texture("out", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
    let out = frame.add_fn("blank", |p| p.color(out, Intent::Overwrite), |_, (), cx| fill_full(cx, RED))?;
    frame.graph_mut().export(out)
}

/// Frames of another graph run in between: of another `Frame`, or of the same one declared differently.
#[test]
fn a_history_survives_frames_of_another_graph() -> TestResult {
    on_every_device("a_history_survives_frames_of_another_graph", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 4, 4);
        let mut other = Frame::<()>::new();
        let valid = Arc::new(AtomicU32::new(9));
        for (frame, sum) in [1.0, 2.0, 4.0, 7.0].into_iter().enumerate() {
            let current = bench.run(|f| declare(f, &valid))?;
            assert_eq!(valid.load(Ordering::Relaxed), (frame as u32).min(2), "valid images in frame {frame}");
            if drawn {
                assert_eq!(bench.pixels(current)?.rgba()[5][0], sum, "frame {frame}");
            }
            for _ in 0..2 {
                std::mem::swap(&mut bench.frame, &mut other);
                bench.run(blank)?;
                std::mem::swap(&mut bench.frame, &mut other);
            }
        }
        for sum in [12.0, 20.0] {
            bench.run(blank)?;
            let current = bench.run(|f| declare(f, &valid))?;
            assert_eq!(valid.load(Ordering::Relaxed), 2, "the same frame was declared otherwise meanwhile");
            assert!(!drawn || bench.pixels(current)?.rgba()[5][0] == sum);
        }
        assert_eq!(bench.executor.objects().histories, 3);
        for _ in 0..ExecutorOptions::default().max_age {
            bench.run(blank)?;
        }
        assert!(bench.executor.history_bytes() > 0);
        bench.run(blank)?;
        assert_eq!(bench.executor.history_bytes(), 0, "it was not written for too long");
        bench.run(|f| declare(f, &valid))?;
        assert_eq!(valid.load(Ordering::Relaxed), 0);
        Ok(())
    })
}

/// Two frames use histories of equal name on one executor. Neither sees the other's images, regardless of formats.
#[test]
fn frames_do_not_share_a_history_of_one_name() -> TestResult {
    on_every_device("frames_do_not_share_a_history_of_one_name", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 4, 4);
        let mut other = Frame::<()>::new();
        let sum = |frame: &mut Frame, format| {
            let history = frame.graph_mut().history("sum", TextureDesc::new(Extent::FRAME, format), 1);
            let previous = frame.graph_mut().previous(history, 1)?;
            let declare = |p: &mut PassBuilder<'_>| Ok((p.sampled(previous)?, p.color(history, Intent::Overwrite)?));
            let (_, current) =
                frame.add_fn("add", declare, |(view, _), (), cx| draw_of(cx, &Raster::new(ADD_LAST), *view))?;
            frame.graph_mut().readback(current)?;
            Ok(current)
        };
        for format in [Format::Rgba16Float, Format::Rgba32Float] {
            for round in 1..=3u8 {
                // The second frame is executed twice in each round.
                for (second, step) in [(false, 1), (true, 2), (true, 2)] {
                    if second {
                        std::mem::swap(&mut bench.frame, &mut other);
                    }
                    let current = bench.run(|f| sum(f, if second { format } else { Format::Rgba16Float }))?;
                    let counted = bench.pixels(current)?.rgba()[5][0];
                    if second {
                        std::mem::swap(&mut bench.frame, &mut other);
                    }
                    let so_far = f32::from((round - 1) * step);
                    assert!(
                        !drawn || counted > so_far && counted <= so_far + f32::from(step),
                        "{counted} in round {round}"
                    );
                }
            }
            bench.executor.reset_history("sum");
        }
        assert_eq!(bench.executor.objects().histories, 8, "two images a ring");
        Ok(())
    })
}

#[test]
fn scopes_separate_histories_of_one_name() -> TestResult {
    on_every_device("scopes_separate_histories_of_one_name", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 4, 4);
        let valid = Arc::new(AtomicU32::new(0));
        let message = bench.run(|f| declare(f, &valid).and_then(|_| declare(f, &valid)));
        let message = message.map(|_| ()).map_err(|e| e.to_string()).err().unwrap_or_default();
        assert!(
            message.contains("resource `sum`: two histories have this name") && message.contains("scope"),
            "{message}"
        );
        for sum in [1.0, 2.0, 4.0] {
            // The left history is reset each time, so the two differ.
            bench.executor.reset_history("left/sum");
            let views = bench.run(|f| Ok(["left", "right"].map(|view| f.scope(view, |f| declare(f, &valid)))));
            let [left, right] = views?;
            if drawn {
                assert_eq!((bench.pixels(left?)?.rgba()[3][0], bench.pixels(right?)?.rgba()[3][0]), (1.0, sum));
            }
        }
        Ok(())
    })
}

/// After a resize, a previous image is inspected at its original size.
#[test]
fn a_previous_image_is_inspected_at_its_own_size() -> TestResult {
    on_every_device("a_previous_image_is_inspected_at_its_own_size", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 4, 4);
        let valid = Arc::new(AtomicU32::new(0));
        for size in [[4, 4], [6, 2], [8, 8]] {
            bench.options.frame = size;
            bench.run(|f| declare(f, &valid))?;
        }
        let mut inspector = Inspector::new(gpu);
        let Bench { executor, plan, frame, imports, .. } = &bench;
        for (name, size, sum) in [("sum", [8, 8], 7.0), ("sum@-1", [8, 8], 4.0), ("sum@-2", [6, 2], 2.0)] {
            let found = inspector.inspect(executor, plan, frame, &(), imports, &name.parse()?)?;
            assert_eq!(found.texels.size, size, "{name}");
            assert!(!drawn || found.texels.numbers().iter().all(|texel| texel[0] == sum), "{name}");
        }
        Ok(())
    })
}
