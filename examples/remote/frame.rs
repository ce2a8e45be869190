//! The frame: a pattern that turns, bright parts of it at half the size, and their sum.

use framegraph::{ClearValue, DeclareError, Extent, Format, Intent, Texture, TextureDesc, View};
use framegraph_wgpu::{Binding, Cx, Frame, Imports, Raster, RecordError, Shader};

/// World of the recorders.
#[derive(Clone, Copy, Debug)]
pub struct Blur {
    /// Angle of the pattern in radians.
    pub angle: f32,
}

const VERTEX: &str = "
@vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.0, 1.0);
}";
const PATTERN: &str = "
@group(0) @binding(0) var<uniform> angle: f32;
@fragment fn fs_main(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let turned = dot(at.xy, vec2f(cos(angle), sin(angle))) * 0.05;
    return vec4f(sin(turned) + 1.0, sin(turned * 0.5) + 1.0, 0.5, 1.0);
}";
const BRIGHT: &str = "
@group(0) @binding(0) var image: texture_2d<f32>;
@fragment fn fs_main(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let first = vec2u(at.xy) * 2;
    let sum = textureLoad(image, first, 0) + textureLoad(image, first + 1, 0);
    return max(sum * 0.5 - 1.0, vec4f());
}";
const SUM: &str = "
@group(0) @binding(0) var image: texture_2d<f32>;
@group(0) @binding(1) var bright: texture_2d<f32>;
@fragment fn fs_main(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let first = vec2u(at.xy);
    let half = min(first / 2, textureDimensions(bright) - 1);
    let color = textureLoad(image, first, 0) + textureLoad(bright, half, 0);
    return color / (color + 1.0);
}";

/// Declares the frame.
///
/// # Errors
/// Fails if a declaration is invalid.
pub fn declare(frame: &mut Frame<Blur>, _: &mut Imports) -> Result<Texture, DeclareError> {
    let desc = |extent, format| TextureDesc::new(extent, format);
    let hdr = frame.graph_mut().texture("hdr", desc(Extent::FRAME, Format::Rgba16Float));
    let clear = Intent::Clear(ClearValue::BLACK);
    let hdr = frame.add_fn(
        "pattern",
        |pass| pass.color(hdr, clear),
        |_, world, cx| draw(cx, "pattern", PATTERN, &[], *world),
    )?;
    let half = frame.graph_mut().texture("bloom/half", desc(Extent::fraction(2), Format::Rgba16Float));
    let bright =
        |pass: &mut framegraph::PassBuilder<'_>| Ok((pass.sampled(hdr)?, pass.color(half, Intent::Overwrite)?));
    let (_, half) =
        frame.add_fn("bloom/bright", bright, |(hdr, _), world, cx| draw(cx, "bright", BRIGHT, &[*hdr], *world))?;
    let shown = frame.graph_mut().texture("shown", desc(Extent::FRAME, Format::Rgba8Unorm));
    let sum = |pass: &mut framegraph::PassBuilder<'_>| {
        Ok((pass.sampled(hdr)?, pass.sampled(half)?, pass.color(shown, Intent::Overwrite)?))
    };
    let record = |(hdr, half, _): &(View, View, Texture), world: &Blur, cx: &mut Cx<'_>| {
        draw(cx, "sum", SUM, &[*hdr, *half], *world)
    };
    let (_, _, shown) = frame.add_fn("sum", sum, record)?;
    frame.graph_mut().export(shown)?;
    Ok(shown)
}

/// Draws a full-screen triangle that reads images; without images, the angle.
fn draw(cx: &mut Cx<'_>, name: &str, fragment: &str, images: &[View], world: Blur) -> Result<(), RecordError> {
    let text = format!("{fragment}{VERTEX}");
    let pipeline = cx.raster_pipeline(&Raster::new(Shader::new(name, &text)))?;
    let mut bindings: Vec<(u32, Binding)> = Vec::new();
    if images.is_empty() {
        bindings.push((0, cx.uniform(&[world.angle, 0.0, 0.0, 0.0])));
    }
    for (slot, image) in (0..).zip(images) {
        bindings.push((slot, cx.view(*image)?.into()));
    }
    let group = cx.bind_group(pipeline.group(0), &bindings);
    let pass = cx.render_pass()?;
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.draw(0..3, 0..1);
    Ok(())
}
