//! Filament's switches of renderables and lights: layers, light channels, casting and receiving shadows.

use crate::stage::{declared, gpu, lighting};
use framegraph::{Options, Plan, Scratch};
use framegraph_passes::gpu_scene::shadow_views::{ContactShadows, ShadowSettings};
use framegraph_passes::gpu_scene::view::{Background, ViewSettings};
use framegraph_passes::{CameraView, LightSearch, Settings, World};
use framegraph_scene::{Camera, Environment, Light, LightKind, Material, Projection, Scene, geometry, progress};
use framegraph_wgpu::{Gpu, Imports, read_texture};
use glam::{DMat4, DVec3, Vec2, Vec3};
use std::error::Error;
use tests::executors;

type TestResult = Result<(), Box<dyn Error>>;

const SIZE_PX: [u32; 2] = [64, 48];
const GROUND: usize = 0;
const BLOCK: usize = 1;
const SUN: usize = 0;
const LAMP: usize = 1;

/// Returns a block on the ground, with a sun on its left and a spot light on its right.
fn scene() -> Scene {
    let mut scene = Scene::default();
    let ground = scene.add_mesh(geometry::plane(Vec2::splat(8.0), 1, Vec2::ONE));
    let block = scene.add_mesh(geometry::cuboid(Vec3::splat(0.5)));
    let white = scene.add_material(Material::dielectric("white", Vec3::splat(0.7), 0.8));
    scene.add_instance("ground", ground, white, DMat4::IDENTITY);
    scene.add_instance("block", block, white, DMat4::from_translation(DVec3::new(0.0, 0.5, 0.0)));
    let kind = LightKind::Point { intensity_candela: 600.0, range_m: None };
    let lamp = Light { kind, position: DVec3::new(2.0, 1.6, 0.3), ..Light::directional("lamp", Vec3::NEG_Y, 0.0) };
    scene.lights = vec![Light::directional("sun", Vec3::new(1.0, -1.0, 0.0), 300.0), lamp];
    scene
}

fn shadows() -> ShadowSettings {
    ShadowSettings { map_texels: 256, local_maps: 6, local_layers: 1, contact: None, ..ShadowSettings::DEFAULT }
}

/// The picture of a scene in a view of these layers; display codes, four bytes a texel.
fn shoot(gpu: &Gpu, scene: &Scene, visible_layers: u8, shadows: ShadowSettings) -> Result<Vec<u8>, Box<dyn Error>> {
    let settings = Settings { shadows: Some(shadows), fxaa: false, ..Settings::DEFAULT };
    let lighting = lighting(gpu, &Environment::uniform(DVec3::splat(100.0))?, &settings.shading)?;
    let projection = Projection::perspective(0.9, 0.1);
    let view = ViewSettings {
        camera: Camera::look_at(DVec3::new(0.0, 5.0, 3.0), DVec3::ZERO, DVec3::Y, projection)?,
        size_px: SIZE_PX,
        ev100: 8.0,
        shadows: settings.shadows,
        lights: LightSearch::All,
        visible_layers,
        ..ViewSettings::default()
    };
    let view = CameraView::new(scene, &lighting.image, &Background::None, &view);
    let world = World::new(gpu, scene, lighting, [view], &mut progress::silent)?;
    let (frame, io) = declared(&settings.for_scene(scene, SIZE_PX));
    let (mut plan, mut executor) = (Plan::new(), executors::lend(gpu));
    let options = Options::for_frame(SIZE_PX[0], SIZE_PX[1]);
    executor.compile(frame.graph(), &options, &mut Scratch::new(), &mut plan)?;
    executor.execute(&plan, &frame, &world, &Imports::new())?;
    Ok(read_texture(gpu, executor.texture(&plan, io.output).ok_or("no picture")?)?.rgba8())
}

/// Numbers of the texels that are brighter in `a` than in `b` by more than two codes, and of those that are darker.
fn compared(a: &[u8], b: &[u8]) -> [Vec<usize>; 2] {
    let sum = |texel: &[u8]| texel[..3].iter().map(|code| i32::from(*code)).sum::<i32>();
    let changes = a.chunks(4).zip(b.chunks(4)).map(|(a, b)| sum(a) - sum(b)).enumerate();
    let changes: Vec<_> = changes.collect();
    [1, -1].map(|sign| changes.iter().filter(|(_, change)| sign * change > 6).map(|(at, _)| *at).collect())
}

/// An object in none of the visible layers is as if it were not in the scene: it neither shows nor casts.
#[test]
fn hidden_layers_neither_show_nor_cast() -> TestResult {
    let Some(gpu) = gpu("hidden_layers_neither_show_nor_cast") else { return Ok(()) };
    let mut scene = scene();
    let shown = shoot(&gpu, &scene, 1, shadows())?;
    scene.instances[BLOCK].draw.layers = 0b10;
    assert_eq!(shoot(&gpu, &scene, 0b11, shadows())?, shown, "both layers");
    let hidden = shoot(&gpu, &scene, 1, shadows())?;
    scene.instances.remove(BLOCK);
    assert!(hidden == shoot(&gpu, &scene, 1, shadows())?, "hidden and absent");
    let [brighter, _] = compared(&hidden, &shown);
    assert!(brighter.len() > 30, "{}", brighter.len());
    Ok(())
}

/// Shadows of both lights disappear if the block does not cast or the ground does not receive them; nothing else
/// changes.
#[test]
fn casting_and_receiving_shadows_can_be_off() -> TestResult {
    let Some(gpu) = gpu("casting_and_receiving_shadows_can_be_off") else { return Ok(()) };
    let mut scene = scene();
    let both = shoot(&gpu, &scene, 1, shadows())?;
    scene.instances[BLOCK].draw.casts_shadows = false;
    let cast_off = shoot(&gpu, &scene, 1, shadows())?;
    let [brighter, darker] = compared(&cast_off, &both);
    // The sun's shadow is right of the block, the spot light's left of it.
    let columns = |range: std::ops::Range<usize>| brighter.iter().filter(|at| range.contains(&(*at % 64))).count();
    assert!(columns(0..26) > 10 && columns(38..64) > 10 && darker.is_empty(), "{brighter:?} {darker:?}");
    scene.instances[BLOCK].draw.casts_shadows = true;
    scene.instances[GROUND].draw.receives_shadows = false;
    let receive_off = shoot(&gpu, &scene, 1, shadows())?;
    assert_eq!(compared(&receive_off, &cast_off), [const { Vec::<usize>::new() }; 2]);
    // Contact shadows are switched off as well.
    scene.instances[BLOCK].draw.receives_shadows = false;
    let contact = ShadowSettings { contact: Some(ContactShadows::FILAMENT), ..shadows() };
    let with_contact = shoot(&gpu, &scene, 1, contact)?;
    assert_eq!(compared(&with_contact, &receive_off), [const { Vec::<usize>::new() }; 2]);
    Ok(())
}

/// A light affects an object only if both share a channel, for directional and punctual lights.
#[test]
fn lights_light_objects_of_their_channels() -> TestResult {
    let Some(gpu) = gpu("lights_light_objects_of_their_channels") else { return Ok(()) };
    let mut scene = scene();
    let all = shoot(&gpu, &scene, 1, shadows())?;
    for light in [SUN, LAMP] {
        scene.lights[light].channels = 0b110;
        let none = shoot(&gpu, &scene, 1, shadows())?;
        let off = scene.lights.remove(light);
        assert!(none == shoot(&gpu, &scene, 1, shadows())?, "{light}: on a channel that nothing has, and off");
        scene.lights.insert(light, off);
        scene.instances.iter_mut().for_each(|instance| instance.draw.light_channels = 0b11);
        assert!(all == shoot(&gpu, &scene, 1, shadows())?, "{light}: shared by all");
        scene.instances[GROUND].draw.light_channels = 1;
        let block = shoot(&gpu, &scene, 1, shadows())?;
        let [brighter, darker] = compared(&block, &none);
        assert!(brighter.len() > 20 && brighter.len() < 400 && darker.is_empty(), "{light}: {}", brighter.len());
        scene.lights[light].channels = 1;
        scene.instances.iter_mut().for_each(|instance| instance.draw.light_channels = 1);
    }
    Ok(())
}
