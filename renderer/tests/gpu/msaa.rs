//! Multisampling: samples are memoryless, and their average is stored.

use crate::bench::{Bench, FILL, RED, TestResult, fill, on_every_device};
use framegraph::{ClearValue, Extent, Format, Intent, TextureDesc};
use framegraph_wgpu::{Depth, Raster};

#[test]
fn samples_are_memoryless_and_resolved() -> TestResult {
    on_every_device("samples_are_memoryless_and_resolved", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 64, 64);
        let resolved = bench.run(|frame| {
            let hdr = TextureDesc::new(Extent::FRAME, Format::Rgba16Float);
            let graph = frame.graph_mut();
            let samples = graph.texture("samples", hdr.samples(4));
            let depth = graph.texture("depth", hdr.samples(4).format(Format::Depth32Float));
            let resolved = graph.texture("resolved", hdr);
            let declare = |p: &mut framegraph::PassBuilder<'_>| {
                let color = p.color(samples, Intent::Clear(ClearValue::TRANSPARENT))?;
                p.depth(depth, Intent::Clear(ClearValue::FAR_REVERSED))?;
                p.resolve(color, resolved)
            };
            let resolved = frame.add_fn("scene", declare, |_, (), cx| {
                fill(cx, &Raster { vertex: "corner", depth: Depth::NEARER, ..Raster::new(FILL) }, RED, 0.5)
            })?;
            frame.graph_mut().readback(resolved)?;
            Ok(resolved)
        })?;
        let counts = bench.executor.executed();
        assert_eq!((counts.memoryless, counts.multisample_resolves), (2, 1));
        assert_eq!((counts.clears, counts.discards, counts.resolves, counts.unresolves), (2, 2, 1, 0));
        if drawn {
            let rgba = bench.pixels(resolved)?.rgba();
            assert_eq!((rgba[63 * 64], rgba[63]), (RED, [0.0; 4]));
            // The edge runs along the diagonal, so all of its texels are partly covered.
            let partial = rgba.iter().filter(|c| c[0] > 0.0 && c[0] < 1.0).count();
            assert!((60..=70).contains(&partial), "{partial} texels are partly covered");
        }
        Ok(())
    })
}
