//! Single raster passes: cleared, overwritten, depth tested, attached to other levels and layers.

use crate::bench::{
    Bench, FILL, GREEN, RED, SHOW_DEPTH, TestResult, draw, draw_of, fill, fill_corner, fill_full, on_every_device, skip,
};
use framegraph::{ClearValue, Extent, Format, Intent, TextureDesc};
use framegraph_wgpu::{Depth, Gpu, Raster, Readback, Shader, Subresource};

const BLUE: ClearValue = ClearValue::Color([0.0, 0.0, 1.0, 1.0]);

#[test]
fn a_triangle_on_a_cleared_target() -> TestResult {
    on_every_device("a_triangle_on_a_cleared_target", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 64, 48);
        let color = bench.run(|frame| {
            let target = frame.graph_mut().texture("color", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
            let color =
                frame.add_fn("triangle", |p| p.color(target, Intent::Clear(BLUE)), |_, (), cx| fill_corner(cx, RED))?;
            frame.graph_mut().readback(color)?;
            Ok(color)
        })?;
        let counts = bench.plan.counts();
        assert_eq!((counts.clears, counts.resolves, counts.unresolves), (1, 1, 0));
        if drawn {
            let pixels = bench.pixels(color)?;
            assert_eq!(pixels.at(0, 47), Some([255, 0, 0, 255].as_slice()), "lower left: drawn");
            assert_eq!(pixels.at(63, 0), Some([0, 0, 255, 255].as_slice()), "upper right: cleared");
        }
        Ok(())
    })
}

#[test]
fn an_overwritten_target_is_not_loaded() -> TestResult {
    on_every_device("an_overwritten_target_is_not_loaded", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 32, 32);
        for color in [RED, GREEN] {
            let target = bench.run(|frame| {
                let target = frame.graph_mut().texture("color", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
                let target = frame.add_fn(
                    "full",
                    |p| p.color(target, Intent::Overwrite),
                    move |_, (), cx| fill_full(cx, color),
                )?;
                frame.graph_mut().readback(target)?;
                Ok(target)
            })?;
            let counts = bench.executor.executed();
            assert_eq!((counts.clears, counts.unresolves, counts.resolves), (0, 0, 1), "don't care, then stored");
            if drawn {
                let expected = color.map(|c| (c * 255.0) as u8);
                assert!(bench.pixels(target)?.bytes.chunks_exact(4).all(|t| t == expected));
            }
        }
        assert_eq!(bench.executor.objects().textures, 1, "both frames draw into one texture");
        Ok(())
    })
}

#[test]
fn reversed_depth_is_tested_and_discarded() -> TestResult {
    on_every_device("reversed_depth_is_tested_and_discarded", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 16, 16);
        let color = bench.run(|frame| {
            let color = frame.graph_mut().texture("color", TextureDesc::new(Extent::FRAME, Format::Rgba16Float));
            let depth =
                frame.graph_mut().texture("depth", TextureDesc::new(Extent::FRAME, Format::Depth32FloatStencil8));
            let declare = |p: &mut framegraph::PassBuilder<'_>| {
                p.depth(depth, Intent::Clear(ClearValue::FAR_REVERSED))?;
                p.color(color, Intent::Clear(BLUE))
            };
            let color = frame.add_fn("near then far", declare, |_, (), cx| {
                let raster = |vertex| Raster { vertex, depth: Depth::NEARER, ..Raster::new(FILL) };
                fill(cx, &raster("corner"), RED, 0.75)?;
                fill(cx, &raster("full"), GREEN, 0.25)
            })?;
            frame.graph_mut().readback(color)?;
            Ok(color)
        })?;
        let counts = bench.executor.executed();
        assert_eq!((counts.memoryless, counts.discards, counts.clears), (1, 1, 2));
        if drawn {
            let rgba = bench.pixels(color)?.rgba();
            assert_eq!((rgba[15 * 16], rgba[15]), (RED, GREEN), "the farther green does not cover the nearer red");
        }
        Ok(())
    })
}

#[test]
fn depth_is_tested_read_only_and_sampled_in_one_step() -> TestResult {
    on_every_device("depth_is_tested_read_only_and_sampled_in_one_step", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 16, 16);
        let color = bench.declare(|frame| {
            let graph = frame.graph_mut();
            let color = graph.texture("color", TextureDesc::new(Extent::FRAME, Format::Rgba16Float));
            let depth = graph.texture("depth", TextureDesc::new(Extent::FRAME, Format::Depth32Float));
            let depth = frame.add_fn(
                "prepass",
                |p| p.depth(depth, Intent::Clear(ClearValue::FAR_REVERSED)),
                |_, (), cx| {
                    fill(
                        cx,
                        &Raster { vertex: "corner", fragment: None, depth: Depth::NEARER, ..Raster::new(FILL) },
                        RED,
                        0.25,
                    )
                },
            )?;
            let declare = |p: &mut framegraph::PassBuilder<'_>| {
                p.depth_read_only(depth)?;
                Ok((p.sampled(depth)?, p.color(color, Intent::Clear(ClearValue::TRANSPARENT))?))
            };
            let (_, color) = frame.add_fn("show", declare, |(depth, _), (), cx| {
                let test = Depth { write: false, ..Depth::NEARER };
                draw_of(cx, &Raster { depth: test, ..Raster::new(SHOW_DEPTH) }, *depth)
            })?;
            frame.graph_mut().readback(color)?;
            Ok(color)
        })?;
        bench.executor.execute(&bench.plan, &bench.frame, &(), &bench.imports)?;
        let (planned, executed) = (bench.plan.counts(), bench.executor.executed());
        // Depth that is sampled while it is tested is read-only, and cannot be discarded.
        assert_eq!((planned, planned.discards), (executed, 0));
        if drawn {
            let rgba = bench.pixels(color)?.rgba();
            assert_eq!(
                (rgba[15 * 16][0], rgba[15][0]),
                (0.25, 0.0),
                "drawn where it is nearer than 0.25 and than the far plane"
            );
        }
        Ok(())
    })
}

#[test]
fn levels_and_layers_are_attached_alone() -> TestResult {
    on_every_device("levels_and_layers_are_attached_alone", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 16, 16);
        let texture = bench.run(|frame| {
            let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm).mips(2).layers(2);
            let mut texture = frame.graph_mut().texture("array", desc);
            for (mip, layer, color) in [(0, 0, RED), (0, 1, GREEN), (1, 0, GREEN), (1, 1, RED)] {
                let part = texture.mip(mip).layer(layer);
                let draw =
                    move |_: &framegraph::Texture, (): &(), cx: &mut framegraph_wgpu::Cx<'_>| fill_full(cx, color);
                texture = frame.add_fn("part", |p| p.color(part, Intent::Overwrite), draw)?;
            }
            frame.graph_mut().readback(texture)?;
            Ok(texture)
        })?;
        if drawn {
            let physical = bench.executor.texture(&bench.plan, texture).ok_or("no texture")?;
            let (red, green) = ([255, 0, 0, 255], [0, 255, 0, 255]);
            let side = |mip: u32| [16 >> mip; 2];
            for (mip, layer, color) in [(0, 0, red), (0, 1, green), (1, 0, green), (1, 1, red)] {
                let part = Subresource { mip, layer, ..Subresource::FIRST };
                let pixels = Readback::start(gpu, physical, part)?.wait(gpu)?;
                assert_eq!(pixels.texels, side(mip));
                assert!(pixels.bytes.chunks_exact(4).all(|t| t == color), "level {mip}, layer {layer}");
            }
        }
        Ok(())
    })
}

const VIEWS: Shader<'static> = Shader::new(
    "views",
    "@vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
       return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.0, 1.0);
     }
     @fragment fn fs_main(@builtin(position) at: vec4f, @builtin(view_index) view: u32) -> @location(0) vec4f {
       if at.x > 8.0 { discard; }
       return vec4f(1.0, f32(view), 0.0, 1.0);
     }",
);

/// Clears three layers to blue and draws over their left halves at once, in red, and also green in all but the first.
/// Returns the upper left and lower right texel of each layer.
fn three_layers(gpu: &Gpu) -> Result<Vec<[Option<Vec<u8>>; 2]>, Box<dyn std::error::Error>> {
    let mut bench = Bench::new(gpu, 16, 16);
    let texture = bench.run(|frame| {
        let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm).layers(3);
        let texture = frame.graph_mut().texture("layers", desc);
        let clear = Intent::Clear(ClearValue::Color([0.0, 0.0, 1.0, 1.0]));
        let draw =
            |_: &framegraph::Texture, (): &(), cx: &mut framegraph_wgpu::Cx<'_>| draw(cx, &Raster::new(VIEWS), &[]);
        let texture = frame.add_fn("views", |p| p.color(texture, clear), draw)?;
        frame.graph_mut().readback(texture)?;
        Ok(texture)
    })?;
    let physical = bench.executor.texture(&bench.plan, texture).ok_or("no texture")?;
    let corners = |layer| {
        let part = Subresource { layer, ..Subresource::FIRST };
        let pixels = Readback::start(gpu, physical, part)?.wait(gpu)?;
        Ok([(0, 0), (15, 15)].map(|(x, y)| pixels.at(x, y).map(<[u8]>::to_vec)))
    };
    (0..3).map(corners).collect()
}

const DRAWN: [[u8; 4]; 3] = [[255, 0, 0, 255], [255, 255, 0, 255], [255, 255, 0, 255]];

#[test]
fn several_layers_are_drawn_into_at_once() -> TestResult {
    let name = "several_layers_are_drawn_into_at_once";
    on_every_device(name, |gpu, drawn| {
        if gpu.max_attached_layers()? < 3 {
            let refused = three_layers(gpu).expect_err("the device does not draw into them").to_string();
            assert!(refused.contains("3 layers are attached at once"), "{refused}");
            return skip(name, &format!("{} does not draw into several layers at once", gpu.describe()));
        }
        let corners = three_layers(gpu)?;
        if !drawn {
            return Ok(());
        }
        for (layer, ([drawn, cleared], color)) in corners.iter().zip(DRAWN).enumerate() {
            let shown = (drawn.as_deref(), cleared.as_deref());
            assert_eq!(shown, (Some(color.as_slice()), Some([0, 0, 255, 255].as_slice())), "layer {layer}");
        }
        Ok(())
    })
}
