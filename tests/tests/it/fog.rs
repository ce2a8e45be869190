//! Fog: opacity over ground and sky, compared with its density integrated along each ray.

use crate::lens_document::documented;
use crate::stage::{gpu, lighting, plan};
use framegraph::{Caps, Options, Plan, Scratch, Target, compile};
use framegraph_passes::effects::fog::{FogColor, FogGlow};
use framegraph_passes::gpu_scene::view::{Background, ViewSettings};
use framegraph_passes::{CameraView, FogSettings, Settings, Shading, World, standard};
use framegraph_scene::environment::EquirectMap;
use framegraph_scene::{Camera, Environment, Light, Projection, Scene, progress};
use framegraph_wgpu::{Frame, Gpu, Imports, read_texture};
use glam::{DVec3, Vec3};
use std::error::Error;
use tests::executors;
use truth::lobe::gathered;

type TestResult = Result<(), Box<dyn Error>>;

/// A plane of ±8 m at y = 0, with balls in front of the center, outside of the tested rays.
const GRID: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/references/filament_frame/assets/grid.glb");
const SIZE: [u32; 2] = [64, 48];
const EYE: DVec3 = DVec3::new(0.3, 1.5, 12.0);
const LOOK: DVec3 = DVec3::new(-0.02, -0.05, -1.0);
const SUN: DVec3 = DVec3::new(-0.2, 0.3, -1.0);
const SUN_LUX: f32 = 2.0;
/// Radiance of the background in nits, at an exposure of 1.
const SKY: Vec3 = Vec3::new(0.25, 0.5, 1.0);
const FOV: f64 = 0.9;

/// Returns the radiance of the grid, rendered by the standard frame.
fn shoot(gpu: &Gpu, fog: Option<FogSettings>, background: &Background) -> Result<Vec<[f32; 4]>, Box<dyn Error>> {
    shoot_under(gpu, fog, background, &Environment::uniform(DVec3::new(0.5, 1.0, 0.75))?)
}

/// Returns the radiance of the grid under another sky.
fn shoot_under(
    gpu: &Gpu,
    fog: Option<FogSettings>,
    background: &Background,
    sky: &Environment,
) -> Result<Vec<[f32; 4]>, Box<dyn Error>> {
    let settings = Settings { shadows: None, fxaa: false, fog, ..Settings::DEFAULT };
    let mut scene = Scene::open(GRID, &mut progress::silent)?;
    scene.lights.push(Light::directional("sun", -SUN.normalize().as_vec3(), SUN_LUX));
    let lighting = lighting(gpu, sky, &Shading::default())?;
    let moment = ViewSettings {
        camera: Camera::look_at(EYE, EYE + LOOK, DVec3::Y, Projection::perspective(FOV, 0.1))?,
        size_px: SIZE,
        ev100: (1.0_f32 / 1.2).log2(),
        shadows: None,
        ..ViewSettings::default()
    };
    let view = CameraView::new(&scene, &lighting.image, background, &moment);
    let world = World::new(gpu, &scene, lighting, [view], &mut progress::silent)?;
    let mut frame: Frame<World> = Frame::new();
    let io = standard(&mut frame, &settings.for_scene(&scene, SIZE), Target::New)?;
    frame.graph_mut().readback(io.hdr)?;
    let mut plan = Plan::new();
    compile(frame.graph(), &gpu.caps(), &Options::for_frame(SIZE[0], SIZE[1]), &mut Scratch::new(), &mut plan)?;
    let mut executor = executors::lend(gpu);
    executor.execute(&plan, &frame, &world, &Imports::new())?;
    let texture = executor.texture(&plan, io.hdr).ok_or("the frame left no radiance")?;
    Ok(read_texture(gpu, texture)?.rgba())
}

/// Returns each pixel's unit ray, and its length to the ground, or infinity for sky. `None` where balls may be.
fn rays() -> Vec<Option<(DVec3, f64)>> {
    let [width, height] = SIZE.map(f64::from);
    let forward = LOOK.normalize();
    let right = forward.cross(DVec3::Y).normalize();
    let up = right.cross(forward);
    let ray = |i: u32| {
        let (x, y) = (f64::from(i % SIZE[0]) + 0.5, f64::from(i / SIZE[0]) + 0.5);
        let tangent = (0.5 * FOV).tan();
        let ray = forward
            + right * (x / width * 2.0 - 1.0) * tangent * width / height
            + up * (1.0 - y / height * 2.0) * tangent;
        let ray = ray.normalize();
        let way_m = -EYE.y / ray.y;
        let met = EYE + ray * way_m;
        // A pixel inside the plane's border, so that edges do not matter.
        let ground = ray.y < 0.0 && met.x.abs() < 7.5 && (1.5..7.5).contains(&met.z);
        if ground { Some((ray, way_m)) } else { (ray.y > 0.0).then_some((ray, 1e10)) }
    };
    (0..SIZE[0] * SIZE[1]).map(ray).collect()
}

/// Returns the opacity of fog along a ray, by integration with geometric steps.
fn hidden(fog: &FogSettings, start_m: f32, ray: DVec3, way_m: f64) -> f64 {
    const STEPS: u32 = 4000;
    let (density, falloff, height) = (f64::from(fog.density), f64::from(fog.falloff), f64::from(fog.height_m));
    let start_m = f64::from(start_m);
    // Beyond this distance there is no fog above, and below, the fog is opaque.
    let way_m = if ray.y.abs() * falloff > 0.0 { way_m.min(start_m + 60.0 / (ray.y.abs() * falloff)) } else { way_m };
    if way_m <= start_m {
        return 0.0;
    }
    let at = |i: u32| start_m + (way_m - start_m) * (f64::from(i) / f64::from(STEPS)).powi(2);
    let depth: f64 = (0..STEPS)
        .map(|i| {
            let middle = EYE.y + ray.y * 0.5 * (at(i) + at(i + 1));
            density * (-falloff * (middle - height)).exp() * (at(i + 1) - at(i))
        })
        .sum();
    1.0 - (-depth).exp()
}

/// Returns the largest difference between a picture with fog and one without that is faded by `expected`, relative to
/// the brightest channel.
fn off(clear: &[[f32; 4]], shot: &[[f32; 4]], expected: impl Fn(DVec3, f64, DVec3) -> DVec3) -> f64 {
    let mut worst = 0.0_f64;
    let mut seen = [0, 0];
    for ((ray, clear), shot) in rays().into_iter().zip(clear).zip(shot) {
        let Some((ray, way_m)) = ray else { continue };
        seen[usize::from(way_m > 1e9)] += 1;
        let rgb = |c: &[f32; 4]| DVec3::new(c[0].into(), c[1].into(), c[2].into());
        let expected = expected(ray, way_m, rgb(clear));
        worst = worst.max((rgb(shot) - expected).abs().max_element() / expected.max_element().max(0.01));
    }
    assert!(seen.iter().all(|count| *count > 300), "ground and sky are both looked at: {seen:?}");
    worst
}

/// Both pictures have half floats with a relative error of 1/2048 each; integration errors are smaller.
const BOUND: f64 = 2e-3;

#[test]
fn fog_hides_what_its_density_along_the_ray_does() -> TestResult {
    let Some(gpu) = gpu("fog_hides_what_its_density_along_the_ray_does") else { return Ok(()) };
    let background = Background::Constant(SKY);
    let clear = shoot(&gpu, None, &background)?;
    let nits = DVec3::new(0.2, 0.4, 0.6);
    let plain = FogSettings { color: FogColor::Radiance(nits.as_vec3().to_array()), ..FogSettings::DEFAULT };
    let low = FogSettings { density: 0.3, falloff: 0.7, height_m: 0.5, start_m: 3.0, ..plain };
    let glow = FogSettings { glow: Some(FogGlow { start_m: 4.0, size: 6.0 }), most_opacity: 0.6, ..low };
    let even = FogSettings { density: 0.05, falloff: 0.0, cut_off_m: 8.0, ..plain };
    let mut most = 0.0_f64;
    for fog in [plain, low, glow, even] {
        let shot = shoot(&gpu, Some(fog), &background)?;
        let faded = |ray: DVec3, way_m: f64, clear: DVec3| {
            if way_m > f64::from(fog.cut_off_m) || way_m < f64::from(fog.start_m) {
                return clear;
            }
            let hidden_share = hidden(&fog, fog.start_m, ray, way_m).min(fog.most_opacity.into());
            let sun = fog.glow.map_or(0.0, |glow| {
                let toward = ray.dot(SUN.normalize()).max(0.0).powf(glow.size.into());
                toward * hidden(&fog, glow.start_m, ray, way_m) * f64::from(SUN_LUX)
            });
            clear * (1.0 - hidden_share) + nits * hidden_share + DVec3::splat(sun)
        };
        let worst = off(&clear, &shot, faded);
        assert!(worst < BOUND, "{fog:?}: off by {worst}");
        most = most.max(worst);
    }
    documented("fog", most);
    // Filament's mean density for a clear start differs.
    let filament = shoot(&gpu, Some(FogSettings { exact: false, ..low }), &background)?;
    let faded = |ray: DVec3, way_m: f64, clear: DVec3| {
        let share = hidden(&low, low.start_m, ray, way_m);
        if way_m < 3.0 { clear } else { clear * (1.0 - share) + nits * share }
    };
    let filament = off(&clear, &filament, faded);
    assert!(filament > 10.0 * BOUND);
    documented("fog that begins at 3 m, `mean=filament`", filament);
    Ok(())
}

/// The environment is uniform, so its color does not depend on the level; a black sky is covered by fog too.
#[test]
fn fog_takes_the_environments_color() -> TestResult {
    let Some(gpu) = gpu("fog_takes_the_environments_color") else { return Ok(()) };
    let (tint, around) = (DVec3::new(1.0, 0.5, 2.0), DVec3::new(0.5, 1.0, 0.75));
    let color = FogColor::Environment { tint: tint.as_vec3().to_array(), sharp_m: 20.0, sharp_levels: 1.0 };
    let fog = FogSettings { color, ..FogSettings::DEFAULT };
    let (clear, shot) = (shoot(&gpu, None, &Background::None)?, shoot(&gpu, Some(fog), &Background::None)?);
    let worst = off(&clear, &shot, |ray, way_m, clear| {
        let share = hidden(&fog, 0.0, ray, way_m);
        clear * (1.0 - share) + tint * around * share
    });
    assert!(worst < BOUND, "off by {worst}");
    Ok(())
}

/// Opaque fog has the color of the environment's roughest level, and of a sharper level beyond a stated distance.
#[test]
fn far_fog_takes_a_sharper_image() -> TestResult {
    let Some(gpu) = gpu("far_fog_takes_a_sharper_image") else { return Ok(()) };
    let map = EquirectMap::from_fn(256, 128, |d| DVec3::splat(2.0 + 1.9 * d.x));
    let sky = Environment { name: "slope".into(), map, sun: None, filtered: None, warnings: Vec::new() };
    // Colors at the left and right of the sky, and the rays there.
    let ends = [8, SIZE[0] as usize - 8];
    let rays = ends.map(|at| rays()[at].map_or(DVec3::ZERO, |(ray, _)| ray));
    let slope = |sharp_m: f32, sharp_levels: f32| -> Result<f64, Box<dyn Error>> {
        let color = FogColor::Environment { tint: [1.0; 3], sharp_m, sharp_levels };
        let fog = FogSettings { color, density: 50.0, falloff: 0.0, ..FogSettings::DEFAULT };
        let shot = shoot_under(&gpu, Some(fog), &Background::None, &sky)?;
        Ok(f64::from(shot[ends[1]][0] - shot[ends[0]][0]) / (1.9 * (rays[1].x - rays[0].x)))
    };
    let [near, far, sky_itself] = [slope(1e20, 16.0)?, slope(1e-3, 1.0)?, slope(1e-3, 16.0)?];
    let blurred = |roughness: f64| gathered(DVec3::Z, roughness, |l| DVec3::splat(l.z)).z;
    // The slope is not linear between the four texels of a face at this level.
    assert!((near / blurred(1.0) - 1.0).abs() < 0.08, "{near} for {}", blurred(1.0));
    assert!(far > 1.05 * near && far < 1.0, "{far} beyond, {near} before");
    // All levels leave no blur: Filament's `skyColor`.
    assert!((sky_itself - 1.0).abs() < 0.01 && sky_itself > far, "{sky_itself} beyond, without blur");
    Ok(())
}

/// Fog without density, or entirely out of range, changes no bit; fog changes no plan.
#[test]
fn fog_of_no_density_changes_no_bit() -> TestResult {
    let options = Options::for_frame(64, 64);
    let count = |fog| plan(&Settings { fog, ..Settings::DEFAULT }, &Caps::wgpu(), &options).counts();
    assert_eq!(count(Some(FogSettings::DEFAULT)), count(None));
    let Some(gpu) = gpu("fog_of_no_density_changes_no_bit") else { return Ok(()) };
    let background = Background::Constant(SKY);
    let clear = shoot(&gpu, None, &background)?;
    let none = FogSettings { density: 0.0, ..FogSettings::DEFAULT };
    assert!(shoot(&gpu, Some(none), &background)? == clear);
    assert!(shoot(&gpu, Some(FogSettings::DEFAULT), &background)? != clear);
    Ok(())
}
