//! Processing of pixels after shading: exposure, vignette, grading, curves, quantization and dithering; and the
//! background.

use crate::stage::{declared, gpu, lighting};
use framegraph::{Options, Plan, Scratch, compile};
use framegraph_passes::gpu_scene::view::{Background, ViewSettings};
use framegraph_passes::grading::{Baked, GradeBy, GradingTables, Look};
use framegraph_passes::{CameraView, PostSettings, Settings, Shading, World};
use framegraph_scene::environment::EquirectMap;
use framegraph_scene::light::LightKind;
use framegraph_scene::{Camera, Environment, Light, Projection, Scene, SunHalo, progress};
use framegraph_shader_mirrors::sky;
use framegraph_shader_mirrors::sky::Preetham;
use framegraph_shaders::layout::{EdgeFade, Grading, SkyUniforms, ToneMap};
use framegraph_wgpu::{Gpu, Imports, read_texture};
use glam::{DVec2, DVec3, Vec3, Vec4};
use std::error::Error;
use tests::executors;

type TestResult = Result<(), Box<dyn Error>>;

const SIZE: [u32; 2] = [96, 60];
/// Vertical field of view, in radians.
const FOV: f64 = 1.1;

struct Picture {
    codes: Vec<u8>,
    linear: Vec<[f32; 4]>,
}

/// Draws an empty scene with a background, at an exposure of 1.
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
    let moment = ViewSettings { camera, size_px: SIZE, ev100, shadows: None, ..ViewSettings::default() };
    let view = CameraView::new(&scene, &lighting.image, background, &moment);
    let world = World::new(gpu, &scene, lighting, [view], &mut progress::silent)?;
    let (mut frame, io) = declared(&settings);
    frame.graph_mut().readback(io.hdr)?;
    let mut plan = Plan::new();
    compile(frame.graph(), &gpu.caps(), &Options::for_frame(SIZE[0], SIZE[1]), &mut Scratch::new(), &mut plan)?;
    let mut executor = executors::lend(gpu);
    executor.execute(&plan, &frame, &world, &Imports::new())?;
    let texture = |handle| executor.texture(&plan, handle).ok_or("the frame left no picture");
    let codes = read_texture(gpu, texture(io.output)?)?.rgba8();
    Ok(Picture { codes, linear: read_texture(gpu, texture(io.hdr)?)?.rgba() })
}

const LOOK: DVec3 = DVec3::new(0.48, 0.36, -0.8);

/// Encodes sRGB without rounding, in 8-bit steps.
fn srgb_code(linear: f64) -> f64 {
    let c = linear.clamp(0.0, 1.0);
    255.0 * if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
}

/// Returns the center of each pixel relative to the picture's center, in pixels.
fn from_middle() -> impl Iterator<Item = DVec2> {
    let [width, height] = SIZE.map(f64::from);
    let pixels = (0..SIZE[0] * SIZE[1]).map(|i| DVec2::new(f64::from(i % SIZE[0]), f64::from(i / SIZE[0])));
    pixels.map(move |p| p + 0.5 - 0.5 * DVec2::new(width, height))
}

/// Returns the largest difference from the expected color, in 8-bit steps.
fn apart(codes: &[u8], expected: impl Fn(DVec2) -> DVec3) -> f64 {
    let off = |(texel, at): (&[u8], DVec2)| {
        let codes = expected(at).to_array().map(srgb_code);
        (0..3).map(|c| (f64::from(texel[c]) - codes[c]).abs()).fold(0.0, f64::max)
    };
    codes.chunks_exact(4).zip(from_middle()).map(off).fold(0.0, f64::max)
}

const COLOR: DVec3 = DVec3::new(0.9, 0.447, 0.2);

fn plain() -> PostSettings {
    PostSettings { look: Look { tone_map: ToneMap::Linear, ..Look::default() }, dither: 0.0, ..PostSettings::DEFAULT }
}

fn of_color(gpu: &Gpu, post: PostSettings, fxaa: bool, split_post: bool) -> Result<Picture, Box<dyn Error>> {
    let dark = Environment::uniform(DVec3::ZERO)?;
    let settings = Settings { post, fxaa, split_post, ..Settings::default() };
    shoot(gpu, &dark, &Background::Constant(COLOR.as_vec3()), settings)
}

/// Vignette by the cosine-fourth law: 1/(1 + f r²)², with r relative to the distance of a corner. A radius that is off
/// by a tenth changes nine 8-bit steps.
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
            // Half an 8-bit step of rounding, and a quarter for half floats between passes. Slopes are smooth, so FXAA
            // changes nothing.
            let off = apart(&codes, vignetted(corner));
            assert!(off < 0.8, "{stops} stops, {fxaa} {split}: {off} codes");
            let control = apart(&codes, vignetted(corner * 1.1));
            assert!(control > 2.0 * stops, "{stops} stops: a radius off by a tenth is {control} codes");
        }
    }
    Ok(())
}

/// Dithering changes values by less than one step, and keeps the mean; each frame has its own pattern.
#[test]
fn dither_keeps_the_mean() -> TestResult {
    let Some(gpu) = gpu("dither_keeps_the_mean") else { return Ok(()) };
    for fxaa in [false, true] {
        let codes = of_color(&gpu, PostSettings { dither: 1.0, ..plain() }, fxaa, false)?.codes;
        for channel in 0..3 {
            let exact = srgb_code(COLOR[channel]);
            let own = || codes.chunks_exact(4).map(|t| f64::from(t[channel]));
            let mean = own().sum::<f64>() / own().count() as f64;
            // Without dithering, the mean would be an integer.
            assert!((exact - exact.round()).abs() > 0.3, "{channel}: {exact}");
            // The target's encoding depends on the driver; lavapipe's is off by an eighth of a step.
            assert!((mean - exact).abs() < if fxaa { 0.06 } else { 0.2 }, "{channel}: {mean} for {exact}");
            assert!(own().all(|code| (code - exact).abs() < 1.01), "{channel}");
        }
    }
    Ok(())
}

/// Returns looks with every grading option, and curves of each kind.
fn looks() -> Vec<Look> {
    let warm = Grading {
        exposure_ev: 0.3,
        temperature: 0.3,
        tint: -0.2,
        mixer: [Vec3::new(0.9, 0.1, 0.0), Vec3::new(0.0, 1.0, 0.05), Vec3::new(0.1, -0.1, 1.0)],
        shadows: Vec4::new(1.2, 1.0, 1.0, 0.05),
        midtones: Vec4::new(1.0, 1.1, 1.0, 0.0),
        highlights: Vec4::new(1.0, 1.0, 1.3, -0.05),
        slope: Vec3::new(1.1, 0.9, 1.0),
        offset: Vec3::new(0.01, 0.02, -0.03),
        power: Vec3::new(0.9, 1.1, 1.05),
        contrast: 1.2,
        vibrance: 0.8,
        saturation: 1.3,
        shadow_gamma: Vec3::new(1.2, 1.1, 1.0),
        highlight_scale: Vec3::new(0.8, 0.9, 1.0),
        ..Grading::NEUTRAL
    };
    let night = Grading { night: 1.0, exposure_ev: -3.0, ..Grading::NEUTRAL };
    let curves = ToneMap::ALL.map(|tone_map| Look { tone_map, ..Look::default() });
    let mut looks = curves.to_vec();
    looks.push(Look { grading: warm, ..Look::default() });
    looks.push(Look { grading: warm, tone_map: ToneMap::Filmic, ..Look::default() });
    // Every channel is tested below and above the middle of its curve.
    for middle in [8.0, 0.01] {
        let (shadow_gamma, highlight_scale) = (Vec3::new(1.5, 0.8, 1.2), Vec3::new(0.7, 1.3, 0.9));
        let grading = Grading { shadow_gamma, middle: Vec3::splat(middle), highlight_scale, ..Grading::NEUTRAL };
        looks.push(Look { grading, ..Look::default() });
    }
    looks.push(Look { grading: night, tone_map: ToneMap::Linear2020, ..Look::default() });
    looks.push(Look { tone_map: ToneMap::Aces, luminance_scaling: true, gamut_mapping: true, ..Look::default() });
    looks
}

/// The mobile curve includes the transfer function, so its values are displayed unchanged: in one pass, and with one
/// pass per effect. Gamut mapping in between decodes and encodes them.
#[test]
fn the_mobile_curve_is_encoded_once() -> TestResult {
    let Some(gpu) = gpu("the_mobile_curve_is_encoded_once") else { return Ok(()) };
    let mobile = COLOR / (COLOR + 0.155) * 1.019;
    for (gamut_mapping, fxaa, split) in [(false, false, false), (false, true, true), (true, true, false)] {
        let look = Look { tone_map: ToneMap::Mobile, gamut_mapping, ..Look::default() };
        let codes = of_color(&gpu, PostSettings { look, ..plain() }, fxaa, split)?.codes;
        let off = |expected: DVec3| (0..3).map(|c| (f64::from(codes[c]) - expected[c]).abs()).fold(0.0, f64::max);
        assert!(off(mobile * 255.0) < 0.9, "{look:?}, {fxaa} {split}: {:?} for {mobile}", &codes[..3]);
        let twice = DVec3::from_array(mobile.to_array().map(srgb_code));
        assert!(off(twice) > 10.0, "encoded twice");
    }
    Ok(())
}

/// Looks in the shader match the CPU's f64 functions, with all effects in one pass and with one pass each. Table
/// lookups match the CPU's interpolation.
#[test]
fn looks_are_computed_and_looked_up_as_on_the_cpu() -> TestResult {
    let Some(gpu) = gpu("looks_are_computed_and_looked_up_as_on_the_cpu") else { return Ok(()) };
    let extras = GradingTables::default();
    let extras = extras.extras();
    let codes_of = |picture: &Picture| -> [f64; 3] { std::array::from_fn(|c| f64::from(picture.codes[c])) };
    for look in test_report::share(looks()) {
        let exact = look.function(extras)?(COLOR) * 255.0;
        for split in [false, true] {
            let found = codes_of(&of_color(&gpu, PostSettings { look, ..plain() }, true, split)?);
            // Half an 8-bit step of rounding, and a quarter for half floats between passes.
            let off = (DVec3::from_array(found) - exact).abs().max_element();
            assert!(off < 0.9, "{look:?}, split {split}: {found:?} for {exact}");
        }
        for text in ["table:16:rgb10", "table:32:f16"] {
            let by = GradeBy::from_text(text)?;
            let GradeBy::Table(desc) = by else { continue };
            let expected = Baked::new(&look, extras, desc)?.sample(COLOR, false) * 255.0;
            let found = codes_of(&of_color(&gpu, PostSettings { look, by, ..plain() }, true, true)?);
            // A device may shift a sample by 1/256 texel; neighboring entries differ by up to 40 steps.
            let off = (DVec3::from_array(found) - expected).abs().max_element();
            assert!(off < 1.0, "{look:?} {text}: {found:?} for {expected}");
        }
    }
    // Negative control: another look is detected.
    let look = Look { tone_map: ToneMap::Aces, ..Look::default() };
    let (aces, hill) = (look.function(extras)?(COLOR) * 255.0, Look::default().function(extras)?(COLOR) * 255.0);
    assert!((aces - hill).abs().max_element() > 2.0, "{aces} {hill}");
    Ok(())
}

/// An edge fade follows its published formula: coordinates of -0.5…0.5 are scaled and raised to a power, and their
/// squared length is raised to another power.
#[test]
fn the_picture_fades_toward_its_edges() -> TestResult {
    let Some(gpu) = gpu("the_picture_fades_toward_its_edges") else { return Ok(()) };
    let tint = DVec3::new(0.5, 0.0, 0.1);
    for (middle, roundness, feather) in [(0.5_f64, 0.5_f64, 0.5_f64), (0.2, 0.9, 0.3), (0.4, 0.2, 1.0)] {
        let (oval, circle) = (roundness.min(0.5) * 2.0, (roundness - 0.5).max(0.0) * 2.0);
        let scale = (1.0 - middle) * (2.2 + 0.8 * oval) * (1.0 - 0.1 * feather);
        let corners = 6.0 - 5.0 * oval;
        let radius = corners * (1.0 + 4.0 * (1.0 - feather) * (1.0 - oval.sqrt()));
        let aspect = 1.0 + circle * (f64::from(SIZE[0]) / f64::from(SIZE[1]) - 1.0);
        let expected = |at: DVec2| {
            let d = (at / DVec2::new(f64::from(SIZE[0]), f64::from(SIZE[1]))).abs() * scale * DVec2::new(aspect, 1.0);
            let d = DVec2::new(d.x.min(1.0).powf(radius), d.y.min(1.0).powf(radius));
            let left = (1.0 - d.length_squared()).clamp(0.0, 1.0).powf(5.0 * feather);
            COLOR * (tint + (DVec3::ONE - tint) * left)
        };
        let color = tint.as_vec3().to_array();
        let [middle, roundness, feather] = [middle, roundness, feather].map(|x| x as f32);
        let edge_fade = Some(EdgeFade { middle, roundness, feather, color, multiple_px: 1 });
        let codes = of_color(&gpu, PostSettings { edge_fade, ..plain() }, false, false)?.codes;
        let off = apart(&codes, expected);
        assert!(off < 0.9, "{middle} {roundness} {feather}: {off} codes");
        let plain = of_color(&gpu, plain(), false, false)?.codes;
        assert!(apart(&plain, expected) > 20.0, "the control, without it");
    }
    Ok(())
}

/// Pixels without a surface show the environment in their own direction.
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

/// The sun's disc with its halo over a uniform background matches the mirror of the formula in each pixel's
/// direction, clamped to the range of half floats. Without a halo the background is uniform.
#[test]
fn the_sun_has_a_disc_and_a_halo_on_demand() -> TestResult {
    let Some(gpu) = gpu("the_sun_has_a_disc_and_a_halo_on_demand") else { return Ok(()) };
    let toward = DVec3::new(0.5, 0.35, -0.75).normalize();
    let (radius_rad, halo) = (0.06_f32, SunHalo { size: 6.0, falloff: 8.0 });
    let illuminance = DVec3::new(6000.0, 300.0, 20.0);
    let kind = LightKind::Directional { illuminance_lux: 1.0, angular_radius_rad: radius_rad };
    let sun = Light { kind, color: illuminance.as_vec3(), ..Light::directional("sun", -toward.as_vec3(), 0.0) };
    let packed = SkyUniforms::default().with_halo(radius_rad, halo.size, halo.falloff);
    let settings = Settings { fxaa: false, post: plain(), ..Settings::default() };
    let even = Background::Constant(Vec3::splat(2.0));
    let shown = |halo| -> Result<Picture, Box<dyn Error>> {
        let sun = Some(Light { halo, ..sun.clone() });
        shoot(&gpu, &Environment { sun, ..Environment::uniform(DVec3::ZERO)? }, &even, settings)
    };
    let (forward, right) = (LOOK.normalize(), LOOK.cross(DVec3::Y).normalize());
    let up = right.cross(forward);
    let per_px = (FOV / 2.0).tan() / (f64::from(SIZE[1]) / 2.0);
    let (mut inside, mut about, mut beyond) = (0, 0, 0);
    for (texel, at) in shown(Some(halo))?.linear.iter().zip(from_middle()) {
        let d = (forward + right * (at.x * per_px) - up * (at.y * per_px)).normalize();
        let [versine, per_halo] = [packed.disc_versine, packed.per_halo].map(f64::from);
        let share = sky::sun_halo(d, toward, versine, per_halo, f64::from(halo.falloff));
        let expected = (2.0 + 4.0 * std::f64::consts::PI * illuminance * share).min(DVec3::splat(65504.0));
        let texel = Vec3::new(texel[0], texel[1], texel[2]).as_dvec3();
        let apart = ((texel - expected).abs() - 5e-3 * expected).max_element();
        assert!(apart < 1e-2, "{at}, {d}: {texel} for {expected}");
        inside += usize::from(expected.x == 65504.0);
        about += usize::from(share > 0.01 && share < 0.5);
        beyond += usize::from(share == 0.0);
    }
    assert!(inside > 10 && about > 40 && beyond > 500, "{inside} in the disc, {about} in the halo, {beyond} beyond");
    assert!(shown(None)?.linear.iter().all(|texel| texel[..3] == [2.0; 3]));
    Ok(())
}

/// A clear sky with a wide sun matches the model's mirror in each pixel's direction.
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
        // At the edge of the disc and at the horizon, rounding to f32 may choose the other side.
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
