//! Reference for inlining with four samples: stores every sample, reads each back, grades it, rounds it to the target's
//! 8 bits, and averages.

use super::{TestResult, apart, graded, rounding_of};
use crate::stage::{Set, Shot, gpu};
use framegraph::{DeclareError, Extent, Format, Intent, Target, Texture, TextureDesc, View};
use framegraph_passes::effects::color::Color;
use framegraph_passes::effects::depth::prepass::Prepass;
use framegraph_passes::effects::post::Post;
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::{PostSettings, Settings, World};
use framegraph_shader_mirrors::grade::Grade;
use framegraph_shaders::layout::{EncodingUniforms, ExposureUniforms, GradingUniforms, VignetteUniforms};
use framegraph_shaders::{Features, Module, resolve};
use framegraph_wgpu::Frame;
use framegraph_wgpu::{Constants, Cx, Raster, RecordError, Shader};
use tests::compare::{Difference, compare};

/// The target's transfer function is inverted for the average, as on a device with an sRGB target.
const PER_SAMPLE: &str = "
import package::effect::expose::expose;
import package::effect::vignette::vignette;
import package::effect::grade::grade;
import package::effect::tone::tone;
import package::effect::encode::encode;
import package::lib::fullscreen::fullscreen_position;
import package::lib::srgb::{linear_from_srgb, srgb_from_linear};

override TARGET_IS_SRGB: bool = true;

@group(0) @binding(0) var samples: texture_multisampled_2d<f32>;

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    return fullscreen_position(vertex, 0.0);
}

fn stored(color: vec4<f32>) -> vec4<f32> {
    if TARGET_IS_SRGB {
        let code = round(srgb_from_linear(color.rgb) * 255.0) / 255.0;
        return vec4<f32>(linear_from_srgb(code), color.a);
    }
    return round(color * 255.0) / 255.0;
}

@fragment
fn fs_main(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    var sum = vec4<f32>(0.0);
    for (var i = 0; i < 4; i++) {
        let at = position.xy;
        let lit = grade(vignette(expose(textureLoad(samples, vec2<i32>(at), i), at), at), at);
        sum += stored(encode(tone(lit, at), at));
    }
    return sum * 0.25;
}
";

/// Declares the frame up to the samples, then the passes of `end`.
fn declared(
    end: impl FnOnce(&mut Frame<World>, Texture, Texture) -> Result<Texture, DeclareError>,
) -> Result<(Frame<World>, Texture), DeclareError> {
    let mut frame = Frame::new();
    let depth = frame.add("prepass", Prepass { samples: 4, ..Prepass::default() })?;
    let color = Color { samples: 4, ..Color::new(depth) };
    let color = frame.add("color", color)?;
    let output = end(&mut frame, color.hdr, color.samples)?;
    frame.graph_mut().readback(output)?;
    Ok((frame, output))
}

fn judge(post: PostSettings, target: Format) -> Result<(Frame<World>, Texture), Box<dyn std::error::Error>> {
    let shader = resolve(&Module::new("per_sample.wgsl", PER_SAMPLE), &Features::NONE, &[])?;
    let bound = shader.reflection.entry_point("fs_main").ok_or("fs_main")?.bindings.clone();
    let text = shader.wgsl;
    let frame = declared(|frame, _, samples| {
        let declare = |pass: &mut framegraph::PassBuilder<'_>| {
            let samples = pass.sampled(samples)?;
            let output = pass.texture("output", TextureDesc::new(Extent::FRAME, target));
            Ok((samples, pass.color(output, Intent::Overwrite)?))
        };
        let record = move |io: &(View, Texture), world: &World, cx: &mut Cx<'_>| -> Result<(), RecordError> {
            let flag = |on: bool| f64::from(u8::from(on));
            let constants = [
                ("TONE_MAP", f64::from(post.look.tone_map.number().unwrap_or_default())),
                ("OUTPUT_ENCODED", flag(!target.is_srgb())),
                ("LUMA_IN_ALPHA", flag(!target.is_srgb())),
                ("TARGET_IS_SRGB", flag(target.is_srgb())),
            ];
            let shader = Shader::new("per_sample", &text);
            let pipeline = cx.raster_pipeline(&Raster { constants: Constants(&constants), ..Raster::new(shader) })?;
            let bindings = [
                ("samples", cx.view(io.0)?.into()),
                ("exposing", cx.uniform(&ExposureUniforms::new(post.compensation_ev))),
                ("grading", cx.uniform(&GradingUniforms::new(&Grade::new(&post.look.grading, true)))),
                ("vignetting", cx.uniform(&VignetteUniforms::new(cx.frame_texels(), post.vignette_ev))),
                ("encoding", cx.uniform(&EncodingUniforms::new(post.dither, world.frame_index.0))),
            ];
            let number = |name: &str| bound.iter().find(|b| b.name == name).map_or(u32::MAX, |b| b.binding);
            let group = cx.bind_group(pipeline.group(0), &bindings.map(|(name, binding)| (number(name), binding)));
            let pass = cx.render_pass()?;
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.draw(0..3, 0..1);
            Ok(())
        };
        Ok(frame.add_fn("judge", declare, record)?.1)
    });
    Ok(frame?)
}

/// The average of four values may round up or down: one step. An sRGB target may have an encoding error of 0.6 steps
/// (Vulkan's tolerance): one step per stored sample, and one for the stored average.
const fn max_steps(target: Format) -> u8 {
    if target.is_srgb() { 2 } else { 1 }
}

#[test]
fn with_four_samples_each_is_graded_before_the_average() -> TestResult {
    let Some(gpu) = gpu("with_four_samples_each_is_graded_before_the_average") else { return Ok(()) };
    let stored = Some(rounding_of(&gpu)?);
    let settings = Settings { shadows: None, ..graded(4, false) };
    let shot = Shot::small(settings);
    for (scene, target) in [("spheres", Format::Rgba8UnormSrgb), ("columns", Format::Rgba8Unorm)] {
        let set = Set::new(&gpu, scene, &shot, &Background::Environment)?;
        let (frame, output) = judge(settings.post, target)?;
        let (expected, plan) = set.render(&gpu, &frame, output, &shot.options)?;
        assert_eq!(plan.counts().inlined, 0);

        let (frame, output) = declared(|frame, hdr, _| {
            let (into, for_fxaa) = (Target::New, !target.is_srgb());
            Ok(frame
                .add("post", Post { hdr, bloom: None, into, settings: settings.post, only: None, for_fxaa, stored })?
                .ldr)
        })?;
        let against = |options| -> Result<(Difference, u32), Box<dyn std::error::Error>> {
            let (picture, plan) = set.render(&gpu, &frame, output, options)?;
            Ok((compare(&picture, &expected).ok_or("two pictures")?, plan.counts().inlined))
        };
        let (inlined, count) = against(&shot.options)?;
        println!("{scene}: each sample graded: {inlined:?}");
        assert_eq!(count, 1);
        assert!(inlined.largest_codes <= max_steps(target), "{scene}: {inlined:?}");
        // Negative control: grading after the average changes edges between surfaces of different brightness.
        let (two, count) = against(&apart(&shot).options)?;
        println!("{scene}: graded after the average: {two:?}");
        assert_eq!(count, 0);
        assert!(two.largest_codes > 4 * max_steps(target), "{scene}: {two:?}");
    }
    Ok(())
}
