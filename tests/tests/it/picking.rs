//! Picking: instance, depth and position at a pixel, compared with rays through known planes.

use crate::stage::{gpu, lighting};
use framegraph_passes::gpu_scene::view::{Background, ViewSettings};
use framegraph_passes::{CameraView, LightSearch, Pickable, Picker, Settings, ViewId, World};
use framegraph_scene::motion::{Body, Moves, Shape};
use framegraph_scene::texture::Filter;
use framegraph_scene::{
    Aabb, AlphaMode, Camera, Environment, Image, Material, Mesh, Projection, Sampler, Scene, TextureRole, TextureSlot,
    UvTransform, geometry, progress,
};
use glam::{DMat4, DVec2, DVec3, DVec4, Vec2, Vec3, Vec4};
use std::error::Error;

type TestResult = Result<(), Box<dyn Error>>;

const SIZE_PX: [u32; 2] = [64, 48];
const MASKED: usize = 1;
const MOVED: usize = 2;

/// Returns a scene of planes. An opaque wall at z = −4 covers the left half. At z = −1 a masked plane with holes is
/// right of the center, and a blended plane covers everything. A plane at z = −2 above the center has deformed
/// vertices.
fn scene() -> Scene {
    let mut scene = Scene::default();
    let quad = |scene: &mut Scene, half: Vec2| {
        let mut mesh = geometry::plane(half * 2.0, 1, Vec2::ONE);
        // Faces the camera.
        mesh.positions.iter_mut().for_each(|p| *p = Vec3::new(p.x, -p.z, 0.0));
        mesh.bounds = Aabb::from_points(&mesh.positions);
        scene.add_mesh(mesh)
    };
    let white = scene.add_material(Material { double_sided: true, ..Material::dielectric("white", Vec3::ONE, 0.8) });
    let sampler = Sampler { mag: Filter::Nearest, min: Filter::Nearest, mip: None, ..Sampler::default() };
    let texels = vec![255, 255, 255, 255, 255, 255, 255, 0];
    let texture = scene.add_texture(Image::from_rgba8("hole", 2, 1, texels), TextureRole::Color, sampler);
    let slot = TextureSlot { texture, uv_set: 0, transform: UvTransform::default() };
    let plain = Material { double_sided: true, ..Material::default() };
    let alpha = AlphaMode::Mask { cutoff: 0.5 };
    let masked = scene.add_material(Material { alpha, base_color_texture: Some(slot), ..plain.clone() });
    let blended =
        scene.add_material(Material { alpha: AlphaMode::Blend, base_color: Vec4::new(1.0, 0.0, 0.0, 0.1), ..plain });
    let [wall, small, all] = [Vec2::splat(4.0), Vec2::splat(0.3), Vec2::splat(0.9)].map(|half| quad(&mut scene, half));
    let at = |x: f64, y: f64, z: f64| DMat4::from_translation(DVec3::new(x, y, z));
    scene.add_instance("wall", wall, white, at(-4.0, 0.0, -4.0));
    scene.add_instance("masked", small, masked, at(0.0, 0.0, -1.0));
    let moved = quad(&mut scene, Vec2::splat(0.2));
    scene.add_instance("moved", moved, white, at(0.0, -9.0, -2.0));
    scene.add_instance("blended", all, blended, at(0.0, 0.0, -0.5));
    let Mesh { positions, normals, tangents, .. } = scene.meshes[moved.index()].clone();
    let rest = Shape { positions, normals, tangents };
    scene.motion.bodies.push(Body { mesh: moved, instance: MOVED, node: 0, skin: None, rest, moves: Moves::default() });
    scene
}

/// The ray through the middle of a pixel meets the plane z = `z` here.
fn meets(camera: &Camera, [x, y]: [u32; 2], z: f64) -> DVec3 {
    let uv = (DVec2::new(x.into(), y.into()) + 0.5) / DVec2::new(SIZE_PX[0].into(), SIZE_PX[1].into());
    let clip = DVec4::new(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y, 0.5, 1.0);
    let aspect = f64::from(SIZE_PX[0]) / f64::from(SIZE_PX[1]);
    let at = (camera.clip_from_view(aspect) * camera.view_from_world()).inverse() * clip;
    let way = (at.truncate() / at.w - camera.eye).normalize();
    camera.eye + way * ((z - camera.eye.z) / way.z)
}

/// Picks return the visible instance for opaque, masked, deformed and blended surfaces, for a hole and for the sky.
/// Depth and position match the ray through the pixel center.
#[test]
fn picks_name_what_is_seen() -> TestResult {
    let Some(gpu) = gpu("picks_name_what_is_seen") else { return Ok(()) };
    let mut scene = scene();
    let lighting = lighting(&gpu, &Environment::uniform(DVec3::ONE)?, &Settings::DEFAULT.shading)?;
    let eye = DVec3::new(0.0, 0.0, 1.0);
    let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, Projection::perspective(0.9, 0.1))?;
    let seen = ViewSettings {
        camera: camera.clone(),
        size_px: SIZE_PX,
        ev100: 0.0,
        shadows: None,
        lights: LightSearch::All,
        ..ViewSettings::default()
    };
    let before = CameraView::new(&scene, &lighting.image, &Background::None, &seen);
    let mut world = World::new(&gpu, &scene, lighting, [before], &mut progress::silent)?;
    // The vertices of one are moved, as joints and morph targets do, into the picture.
    let mesh = scene.instances[MOVED].mesh;
    let moved = &mut scene.meshes[mesh.index()];
    moved.positions.iter_mut().for_each(|p| p.y += 9.6);
    moved.bounds = Aabb::from_points(&moved.positions);
    let instance = &mut scene.instances[MOVED];
    instance.bounds = scene.meshes[mesh.index()].bounds.transformed(&instance.world_from_model);
    world.scene.repose(&gpu, &scene)?;
    let mut view = CameraView::new(&scene, &world.lighting.image, &Background::None, &seen);
    let streamed = view.streams_objects;
    let mut picker = Picker::new(&gpu);
    let pixels: [([u32; 2], Option<(usize, f64)>); 6] = [
        ([5, 24], Some((0, -4.0))),
        ([30, 23], Some((MASKED, -1.0))),
        // The hole on the right, behind which is nothing, as beside it.
        ([34, 23], None),
        ([60, 2], None),
        // The wall ends at the middle of the picture.
        ([31, 14], Some((MOVED, -2.0))),
        ([28, 40], Some((0, -4.0))),
    ];
    for streams in [streamed, !streamed] {
        view.streams_objects = streams;
        world.set_view(&gpu, ViewId::MAIN, view.clone())?;
        for (pixel, expected) in pixels {
            let pick = picker.pick(&world, ViewId::MAIN, pixel, Pickable::Opaque)?;
            assert_eq!(pick.map(|pick| pick.instance), expected.map(|(instance, _)| instance), "{pixel:?}");
            if let (Some(pick), Some((_, z))) = (pick, expected) {
                let place = meets(&camera, pixel, z);
                assert!((pick.position - place).length() < 1e-4, "{pixel:?}: {} for {place}", pick.position);
                // Reversed depth without a far plane is the near plane's distance over the surface's.
                assert!((f64::from(pick.depth) - 0.1 / (1.0 - z)).abs() < 1e-6, "{pixel:?}: {}", pick.depth);
            }
        }
    }
    let all = picker.pick(&world, ViewId::MAIN, [34, 23], Pickable::All)?.map(|pick| pick.instance);
    assert_eq!(all, Some(3), "the blended one over the hole");
    let outside = picker.pick(&world, ViewId::MAIN, [64, 0], Pickable::Opaque).err().map(|error| error.to_string());
    let sentence = "pixel 64,0 is outside of the view of 64x48 pixels; pick one within it";
    assert_eq!(outside.as_deref(), Some(sentence));
    Ok(())
}
