//! What happens to a picture after shading, pixel by pixel: exposure, vignette, grading, curves, codes and dither; and what
//! is seen where there is no surface.

use crate::stage::{declared, gpu, lighting};
use framegraph::{Options, Plan, Scratch, compile};
use framegraph_passes::view::{Background, ViewSettings};
use framegraph_passes::{CameraView, LightSearch, PostSettings, Settings, Shading, World};
use framegraph_scene::environment::EquirectMap;
use framegraph_scene::light::LightKind;
use framegraph_scene::{Camera, Environment, Light, Projection, Scene, progress};
use framegraph_shaders::layout::{Grading, ToneMap};
use framegraph_shaders::reference::sky::Preetham;
use framegraph_shaders::reference::{grading, sky};
use framegraph_wgpu::{Executor, Gpu, Imports, read_texture};
use glam::{DVec2, DVec3, Vec3};
use std::error::Error;

type TestResult = Result<(), Box<dyn Error>>;

const SIZE: [u32; 2] = [96, 60];
/// Full vertical field of view in radians.
const FOV: f64 = 1.1;

struct Picture {
    codes: Vec<u8>,
    linear: Vec<[f32; 4]>,
}

/// No surface at all, but what stands behind everything; an exposure of one.
fn shoot(
    gpu: &Gpu,
    environment: &Environment,
    background: &Background,
    settings: Settings,
) -> Result<Picture, Box<dyn Error>> {
    let settings = Settings { shadows: None, ..settings };
    let lighting = lighting(gpu, environment, &Shading::default())?;
    let scene = Scene::default();
    let eye = DVec3::new(3e4, -200.0, 70.0);
    let camera = Camera::look_at(eye, eye + LOOK, DVec3::Y, Projection::perspective(FOV, 0.1))?;
    let ev100 = (1.0_f32 / 1.2).log2();
    let moment = ViewSettings {
        camera,
        size_px: SIZE,
        ev100,
        environment_intensity: 1.0,
        shadows: None,
        lights: LightSearch::default(),
    };
    let view = CameraView::new(&scene, &lighting.image, background, &moment);
    let world = World::new(gpu, &scene, lighting, [view], &mut progress::silent)?;
    let (mut frame, io) = declared(&settings);
    frame.graph_mut().readback(io.hdr)?;
    let mut plan = Plan::new();
    compile(frame.graph(), &gpu.caps(), &Options::for_frame(SIZE[0], SIZE[1]), &mut Scratch::new(), &mut plan)?;
    let mut executor = Executor::new(gpu);
    executor.execute(&plan, &frame, &world, &Imports::new())?;
    let texture = |handle| executor.texture(&plan, handle).ok_or("the frame left no picture");
    let codes = read_texture(gpu, texture(io.output)?)?.rgba8();
    Ok(Picture { codes, linear: read_texture(gpu, texture(io.hdr)?)?.rgba() })
}

const LOOK: DVec3 = DVec3::new(0.48, 0.36, -0.8);

/// Not rounded.
fn srgb_code(linear: f64) -> f64 {
    let c = linear.clamp(0.0, 1.0);
    255.0 * if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
}

/// The middle of each pixel from the middle of the picture, in pixels.
fn from_middle() -> impl Iterator<Item = DVec2> {
    let [width, height] = SIZE.map(f64::from);
    let pixels = (0..SIZE[0] * SIZE[1]).map(|i| DVec2::new(f64::from(i % SIZE[0]), f64::from(i / SIZE[0])));
    pixels.map(move |p| p + 0.5 - 0.5 * DVec2::new(width, height))
}

/// The largest difference in codes from what each pixel should show.
fn apart(codes: &[u8], expected: impl Fn(DVec2) -> DVec3) -> f64 {
    let off = |(texel, at): (&[u8], DVec2)| {
        let codes = expected(at).to_array().map(srgb_code);
        (0..3).map(|c| (f64::from(texel[c]) - codes[c]).abs()).fold(0.0, f64::max)
    };
    codes.chunks_exact(4).zip(from_middle()).map(off).fold(0.0, f64::max)
}

const COLOR: DVec3 = DVec3::new(0.9, 0.447, 0.2);

fn plain() -> PostSettings {
    PostSettings { tone_map: ToneMap::Linear, dither: 0.0, ..PostSettings::DEFAULT }
}

fn of_color(gpu: &Gpu, post: PostSettings, fxaa: bool, split_post: bool) -> Result<Picture, Box<dyn Error>> {
    let dark = Environment::uniform(DVec3::ZERO)?;
    let settings = Settings { post, fxaa, split_post, ..Settings::default() };
    shoot(gpu, &dark, &Background::Constant(COLOR.as_vec3()), settings)
}

/// By the cosine-fourth law: 1/(1 + f r²)², r the share of the way to a corner. A radius off by a tenth is nine codes.
#[test]
fn corners_are_darker_by_the_stops_asked_for() -> TestResult {
    let Some(gpu) = gpu("corners_are_darker_by_the_stops_asked_for") else { return Ok(()) };
    let corner = DVec2::new(f64::from(SIZE[0]), f64::from(SIZE[1])).length() / 2.0;
    for (stops, compensation_ev) in [(2.0, 0.0), (0.5, 0.0), (1.0, -1.0)] {
        let vignetted = |radius: f64| {
            let share =
                move |at: DVec2| (1.0 + (2.0_f64.powf(stops / 2.0) - 1.0) * (at.length() / radius).powi(2)).powi(-2);
            move |at: DVec2| COLOR * (share(at) * f64::from(compensation_ev).exp2())
        };
        let post = PostSettings { vignette_ev: stops as f32, compensation_ev, ..plain() };
        for (fxaa, split) in [(false, false), (true, false), (false, true)] {
            let codes = of_color(&gpu, post, fxaa, split)?.codes;
            // Half a code of rounding; half floats between passes are a quarter of one more. Slopes are smooth, so the edge
            // filter does nothing.
            let off = apart(&codes, vignetted(corner));
            assert!(off < 0.8, "{stops} stops, {fxaa} {split}: {off} codes");
            let control = apart(&codes, vignetted(corner * 1.1));
            assert!(control > 2.0 * stops, "{stops} stops: a radius off by a tenth is {control} codes");
        }
    }
    Ok(())
}

/// Dither moves a code by less than one, and the mean not at all; each frame has a pattern of its own.
#[test]
fn dither_keeps_the_mean() -> TestResult {
    let Some(gpu) = gpu("dither_keeps_the_mean") else { return Ok(()) };
    for fxaa in [false, true] {
        let codes = of_color(&gpu, PostSettings { dither: 1.0, ..plain() }, fxaa, false)?.codes;
        for channel in 0..3 {
            let exact = srgb_code(COLOR[channel]);
            let own = || codes.chunks_exact(4).map(|t| f64::from(t[channel]));
            let mean = own().sum::<f64>() / own().count() as f64;
            // Without dither the mean would be a whole code.
            assert!((exact - exact.round()).abs() > 0.3, "{channel}: {exact}");
            // Encoding by the target is the driver's own, and lavapipe's an eighth of a code off.
            assert!((mean - exact).abs() < if fxaa { 0.06 } else { 0.2 }, "{channel}: {mean} for {exact}");
            assert!(own().all(|code| (code - exact).abs() < 1.01), "{channel}");
        }
    }
    Ok(())
}

/// Grading does its parts in their order.
#[test]
fn grading_does_its_parts_in_order() -> TestResult {
    let Some(gpu) = gpu("grading_does_its_parts_in_order") else { return Ok(()) };
    let look = Grading {
        temperature: 0.3,
        tint: -0.2,
        slope: Vec3::new(1.1, 0.9, 1.0),
        offset: Vec3::new(0.01, 0.02, -0.03),
        power: Vec3::new(0.9, 1.1, 1.05),
        contrast: 1.2,
        vibrance: 0.8,
        saturation: 1.3,
    };
    let balanced = (grading::white_balance(f64::from(look.temperature), f64::from(look.tint)) * COLOR).max(DVec3::ZERO);
    let decided = grading::slope_offset_power(
        grading::log_c_from_linear(balanced),
        look.slope.as_dvec3(),
        look.offset.as_dvec3(),
        look.power.as_dvec3(),
    );
    let contrasted =
        grading::contrast_about(decided, grading::log_c_from_linear(DVec3::splat(0.18)).x, look.contrast.into());
    let vivid = grading::saturation(
        grading::vibrance(grading::linear_from_log_c(contrasted), look.vibrance.into()),
        look.saturation.into(),
    );
    for split in [false, true] {
        let codes = of_color(&gpu, PostSettings { grading: look, ..plain() }, false, split)?.codes;
        let off = apart(&codes, |_| vivid.max(DVec3::ZERO));
        assert!(off < 0.65, "{off} codes: {:?} for {vivid}", &codes[..3]);
    }
    Ok(())
}

/// Where there is no surface the environment is seen, each pixel in its own direction.
#[test]
fn each_pixel_sees_the_environment_in_its_direction() -> TestResult {
    let Some(gpu) = gpu("each_pixel_sees_the_environment_in_its_direction") else { return Ok(()) };
    let map = EquirectMap::from_fn(512, 256, |d| DVec3::ONE + d * 0.8);
    let slope = Environment { name: "slope".into(), map, sun: None, filtered: None, warnings: Vec::new() };
    let (forward, right) = (LOOK.normalize(), LOOK.cross(DVec3::Y).normalize());
    let up = right.cross(forward);
    let per_px = (FOV / 2.0).tan() / (f64::from(SIZE[1]) / 2.0);
    for samples in [1, 4] {
        let settings = Settings { samples, fxaa: false, post: plain(), ..Settings::default() };
        let seen = shoot(&gpu, &slope, &Background::Environment, settings)?;
        for (texel, at) in seen.linear.iter().zip(from_middle()) {
            let d = (forward + right * (at.x * per_px) - up * (at.y * per_px)).normalize();
            let expected = DVec3::ONE + d * 0.8;
            let texel = Vec3::new(texel[0], texel[1], texel[2]).as_dvec3();
            assert!((texel - expected).abs().max_element() < 3e-3, "{at}: {texel} for {expected}");
        }
    }
    let nothing = shoot(&gpu, &slope, &Background::None, Settings { post: plain(), ..Settings::default() })?;
    assert!(nothing.linear.iter().all(|t| t[..3] == [0.0; 3]), "nothing is black");
    Ok(())
}

/// A clear sky with a wide sun: each pixel is what the model's mirror says of its direction.
#[test]
fn a_clear_sky_shows_its_sun() -> TestResult {
    let Some(gpu) = gpu("a_clear_sky_shows_its_sun") else { return Ok(()) };
    let toward = DVec3::new(0.5, 0.5, -0.75).normalize();
    let (illuminance, radius) = (DVec3::new(1.0, 0.9, 0.7) * 300.0, 0.12_f64);
    let clear = Preetham::new(toward, 3.0, DVec3::new(0.3, 0.2, 0.1), illuminance);
    let kind = LightKind::Directional { illuminance_lux: 300.0, angular_radius_rad: radius as f32 };
    let sun =
        Light { kind, color: (illuminance / 300.0).as_vec3(), ..Light::directional("sun", -toward.as_vec3(), 0.0) };
    let environment = Environment { sun: Some(sun), ..Environment::uniform(DVec3::ZERO)? };
    let settings = Settings { fxaa: false, post: plain(), ..Settings::default() };
    let seen = shoot(&gpu, &environment, &Background::ClearSky(clear), settings)?;
    let (forward, right) = (LOOK.normalize(), LOOK.cross(DVec3::Y).normalize());
    let up = right.cross(forward);
    let per_px = (FOV / 2.0).tan() / (f64::from(SIZE[1]) / 2.0);
    let (mut inside, mut below) = (0, 0);
    for (texel, at) in seen.linear.iter().zip(from_middle()) {
        let d = (forward + right * (at.x * per_px) - up * (at.y * per_px)).normalize();
        let disc = sky::sun_disc(d, toward, radius.sin());
        // At the edge of the disc and at the horizon a direction in single precision may lie on the other side.
        if d.y.abs() < 1e-3 || disc > 0.0 && disc < 1.0 {
            continue;
        }
        let expected = clear.radiance(d) + sky::sun_disc_radiance(illuminance, radius.sin()) * disc;
        let texel = Vec3::new(texel[0], texel[1], texel[2]).as_dvec3();
        let apart = ((texel - expected).abs() - 5e-3 * expected).max_element();
        assert!(apart < 0.5, "{at}, {d}: {texel} for {expected}");
        (inside, below) = (inside + usize::from(disc == 1.0), below + usize::from(d.y < 0.0));
    }
    assert!(inside > 50 && below > 200, "{inside} pixels of the sun, {below} of the ground");
    Ok(())
}
