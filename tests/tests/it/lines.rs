//! Lines and points: lit pixels compared with positions, in every kind of frame.

mod frames;

use crate::stage::{Shot, declared, gpu, lighting, view_of};
use framegraph::{Options, Plan, Scratch, compile};
use framegraph_passes::gpu_scene::shadow_views::ShadowSettings;
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::{Settings, World};
use framegraph_scene::{Aabb, AlphaMode, Camera, Environment, Material, Mesh, Projection, Scene, Topology, progress};
use framegraph_wgpu::{Gpu, Imports, read_texture};
use glam::{DMat4, DQuat, DVec2, DVec3, Vec3, Vec4};
use std::error::Error;
use tests::executors;

type TestResult = Result<(), Box<dyn Error>>;

/// Width and height of the pictures; a unit of the scene is one pixel.
const SIZE: usize = 48;

/// Returns an unlit material of a color.
fn unlit(color: Vec3) -> Material {
    Material { unlit: true, ..Material::dielectric("unlit", color, 1.0) }
}

/// Creates primitives without normals at positions in pixels from the upper left.
fn mesh(topology: Topology, places_px: &[DVec2]) -> Mesh {
    let half = SIZE as f64 / 2.0;
    let positions: Vec<Vec3> = places_px.iter().map(|at| DVec3::new(at.x - half, half - at.y, 0.0).as_vec3()).collect();
    let indices = (0..positions.len() as u32).collect();
    Mesh { topology, bounds: Aabb::from_points(&positions), positions, indices, ..Mesh::default() }
}

/// Creates an orthographic scene in which a unit is one pixel.
fn scene() -> Scene {
    let projection =
        Projection::Orthographic { half_width_m: None, half_height_m: SIZE as f64 / 2.0, near_m: 1.0, far_m: 100.0 };
    let camera = Camera { name: "front".into(), eye: DVec3::Z * 50.0, world_from_view: DQuat::IDENTITY, projection };
    Scene { name: "lines".into(), cameras: vec![camera], ..Scene::default() }
}

fn put(scene: &mut Scene, mesh: Mesh, material: Material, at: DVec3) {
    let (mesh, material) = (scene.add_mesh(mesh), scene.add_material(material));
    scene.add_instance("it", mesh, material, DMat4::from_translation(at));
}

/// Returns pre-exposed radiance row by row, on black; the exposure is 1 to within a few thousandths.
fn radiance(gpu: &Gpu, scene: &Scene, settings: Settings) -> Result<Vec<Vec3>, Box<dyn Error>> {
    let size_px = [SIZE as u32; 2];
    let settings = settings.for_scene(scene, size_px);
    let shot = Shot { size_px, ev100: 0.0, settings, options: Options::for_frame(size_px[0], size_px[1]) };
    let lighting = lighting(gpu, &Environment::uniform(DVec3::splat(0.1))?, &settings.shading)?;
    let view = view_of(scene, &lighting.image, &Background::None, &shot);
    let world = World::new(gpu, scene, lighting, [view], &mut progress::silent)?;
    let (mut frame, io) = declared(&settings);
    frame.graph_mut().readback(io.hdr)?;
    let mut plan = Plan::new();
    compile(frame.graph(), &gpu.caps(), &shot.options, &mut Scratch::new(), &mut plan)?;
    let mut executor = executors::lend(gpu);
    executor.execute(&plan, &frame, &world, &Imports::new())?;
    let texture = executor.texture(&plan, io.hdr).ok_or("the frame left no picture")?;
    Ok(read_texture(gpu, texture)?.rgba().iter().map(|[r, g, b, _]| Vec3::new(*r, *g, *b)).collect())
}

/// Returns settings of a frame without effects.
fn plain(samples: u8, prepass: bool, shadows: bool) -> Settings {
    let shadows = shadows.then(|| ShadowSettings::texels(128));
    Settings { samples, prepass, shadows, fxaa: false, ..Settings::default() }
}

/// Returns the frames without effects that a device can draw.
fn frames(gpu: &Gpu) -> Vec<Settings> {
    let most = if gpu.info().backend == wgpu::Backend::Gl { 1 } else { 4 };
    let all = [(1, true, true), (1, false, false), (4, true, false), (4, false, true)];
    all.into_iter()
        .filter(|row| row.0 <= most)
        .map(|(samples, prepass, shadows)| plain(samples, prepass, shadows))
        .collect()
}

/// Returns the distance of a point from a segment.
fn distance(point: DVec2, [from, to]: [DVec2; 2]) -> f64 {
    let along = to - from;
    let share = ((point - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    point.distance(from + along * share)
}

/// Compares a picture with segments one pixel wide that do not intersect. All light is within a pixel of a segment.
/// Each column of a flat segment, or row of a steep one, has the light of one pixel.
fn is_drawn_as(light: &[f32], segments: &[[DVec2; 2]], samples: u8) {
    for (at, light) in light.iter().enumerate().filter(|(_, light)| **light > 0.0) {
        let center = DVec2::new((at % SIZE) as f64 + 0.5, (at / SIZE) as f64 + 0.5);
        let near = segments.iter().map(|segment| distance(center, *segment)).fold(f64::INFINITY, f64::min);
        assert!(near < 1.01, "pixel {center} has {light}, {near:.2} pixels from every line");
    }
    for segment in segments {
        let along = (segment[1] - segment[0]).abs();
        let axis = usize::from(along.y > along.x);
        let (first, last) = (segment[0][axis].min(segment[1][axis]), segment[0][axis].max(segment[1][axis]));
        // Ends may have one pixel more or less.
        for step in first.ceil() as usize + 1..last.floor() as usize - 1 {
            let column = (0..SIZE).map(|across| {
                let at = if axis == 0 {
                    DVec2::new(step as f64, across as f64)
                } else {
                    DVec2::new(across as f64, step as f64)
                };
                let own = distance(at + 0.5, *segment) < 1.6;
                if own { light[at.y as usize * SIZE + at.x as usize] } else { 0.0 }
            });
            let sum = column.sum::<f32>();
            // A device draws one pixel per step, or a rectangle one pixel wide, which is up to √2 pixels high if
            // slanted. With one sample, this covers one or two pixels; with four samples, three to seven samples.
            let range = if samples == 1 { 0.99..=2.01 } else { 0.74..=1.76 };
            assert!(range.contains(&sum), "step {step} of {segment:?} along axis {axis}: {sum}");
        }
    }
}

/// Flat, steep, diagonal and axis-parallel lines light the pixels along them.
#[test]
fn lines_light_the_pixels_along_them() -> TestResult {
    let Some(gpu) = gpu("lines_light_the_pixels_along_them") else { return Ok(()) };
    let segments = [
        [(3.2, 4.3), (44.7, 9.1)],
        [(4.6, 12.2), (12.9, 44.4)],
        [(16.3, 16.4), (26.3, 26.4)],
        [(45.2, 14.7), (20.1, 42.2)],
        [(17.5, 45.5), (45.5, 45.5)],
        [(46.5, 12.5), (46.5, 40.5)],
    ]
    .map(|segment| segment.map(DVec2::from));
    let mut lines = scene();
    put(&mut lines, mesh(Topology::Lines, segments.as_flattened()), unlit(Vec3::ONE), DVec3::ZERO);
    for settings in frames(&gpu) {
        let light: Vec<f32> = radiance(&gpu, &lines, settings)?.iter().map(|light| light.x).collect();
        is_drawn_as(&light, &segments, settings.samples);
    }
    Ok(())
}

/// A point lights only the pixel that contains it, in its vertex color. A scene of only points is drawn.
#[test]
fn points_light_the_pixels_that_they_are_in() -> TestResult {
    let Some(gpu) = gpu("points_light_the_pixels_that_they_are_in") else { return Ok(()) };
    let places: Vec<(usize, usize)> = (0..20).map(|i| (i * 17 % SIZE, i * 29 % SIZE)).collect();
    let middles: Vec<DVec2> = places.iter().map(|(x, y)| DVec2::new(*x as f64 + 0.5, *y as f64 + 0.5)).collect();
    let mut points = mesh(Topology::Points, &middles);
    let color = |i: usize| Vec3::new(1.0, 0.5, (i % 4) as f32 / 4.0);
    points.colors = (0..places.len()).map(|i| color(i).extend(1.0)).collect();
    let mut scene = scene();
    put(&mut scene, points, unlit(Vec3::ONE), DVec3::ZERO);
    for settings in frames(&gpu) {
        for (at, light) in radiance(&gpu, &scene, settings)?.into_iter().enumerate() {
            let own = places.iter().position(|place| *place == (at % SIZE, at / SIZE));
            let expected = own.map_or(Vec3::ZERO, color);
            assert!(light.abs_diff_eq(expected, 1e-3), "pixel {at}: {light}, not {expected}, {settings:?}");
        }
    }
    Ok(())
}

/// Near lines hide far triangles and the reverse. Blended lines cover by alpha, and masked ones below the cutoff are
/// not drawn.
#[test]
fn depth_and_alpha_are_those_of_triangles() -> TestResult {
    let Some(gpu) = gpu("depth_and_alpha_are_those_of_triangles") else { return Ok(()) };
    let row = |y: f64| mesh(Topology::Lines, &[DVec2::new(4.0, y), DVec2::new(44.0, y)]);
    let of_alpha =
        |alpha: AlphaMode, a: f32| Material { alpha, base_color: Vec4::new(1.0, 0.0, 0.0, a), ..unlit(Vec3::ONE) };
    let mask = AlphaMode::Mask { cutoff: 0.5 };
    let mut scene = scene();
    let wall = framegraph_scene::geometry::cuboid(Vec3::new(10.0, 30.0, 0.1));
    put(&mut scene, wall, unlit(Vec3::new(0.0, 0.5, 0.0)), DVec3::ZERO);
    for (y, material, z) in [
        (5.5, of_alpha(AlphaMode::Opaque, 0.2), 2.0),
        (10.5, of_alpha(AlphaMode::Opaque, 1.0), -2.0),
        (15.5, of_alpha(AlphaMode::Blend, 0.25), 2.0),
        (20.5, of_alpha(mask, 0.6), 2.0),
        (25.5, of_alpha(mask, 0.4), 2.0),
        (30.5, of_alpha(AlphaMode::Blend, 0.25), -2.0),
    ] {
        put(&mut scene, row(y), material, DVec3::Z * z);
    }
    for settings in frames(&gpu) {
        let light = radiance(&gpu, &scene, settings)?;
        // The wall is 20 pixels wide.
        let [beside, before] = [10, 24].map(|x| [5, 10, 15, 20, 25, 30].map(|y: usize| light[y * SIZE + x]));
        let (red, green) = (Vec3::X, Vec3::Y * 0.5);
        let expected_beside = [red, red, red * 0.25, red, Vec3::ZERO, red * 0.25];
        let expected_before = [red, green, Vec3::new(0.25, 0.375, 0.0), red, green, green];
        for (found, expected) in
            beside.into_iter().chain(before).zip(expected_beside.into_iter().chain(expected_before))
        {
            assert!(found.abs_diff_eq(expected, 2e-3), "{found}, not {expected}: {beside:?} {before:?}");
        }
    }
    Ok(())
}

/// Without normals, base color and emission add up; with normals, lines and points are lit like a plane with that
/// normal.
#[test]
fn lines_with_normals_are_lit_and_others_are_not() -> TestResult {
    let Some(gpu) = gpu("lines_with_normals_are_lit_and_others_are_not") else { return Ok(()) };
    let places = [DVec2::new(4.5, 10.5), DVec2::new(44.5, 10.5)];
    let emitting = Material { emissive: Vec3::new(0.0, 0.25, 0.5), ..unlit(Vec3::new(0.5, 0.25, 0.0)) };
    let clay = Material::dielectric("clay", Vec3::new(0.8, 0.4, 0.2), 0.7);
    let lit = |own: Mesh| Mesh { normals: vec![Vec3::Z; own.positions.len()], ..own };
    let mut scene = scene();
    for (row, topology) in [Topology::Lines, Topology::Points].into_iter().enumerate() {
        let down = DVec3::NEG_Y * 10.0 * row as f64;
        put(&mut scene, mesh(topology, &places), emitting.clone(), down);
        put(&mut scene, lit(mesh(topology, &places)), clay.clone(), down - DVec3::Y * 5.0);
    }
    put(&mut scene, framegraph_scene::geometry::cuboid(Vec3::new(22.0, 2.0, 0.1)), clay, DVec3::NEG_Y * 18.0);
    scene.lights.push(framegraph_scene::Light::directional("sun", Vec3::new(0.3, -0.4, -1.0).normalize(), 2.0));
    for settings in frames(&gpu) {
        let light = radiance(&gpu, &scene, settings)?;
        // A point, or the middle of a line.
        let at = |y: usize| light[y * SIZE + if y < 20 { 24 } else { 4 }];
        let wall = at(42);
        assert!(wall.min_element() > 0.05, "the wall is lit: {wall}");
        for y in [10, 20] {
            assert!(at(y).abs_diff_eq(Vec3::new(0.5, 0.5, 0.5), 2e-3), "row {y}: {}", at(y));
            // Half floats; the position in the picture does not change the view direction.
            assert!(
                (at(y + 5) - wall).abs().max_element() < 4e-3 * wall.max_element(),
                "row {y}: {} {wall}",
                at(y + 5)
            );
        }
    }
    Ok(())
}
