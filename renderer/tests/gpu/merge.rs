//! Merged passes are recorded into one render pass and do not see each other's state.

use crate::bench::{Bench, GREEN, RED, TestResult, fill_corner, fill_full, on_every_device};
use framegraph::{ClearValue, DeclareError, Extent, Format, Intent, Texture, TextureDesc};
use framegraph_wgpu::Frame;
use framegraph_wgpu::Gpu;

fn declare(frame: &mut Frame) -> Result<Texture, DeclareError> {
    let target = frame.graph_mut().texture("color", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
    let clear = Intent::Clear(ClearValue::BLACK);
    let target = frame.add_fn(
        "small",
        |p| p.color(target, clear),
        |_, (), cx| {
            let pass = cx.render_pass()?;
            pass.set_viewport(0.0, 0.0, 2.0, 2.0, 0.0, 1.0);
            pass.set_scissor_rect(0, 0, 1, 1);
            fill_full(cx, RED)
        },
    )?;
    let target = frame.add_fn("over", |p| p.color(target, Intent::Modify), |_, (), cx| fill_corner(cx, GREEN))?;
    frame.graph_mut().readback(target)?;
    Ok(target)
}

#[test]
fn merging_does_not_change_the_image() -> TestResult {
    on_every_device("merging_does_not_change_the_image", |gpu, drawn| {
        let mut pictures = Vec::new();
        for (merge, steps, unresolves) in [(true, 1, 0), (false, 2, 1)] {
            let mut bench = Bench::new(gpu, 8, 8);
            bench.options.merge = merge;
            let target = bench.run(declare)?;
            let counts = bench.executor.executed();
            assert_eq!((counts.render_passes, counts.unresolves, counts.passes), (steps, unresolves, 2));
            if drawn {
                pictures.push(bench.pixels(target)?);
            }
        }
        if let [merged, apart] = pictures.as_slice() {
            assert_eq!(merged, apart);
            assert_eq!(merged.at(0, 0), Some([255, 0, 0, 255].as_slice()), "the scissored texel");
            assert_eq!(merged.at(6, 7), Some([0, 255, 0, 255].as_slice()), "the second pass has the whole viewport");
        }
        Ok(())
    })
}

#[test]
fn a_pass_without_a_recorder_is_named() -> TestResult {
    let gpu = Gpu::noop()?;
    let mut bench = Bench::new(&gpu, 8, 8);
    let refused = bench.run(|frame| {
        declare(frame)?;
        frame.graph_mut().add_fn("bare", |p| {
            p.side_effect();
            Ok(())
        })
    });
    assert!(refused.is_err_and(|e| e.to_string().contains("pass `bare` has no recorder")));
    Ok(())
}

/// Each pass of a merged step is a debug group: a recorder can close it, and wgpu accepts this only if it is open. Passes
/// of other steps are named by their render pass.
#[test]
fn every_pass_of_a_merged_step_has_a_debug_group() -> TestResult {
    on_every_device("every_pass_of_a_merged_step_has_a_debug_group", |gpu, _| {
        for (merge, accepted) in [(true, true), (false, false)] {
            let mut bench = Bench::new(gpu, 8, 8);
            bench.options.merge = merge;
            let report = bench.run(|frame| {
                let mut target = declare(frame)?;
                for name in ["third", "fourth"] {
                    target = frame.add_fn(
                        name,
                        |p| p.color(target, Intent::Modify),
                        |_, (), cx| {
                            let pass = cx.render_pass()?;
                            pass.pop_debug_group();
                            pass.push_debug_group("of the recorder");
                            Ok(())
                        },
                    )?;
                }
                frame.graph_mut().readback(target)
            });
            assert_eq!(report.is_ok(), accepted, "{report:?}");
        }
        Ok(())
    })
}

#[test]
fn textures_have_the_names_of_their_resources() -> TestResult {
    on_every_device("textures_have_the_names_of_their_resources", |gpu, _| {
        let mut bench = Bench::new(gpu, 8, 8);
        let target = bench.run(declare)?;
        let texture = bench.executor.texture(&bench.plan, target).ok_or("no texture")?;
        texture.destroy();
        // wgpu tells the label in its error alone.
        let refused = gpu.guard("a view", || texture.create_view(&Default::default())).map(|_| ());
        assert!(refused.as_ref().is_err_and(|e| e.to_string().contains("'color'")), "{refused:?}");
        Ok(())
    })
}
