//! The picture of the example `vulkan_post`: two subpasses on bare Vulkan, and one shader of the wgpu executor into which
//! the same post-processing is inlined.

#[path = "../../../vulkan/examples/vulkan_post/post.rs"]
#[allow(dead_code, reason = "the example prints more")]
mod post;

use crate::stage::gpu;
use framegraph::{ClearValue, Counts, Extent, Format, Intent, Options, Plan, Scratch, TextureDesc, compile};
use framegraph_vulkan::testing::{DeviceRequest, TestDevice};
use framegraph_wgpu::{
    Binding, Compute, Cx, Depth, Executor, Frame, Gpu, Imports, Raster, RecordError, Shader, read_texture,
};
use std::error::Error;
use tests::compare::compare;

/// A triangle that covers the picture if `REACH` is 4, and half of it if `REACH` is 2. Vulkan's clip space is flipped.
const VERTICES: &str = "
@vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
  return vec4f(f32(i & 1u) * REACH - 1.0, 1.0 - f32(i >> 1u) * REACH, 0.5, 1.0);
}
";

/// The color pass with the example's grading as its epilogue. `GAIN` is 1 except in the negative control.
const FUSED: &str = "
@fragment fn fs_fused(@builtin(position) at: vec4f) -> @location(0) vec4f {
  let color = GAIN * lit(at).xyz;
  return vec4f(color / (1.0 + color), 1.0);
}
";

const RASTER: Raster<'static> = Raster::new(Shader::new("post", ""));

/// Records a triangle.
fn draw(
    cx: &mut Cx<'_>,
    (reach, text): (&str, &str),
    raster: Raster<'static>,
    bound: &[(u32, Binding)],
) -> Result<(), RecordError> {
    let text = VERTICES.replace("REACH", reach) + text;
    let pipeline = cx.raster_pipeline(&Raster { shader: Shader::new("post", &text), ..raster })?;
    let group = (!bound.is_empty()).then(|| cx.bind_group(pipeline.group(0), bound));
    let pass = cx.render_pass()?;
    pass.set_pipeline(&pipeline);
    if let Some(group) = &group {
        pass.set_bind_group(0, group, &[]);
    }
    pass.draw(0..3, 0..1);
    Ok(())
}

/// Draws the frame of the example with the wgpu executor. Grading is inlined into the color pass, for each sample.
fn inlined(gpu: &Gpu, samples: u8, gain: &'static str) -> Result<(Vec<u8>, Counts), Box<dyn Error>> {
    let texture = |format| TextureDesc::new(Extent::FRAME, format);
    let mut frame = Frame::new();
    let graph = frame.graph_mut();
    let [depth, ao] = [("depth", Format::Depth32Float), ("ao", Format::R32Float)]
        .map(|(name, format)| graph.texture(name, texture(format)));
    let shadow = graph.texture("shadow", TextureDesc::new(Extent::absolute(16, 16), Format::R32Float));
    let hdr = graph.texture("hdr", texture(Format::Rgba16Float));
    let hdr_samples = graph.texture("hdr_samples", texture(Format::Rgba16Float).samples(samples));
    let picture = graph.texture("picture", texture(Format::Rgba8Unorm));
    let depth = frame.add_fn(
        "depth",
        |p| p.depth(depth, Intent::Clear(ClearValue::FAR_REVERSED)),
        |_, (), cx| {
            let compare = wgpu::CompareFunction::Always;
            draw(cx, ("4.0", post::DEPTH), Raster { depth: Depth { compare, ..Depth::NEARER }, ..RASTER }, &[])
        },
    )?;
    let (_, ao) = frame.add_fn(
        "ao",
        |p| Ok((p.sampled(depth)?, p.storage_write(ao, Intent::Overwrite)?)),
        |(depth, ao), (), cx| {
            let pipeline = cx.compute_pipeline(&Compute::new(Shader::new("ao", post::AO)))?;
            let bound = [(0, cx.view(*depth)?.into()), (1, cx.view_of(*ao)?.into())];
            let group = cx.bind_group(pipeline.group(0), &bound);
            let pass = cx.compute_pass()?;
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups(post::SIZE[0] / 8, post::SIZE[1] / 8, 1);
            Ok(())
        },
    )?;
    let shadow = frame.add_fn(
        "shadow",
        |p| p.color(shadow, Intent::Overwrite),
        |_, (), cx| draw(cx, ("4.0", post::SHADOW), RASTER, &[]),
    )?;
    let (_, _, hdr) = frame.add_fn(
        "color",
        |p| {
            p.takes_epilogue();
            let (ao, shadow, black) = (p.sampled(ao)?, p.sampled(shadow)?, Intent::Clear(ClearValue::BLACK));
            if samples == 1 {
                return Ok((ao, shadow, p.color(hdr, black)?));
            }
            let drawn = p.color(hdr_samples, black)?;
            Ok((ao, shadow, p.resolve(drawn, hdr)?))
        },
        move |(ao, shadow, _), (), cx| {
            if cx.inlined().count() != 1 {
                return Err(RecordError::custom("grading is not inlined"));
            }
            let bound = [(0, cx.view(*ao)?.into()), (1, cx.view(*shadow)?.into())];
            // Entry points cannot be called.
            let color = post::COLOR
                .replace("@fragment fn fs_main(@builtin(position) at: vec4f) -> @location(0)", "fn lit(at: vec4f) ->");
            let text = color + &FUSED.replace("GAIN", gain);
            draw(cx, ("2.0", &text), Raster { fragment: Some("fs_fused"), ..RASTER }, &bound)
        },
    )?;
    let picture = frame.add_fn(
        "grade",
        |p| {
            p.pointwise();
            p.same_pixel(hdr)?;
            p.color(picture, Intent::Overwrite)
        },
        |_, (), _| Err(RecordError::custom("grading is inlined")),
    )?;
    frame.graph_mut().readback(picture)?;
    let (mut plan, mut executor) = (Plan::new(), Executor::new(gpu));
    let options = Options::for_frame(post::SIZE[0], post::SIZE[1]);
    compile(frame.graph(), &gpu.caps(), &options, &mut Scratch::new(), &mut plan)?;
    executor.execute(&plan, &frame, &(), &Imports::new())?;
    let texture = executor.texture(&plan, picture).ok_or("the picture is exported")?;
    Ok((read_texture(gpu, texture)?.bytes, plan.counts()))
}

#[test]
fn subpasses_on_vulkan_draw_the_inlined_picture_of_wgpu() -> Result<(), Box<dyn Error>> {
    let test = "subpasses_on_vulkan_draw_the_inlined_picture_of_wgpu";
    let Some(gpu) = gpu(test) else { return Ok(()) };
    let device = match TestDevice::open(DeviceRequest { layers: false, ..DeviceRequest::default() }) {
        Ok(device) => device,
        Err(error) => {
            test_report::skip(test, &format!("the program needs a Vulkan device: {error}"));
            return Ok(());
        }
    };
    for samples in [1, 4] {
        let vulkan = post::run(&device, samples)?;
        let (fused, counts) = inlined(&gpu, samples, "1.0")?;
        assert_eq!((vulkan.subpasses, counts.inlined), (2, 1), "{samples} samples");
        let difference = compare(&vulkan.pixels, &fused).ok_or("two pictures")?;
        assert!(difference.largest_codes <= 1, "{samples} samples: {difference:?}");
        let wrong = compare(&vulkan.pixels, &inlined(&gpu, samples, "1.05")?.0).ok_or("two pictures")?;
        assert!(wrong.largest_codes > 1, "the control, five percent brighter: {wrong:?}");
    }
    Ok(())
}
