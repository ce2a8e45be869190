//! Passes recorded with only the parts that they use: post-processing and FXAA on an uploaded picture, and the scene
//! copy on an uploaded depth. There is no scene, table or light.

use crate::stage::gpu;
use framegraph::{
    ClearValue, DeclareError, Entry, Exit, Extent, Format, Intent, Options, Plan, Scratch, Target, Texture,
    TextureDesc, compile,
};
use framegraph_passes::effects::depth::resolve::{DepthOf, DepthResolve};
use framegraph_passes::effects::fxaa::Fxaa;
use framegraph_passes::effects::post::Post;
use framegraph_passes::effects::transmission::{SceneCopy, SceneLevel};
use framegraph_passes::gpu_scene::view::Views;
use framegraph_passes::grading::{GradingTables, Look};
use framegraph_passes::program::Programs;
use framegraph_passes::{CameraView, FrameIndex, PostSettings, ViewId, ViewSettings};
use framegraph_scene::{Camera, Projection};
use framegraph_shader_mirrors::srgb::srgb_from_linear_channel;
use framegraph_shaders::layout::{FxaaUniforms, ToneMap};
use framegraph_wgpu::{Depth, Frame, Gpu, Imports, Raster, Shader, read_texture, texture_2d};
use glam::DVec3;
use std::error::Error;
use tests::executors;
use wgpu::util::{DeviceExt, TextureDataOrder};
use wgpu::{TextureFormat, TextureUsages};

type TestResult = Result<(), Box<dyn Error>>;

/// Parts that post-processing needs: shaders, grading tables and the frame index.
#[derive(Default)]
pub struct Parts {
    pub programs: Programs,
    pub frame_index: FrameIndex,
    pub grading: GradingTables,
    pub views: Views,
}

impl AsRef<Programs> for Parts {
    fn as_ref(&self) -> &Programs {
        &self.programs
    }
}

impl AsRef<FrameIndex> for Parts {
    fn as_ref(&self) -> &FrameIndex {
        &self.frame_index
    }
}

impl AsRef<GradingTables> for Parts {
    fn as_ref(&self) -> &GradingTables {
        &self.grading
    }
}

impl AsRef<Views> for Parts {
    fn as_ref(&self) -> &Views {
        &self.views
    }
}

const SIZE: [u32; 2] = [16, 12];
const TEXELS: usize = (SIZE[0] * SIZE[1]) as usize;

fn uploaded(gpu: &Gpu, format: TextureFormat, bytes: &[u8]) -> wgpu::Texture {
    let desc = texture_2d("picture", [SIZE[0], SIZE[1]], format, TextureUsages::TEXTURE_BINDING);
    gpu.device.create_texture_with_data(&gpu.queue, &desc, TextureDataOrder::LayerMajor, bytes)
}

/// Executes declared passes on an imported picture with only `parts`; returns the texels.
fn filtered(
    gpu: &Gpu,
    parts: &Parts,
    (format, picture): (Format, &wgpu::Texture),
    declare: impl FnOnce(&mut Frame<Parts>, Texture) -> Result<Texture, DeclareError>,
) -> Result<(framegraph_wgpu::Pixels, Plan), Box<dyn Error>> {
    let mut frame = Frame::<Parts>::new();
    let desc = TextureDesc::new(Extent::FRAME, format);
    let import = frame.graph_mut().import_texture("picture", desc, Entry::Defined, Exit::Discard);
    let result = declare(&mut frame, import)?;
    frame.graph_mut().readback(result)?;
    let mut plan = Plan::new();
    compile(frame.graph(), &gpu.caps(), &Options::for_frame(SIZE[0], SIZE[1]), &mut Scratch::new(), &mut plan)?;
    let mut imports = Imports::new();
    imports.texture(import, picture);
    let mut executor = executors::lend(gpu);
    executor.execute(&plan, &frame, parts, &imports)?;
    assert_eq!(executor.executed(), plan.counts(), "executed against planned");
    let texture = executor.texture(&plan, result).ok_or("there is no result")?;
    Ok((read_texture(gpu, texture)?, plan))
}

/// Returns a gray of the ramp at column `x`, from 0.5 in steps too small for FXAA.
fn gray(x: u32) -> f32 {
    0.5 + 0.05 * x as f32
}

/// Returns half floats of a gray ramp from left to right, with a black bar in the middle.
fn ramp() -> Vec<u8> {
    let texel = |i: usize| {
        let [x, y] = [i % SIZE[0] as usize, i / SIZE[0] as usize];
        let gray = if y == 6 { 0.0 } else { gray(x as u32) };
        [gray, gray, gray, 1.0].map(::half::f16::from_f32)
    };
    (0..TEXELS).flat_map(|i| texel(i).map(::half::f16::to_le_bytes).concat()).collect()
}

/// Encodes linear light as an 8-bit sRGB value.
fn code(linear: f64) -> f64 {
    255.0 * srgb_from_linear_channel(linear.clamp(0.0, 1.0))
}

#[test]
fn post_and_fxaa_run_on_a_picture_without_a_scene() -> TestResult {
    let Some(gpu) = gpu("post_and_fxaa_run_on_a_picture_without_a_scene") else { return Ok(()) };
    let picture = uploaded(&gpu, TextureFormat::Rgba16Float, &ramp());
    let picture = (Format::Rgba16Float, &picture);
    let look = Look { tone_map: ToneMap::Linear, ..Look::default() };
    let post = PostSettings { compensation_ev: -1.0, look, dither: 0.0, ..PostSettings::DEFAULT };
    let post = move |hdr, for_fxaa| Post {
        hdr,
        bloom: None,
        into: Target::New,
        settings: post,
        only: None,
        for_fxaa,
        stored: None,
    };
    let parts = Parts::default();

    let (plain, plan) = filtered(&gpu, &parts, picture, |frame, hdr| Ok(frame.add("post", post(hdr, false))?.ldr))?;
    assert_eq!((plan.counts().steps, plan.counts().resolves, plan.counts().unresolves), (1, 1, 0));
    for y in 0..SIZE[1] {
        for x in 0..SIZE[0] {
            let expected = if y == 6 { 0.0 } else { code(0.5 * f64::from(gray(x))) };
            let texel = plain.at(x, y).ok_or("inside")?;
            // Rounding, and encoding by the target to within 0.6 steps (Vulkan's tolerance).
            assert!((f64::from(texel[0]) - expected).abs() < 1.1, "({x}, {y}): {texel:?} for {expected}");
        }
    }

    // An sRGB target with a non-sRGB view receives the same values.
    let (codes, _) = filtered(&gpu, &parts, picture, |frame, hdr| {
        let into = frame.graph_mut().texture("codes", TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb));
        let into = into.viewed_as(Format::Rgba8Unorm).into();
        Ok(frame.add("post", Post { into, ..post(hdr, false) })?.ldr)
    })?;
    // The device encodes within 0.6 steps (Vulkan's tolerance), the shader to the nearest step.
    let same = plain.rgba8().iter().zip(codes.rgba8()).all(|(a, b)| a.abs_diff(b) <= 1);
    assert!(same, "light is written where codes are asked for");

    let (smooth, plan) = filtered(&gpu, &parts, picture, |frame, hdr| {
        let ldr = frame.add("post", post(hdr, true))?.ldr;
        Ok(frame.add("fxaa", Fxaa { ldr, into: Target::New, settings: FxaaUniforms::default() })?.output)
    })?;
    assert_eq!((plan.counts().steps, plan.counts().resolves), (2, 2));
    // Rows away from the bar have no edge; the bar is smoothed.
    let row = |pixels: &framegraph_wgpu::Pixels, y: u32| {
        (0..SIZE[0]).filter_map(|x| Some(pixels.at(x, y)?[0])).collect::<Vec<_>>()
    };
    for y in [0, 3, 9, 11] {
        let differs = row(&plain, y).iter().zip(row(&smooth, y)).filter(|(a, b)| a.abs_diff(*b) > 1).count();
        assert_eq!(differs, 0, "row {y} has no edge");
    }
    let softened = row(&plain, 6).iter().zip(row(&smooth, 6)).filter(|(a, b)| a.abs_diff(*b) > 8).count();
    assert!(softened > 4, "the edge of the bar is softened in {softened} texels");
    Ok(())
}

/// FXAA needs only programs: [`Programs`] itself can be its world.
#[test]
fn programs_alone_are_a_world() -> TestResult {
    fn records<W: ?Sized, P: framegraph_wgpu::Record<W>>() {}
    records::<Programs, Fxaa>();
    records::<Programs, SceneLevel>();
    records::<Programs, DepthResolve>();
    Ok(())
}

/// With an infinite far plane, depth d is near / distance.
#[test]
fn a_scene_copy_takes_a_camera_and_no_scene() -> TestResult {
    let Some(gpu) = gpu("a_scene_copy_takes_a_camera_and_no_scene") else { return Ok(()) };
    let (near_m, depth) = (0.1, 0.25);
    let camera = Camera::look_at(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, Projection::perspective(1.0, near_m))?;
    let seen = ViewSettings { camera, size_px: SIZE, ev100: 0.0, shadows: None, ..ViewSettings::default() };
    let parts = Parts { views: Views::new(&gpu, [CameraView::empty(&seen)])?, ..Parts::default() };
    let picture = uploaded(&gpu, TextureFormat::Rgba16Float, &ramp());
    let (scene, _) = filtered(&gpu, &parts, (Format::Rgba16Float, &picture), |frame, hdr| {
        let cleared = frame.graph_mut().texture("depth", TextureDesc::new(Extent::FRAME, Format::Depth32Float));
        let clear = Intent::Clear(ClearValue::DepthStencil(depth, 0));
        let depth = frame.add_fn("depth", |pass| pass.depth(cleared, clear), |_, _, _| Ok(()))?;
        let copy = SceneCopy { view: ViewId::MAIN, hdr, depth, levels: 2 };
        let scene = frame.add("copy", copy)?.scene;
        Ok(frame.add("level", SceneLevel { scene, level: 1 })?.scene)
    })?;
    let [red, _, _, distance_m] = scene.rgba()[SIZE[0] as usize + 15];
    // Both are half floats: eleven bits.
    assert!((red - gray(15)).abs() < 2e-3, "{red}");
    assert!((f64::from(distance_m) - near_m / f64::from(depth)).abs() < 1e-3, "{distance_m} m");
    Ok(())
}

/// Draws four samples of known depths; depth is reversed, so the largest is the nearest.
const SAMPLES: Shader<'static> = Shader::new(
    "samples",
    "@vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
         return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.5, 1.0);
     }
     @fragment fn fs_main(@builtin(sample_index) sample: u32) -> @builtin(frag_depth) f32 {
         return array(0.3, 0.7, 0.1, 0.5)[sample];
     }",
);

#[test]
fn one_depth_of_four_samples_is_that_asked_for() -> TestResult {
    let Some(gpu) = gpu("one_depth_of_four_samples_is_that_asked_for") else { return Ok(()) };
    if gpu.info().backend == wgpu::Backend::Gl {
        test_report::skip("one_depth_of_four_samples_is_that_asked_for", "depth of several samples cannot be read");
        return Ok(());
    }
    let picture = uploaded(&gpu, TextureFormat::Rgba16Float, &ramp());
    for (which, expected) in [(DepthOf::FirstSample, 0.3), (DepthOf::Nearest, 0.7), (DepthOf::Farthest, 0.1)] {
        let (resolved, _) = filtered(&gpu, &Parts::default(), (Format::Rgba16Float, &picture), |frame, picture| {
            let desc = TextureDesc::new(Extent::FRAME, Format::Depth32Float).samples(4);
            let samples = frame.graph_mut().texture("depth", desc);
            let depth = frame.add_fn(
                "samples",
                |pass| {
                    pass.sampled(picture)?;
                    pass.depth(samples, Intent::Overwrite)
                },
                |_, _, cx| {
                    let depth = Depth { compare: wgpu::CompareFunction::Always, write: true, ..Depth::NONE };
                    let pipeline = cx.raster_pipeline(&Raster { depth, ..Raster::new(SAMPLES) })?;
                    let pass = cx.render_pass()?;
                    pass.set_pipeline(&pipeline);
                    pass.draw(0..3, 0..1);
                    Ok(())
                },
            )?;
            Ok(frame.add("depth_resolve", DepthResolve { depth, which })?.depth)
        })?;
        let depths = resolved.depth().ok_or("depth")?;
        assert!(depths.len() == TEXELS && depths.iter().all(|d| *d == expected), "{which:?}: {:?}", &depths[..4]);
    }
    Ok(())
}
