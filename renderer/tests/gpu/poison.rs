//! Poisoning makes undefined contents visible, and does not change a correct frame.

use crate::bench::{Bench, RED, TestResult, fill_corner, fill_full, on_every_device};
use framegraph::{Aspect, ClearValue, DeclareError, Extent, Format, Intent, Texture, TextureDesc};
use framegraph_wgpu::Frame;
use framegraph_wgpu::{Executor, ExecutorOptions, Readback, Subresource};

fn poisoned(bench: &mut Bench) {
    let options = ExecutorOptions { poison: true, ..ExecutorOptions::default() };
    bench.executor = Executor::with(&bench.gpu, options);
}

/// Declares that all texels are written; if `keep` is false, half of them are not.
fn promise(frame: &mut Frame, format: Format, keep: bool) -> Result<Texture, DeclareError> {
    let target = frame.graph_mut().texture("color", TextureDesc::new(Extent::FRAME, format));
    let draw = move |_: &Texture, (): &(), cx: &mut framegraph_wgpu::Cx<'_>| {
        if keep { fill_full(cx, RED) } else { fill_corner(cx, RED) }
    };
    let target = frame.add_fn("promise", |p| p.color(target, Intent::Overwrite), draw)?;
    frame.graph_mut().readback(target)?;
    Ok(target)
}

#[test]
fn a_broken_overwrite_is_visible() -> TestResult {
    on_every_device("a_broken_overwrite_is_visible", |gpu, drawn| {
        for (format, keep) in [(Format::Rgba16Float, false), (Format::Rgba16Float, true), (Format::Rgba8Unorm, false)] {
            let mut bench = Bench::new(gpu, 8, 8);
            poisoned(&mut bench);
            let target = bench.run(|f| promise(f, format, keep))?;
            if drawn {
                let corner = bench.pixels(target)?.rgba()[7];
                match (format, keep) {
                    (_, true) => assert_eq!(corner, RED),
                    (Format::Rgba16Float, _) => {
                        assert!(corner.iter().all(|c| !c.is_finite()), "{corner:?}");
                    }
                    _ => assert_eq!(corner, [1.0, 0.0, 1.0, 1.0]),
                }
            }
        }
        Ok(())
    })
}

#[test]
fn a_correct_frame_looks_the_same() -> TestResult {
    // Samples and depth are discarded after each step; one of them is in memory, since merging is off.
    let declare = |frame: &mut Frame| {
        let hdr = TextureDesc::new(Extent::FRAME, Format::Rgba16Float);
        let graph = frame.graph_mut();
        let (samples, out) = (graph.texture("samples", hdr.samples(4)), graph.texture("out", hdr));
        let clear = Intent::Clear(ClearValue::BLACK);
        let samples = frame.add_fn("first", |p| p.color(samples, clear), |_, (), cx| fill_full(cx, RED))?;
        let resolve = |p: &mut framegraph::PassBuilder<'_>| {
            let samples = p.color(samples, Intent::Modify)?;
            p.resolve(samples, out)
        };
        let out = frame.add_fn("second", resolve, |_, (), cx| fill_corner(cx, [0.0, 1.0, 0.0, 1.0]))?;
        frame.graph_mut().readback(out)?;
        Ok(out)
    };
    on_every_device("a_correct_frame_looks_the_same", |gpu, drawn| {
        let mut pictures = Vec::new();
        for poison in [false, true] {
            let mut bench = Bench::new(gpu, 16, 16);
            bench.options.merge = false;
            if poison {
                poisoned(&mut bench);
            }
            for _ in 0..3 {
                let out = bench.run(declare)?;
                if drawn {
                    pictures.push(bench.pixels(out)?);
                }
            }
        }
        assert!(pictures.windows(2).all(|p| p[0] == p[1]));
        Ok(())
    })
}

#[test]
fn a_stored_plane_is_not_poisoned() -> TestResult {
    // Depth is cleared three times and shown after the last; stencil is written by the first pass only.
    let declare = |frame: &mut Frame| {
        let graph = frame.graph_mut();
        let depth = graph.texture("depth", TextureDesc::new(Extent::FRAME, Format::Depth32FloatStencil8));
        let both = Intent::Clear(ClearValue::DepthStencil(0.25, 7));
        let depth = frame.add_fn("both", |p| p.depth(depth, both), |_, (), _| Ok(()))?;
        let again = |p: &mut framegraph::PassBuilder<'_>| {
            p.side_effect();
            p.never_merge();
            p.depth(depth.aspect(Aspect::Depth), Intent::Clear(ClearValue::FAR))
        };
        let depth = frame.add_fn("again", again, |_, (), _| Ok(()))?;
        let last = |p: &mut framegraph::PassBuilder<'_>| {
            p.depth(depth.aspect(Aspect::Depth), Intent::Clear(ClearValue::FAR_REVERSED))
        };
        let depth = frame.add_fn("last", last, |_, (), _| Ok(()))?;
        frame.graph_mut().readback(depth)?;
        Ok(depth)
    };
    on_every_device("a_stored_plane_is_not_poisoned", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 8, 8);
        poisoned(&mut bench);
        let depth = bench.declare(declare)?;
        bench.executor.execute(&bench.plan, &bench.frame, &(), &bench.imports)?;
        let dropped = bench.plan.attachments().iter().filter(|a| a.store == framegraph::StoreOp::Discard).count();
        assert_eq!(dropped, 2, "unread depth planes, with stored and with untouched stencil");
        if drawn {
            let physical = bench.executor.texture(&bench.plan, depth).ok_or("no texture")?;
            let plane = |aspect| Readback::start(gpu, physical, Subresource { aspect, ..Subresource::FIRST });
            assert!(plane(Aspect::Stencil)?.wait(gpu)?.bytes.iter().all(|s| *s == 7));
            assert_eq!(plane(Aspect::Depth)?.wait(gpu)?.depth(), Some(vec![0.0; 64]));
        }
        Ok(())
    })
}
