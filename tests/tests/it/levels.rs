//! Levels of detail: pictures are close to those of full meshes, and simplified casters add no shadows.

use crate::stage::{Shot, declared, gpu, lighting};
use framegraph::{Options, Plan, Scratch, compile};
use framegraph_passes::gpu_scene::draws::ViewDraws;
use framegraph_passes::gpu_scene::shadow_views::ShadowSettings;
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::{CameraView, LightSearch, Settings, ViewId, ViewSettings, World};
use framegraph_scene::environment::Sky;
use framegraph_scene::geometry::{plane, sphere, torus};
use framegraph_scene::{Camera, Light, Material, Projection, Scene, progress};
use framegraph_wgpu::{Gpu, Imports, read_texture};
use glam::{DMat4, DVec3, Vec2, Vec3};
use std::error::Error;
use tests::executors;

const SIZE_PX: [u32; 2] = [192, 128];

/// Returns balls and rings from near to far on a floor, each a mesh with its own draw.
fn rows() -> Result<Scene, Box<dyn Error>> {
    let mut scene = Scene::default();
    let clay = scene.add_material(Material::dielectric("clay", Vec3::new(0.8, 0.3, 0.2), 0.35));
    let floor = scene.add_mesh(plane(Vec2::splat(60.0), 1, Vec2::ONE));
    scene.add_instance("floor", floor, clay, DMat4::IDENTITY);
    for i in 0..8_u32 {
        let mesh = scene.add_mesh(if i % 3 == 2 { torus(0.4, 0.12, 40, 20) } else { sphere(0.45, 56, 28) });
        let at = DVec3::new(1.1 * f64::from(i % 2) - 0.55, 0.5, -2.5 * f64::from(i / 2));
        let turned = DMat4::from_rotation_x(f64::from(i)) * DMat4::from_scale(DVec3::new(1.0, 1.0, 1.1));
        scene.add_instance("one", mesh, clay, DMat4::from_translation(at) * turned);
    }
    scene.lights.push(Light::directional("sun", Vec3::new(-0.5, -0.8, -0.3).normalize(), 60_000.0));
    scene.make_levels(&mut progress::silent)?;
    Ok(scene)
}

fn shoot(gpu: &Gpu, world: &World, settings: &Settings) -> Result<Vec<u8>, Box<dyn Error>> {
    let (frame, io) = declared(settings);
    let (mut plan, options) = (Plan::new(), Options::for_frame(SIZE_PX[0], SIZE_PX[1]));
    compile(frame.graph(), &gpu.caps(), &options, &mut Scratch::new(), &mut plan)?;
    let mut executor = executors::lend(gpu);
    executor.execute(&plan, &frame, world, &Imports::new())?;
    Ok(read_texture(gpu, executor.texture(&plan, io.output).ok_or("the frame left no picture")?)?.rgba8())
}

/// Returns the share of pixels with a channel that differs by more than 8 8-bit steps, and the PSNR in dB.
fn apart(a: &[u8], b: &[u8]) -> (f64, f64) {
    let off = |(a, b): (&[u8], &[u8])| a.iter().zip(b).take(3).any(|(a, b)| a.abs_diff(*b) > 8);
    let differ = a.chunks(4).zip(b.chunks(4)).filter(|pair| off(*pair)).count();
    let square = a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2)).sum::<f64>() / a.len() as f64;
    (differ as f64 / (a.len() / 4) as f64, 10.0 * (255.0 * 255.0 / square.max(1e-9)).log10())
}

#[test]
fn a_pixel_off_is_hardly_seen_and_surfaces_shadow_nothing_of_their_own() -> Result<(), Box<dyn Error>> {
    let Some(gpu) = gpu("a_pixel_off_is_hardly_seen_and_surfaces_shadow_nothing_of_their_own") else { return Ok(()) };
    let scene = rows()?;
    let settings = Settings { shadows: Some(ShadowSettings::texels(1024)), ..Settings::DEFAULT };
    let shot = Shot { size_px: SIZE_PX, ..Shot::small(settings) };
    let settings = settings.for_scene(&scene, SIZE_PX);
    let lighting = lighting(&gpu, &Sky::default().environment(128)?, &settings.shading)?;
    let view = |lod_error_px: f32| -> Result<CameraView, Box<dyn Error>> {
        let eye = DVec3::new(0.4, 2.2, 3.4);
        let seen = ViewSettings {
            camera: Camera::look_at(eye, DVec3::new(0.0, 0.2, -2.0), DVec3::Y, Projection::perspective(0.8, 0.1))?,
            size_px: SIZE_PX,
            ev100: shot.ev100,
            shadows: settings.shadows,
            lights: LightSearch::All,
            lod_error_px,
            ..ViewSettings::default()
        };
        Ok(CameraView::new(&scene, &lighting.image, &Background::Environment, &seen))
    };
    let whole = view(0.0)?;
    let triangles = |view: &CameraView| {
        let of = |batch: &framegraph_scene::Batch| {
            let mesh = &scene.meshes[scene.instances[batch.instance as usize].mesh.index()];
            mesh.indices_in(batch.level).len() / 3
        };
        view.draws.surfaces[0].iter().map(of).sum::<usize>()
    };
    // Negative control: full casters with simplified surfaces.
    let far = view(8.0)?;
    assert_eq!(far.draws.numbers, whole.draws.numbers);
    let draws = ViewDraws { casters: whole.draws.casters.clone(), ..far.draws.clone() };
    let mixed = CameraView { draws, ..far };
    let views = [0.5, 1.0, 2.0, 4.0, 8.0].map(|lod_error_px| (lod_error_px, view(lod_error_px)));
    let mut world = World::new(&gpu, &scene, lighting, [whole.clone()], &mut progress::silent)?;
    let first = shoot(&gpu, &world, &settings)?;
    let mut table = vec![(0.0, triangles(&whole), 0.0, f64::INFINITY)];
    for (lod_error_px, view) in views {
        let (view, before) = (view?, table[table.len() - 1]);
        let count = triangles(&view);
        world.set_view(&gpu, ViewId::MAIN, view)?;
        let (share, db) = apart(&shoot(&gpu, &world, &settings)?, &first);
        assert!(count < before.1 && db < before.3, "{lod_error_px} px: {count} triangles, {db} dB after {before:?}");
        table.push((lod_error_px, count, share, db));
    }
    // With an error limit of 1 pixel, only pixels at edges differ.
    let pixel = table[2];
    assert!(pixel.1 * 3 < table[0].1 * 2 && pixel.2 < 0.02 && pixel.3 > 38.0, "{table:?}");
    world.set_view(&gpu, ViewId::MAIN, mixed)?;
    let (share, _) = apart(&shoot(&gpu, &world, &settings)?, &first);
    assert!(share > table[5].2 + 0.005, "another level's shadow is not seen: {share} after {table:?}");
    is_documented(&table);
    Ok(())
}

/// Compares the document's rows: triangle counts exactly, pictures within the tolerance between drivers.
fn is_documented(table: &[(f32, usize, f64, f64)]) {
    let document = include_str!("../../../docs/measurements/performance.md");
    let marked = document.split_once("<!-- table: levels -->").and_then(|(_, rest)| rest.split_once("<!-- end -->"));
    let rows: Vec<Vec<&str>> =
        marked.map_or("", |(rows, _)| rows).lines().filter(|line| line.starts_with("| ")).map(cells).collect();
    let row = |(error_px, triangles, share, db): &(f32, usize, f64, f64)| {
        format!("| {error_px} | {triangles} | {:.2} | {db:.1} |", 100.0 * share)
    };
    table.iter().for_each(|own| program::line(format_args!("{}", row(own))));
    for own in table {
        let (error_px, triangles, share, db) = own;
        let near = |cells: &Vec<&str>| {
            let is = |at: usize, found: f64, off: f64| {
                cells[at].parse::<f64>().is_ok_and(|there| there == found || (there - found).abs() <= off)
            };
            let same = cells[0] == error_px.to_string() && cells[1] == triangles.to_string();
            same && is(2, 100.0 * share, 0.1 + 20.0 * share) && is(3, *db, 1.0)
        };
        assert!(rows.iter().any(near), "docs/measurements/performance.md has not: {}", row(own));
    }
}

fn cells(line: &str) -> Vec<&str> {
    line.trim_matches('|').split('|').map(str::trim).collect()
}
