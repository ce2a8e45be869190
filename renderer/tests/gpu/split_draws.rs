//! Draws of one pass that several threads record: contents and order are those of one thread.

use crate::bench::{Bench, TestResult, on_every_device};
use framegraph::{ClearValue, DeclareError, Extent, Format, Intent, Texture, TextureDesc};
use framegraph_wgpu::wgpu::{BlendState, CompareFunction};
use framegraph_wgpu::{Depth, ExecuteError, Frame, Output, Raster, RecordError, Shader, Workers};
use std::sync::atomic::{AtomicU32, Ordering};

/// Draw `i` covers all texels, with a color and a depth that depend on `i`.
const DRAW: Shader<'static> = Shader::new(
    "draw",
    "struct Corner { @builtin(position) at: vec4f, @location(0) @interpolate(flat) number: u32 }
     @vertex fn vs_main(@builtin(vertex_index) i: u32, @builtin(instance_index) number: u32) -> Corner {
       let depth = f32((number * 7919) % 1000) / 1000.0;
       return Corner(vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, depth, 1.0), number);
     }
     @fragment fn fs_main(corner: Corner) -> @location(0) vec4f {
       return vec4f(f32(corner.number % 13) / 13.0, f32(corner.number % 5) / 5.0, f32(corner.number % 2), 0.25);
     }",
);

const DRAWS: u32 = 1500;

/// Number of calls of the closure that records draws.
static CALLS: AtomicU32 = AtomicU32::new(0);

/// Declares a pass that blends many draws, with a depth test against a depth buffer that is read or written. The draws
/// from `wrong` on lack their pipeline.
fn declare(frame: &mut Frame, read_only: bool, wrong: Option<u32>) -> Result<Texture, DeclareError> {
    let color = frame.graph_mut().texture("color", TextureDesc::new(Extent::FRAME, Format::Rgba16Float).samples(4));
    let depth = frame.graph_mut().texture("depth", TextureDesc::new(Extent::FRAME, Format::Depth32Float).samples(4));
    let resolved = frame.graph_mut().texture("resolved", TextureDesc::new(Extent::FRAME, Format::Rgba16Float));
    let clear = Intent::Clear(ClearValue::DepthStencil(0.5, 0));
    let depth = frame.add_fn("depth", |p| p.depth(depth, clear), |_, (), _| Ok(()))?;
    let resolved = frame.add_fn(
        "draws",
        |p| {
            let color = p.color(color, Intent::Clear(ClearValue::BLACK))?;
            if read_only {
                p.depth_read_only(depth).map(drop)?;
            } else {
                p.depth(depth, Intent::Modify).map(drop)?;
            }
            p.resolve(color, resolved)
        },
        move |_, (), cx| {
            let colors = [Output { blend: Some(BlendState::ALPHA_BLENDING), ..Output::REPLACE }];
            let depth = Depth { compare: CompareFunction::LessEqual, write: !read_only, ..Depth::NONE };
            let pipeline = cx.raster_pipeline(&Raster { colors: &colors, depth, ..Raster::new(DRAW) })?;
            cx.draw_split(DRAWS, |draws, range| {
                CALLS.fetch_add(1, Ordering::Relaxed);
                if wrong.is_none_or(|wrong| range.end <= wrong) {
                    draws.set_pipeline(&pipeline);
                }
                range.for_each(|number| draws.draw(0..3, number..number + 1));
            })
        },
    )?;
    frame.graph_mut().readback(resolved)?;
    Ok(resolved)
}

#[test]
fn split_draws_keep_their_order() -> TestResult {
    on_every_device("split_draws_keep_their_order", |gpu, drawn| {
        for read_only in [false, true] {
            let mut pictures = Vec::new();
            for (threads, parts) in [(1, 1), (3, 3), (9, 5)] {
                let mut bench = Bench::new(gpu, 4, 4);
                bench.executor.record_on(Some(Workers::with_threads(threads)?));
                CALLS.store(0, Ordering::Relaxed);
                let color = bench.run(|frame| declare(frame, read_only, None))?;
                assert_eq!(CALLS.load(Ordering::Relaxed), parts, "{threads} threads");
                if drawn {
                    pictures.push(bench.pixels(color)?);
                }
            }
            assert!(pictures.windows(2).all(|two| two[0] == two[1]), "read only: {read_only}");
            assert!(pictures.iter().all(|picture| picture.rgba()[0][0] > 0.0), "something was drawn");
        }
        let mut bench = Bench::new(gpu, 4, 4);
        bench.executor.record_on(Some(Workers::with_threads(3)?));
        let error = bench.run(|frame| declare(frame, true, Some(1000))).err().ok_or("was drawn")?;
        let error = error.downcast::<ExecuteError>()?;
        let expected = |error: &RecordError| matches!(error, RecordError::Draws { first: 1000, end: 1500, message } if message.contains("ipeline"));
        assert!(matches!(&*error, ExecuteError::Record { error, .. } if expected(error)), "{error}");
        bench.run(|frame| declare(frame, true, None)).map(drop)
    })
}
