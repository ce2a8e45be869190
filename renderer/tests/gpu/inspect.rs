//! Inspection returns the drawn values and does not change the frame.

use crate::bench::{Bench, FILL, RED, TestResult, draw_of, fill, fill_corner, fill_full, on_every_device};
use framegraph::{
    Aspect, ClearValue, DeclareError, Dimension, Entry, Exit, Extent, Format, Intent, Placement, Texture, TextureDesc,
    dump,
};
use framegraph_wgpu::Frame;
use framegraph_wgpu::inspect::{Inspection, Inspector, Texels, all_targets};
use framegraph_wgpu::{Depth, Raster, read_texture, texture_2d};

const SIDE: u32 = 8;
/// Half of the target has depth 0.25 and a color outside of 0…1, over a clear color.
const DRAWN: [f32; 4] = [2.5, 0.125, -3.0, 1.0];
const BEHIND: [f64; 4] = [0.5, 16.0, 0.0, 0.25];

fn look(bench: &Bench, inspector: &mut Inspector, request: &str) -> Result<Inspection, Box<dyn std::error::Error>> {
    let Bench { executor, plan, frame, imports, .. } = bench;
    Ok(inspector.inspect(executor, plan, frame, &(), imports, &request.parse()?)?)
}

fn refused(bench: &Bench, inspector: &mut Inspector, request: &str) -> String {
    look(bench, inspector, request).map(|_| ()).map_err(|e| e.to_string()).err().unwrap_or_default()
}

/// Depth and samples are memoryless. The image is drawn by a second pass from the average.
fn declare(frame: &mut Frame, samples: u8) -> Result<Texture, DeclareError> {
    let hdr = TextureDesc::new(Extent::FRAME, Format::Rgba16Float);
    let scene = |p: &mut framegraph::PassBuilder<'_>| {
        let depth = p.texture("depth", hdr.samples(samples).format(Format::Depth32Float));
        p.depth(depth, Intent::Clear(ClearValue::FAR_REVERSED))?;
        let color = p.texture("hdr", hdr.samples(samples));
        p.color(color, Intent::Clear(ClearValue::Color(BEHIND)))
    };
    let draw = |_: &Texture, (): &(), cx: &mut framegraph_wgpu::Cx<'_>| {
        fill(cx, &Raster { vertex: "corner", depth: Depth::NEARER, ..Raster::new(FILL) }, DRAWN, 0.25)
    };
    let mut color = frame.add_fn("scene", scene, draw)?;
    if samples > 1 {
        let average = frame.graph_mut().texture("average", hdr);
        let resolve = |p: &mut framegraph::PassBuilder<'_>| {
            let color = p.color(color, Intent::Modify)?;
            p.resolve(color, average)
        };
        color = frame.add_fn("resolve", resolve, |_, (), _| Ok(()))?;
    }
    let out = frame.graph_mut().texture("out", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
    let grade =
        |p: &mut framegraph::PassBuilder<'_>| Ok((p.sampled(color)?, p.color(out, Intent::Clear(ClearValue::BLACK))?));
    let (_, out) = frame.add_fn("grade", grade, |_, (), cx| fill_corner(cx, RED))?;
    frame.graph_mut().readback(out)?;
    Ok(out)
}

/// Returns whether the lower left triangle covers the texel's center; `None` on the diagonal, where the driver's fill
/// rule decides.
fn covered(x: u32, y: u32) -> Option<bool> {
    let below = i64::from(y) - i64::from(x);
    (below != 0).then_some(below > 0)
}

/// Compares every texel outside of the diagonal.
fn compare(texels: &Texels, inside: [f32; 4], outside: [f32; 4]) {
    let mut seen = 0;
    for (index, found) in texels.numbers().iter().enumerate() {
        let (x, y) = (index as u32 % SIDE, index as u32 / SIDE);
        if let Some(covered) = covered(x, y) {
            assert_eq!(*found, if covered { inside } else { outside }, "texel {x}, {y}");
            seen += 1;
        }
    }
    assert_eq!(seen, SIDE * (SIDE - 1));
}

#[test]
fn depth_and_color_equal_the_drawn_values() -> TestResult {
    let behind = BEHIND.map(|c| c as f32);
    on_every_device("depth_and_color_equal_the_drawn_values", |gpu, drawn| {
        for samples in [1, 4] {
            let mut bench = Bench::new(gpu, SIDE, SIDE);
            let out = bench.run(|f| declare(f, samples))?;
            let depth = bench.plan.graph().find_resource("depth").ok_or("no depth")?;
            let placement = bench.plan.resources()[depth.index()].placement;
            assert_eq!(placement, Placement::Memoryless, "what never leaves the tile is to be looked at");
            let (text, objects) = (dump::text(&bench.plan), bench.executor.objects());
            let picture = if drawn { Some(bench.pixels(out)?) } else { None };

            let mut inspector = Inspector::new(gpu);
            let depth = look(&bench, &mut inspector, "depth")?;
            let light = look(&bench, &mut inspector, "hdr@scene")?;
            // Depth is not averaged; the first sample is used.
            let titles = if samples == 1 { "depth@scene" } else { "depth@scene, sample 0" };
            assert_eq!((depth.title().as_str(), light.title().as_str()), (titles, "hdr@scene"));
            if samples > 1 {
                look(&bench, &mut inspector, "average")?;
            }
            if drawn {
                compare(&depth.texels, [0.25, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0]);
                compare(&light.texels, DRAWN, behind);
                let distances = depth.texels.distances_m(0.1).ok_or("no depth")?;
                assert_eq!((distances[7 * 8], distances[7]), (0.1 / 0.25, f32::INFINITY));
            }

            assert_eq!(dump::text(&bench.plan), text, "the plan under study");
            assert_eq!(bench.executor.objects(), objects, "what the executor holds");
            if let Some(before) = picture {
                assert_eq!(bench.pixels(out)?, before, "the picture that was there");
                bench.execute()?;
                assert_eq!(bench.pixels(out)?, before, "the next picture");
                let seen = look(&bench, &mut inspector, "out")?;
                assert_eq!(seen.texels.display(Default::default(), 1.0).rgba8, before.rgba8());
            }
        }
        Ok(())
    })
}

#[test]
fn samples_are_averaged_or_inspected_separately() -> TestResult {
    on_every_device("samples_are_averaged_or_inspected_separately", |gpu, drawn| {
        let mut bench = Bench::new(gpu, SIDE, SIDE);
        bench.run(|f| declare(f, 4))?;
        let mut inspector = Inspector::new(gpu);
        let average = look(&bench, &mut inspector, "hdr@scene")?.texels.numbers();
        let resolved = look(&bench, &mut inspector, "average")?.texels.numbers();
        let mut sum = vec![[0.0; 4]; average.len()];
        let mut partial = 0;
        for sample in 0..4 {
            let request = framegraph_wgpu::inspect::Request {
                sample: Some(sample),
                ..framegraph_wgpu::inspect::Request::newest("hdr")
            };
            let Bench { executor, plan, frame, imports, .. } = &bench;
            let one = inspector.inspect(executor, plan, frame, &(), imports, &request)?.texels.numbers();
            for (sum, (one, average)) in sum.iter_mut().zip(one.iter().zip(&average)) {
                (0..4).for_each(|c| sum[c] += one[c] / 4.0);
                partial += u32::from(one != average);
            }
        }
        if drawn {
            assert_eq!(sum, average);
            // These sums of quarters are exact in 16-bit floats.
            assert_eq!(resolved, average);
            assert!(partial > 0, "the edge has texels that are partly covered");
        }
        let message = refused(&bench, &mut inspector, "depth@nobody");
        assert!(message.contains("no version of a pass `nobody`; it has v1 (`scene`)"), "{message}");
        Ok(())
    })
}

#[test]
fn levels_layers_planes_and_slices_are_inspected_separately() -> TestResult {
    // Each mip and layer has its own color, stencil is 7, and four slices are cleared at once.
    let tone = |mip: u8, layer: u16| [f32::from(mip) + 1.0, f32::from(layer) + 1.0, 0.5, 1.0];
    let declare = move |frame: &mut Frame| {
        let graph = frame.graph_mut();
        let desc = TextureDesc::new(Extent::FRAME, Format::Rgba16Float).mips(2).layers(3);
        let mut pyramid = graph.texture("pyramid", desc);
        let both = graph.texture("both", TextureDesc::new(Extent::FRAME, Format::Depth32FloatStencil8));
        let ids = graph.texture("ids", TextureDesc::new(Extent::FRAME, Format::R32Uint));
        for mip in 0..2 {
            for layer in 0..3 {
                let color = tone(mip, layer);
                pyramid = frame.add_fn(
                    "level",
                    |p| p.color(pyramid.mip(mip).layer(layer), Intent::Overwrite),
                    move |_, (), cx| fill_full(cx, color),
                )?;
            }
        }
        let clear = Intent::Clear(ClearValue::DepthStencil(0.75, 7));
        frame.add_fn("both", |p| p.depth(both, clear), |_, (), _| Ok(()))?;
        let white = Intent::Clear(ClearValue::Color([4_000_000_000.0, 0.0, 0.0, 0.0]));
        frame.add_fn("ids", |p| p.color(ids, white), |_, (), _| Ok(()))?;
        let desc = TextureDesc { dimension: Dimension::D3, ..desc.mips(1).layers(4) };
        let volume = frame.graph_mut().texture("volume", desc);
        let zero = Intent::Clear(ClearValue::Zero);
        let volume = frame.add_fn("volume", |p| p.storage_write(volume, zero), |_, (), _| Ok(()))?;
        frame.graph_mut().export(volume)?;
        frame.graph_mut().export(pyramid)?;
        Ok(())
    };
    on_every_device("levels_layers_planes_and_slices_are_inspected_separately", |gpu, drawn| {
        let mut bench = Bench::new(gpu, SIDE, SIDE);
        bench.run(declare)?;
        let mut inspector = Inspector::new(gpu);
        for mip in 0..2u8 {
            for layer in 0..3u16 {
                let seen = look(&bench, &mut inspector, &format!("pyramid:{mip}:{layer}"))?;
                assert_eq!(seen.texels.size, [SIDE >> mip; 2]);
                if drawn {
                    assert!(seen.texels.numbers().iter().all(|n| *n == tone(mip, layer)), "{mip} {layer}");
                }
            }
        }
        // Neither is exported or read, so both are culled in the frame, but they can be inspected.
        assert_eq!(bench.plan.counts().culled, 2);
        let depth = look(&bench, &mut inspector, "both")?;
        let ids = look(&bench, &mut inspector, "ids")?;
        look(&bench, &mut inspector, "volume:0:3")?;
        let Bench { executor, plan, frame, imports, .. } = &bench;
        let request = framegraph_wgpu::inspect::Request {
            aspect: Aspect::Stencil,
            ..framegraph_wgpu::inspect::Request::newest("both")
        };
        let stencil = inspector.inspect(executor, plan, frame, &(), imports, &request)?;
        if drawn {
            assert!(depth.texels.numbers().iter().all(|n| n[0] == 0.75));
            assert!(stencil.texels.bits.iter().all(|n| n[0] == 7));
            assert!(ids.texels.bits.iter().all(|n| n[0] == 4_000_000_000));
        }
        // Levels of version 1 that only later passes write.
        let message = refused(&bench, &mut inspector, "pyramid@v1:1");
        assert!(message.contains("cannot be inspected there"), "{message}");
        for (request, part) in [("pyramid:2", "no level 2; it has levels 0 to 1"), ("pyramid:0:3", "layers 0 to 2")] {
            let message = refused(&bench, &mut inspector, request);
            assert!(message.contains(part), "{message}");
        }
        Ok(())
    })
}

#[test]
fn inspection_does_not_change_imports() -> TestResult {
    on_every_device("inspection_does_not_change_imports", |gpu, drawn| {
        let mut bench = Bench::new(gpu, SIDE, SIDE);
        let mine = bench.declare(|frame| {
            let desc = TextureDesc::new(Extent::FRAME, Format::Rgba16Float);
            let mine = frame.graph_mut().import_texture("mine", desc, Entry::Defined, Exit::Keep);
            let add = wgpu::BlendComponent {
                src_factor: wgpu::BlendFactor::One,
                dst_factor: wgpu::BlendFactor::One,
                operation: wgpu::BlendOperation::Add,
            };
            let more = move |_: &Texture, (): &(), cx: &mut framegraph_wgpu::Cx<'_>| {
                let blend = Some(wgpu::BlendState { color: add, alpha: add });
                let colors = [framegraph_wgpu::Output { blend, ..framegraph_wgpu::Output::REPLACE }];
                fill(cx, &Raster { vertex: "full", colors: &colors, ..Raster::new(FILL) }, [1.0; 4], 0.0)
            };
            frame.add_fn("more", |p| p.color(mine, Intent::Modify), more)
        })?;
        let uses = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let texture = |usage| {
            gpu.device.create_texture(&texture_2d("mine", [SIDE, SIDE], wgpu::TextureFormat::Rgba16Float, usage))
        };
        let image = texture(uses | wgpu::TextureUsages::COPY_SRC);
        bench.imports.texture(mine, &image);
        let mut inspector = Inspector::new(gpu);
        for frame in 0..3 {
            bench.execute()?;
            let seen = look(&bench, &mut inspector, "mine")?;
            let entry = look(&bench, &mut inspector, "mine@v0")?;
            if drawn {
                let done = frame as f32 + 1.0;
                assert_eq!(read_texture(gpu, &image)?.rgba()[9], [done; 4], "added to once a frame");
                assert_eq!(seen.texels.numbers()[9], [done + 1.0; 4], "the frame to come");
                assert_eq!(entry.texels.numbers()[9], [done; 4]);
            }
        }
        bench.imports.clear();
        bench.imports.texture(mine, &texture(uses));
        let message = refused(&bench, &mut inspector, "mine");
        assert!(
            message.contains("writes the import `mine`") || message.contains("write the import `mine`"),
            "{message}"
        );
        Ok(())
    })
}

/// A history that counts frames. The inspection shows the next frame, and does not advance the history.
#[test]
fn inspection_shows_histories_of_the_next_frame() -> TestResult {
    let declare = |frame: &mut Frame| {
        let desc = TextureDesc::new(Extent::FRAME, Format::Rgba16Float);
        let history = frame.graph_mut().history("count", desc, 1);
        let earlier = frame.graph_mut().previous(history, 1)?;
        const NEXT: framegraph_wgpu::Shader<'static> = framegraph_wgpu::Shader::new(
            "next",
            "@group(0) @binding(0) var earlier: texture_2d<f32>;
             @vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
               return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.5, 1.0);
             }
             @fragment fn fs_main() -> @location(0) vec4f { return textureLoad(earlier, vec2u(), 0) + 1.0; }",
        );
        let declare =
            |p: &mut framegraph::PassBuilder<'_>| Ok((p.sampled(earlier)?, p.color(history, Intent::Overwrite)?));
        let (_, current) = frame.add_fn("next", declare, |(view, _), (), cx| draw_of(cx, &Raster::new(NEXT), *view))?;
        frame.graph_mut().export(current)?;
        Ok(current)
    };
    on_every_device("inspection_shows_histories_of_the_next_frame", |gpu, drawn| {
        let mut bench = Bench::new(gpu, SIDE, SIDE);
        let mut inspector = Inspector::new(gpu);
        for frame in 1..5u8 {
            let current = bench.run(declare)?;
            let (next, earlier) = (look(&bench, &mut inspector, "count")?, look(&bench, &mut inspector, "count@-1")?);
            if drawn {
                let count = f32::from(frame);
                assert_eq!(bench.pixels(current)?.rgba()[0][0], count, "frame {frame}");
                assert_eq!((next.texels.numbers()[0][0], earlier.texels.numbers()[0][0]), (count + 1.0, count));
            }
            assert_eq!(bench.executor.objects().histories, 2);
        }
        Ok(())
    })
}

#[test]
fn missing_names_list_existing_ones() -> TestResult {
    on_every_device("missing_names_list_existing_ones", |gpu, _| {
        let mut bench = Bench::new(gpu, SIDE, SIDE);
        bench.run(|f| {
            let buffer = f.graph_mut().buffer("sums", 64);
            let clear = Intent::Clear(ClearValue::Zero);
            let kind = framegraph::AccessKind::StorageWrite;
            let buffer = f.add_fn("sum", |p| p.write_buffer(buffer, kind, clear), |_, (), _| Ok(()))?;
            f.graph_mut().export_buffer(buffer)?;
            declare(f, 1)
        })?;
        let mut inspector = Inspector::new(gpu);
        let cases = [
            ("hbr", "there is no texture `hbr`; the frame has `depth`, `hdr`, `out`"),
            ("hdr@v7", "`hdr` has no version v7; it has v1 (`scene`)"),
            ("hdr@v0", "`hdr` has no version v0; it has v1 (`scene`)"),
            ("sums", "`sums` is a buffer"),
        ];
        for (request, expected) in cases {
            let message = refused(&bench, &mut inspector, request);
            assert!(message.contains(expected), "{message}");
        }
        let all: Vec<_> = all_targets(&bench.plan).iter().map(|s| s.title()).collect();
        assert_eq!(all, ["depth@scene", "hdr@scene", "out@grade"]);
        Ok(())
    })
}

/// A texture that is drawn into three times: its contents before the first step and after each step.
#[test]
fn steps_select_the_contents_after_them() -> TestResult {
    on_every_device("steps_select_the_contents_after_them", |gpu, drawn| {
        let mut bench = Bench::new(gpu, SIDE, SIDE);
        bench.options.merge = false;
        bench.run(|frame| {
            let desc = TextureDesc::new(Extent::FRAME, Format::Rgba16Float);
            let other = frame.graph_mut().texture("other", desc);
            let other = frame.add_fn("first", |p| p.color(other, Intent::Overwrite), |_, (), cx| fill_full(cx, RED))?;
            let sum = frame.graph_mut().texture("sum", desc);
            let mut sum =
                frame.add_fn("s9", |p| p.color(sum, Intent::Overwrite), |_, (), cx| fill_full(cx, [1.0; 4]))?;
            for value in [2.0, 3.0] {
                let over = move |_: &Texture, (): &(), cx: &mut framegraph_wgpu::Cx<'_>| fill_full(cx, [value; 4]);
                sum = frame.add_fn("over", |p| p.color(sum, Intent::Modify), over)?;
            }
            frame.graph_mut().export(sum)?;
            frame.graph_mut().export(other)?;
            Ok(())
        })?;
        assert_eq!(bench.plan.steps().len(), 4);
        let mut inspector = Inspector::new(gpu);
        let message = refused(&bench, &mut inspector, "sum@s0");
        assert!(
            message.contains("`sum` has no version at step 0 of 4; it has v1 (`s9`), v2 (`over`), v3 (`over`)"),
            "{message}"
        );
        for (request, number) in
            [("sum@s1", 1), ("sum@s2", 2), ("sum@s3", 3), ("sum@s9", 1), ("sum@over", 3), ("sum@v2", 2)]
        {
            let seen = look(&bench, &mut inspector, request)?;
            assert_eq!(seen.target.number, number, "{request}");
            assert!(!drawn || seen.texels.numbers()[0][0] == number as f32, "{request}");
        }
        Ok(())
    })
}
