//! Scenes with a number that is zero, negative or far too large: every pixel is finite, and the rest of the scene stays
//! visible.

use crate::stage::{Shot, declared, gpu, lighting};
use framegraph::{Plan, Scratch, compile};
use framegraph_passes::gpu_scene::view::{Background, ViewSettings};
use framegraph_passes::{CameraView, Settings, World};
use framegraph_scene::environment::Sky;
use framegraph_scene::geometry::{plane, sphere};
use framegraph_scene::light::LightKind;
use framegraph_scene::{Camera, Light, Material, Projection, Scene, progress};
use framegraph_wgpu::{Gpu, Imports, read_texture};
use glam::{DMat4, DQuat, DVec3, Vec2, Vec3};
use std::error::Error;
use tests::executors;

type TestResult = Result<(), Box<dyn Error>>;

/// Returns a sphere of 1 m on a floor under a sun.
fn base(origin: DVec3) -> Scene {
    let mut scene = Scene::default();
    let material = scene.add_material(Material::dielectric("clay", Vec3::splat(0.5), 0.4));
    let ball = scene.add_mesh(sphere(1.0, 16, 8));
    scene.add_instance("ball", ball, material, DMat4::from_translation(origin));
    let floor = scene.add_mesh(plane(Vec2::splat(8.0), 1, Vec2::ONE));
    scene.add_instance("floor", floor, material, DMat4::from_translation(origin - DVec3::Y));
    scene.lights.push(Light::directional("sun", Vec3::new(-0.3, -0.8, -0.5), 110_000.0));
    scene
}

fn camera(eye: DVec3, target: DVec3) -> Result<Camera, Box<dyn Error>> {
    Ok(Camera::look_at(eye, target, DVec3::Y, Projection::perspective(0.8, 0.1))?)
}

/// Returns radiance times exposure of every pixel.
fn radiance(
    gpu: &Gpu,
    scene: &Scene,
    camera: Camera,
    size_px: [u32; 2],
    ev100: f32,
) -> Result<Vec<[f32; 4]>, Box<dyn Error>> {
    let options = framegraph::Options::for_frame(size_px[0], size_px[1]);
    let shot = Shot { size_px, options, ev100, ..Shot::small(Settings::default()) };
    let environment = Sky::default().environment(32)?;
    let lighting = lighting(gpu, &environment, &shot.settings.shading)?;
    let moment = ViewSettings { camera, size_px, ev100, shadows: shot.settings.shadows, ..ViewSettings::default() };
    let view = CameraView::new(scene, &lighting.image, &Background::Environment, &moment);
    let world = World::new(gpu, scene, lighting, [view], &mut progress::silent)?;
    let (mut frame, io) = declared(&shot.settings.for_scene(scene, size_px));
    frame.graph_mut().readback(io.hdr)?;
    let mut plan = Plan::new();
    compile(frame.graph(), &gpu.caps(), &shot.options, &mut Scratch::new(), &mut plan)?;
    let mut executor = executors::lend(gpu);
    executor.execute(&plan, &frame, &world, &Imports::new())?;
    let texture = executor.texture(&plan, io.hdr).ok_or("the frame left no radiance")?;
    Ok(read_texture(gpu, texture)?.rgba())
}

/// Checks that every channel is finite by its bits, not negative, and within the range of half floats, and that the
/// picture is not all black.
fn is_sound(what: &str, pixels: &[[f32; 4]]) {
    let channels = || pixels.iter().flat_map(|p| &p[..3]);
    assert!(
        channels().all(|c| c.to_bits() <= 65504.0_f32.to_bits()),
        "{what}: {:?}",
        channels().find(|c| c.to_bits() > 65504.0_f32.to_bits())
    );
    assert!(channels().any(|c| *c > 0.0), "{what} is black");
}

const SIDE: [u32; 2] = [48, 48];

fn seen(gpu: &Gpu, what: &str, scene: &Scene) -> TestResult {
    let camera = camera(DVec3::new(2.0, 1.5, 4.0), DVec3::ZERO)?;
    is_sound(what, &radiance(gpu, scene, camera, SIDE, 14.5)?);
    Ok(())
}

#[test]
fn meshes_without_area_and_direction() -> TestResult {
    let Some(gpu) = gpu("meshes_without_area_and_direction") else { return Ok(()) };
    let mut scene = base(DVec3::ZERO);
    let material = scene.instances[0].material;
    let mut flat = sphere(1.2, 8, 4);
    // A third of the vertices coincide; normals and tangents have length 0 or are NaN.
    let first = flat.positions[0];
    flat.positions.iter_mut().step_by(3).for_each(|p| *p = first);
    flat.normals.iter_mut().for_each(|n| *n = Vec3::ZERO);
    flat.tangents.iter_mut().for_each(|t| *t = glam::Vec4::ZERO);
    let flat = scene.add_mesh(flat);
    scene.add_instance("flat", flat, material, DMat4::IDENTITY);
    let mut line = sphere(1.0, 8, 4);
    line.positions.iter_mut().for_each(|p| *p = Vec3::new(p.x, 0.0, 0.0));
    let line = scene.add_mesh(line);
    scene.add_instance("line", line, material, DMat4::IDENTITY);
    seen(&gpu, "zero area, zero normals", &scene)
}

#[test]
fn scales_of_nothing_and_less() -> TestResult {
    let Some(gpu) = gpu("scales_of_nothing_and_less") else { return Ok(()) };
    let mut scene = base(DVec3::ZERO);
    let (mesh, material) = (scene.instances[0].mesh, scene.instances[0].material);
    let scales = [[1.0, 1.0, 0.0], [0.0; 3], [1e-13; 3], [-1.0, 1.0, 1.0], [1e4, 1.0, 1e-8]];
    for (at, scale) in scales.into_iter().enumerate() {
        let place = DVec3::new(at as f64 - 2.0, 0.0, 0.5);
        let placed = DMat4::from_scale_rotation_translation(DVec3::from_array(scale), DQuat::IDENTITY, place);
        scene.add_instance("scaled", mesh, material, placed);
    }
    seen(&gpu, "scales of nothing and less", &scene)
}

#[test]
fn lights_at_surfaces_and_along_the_view() -> TestResult {
    let Some(gpu) = gpu("lights_at_surfaces_and_along_the_view") else { return Ok(()) };
    let mut scene = base(DVec3::ZERO);
    let lamp = |kind, position, direction| Light { kind, position, ..Light::directional("lamp", direction, 0.0) };
    let point = LightKind::Point { intensity_candela: 1000.0, range_m: None };
    let cone = |inner_cone_rad, outer_cone_rad| LightKind::Spot {
        intensity_candela: 1000.0,
        range_m: Some(5.0),
        inner_cone_rad,
        outer_cone_rad,
    };
    // Lights on the floor, in the ball and at the eye; a cone with equal angles, and one of 0.5°; a sun along the view
    // direction.
    scene.lights.push(lamp(point, DVec3::new(1.5, -1.0, 0.5), Vec3::NEG_Y));
    scene.lights.push(lamp(point, DVec3::ZERO, Vec3::NEG_Y));
    scene.lights.push(lamp(point, DVec3::new(2.0, 1.5, 4.0), Vec3::NEG_Y));
    scene.lights.push(lamp(cone(0.4, 0.4), DVec3::Y * 3.0, Vec3::NEG_Y));
    scene.lights.push(lamp(cone(0.0, 0.0087), DVec3::new(0.0, 3.0, 1.5), Vec3::NEG_Y));
    scene.lights.push(Light::directional("along", Vec3::new(-2.0, -1.5, -4.0).normalize(), 1000.0));
    scene.lights.push(Light::directional("against", Vec3::new(2.0, 1.5, 4.0).normalize(), 1000.0));
    seen(&gpu, "lights at surfaces", &scene)
}

/// At a distance of 1000 km from the origin, the picture is unchanged, apart from f64 rounding. Positions are relative
/// to the eye before they are converted to f32.
#[test]
fn a_thousand_kilometers_from_the_origin() -> TestResult {
    let Some(gpu) = gpu("a_thousand_kilometers_from_the_origin") else { return Ok(()) };
    let shoot = |origin: DVec3| {
        let camera = camera(origin + DVec3::new(2.0, 1.5, 4.0), origin)?;
        radiance(&gpu, &base(origin), camera, SIDE, 14.5)
    };
    let (near, far) = (shoot(DVec3::ZERO)?, shoot(DVec3::new(1e6, -1e6, 1e6))?);
    is_sound("far away", &far);
    let apart = near.iter().zip(&far).filter(|(a, b)| (0..3).any(|c| (a[c] - b[c]).abs() > 0.02 * (a[c] + 0.02)));
    // Pixels on an edge or a shadow's edge, where 1e-10 m decide.
    assert!(apart.count() < near.len() / 50);
    Ok(())
}

#[test]
fn targets_of_a_pixel_and_of_a_line() -> TestResult {
    let Some(gpu) = gpu("targets_of_a_pixel_and_of_a_line") else { return Ok(()) };
    for size in [[1, 1], [1, 777], [3, 2]] {
        let camera = camera(DVec3::new(2.0, 1.5, 4.0), DVec3::ZERO)?;
        let pixels = radiance(&gpu, &base(DVec3::ZERO), camera, size, 14.5)?;
        assert_eq!(pixels.len(), (size[0] * size[1]) as usize);
        is_sound(&format!("{size:?}"), &pixels);
    }
    Ok(())
}

/// With an exposure for the dark, sunlight exceeds half floats and is clamped. Inside the ball, nothing outside is
/// visible.
#[test]
fn exposures_from_cave_to_sun() -> TestResult {
    let Some(gpu) = gpu("exposures_from_cave_to_sun") else { return Ok(()) };
    let eye = DVec3::new(2.0, 1.5, 4.0);
    let most = |pixels: &[[f32; 4]]| pixels.iter().flat_map(|p| &p[..3]).fold(0.0_f32, |a, b| a.max(*b));
    for (ev100, held) in [(-10.0, true), (0.0, false), (24.0, false)] {
        let pixels = radiance(&gpu, &base(DVec3::ZERO), camera(eye, DVec3::ZERO)?, SIDE, ev100)?;
        is_sound(&format!("EV {ev100}"), &pixels);
        assert_eq!(most(&pixels) == 65504.0, held, "EV {ev100}: {}", most(&pixels));
    }
    let inside = radiance(&gpu, &base(DVec3::ZERO), camera(DVec3::new(0.2, 0.0, 0.0), DVec3::X)?, SIDE, 14.5)?;
    assert!(inside.iter().flatten().all(|c| c.to_bits() <= 65504.0_f32.to_bits()), "in the ball");
    let mut empty = base(DVec3::ZERO);
    empty.instances.clear();
    is_sound("nothing in the scene", &radiance(&gpu, &empty, camera(eye, DVec3::ZERO)?, SIDE, 14.5)?);
    Ok(())
}
