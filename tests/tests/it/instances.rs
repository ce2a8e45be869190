//! Instanced and indirect draws: their number, and equality with one draw per instance.

use crate::stage::{Shot, declared, gpu, lighting, view_of};
use framegraph::{Options, Plan, Scratch, compile};
use framegraph_passes::gpu_scene::indirect::{LEAST_BATCHES, draws_indirectly};
use framegraph_passes::gpu_scene::shadow_views::{MomentSettings, ShadowFilter, ShadowSettings};
use framegraph_passes::gpu_scene::view::{Background, MAX_STREAMED};
use framegraph_passes::{CameraView, PreparedScene, Settings, ViewId, ViewSettings, World};
use framegraph_scene::environment::Sky;
use framegraph_scene::geometry::{cuboid, plane, sphere};
use framegraph_scene::texture::{Image, Sampler, TextureRole, TextureSlot, UvTransform};
use framegraph_scene::{AlphaMode, ClearCoat, Light, Material, MaterialId, Scene, Transmission, progress};
use framegraph_wgpu::{Gpu, Imports, read_texture};
use glam::{DMat4, DVec3, Vec3};
use std::error::Error;
use tests::executors;

type TestResult = Result<(), Box<dyn Error>>;

/// Returns rows of balls and boxes with all kinds of surfaces, many instances of each, some mirrored, on a floor.
fn crowd() -> Scene {
    let mut scene = Scene::default();
    let meshes = [cuboid(Vec3::splat(0.3)), sphere(0.35, 12, 8)].map(|mesh| scene.add_mesh(mesh));
    let clay = |hue: f32| Material::dielectric("clay", Vec3::new(hue, 0.4, 1.0 - hue), 0.4);
    let materials = [
        clay(0.9),
        clay(0.1),
        Material { clear_coat: Some(ClearCoat { factor: 1.0, ..ClearCoat::default() }), ..clay(0.5) },
        Material { double_sided: true, ..clay(0.7) },
        Material { alpha: AlphaMode::Mask { cutoff: 0.5 }, ..clay(0.3) },
        Material { alpha: AlphaMode::Blend, base_color: clay(0.2).base_color * 0.6, ..clay(0.2) },
        Material { transmission: Some(Transmission { factor: 1.0, ..Transmission::default() }), ..clay(0.8) },
    ]
    .map(|material| scene.add_material(material));
    let floor = scene.add_mesh(plane(DVec3::splat(20.0).as_vec3().truncate(), 1, glam::Vec2::ONE));
    scene.add_instance("floor", floor, materials[0], DMat4::from_translation(DVec3::NEG_Y * 0.4));
    for i in 0..120_usize {
        let mirror = if i % 5 == 0 { DVec3::new(-1.0, 1.0, 1.0) } else { DVec3::ONE };
        let at = DVec3::new((i % 12) as f64 - 5.5, 0.1 * (i % 3) as f64, -((i / 12) as f64));
        let placed = DMat4::from_translation(at) * DMat4::from_rotation_y(i as f64) * DMat4::from_scale(mirror);
        scene.add_instance("one", meshes[i / 3 % 2], materials[i % 7], placed);
    }
    scene.lights.push(Light::directional("sun", Vec3::new(-0.4, -0.8, -0.3).normalize(), 50_000.0));
    scene
}

fn draw(gpu: &Gpu, world: &World, settings: &Settings, options: &Options) -> Result<Vec<u8>, Box<dyn Error>> {
    let (frame, io) = declared(settings);
    let mut plan = Plan::new();
    compile(frame.graph(), &gpu.caps(), options, &mut Scratch::new(), &mut plan)?;
    let mut executor = executors::lend(gpu);
    executor.execute(&plan, &frame, world, &Imports::new())?;
    let picture = executor.texture(&plan, io.output).ok_or("the frame left no picture")?;
    Ok(read_texture(gpu, picture)?.rgba8())
}

/// Meshes with more than 65,536 vertices use 32-bit indices, others 16-bit ones, in the same buffer. The picture has
/// the same bytes whether unused vertices enlarge no mesh, one or all of them.
#[test]
fn short_and_long_indices_draw_the_same_picture() -> TestResult {
    let Some(gpu) = gpu("short_and_long_indices_draw_the_same_picture") else { return Ok(()) };
    let settings = Settings { shadows: Some(ShadowSettings::texels(128)), ..Settings::DEFAULT };
    let shot = Shot { size_px: [96, 64], options: Options::for_frame(96, 64), ..Shot::small(settings) };
    let environment = Sky::default().environment(128)?;
    let picture = |long: fn(usize) -> bool| {
        let mut scene = crowd();
        for (_, mesh) in scene.meshes.iter_mut().enumerate().filter(|(index, _)| long(*index)) {
            let count = (1 << 16) + 1;
            mesh.positions.resize(count, Vec3::ZERO);
            mesh.normals.resize(count, Vec3::Y);
            let grow = |of: &mut Vec<glam::Vec2>| (!of.is_empty()).then(|| of.resize(count, glam::Vec2::ZERO));
            let _ = (grow(&mut mesh.uv0), grow(&mut mesh.uv1));
            for of in [&mut mesh.tangents, &mut mesh.colors].into_iter().filter(|of| !of.is_empty()) {
                of.resize(count, glam::Vec4::ONE);
            }
        }
        let settings = settings.for_scene(&scene, shot.size_px);
        let lighting = lighting(&gpu, &environment, &settings.shading)?;
        let view = view_of(&scene, &lighting.image, &Background::Environment, &shot);
        let world = World::new(&gpu, &scene, lighting, [view], &mut progress::silent)?;
        let found: Vec<bool> = (0..scene.meshes.len())
            .map(|mesh| world.scene.mesh(framegraph_scene::MeshId::new(mesh), 0).short)
            .collect();
        assert!(found.iter().enumerate().all(|(index, short)| *short != long(index)), "{found:?}");
        draw(&gpu, &world, &settings, &shot.options)
    };
    let short = picture(|_| false)?;
    assert!(short == picture(|index| index == 1)?, "indices of both kinds draw another picture");
    assert!(short == picture(|_| true)?, "indices of 32 bits draw another picture");
    Ok(())
}

/// Objects in the instance stream give the same picture as objects in buffers. Tested with all kinds of surfaces,
/// rotated and mirrored under a normal map, with and without vertex colors, also with materials in an array.
#[test]
fn objects_in_a_stream_and_in_buffers_are_the_same_picture() -> TestResult {
    let Some(gpu) = gpu("objects_in_a_stream_and_in_buffers_are_the_same_picture") else { return Ok(()) };
    let mut crowd = crowd();
    let tilted = Image::from_rgba8("tilted.png", 1, 1, vec![200, 90, 220, 255]);
    let texture = crowd.add_texture(tilted, TextureRole::Normal, Sampler::default());
    let slot = TextureSlot { texture, uv_set: 0, transform: UvTransform::default() };
    crowd.materials[1].normal_texture = Some(slot);
    let vertices = crowd.meshes[1].positions.iter();
    crowd.meshes[1].colors = vertices.map(|at| (at.abs() * 3.0).min(Vec3::ONE).extend(1.0)).collect();
    let settings = Settings { shadows: Some(ShadowSettings::texels(128)), ..Settings::DEFAULT };
    let shot = Shot { size_px: [96, 64], options: Options::for_frame(96, 64), ..Shot::small(settings) };
    let environment = Sky::default().environment(128)?;
    for (scene, variant) in [(crowd, "VERTEX_COLORS"), (wall(MAX_STREAMED), "MATERIAL_TABLE")] {
        let settings = settings.for_scene(&scene, shot.size_px);
        let picture = |streamed: bool| -> Result<_, Box<dyn Error>> {
            let lighting = lighting(&gpu, &environment, &settings.shading)?;
            let view = view_of(&scene, &lighting.image, &Background::Environment, &shot);
            assert!(view.streams_objects);
            let view = CameraView { streams_objects: streamed, ..view };
            let world = World::new(&gpu, &scene, lighting, [view], &mut progress::silent)?;
            let picture = draw(&gpu, &world, &settings, &shot.options)?;
            let made = world.programs.made();
            let made = |feature: &str| made.iter().filter(|program| program.name().contains(feature)).count();
            Ok((picture, made("INSTANCE_STREAM"), made(variant)))
        };
        let ((streamed, streams, own), (read, none, other)) = (picture(true)?, picture(false)?);
        assert!(streams > 2 && none == 0 && own > 0 && other > 0, "{streams} and {none} variants, {own} and {other}");
        assert!(streamed == read, "{variant}: objects in a stream are another picture");
    }
    let larger = wall(MAX_STREAMED + 1);
    let image = lighting(&gpu, &environment, &settings.shading)?.image;
    assert!(!view_of(&larger, &image, &Background::Environment, &shot).streams_objects);
    Ok(())
}

/// Instanced draws give the same bytes as one draw per instance. Moment shadow maps are tested, since they depend on
/// the order of draws at equal depth. Masked, blended, transmissive and mirrored surfaces and levels of detail are
/// tested too. Moved objects match a newly uploaded scene.
#[test]
fn instanced_draws_are_the_same_picture() -> TestResult {
    let Some(gpu) = gpu("instanced_draws_are_the_same_picture") else { return Ok(()) };
    let mut scene = crowd();
    scene.make_levels(&mut progress::silent)?;
    let moments = MomentSettings { samples: 1, ..ShadowSettings::DEFAULT.moments };
    let shadows = ShadowSettings { filter: ShadowFilter::Vsm, moments, ..ShadowSettings::texels(128) };
    let settings = Settings { shadows: Some(shadows), ..Settings::DEFAULT };
    let shot = Shot { size_px: [96, 64], options: Options::for_frame(96, 64), ..Shot::small(settings) };
    let settings = settings.for_scene(&scene, shot.size_px);
    let environment = Sky::default().environment(128)?;
    let lighting = lighting(&gpu, &environment, &settings.shading)?;
    let background = Background::Environment;
    let view = |scene: &Scene, image: &_| view_of(scene, image, &background, &shot);
    let instanced = view(&scene, &lighting.image);
    let apart = CameraView { draws: instanced.draws.clone().one_by_one(), ..instanced.clone() };
    let (few, many) = (instanced.draws.count(), apart.draws.count());
    // Opaque and masked instances of one mesh, material and side are one draw. Transmissive ones, and blended ones that
    // are not adjacent, are not.
    assert!(many > 250 && few < 100, "{few} draws for {many}");
    let mut world = World::new(&gpu, &scene, lighting, [instanced], &mut progress::silent)?;
    let first = draw(&gpu, &world, &settings, &shot.options)?;
    world.set_view(&gpu, ViewId::MAIN, apart)?;
    assert!(first == draw(&gpu, &world, &settings, &shot.options)?, "a draw for each is another picture");
    let seen = ViewSettings {
        camera: scene.default_camera(1.5),
        size_px: shot.size_px,
        ev100: shot.ev100,
        shadows: settings.shadows,
        lights: framegraph_passes::LightSearch::default(),
        lod_error_px: 2.0,
        ..ViewSettings::default()
    };
    let coarse = CameraView::new(&scene, &world.lighting.image, &background, &seen);
    let levels = |list: &framegraph_passes::gpu_scene::indirect::DrawList| {
        list.iter().map(|batch| batch.level).collect::<Vec<_>>()
    };
    let drawn = levels(&coarse.draws.surfaces[0]);
    assert!(drawn.contains(&0) && drawn.iter().any(|level| *level > 0), "{drawn:?}");
    let apart = CameraView { draws: coarse.draws.clone().one_by_one(), ..coarse.clone() };
    world.set_view(&gpu, ViewId::MAIN, coarse)?;
    let levelled = draw(&gpu, &world, &settings, &shot.options)?;
    world.set_view(&gpu, ViewId::MAIN, apart)?;
    assert!(levelled == draw(&gpu, &world, &settings, &shot.options)?, "a draw for each is another picture");
    assert_ne!(levelled, first, "levels are the meshes themselves");

    let mut prepared = PreparedScene::new(&scene);
    let moved = &mut scene.instances[7];
    moved.world_from_model = DMat4::from_translation(DVec3::Y) * moved.world_from_model * DMat4::from_rotation_x(1.0);
    moved.bounds = scene.meshes[moved.mesh.index()].bounds.transformed(&moved.world_from_model);
    prepared.update(&scene, &[7]);
    let seen = ViewSettings { camera: scene.default_camera(1.5), lod_error_px: 0.0, ..seen };
    let image = &world.lighting.image;
    let own = CameraView::prepared(&scene, &prepared, image, &background, &seen);
    let anew = CameraView::new(&scene, image, &background, &seen);
    world.set_view(&gpu, ViewId::MAIN, own)?;
    let updated = draw(&gpu, &world, &settings, &shot.options)?;
    world.set_view(&gpu, ViewId::MAIN, anew)?;
    assert!(updated == draw(&gpu, &world, &settings, &shot.options)?, "an update is not as preparing anew");
    assert_ne!(updated, first, "nothing moved");
    Ok(())
}

/// Returns a wall of boxes and balls with a material each: some masked, some coated, two thirds textured.
fn wall(count: usize) -> Scene {
    let mut scene = Scene::default();
    let meshes = [cuboid(Vec3::splat(0.3)), sphere(0.35, 8, 6)].map(|mesh| scene.add_mesh(mesh));
    let mut texture = |texel: [u8; 4]| {
        let image = Image::from_rgba8("two.png", 2, 1, [texel, [255; 4]].concat());
        let texture = scene.add_texture(image, TextureRole::Color, Sampler::default());
        Some(TextureSlot { texture, uv_set: 0, transform: UvTransform::default() })
    };
    let textures = [None, texture([255, 90, 0, 255]), texture([0, 90, 255, 20])];
    let side = (count as f64).sqrt().ceil() as usize;
    for i in 0..count {
        let hue = i as f32 / count as f32;
        let material = scene.add_material(Material {
            base_color_texture: textures[3 * i / count],
            alpha: if i % 7 < 3 { AlphaMode::Mask { cutoff: 0.3 } } else { AlphaMode::Opaque },
            clear_coat: (i % 29 == 0).then(|| ClearCoat { factor: 1.0, ..ClearCoat::default() }),
            ..Material::dielectric("clay", Vec3::new(hue, 0.4, 1.0 - hue), 0.2 + 0.6 * hue)
        });
        let at = DVec3::new((i % side) as f64, (i / side) as f64, 0.0) - DVec3::new(0.5, 0.5, 0.0) * side as f64;
        let turned = DMat4::from_translation(at) * DMat4::from_rotation_y(i as f64);
        scene.add_instance("one", meshes[i % 2], material, turned);
    }
    scene.lights.push(Light::directional("sun", Vec3::new(-0.4, -0.8, -0.3).normalize(), 50_000.0));
    scene
}

/// Long opaque and masked lists use indirect draws, and untextured materials an array: the same bytes as with a call
/// and bind group each. A changed material is updated in the array too.
#[test]
fn indirect_draws_are_the_same_picture() -> TestResult {
    let Some(gpu) = gpu("indirect_draws_are_the_same_picture") else { return Ok(()) };
    let count = 2 * LEAST_BATCHES + 400;
    let scene = wall(count);
    let settings = Settings { shadows: Some(ShadowSettings::texels(64)), ..Settings::DEFAULT };
    let shot = Shot { size_px: [128, 96], options: Options::for_frame(128, 96), ..Shot::small(settings) };
    let settings = settings.for_scene(&scene, shot.size_px);
    let lighting = lighting(&gpu, &Sky::default().environment(128)?, &settings.shading)?;
    let view = view_of(&scene, &lighting.image, &Background::Environment, &shot);
    let indirect = view.draws.surfaces.iter().all(|list| list.first_arguments().is_some());
    assert!(indirect && draws_indirectly(&gpu), "nothing is drawn indirectly here");
    let apart = CameraView { draws: view.draws.clone().one_by_one(), ..view.clone() };
    assert!(apart.draws.surfaces.iter().all(|list| list.first_arguments().is_none()));
    let mut world = World::new(&gpu, &scene, lighting, [view.clone()], &mut progress::silent)?;
    let first = draw(&gpu, &world, &settings, &shot.options)?;
    world.set_view(&gpu, ViewId::MAIN, apart.clone())?;
    assert!(first == draw(&gpu, &world, &settings, &shot.options)?, "calls for each draw another picture");
    let variants = world.programs.made().iter().filter(|program| program.name().contains("MATERIAL_TABLE")).count();
    assert!(variants >= 2, "{variants} shaders read materials from an array");

    // Indices in the middle of the picture.
    for index in (count / 6..5 * count / 6).filter(|index| index % 29 != 0) {
        let id = MaterialId::new(index);
        let green = Material { base_color: glam::Vec4::new(0.0, 1.0, 0.0, 1.0), ..scene.materials[index].clone() };
        world.scene.write_material(&gpu, id, &green)?;
    }
    let bound = draw(&gpu, &world, &settings, &shot.options)?;
    world.set_view(&gpu, ViewId::MAIN, view)?;
    assert!(bound == draw(&gpu, &world, &settings, &shot.options)?, "a written material differs in the array");
    assert_ne!(bound, first, "no material was written");
    Ok(())
}
