//! Copy passes, and aliased textures with linear and sRGB formats.

use crate::bench::{Bench, RED, SHOW, TestResult, draw_of, fill_full, on_every_device};
use framegraph::{Aspect, ClearValue, Extent, Format, Intent, TextureDesc};
use framegraph_wgpu::{Raster, Readback, Subresource};

#[test]
fn a_copy_equals_its_source() -> TestResult {
    on_every_device("a_copy_equals_its_source", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 8, 8);
        let copy = bench.run(|frame| {
            let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
            let source = frame.graph_mut().texture("source", desc);
            let source =
                frame.add_fn("draw", |p| p.color(source, Intent::Overwrite), |_, (), cx| fill_full(cx, RED))?;
            let copy = frame.graph_mut().texture("copy", desc);
            let declare = |p: &mut framegraph::PassBuilder<'_>| {
                Ok((p.copy_source(source)?, p.copy_target(copy, Intent::Overwrite)?))
            };
            let (_, copy) = frame.add_fn("copy", declare, |(from, to), (), cx| {
                let (from, to) = (cx.texture(*from)?, cx.texture_of(*to)?);
                cx.encoder()?.copy_texture_to_texture(from.as_image_copy(), to.as_image_copy(), from.size());
                Ok(())
            })?;
            frame.graph_mut().readback(copy)?;
            Ok(copy)
        })?;
        assert_eq!(bench.executor.unused_accesses(&bench.plan).count(), 0);
        if drawn {
            assert!(bench.pixels(copy)?.bytes.chunks_exact(4).all(|t| t == [255, 0, 0, 255]));
        }
        Ok(())
    })
}

#[test]
fn linear_and_srgb_textures_share_memory() -> TestResult {
    on_every_device("linear_and_srgb_textures_share_memory", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 8, 8);
        let out = bench.run(|frame| {
            let mut shown = None;
            // Formats alternate between linear and sRGB. The first texture is dead when the third is written, and each
            // reads its predecessor.
            for format in [Format::Rgba8Unorm, Format::Rgba8UnormSrgb, Format::Rgba8Unorm, Format::Rgba16Float] {
                let target = frame.graph_mut().texture("stage", TextureDesc::new(Extent::FRAME, format));
                let before: Option<framegraph::Texture> = shown;
                let declare = |p: &mut framegraph::PassBuilder<'_>| {
                    let view = before.map(|b| p.sampled(b)).transpose()?;
                    Ok((view, p.color(target, Intent::Overwrite)?))
                };
                let (_, texture) = frame.add_fn("stage", declare, |(view, _), (), cx| {
                    let Some(view) = view else {
                        return fill_full(cx, [0.5, 0.25, 1.0, 1.0]);
                    };
                    draw_of(cx, &Raster::new(SHOW), *view)
                })?;
                shown = Some(texture);
            }
            let out = shown.ok_or_else(|| unreachable!("four stages were added"))?;
            frame.graph_mut().readback(out)?;
            Ok(out)
        })?;
        if drawn {
            // Each stage keeps the value except for 8-bit rounding. The error is at most half a step per stage, and up
            // to one step where the sRGB curve is steep.
            let rgba = bench.pixels(out)?.rgba();
            for (got, expected) in rgba[0].into_iter().zip([0.5, 0.25, 1.0, 1.0]) {
                assert!((got - expected).abs() < 2.0 / 255.0, "{:?}", rgba[0]);
            }
        }
        Ok(())
    })
}

#[test]
fn a_storage_texture_serves_its_srgb_form() -> TestResult {
    const STORE: framegraph_wgpu::Shader<'static> = framegraph_wgpu::Shader::new(
        "store",
        "@group(0) @binding(0) var image: texture_storage_2d<rgba8unorm, write>;
         @compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) at: vec3u) { textureStore(image, at.xy, vec4f(1.0)); }",
    );
    let storage = |frame: &mut framegraph_wgpu::Frame, desc: TextureDesc| {
        let image = frame.graph_mut().texture("image", desc);
        frame.add_fn(
            "store",
            |p| p.storage_write(image, Intent::Overwrite),
            |image: &framegraph::Texture, (), cx| {
                let pipeline = cx.compute_pipeline(&framegraph_wgpu::Compute::new(STORE))?;
                let view = cx.view_of(*image)?;
                let group = cx.bind_group(pipeline.group(0), &[(0, view.into())]);
                let pass = cx.compute_pass()?;
                pass.set_pipeline(&pipeline);
                pass.set_bind_group(0, &group, &[]);
                pass.dispatch_workgroups(1, 1, 1);
                Ok(())
            },
        )
    };
    on_every_device("a_storage_texture_serves_its_srgb_form", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 8, 8);
        let linear = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
        // `with_storage` first puts a storage texture into the memory that the sRGB texture uses in both frames.
        for with_storage in [true, false] {
            let out = bench.run(|frame| {
                if with_storage {
                    let image = storage(frame, linear)?;
                    let sink = frame.graph_mut().buffer("sink", 8 * 256);
                    let declare = |p: &mut framegraph::PassBuilder<'_>| {
                        Ok((
                            p.copy_source(image)?,
                            p.write_buffer(sink, framegraph::AccessKind::CopyTarget, Intent::Overwrite)?,
                        ))
                    };
                    let (_, sink) = frame.add_fn("sink", declare, |(from, to), (), cx| {
                        let (from, to) = (cx.texture(*from)?, cx.buffer_of(*to)?);
                        let layout =
                            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(256), rows_per_image: None };
                        let to = wgpu::TexelCopyBufferInfo { buffer: &to.buffer, layout };
                        cx.encoder()?.copy_texture_to_buffer(from.as_image_copy(), to, from.size());
                        Ok(())
                    })?;
                    frame.graph_mut().export_buffer(sink)?;
                }
                let image = frame.graph_mut().texture("image", linear.format(Format::Rgba8UnormSrgb));
                let image =
                    frame.add_fn("draw", |p| p.color(image, Intent::Overwrite), |_, (), cx| fill_full(cx, RED))?;
                let copy = frame.graph_mut().texture("copy", linear.format(Format::Rgba8UnormSrgb));
                let declare =
                    |p: &mut framegraph::PassBuilder<'_>| Ok((p.sampled(image)?, p.color(copy, Intent::Overwrite)?));
                let (_, copy) =
                    frame.add_fn("copy", declare, |(from, _), (), cx| draw_of(cx, &Raster::new(SHOW), *from))?;
                frame.graph_mut().readback(copy)?;
                Ok(copy)
            })?;
            if drawn {
                assert_eq!(bench.pixels(out)?.at(3, 3), Some([255, 0, 0, 255].as_slice()));
            }
        }
        // With view formats, one texture serves the linear and the sRGB form, and one is the copy.
        let images = if gpu.has_view_formats() { 2 } else { 3 };
        assert_eq!(bench.executor.objects().textures, images);
        Ok(())
    })
}

#[test]
fn one_plane_is_cleared_by_a_copy_pass() -> TestResult {
    on_every_device("one_plane_is_cleared_by_a_copy_pass", |gpu, drawn| {
        let zero = (Aspect::Stencil, ClearValue::Zero, 0.25, 0);
        let far = (Aspect::Depth, ClearValue::FAR, 1.0, 7);
        for (aspect, value, depth, stencil) in [zero, far, (Aspect::All, ClearValue::DepthStencil(0.5, 3), 0.5, 3)] {
            let mut bench = Bench::new(gpu, 8, 8);
            let planes = bench.run(|frame| {
                let desc = TextureDesc::new(Extent::FRAME, Format::Depth32FloatStencil8);
                let planes = frame.graph_mut().texture("planes", desc);
                let both = Intent::Clear(ClearValue::DepthStencil(0.25, 7));
                let planes = frame.add_fn("both", |p| p.depth(planes, both), |_, (), _| Ok(()))?;
                let clear =
                    |p: &mut framegraph::PassBuilder<'_>| p.copy_target(planes.aspect(aspect), Intent::Clear(value));
                let planes = frame.add_fn("clear", clear, |_, (), _| Ok(()))?;
                frame.graph_mut().readback(planes)?;
                Ok(planes)
            })?;
            if drawn {
                let physical = bench.executor.texture(&bench.plan, planes).ok_or("no texture")?;
                let read = |aspect| Readback::start(gpu, physical, Subresource { aspect, ..Subresource::FIRST });
                assert_eq!(read(Aspect::Depth)?.wait(gpu)?.depth(), Some(vec![depth; 64]), "{aspect:?}");
                assert!(read(Aspect::Stencil)?.wait(gpu)?.bytes.iter().all(|s| *s == stencil), "{aspect:?}");
            }
        }
        Ok(())
    })
}
