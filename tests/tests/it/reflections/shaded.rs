//! Shading with reflections.

use super::TestResult;
use crate::stage::{Shot, declared, gpu, lighting, view_of};
use crate::transmission::below;
use framegraph::{Plan, Scratch, compile};
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::{Precision, ReflectionSettings, Settings, ViewId, World};
use framegraph_scene::geometry::plane;
use framegraph_scene::{Camera, Environment, Material, Projection, Scene, Transmission, progress};
use framegraph_wgpu::{Gpu, Imports, read_texture};
use glam::{DMat4, DVec2, DVec3, Vec2, Vec3};
use std::error::Error;
use tests::executors;
use truth::reflection::Lens;

/// Radiance of the uniform light, in nits.
const NITS: f64 = 1000.0;
/// Color of the wall.
const WALL: Vec3 = Vec3::new(0.7, 0.2, 0.05);
/// Positions of the eye and of the point it looks at.
const EYE: [DVec3; 2] = [DVec3::new(0.0, 1.0, 2.0), DVec3::new(0.0, 0.2, -1.0)];
const FOV_Y_RAD: f64 = 0.7;

/// Creates a floor in front of a matte wall at z = -1 m, whose right half can have another color.
fn room(floor: Material, right: Vec3) -> Scene {
    let mut scene = Scene { name: "room".into(), ..Scene::default() };
    let floor = scene.add_material(floor);
    let flat = scene.add_mesh(plane(Vec2::splat(8.0), 1, Vec2::ONE));
    scene.add_instance("floor", flat, floor, DMat4::IDENTITY);
    for (color, x) in [(WALL, -4.0), (right, 4.0)] {
        let wall = scene.add_material(Material::dielectric("wall", color, 1.0));
        let upright = DMat4::from_rotation_x(std::f64::consts::FRAC_PI_2);
        scene.add_instance("wall", flat, wall, DMat4::from_translation(DVec3::new(x, 0.0, -1.0)) * upright);
    }
    let projection = Projection::perspective(FOV_Y_RAD, 0.1);
    scene.cameras.extend(Camera::look_at(EYE[0], EYE[1], DVec3::Y, projection));
    scene
}

fn mirror(roughness: f32) -> Material {
    Material { metallic: 1.0, ..Material::dielectric("mirror", Vec3::ONE, roughness) }
}

/// Returns the pre-exposed radiance of several frames.
fn frames(gpu: &Gpu, scene: &Scene, settings: Settings, count: usize) -> Result<Vec<Vec<Vec3>>, Box<dyn Error>> {
    exposed(gpu, scene, settings, &vec![10.0; count])
}

/// Returns the pre-exposed radiance of one frame per EV100.
fn exposed(gpu: &Gpu, scene: &Scene, settings: Settings, ev100: &[f32]) -> Result<Vec<Vec<Vec3>>, Box<dyn Error>> {
    let shot = Shot::small(Settings { shadows: None, ..settings });
    let environment = Environment::uniform(DVec3::splat(NITS))?;
    let lighting = lighting(gpu, &environment, &shot.settings.shading)?;
    let shot = Shot { settings: shot.settings.for_scene(scene, shot.size_px), ev100: ev100[0], ..shot };
    let view = |ev100: &f32| view_of(scene, &lighting.image, &Background::None, &Shot { ev100: *ev100, ..shot });
    let mut views = ev100.iter().map(view).collect::<Vec<_>>().into_iter();
    let first = views.next().ok_or("no frame is asked for")?;
    let mut world = World::new(gpu, scene, lighting, [first], &mut progress::silent)?;
    let (mut frame, io) = declared(&shot.settings);
    frame.graph_mut().readback(io.hdr)?;
    let mut plan = Plan::new();
    compile(frame.graph(), &gpu.caps(), &shot.options, &mut Scratch::new(), &mut plan)?;
    let mut executor = executors::lend(gpu);
    let mut render = |world: &World| -> Result<_, Box<dyn Error>> {
        executor.execute(&plan, &frame, world, &Imports::new())?;
        assert_eq!(executor.executed(), plan.counts(), "executed against planned");
        let texels = read_texture(gpu, executor.texture(&plan, io.hdr).ok_or("no picture")?)?.rgba();
        Ok(texels.iter().map(|[r, g, b, _]| Vec3::new(*r, *g, *b)).collect())
    };
    let mut pictures = vec![render(&world)?];
    for view in views {
        let earlier = world.views.get(ViewId::MAIN)?.view.clone();
        world.set_view(gpu, ViewId::MAIN, view.after(&earlier))?;
        pictures.push(render(&world)?);
    }
    Ok(pictures)
}

fn with_reflections() -> Settings {
    Settings { reflections: Some(ReflectionSettings::DEFAULT), ..Settings::default() }
}

/// Returns the index of a pixel in a picture of [`Shot::small`].
fn at(x: usize, y: usize) -> usize {
    y * 160 + x
}

/// Under uniform light, a mirror shows white for the environment and the wall's radiance for the wall, to within a few bits. Tested in each precision and with each number of samples. The first frame has no reflections.
#[test]
fn mirrors_show_the_wall() -> TestResult {
    let Some(gpu) = gpu("mirrors_show_the_wall") else { return Ok(()) };
    let scene = room(mirror(0.0), WALL);
    for (samples, precision) in [(1, Precision::Full), (4, Precision::Full), (1, Precision::Half)] {
        if let Err(error) = precision.check(&gpu) {
            test_report::skip("mirrors_show_the_wall", &error.to_string());
            continue;
        }
        let with = |settings: Settings| Settings { samples, ..settings };
        let with = |settings: Settings| {
            let shading = framegraph_passes::Shading { precision, ..settings.shading };
            with(Settings { shading, ..settings })
        };
        let off = frames(&gpu, &scene, with(Settings::default()), 1)?;
        let on = frames(&gpu, &scene, with(with_reflections()), 3)?;
        let near = |a: Vec3, b: Vec3, most: f32| ((a - b) / b).abs().max_element() < most;
        let apart = off[0].iter().zip(&on[0]).filter(|(a, b)| !near(**b, **a, 1e-3)).count();
        assert_eq!(apart, 0, "the first frame has no earlier one");
        // The center column, above and below the edge between wall and floor.
        let edge = (0..90).find(|y| off[0][at(80, *y)].y > 2.0 * off[0][at(80, 30)].y).ok_or("there is a floor")?;
        let (wall, floor) = (on[2][at(80, edge - 6)], on[2][at(80, edge + 6)]);
        // A hundredth of the environment's radiance, the size of a texel below the wall's foot.
        let environment = off[0][at(80, edge + 6)];
        let shows = |found: Vec3| (found - wall).abs().max_element() < 0.01 * environment.max_element();
        assert!(shows(floor), "{samples} samples, {precision:?}: {floor} shows {wall}");
        assert!(!shows(environment), "without, it shows the environment: {environment}");
        // Multiple reflections show earlier frames, and converge to within a hundredth.
        let apart = on[1].iter().zip(&on[2]).map(|(a, b)| (*a - *b).abs().max_element()).fold(0.0, f32::max);
        assert!(apart < 0.01 * environment.max_element(), "what stands still does not flicker: {apart}");
    }
    Ok(())
}

/// If the exposure changes between frames, reflections are rescaled to match.
#[test]
fn mirrors_follow_the_exposure() -> TestResult {
    let Some(gpu) = gpu("mirrors_follow_the_exposure") else { return Ok(()) };
    let pictures = exposed(&gpu, &room(mirror(0.0), WALL), with_reflections(), &[10.0, 10.0, 11.0])?;
    let most = |of: fn((&Vec3, &Vec3)) -> f32| pictures[1].iter().zip(&pictures[2]).map(of).fold(0.0, f32::max);
    // A hundredth of the brightest pixel.
    let most = most(|(a, b)| (*a - 2.0 * *b).abs().max_element()) / most(|(a, _)| a.max_element());
    assert!(most < 0.01, "{most}");
    Ok(())
}

/// A rough mirror blurs an edge by the width of its lobe times the ray's length. At the wall's foot rays are short, and
/// the reflection is as sharp as in a smooth mirror.
#[test]
fn rough_mirrors_blur_by_the_way() -> TestResult {
    let Some(gpu) = gpu("rough_mirrors_blur_by_the_way") else { return Ok(()) };
    let lens = Lens { eye: EYE[0], target: EYE[1], fov_y_rad: FOV_Y_RAD, aspect: 160.0 / 90.0 };
    let right = Vec3::splat(0.05);
    for roughness in [0.25_f32, 0.3] {
        let pictures = frames(&gpu, &room(mirror(roughness), right), with_reflections(), 2)?;
        for y in [64, 70] {
            // The center of the row, on the floor; its reflected ray hits the wall.
            let along = lens.along(DVec2::new(0.5, (y as f64 + 0.5) / 90.0));
            let place = EYE[0] - along * (EYE[0].y / along.y);
            let way_m = (-1.0 - place.z) / along.z;
            let ahead_m = (place - EYE[0]).dot((EYE[1] - EYE[0]).normalize()) + way_m;
            let alpha = f64::from(roughness * roughness);
            let sigma_px = 2.0 * 0.849 * alpha * way_m * 45.0 / ((0.5 * FOV_Y_RAD).tan() * ahead_m);
            let row: Vec<f64> = (55..105).map(|x| f64::from(pictures[1][at(x, y)].x)).collect();
            let (bright, dark) = (row[0], row[49]);
            assert!(bright > 3.0 * dark, "both halves are seen: {bright} {dark}");
            let worst = |sigma_px: f64| {
                let off = |(i, found): (usize, &f64)| {
                    ((found - dark) / (bright - dark) - below((24.5 - i as f64) / sigma_px)).abs()
                };
                row.iter().enumerate().map(off).fold(0.0, f64::max)
            };
            // Levels are powers of two, read with trilinear filters: an error of a few percent of the step. Negative
            // controls: half and twice the blur.
            let [off, half, twice] = [1.0, 0.5, 2.0].map(|factor| worst(factor * sigma_px));
            assert!(
                off < 0.06 && half > 0.09 && twice > 0.09,
                "{roughness}, row {y}, {sigma_px} px: {off}, {half}, {twice}"
            );
        }
        let [environment, smooth] = [(0.0, Settings::default()), (0.0, with_reflections())]
            .map(|(roughness, settings)| frames(&gpu, &room(mirror(roughness), WALL), settings, 2));
        let (environment, smooth) = (environment?, smooth?);
        let rough = frames(&gpu, &room(mirror(roughness), WALL), with_reflections(), 2)?;
        for y in 55..60 {
            let [environment, smooth, rough] = [&environment, &smooth, &rough].map(|of| of[1][at(80, y)].y);
            let share = (rough - smooth) / (environment - smooth);
            assert!(share.abs() < 0.1, "row {y}: {rough} between {smooth} and {environment}");
        }
    }
    Ok(())
}

/// A mirror above the roughness limit, and a transmissive one, are shaded as without reflections.
#[test]
fn what_traces_nothing_is_as_without() -> TestResult {
    let Some(gpu) = gpu("what_traces_nothing_is_as_without") else { return Ok(()) };
    let glass = Material {
        transmission: Some(Transmission { factor: 1.0, texture: None, volume: None }),
        ..Material::dielectric("glass", Vec3::ONE, 0.0)
    };
    for floor in [mirror(0.75), glass] {
        let name = floor.name.clone();
        let scene = room(floor, WALL);
        let [with, without] = [with_reflections(), Settings::default()].map(|s| frames(&gpu, &scene, s, 2));
        let (with, without) = (with?, without?);
        // A few bits: different shaders round differently.
        let off = |(a, b): (&Vec3, &Vec3)| ((*a - *b) / *b).abs().max_element() > 2e-3;
        assert_eq!(with[1].iter().zip(&without[1]).filter(|pair| off(*pair)).count(), 0, "{name}");
    }
    Ok(())
}
