//! Textures and buffers that share one block of memory: contents, bytes, fallbacks, and what the validation layers say.

use crate::bench::{Bench, GREEN, RED, TestResult, fill_full, on_adapter, skip};
use framegraph::{Alias, ClearValue, DeclareError, Extent, Format, Intent, Placement, Plan, Scratch, Texture, TextureDesc};
use framegraph_wgpu::{Executor, Frame, Gpu, Imports, Raster, Shader, read_texture, wgpu};

/// Copies a picture texel by texel.
const COPY: Shader<'static> = Shader::new(
    "copy",
    "@group(0) @binding(0) var image: texture_2d<f32>;
     @vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
       return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.0, 1.0);
     }
     @fragment fn fs_main(@builtin(position) at: vec4f) -> @location(0) vec4f {
       return textureLoad(image, vec2u(at.xy), 0);
     }",
);

/// A chain of pictures of other sizes and formats: each lives in two steps, so the next but one can have its memory.
fn chain(frame: &mut Frame, length: u32) -> Result<Texture, DeclareError> {
    let formats = [Format::Rgba8Unorm, Format::Rgba16Float, Format::Rg11b10Ufloat, Format::Rgba32Float];
    let desc = |at: u32| TextureDesc::new(Extent::absolute(96 - at, 64 + at), formats[at as usize % 4]);
    let first = frame.graph_mut().texture("0", desc(0));
    let mut last = frame.add_fn("fill", |p| p.color(first, Intent::Overwrite), |_, (), cx| fill_full(cx, GREEN))?;
    for at in 1..=length {
        let next = frame.graph_mut().texture(&at.to_string(), desc(if at == length { 0 } else { at }));
        let declare = |p: &mut framegraph::PassBuilder<'_>| {
            let view = p.sampled(last)?;
            // Everything beside the copied texels is cleared.
            Ok((view, p.color(next, Intent::Clear(ClearValue::Color([1.0, 0.0, 0.0, 1.0])))?))
        };
        (_, last) = frame.add_fn("copy", declare, |_, (view, _): &(framegraph::View, Texture), cx| {
            let pipeline = cx.raster_pipeline(&Raster::new(COPY))?;
            let image = cx.view(*view)?;
            let group = cx.bind_group(pipeline.group(0), &[(0, image.into())]);
            let pass = cx.render_pass()?;
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.draw(0..3, 0..1);
            Ok(())
        })?;
    }
    frame.graph_mut().readback(last)?;
    Ok(last)
}
