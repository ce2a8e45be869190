//! `materials`: one object for each material feature.
//!
//! Back row: metals by measured reflectance. Middle row: dielectrics. Front row: textures, normal
//! map, emission, cut-outs, blending, double sides, vertex colors, unlit.

use glam::{DMat4, DVec3, Vec2, Vec3, Vec4};

use super::camera::camera;
use super::metal::METALS;
use super::{ground, pattern};
use crate::color::linear_from_hex;
use crate::geometry::{cuboid, cylinder, plane, sphere, torus};
use crate::material::{AlphaMode, EmissiveUnit, Material};
use crate::mesh::Mesh;
use crate::scene::Scene;
use crate::texture::TextureId;
use crate::texture::{Sampler, TextureRole, TextureSlot, UvTransform, Wrap};

const SPACING_M: f64 = 1.15;

pub(super) fn scene() -> Scene {
    let mut scene = Scene { name: "materials".into(), ..Scene::default() };
    ground::checkered(&mut scene, [Vec3::splat(0.12), Vec3::splat(0.22)], 0.7, 2.0);
    metals(&mut scene);
    dielectrics(&mut scene);
    textured(&mut scene);
    transparent(&mut scene);
    special(&mut scene);
    let eye = DVec3::new(0.0, 5.4, 7.6);
    scene.cameras.push(camera("front", eye, DVec3::new(0.0, 0.25, -0.1), 38.0));
    let eye = DVec3::new(-1.6, 1.2, 4.6);
    scene.cameras.push(camera("close", eye, DVec3::new(-2.4, 0.5, 1.4), 40.0));
    scene
}

/// Returns the transform of the object in `column` (0 to 7) of a row, `y` meters above the ground.
fn stand(column: u32, z: f64, y: f64) -> DMat4 {
    let x = (f64::from(column) - 3.5) * SPACING_M;
    DMat4::from_translation(DVec3::new(x, y, z))
}

fn slot(texture: TextureId, tiles: Vec2) -> Option<TextureSlot> {
    Some(TextureSlot { texture, uv_set: 0, transform: UvTransform { scale: tiles, ..UvTransform::default() } })
}

fn metals(scene: &mut Scene) {
    let ball = scene.add_mesh(sphere(0.45, 64, 32));
    for (column, metal) in METALS.iter().enumerate() {
        let roughness = if column % 2 == 0 { 0.15 } else { 0.35 };
        let material = scene.add_material(Material::metal(metal.name, metal.f0, roughness));
        scene.add_instance(metal.name, ball, material, stand(column as u32, -1.7, 0.45));
    }
}

fn dielectrics(scene: &mut Scene) {
    let ball = scene.add_mesh(sphere(0.45, 64, 32));
    for (column, (name, color, roughness)) in [
        ("chalk", 0xe8_e4_dc, 1.0),
        ("plaster", 0xc9_b8_9a, 0.85),
        ("clay", 0xb0_58_3a, 0.7),
        ("red lacquer", 0xb8_10_1c, 0.05),
        ("green plastic", 0x1c_8a_3c, 0.3),
        ("blue plastic", 0x1a_4c_b4, 0.45),
        ("rubber", 0x32_30_2f, 0.8),
        ("charcoal", 0x32_2f_2c, 0.95),
    ]
    .into_iter()
    .enumerate()
    {
        let material = Material::dielectric(name, linear_from_hex(color), roughness);
        let material = scene.add_material(material);
        scene.add_instance(name, ball, material, stand(column as u32, -0.3, 0.45));
    }
}

fn textured(scene: &mut Scene) {
    let sampler = Sampler::default();
    let normal = pattern::bumps("bumps", 128, 2.0, 0.6);
    let normal = scene.add_texture(normal, TextureRole::Normal, sampler);
    let occlusion = pattern::bumps_occlusion("bumps occlusion", 128, 2.0);
    let occlusion = scene.add_texture(occlusion, TextureRole::Linear, sampler);
    let cube = scene.add_mesh(cuboid(Vec3::splat(0.4)));
    let bumped = scene.add_material(Material {
        normal_texture: slot(normal, Vec2::splat(2.0)),
        occlusion_texture: slot(occlusion, Vec2::splat(2.0)),
        ..Material::dielectric("normal map", Vec3::new(0.5, 0.42, 0.3), 0.4)
    });
    let turned = stand(0, 1.2, 0.4) * DMat4::from_rotation_y(0.5);
    scene.add_instance("normal map", cube, bumped, turned);

    let inlay = pattern::inlay("inlay", 128, 0.15, 0.6);
    let inlay = scene.add_texture(inlay, TextureRole::Linear, sampler);
    let ball = scene.add_mesh(sphere(0.45, 64, 32));
    let inlaid = scene.add_material(Material {
        base_color: Vec4::new(0.91, 0.60, 0.30, 1.0),
        metallic_roughness_texture: slot(inlay, Vec2::new(4.0, 2.0)),
        ..Material::default()
    });
    scene.add_instance("metallic-roughness map", ball, inlaid, stand(1, 1.2, 0.45));

    let lines = pattern::grid_lines("grid lines", 128, Vec3::new(1.0, 0.45, 0.12));
    let lines = scene.add_texture(lines, TextureRole::Color, sampler);
    let glowing = scene.add_material(Material {
        emissive: Vec3::splat(40_000.0),
        emissive_unit: EmissiveUnit::Nits,
        emissive_texture: slot(lines, Vec2::ONE),
        ..Material::dielectric("emissive map", Vec3::splat(0.03), 0.4)
    });
    let turned = stand(2, 1.2, 0.4) * DMat4::from_rotation_y(0.7);
    scene.add_instance("emissive map", cube, glowing, turned);
}

fn transparent(scene: &mut Scene) {
    let leaves = pattern::leaves("leaves", 128);
    let sampler = Sampler { wrap_u: Wrap::ClampToEdge, wrap_v: Wrap::ClampToEdge, ..Sampler::default() };
    let leaves = scene.add_texture(leaves, TextureRole::Color, sampler);
    let pane = scene.add_mesh(plane(Vec2::splat(0.9), 1, Vec2::ONE));
    // Upright, facing +z.
    let upright = DMat4::from_rotation_x(std::f64::consts::FRAC_PI_2);
    let cut_out = scene.add_material(Material {
        alpha: AlphaMode::Mask { cutoff: 0.5 },
        double_sided: true,
        base_color_texture: slot(leaves, Vec2::ONE),
        ..Material::dielectric("alpha mask", Vec3::ONE, 0.8)
    });
    scene.add_instance("alpha mask", pane, cut_out, stand(3, 1.2, 0.45) * upright);

    // Two panes behind each other, where blending order shows.
    for (color, z, x) in [(0x2a_6a_d0, 1.05, -0.12), (0xd0_48_2a, 1.35, 0.12)] {
        let glass = scene.add_material(Material {
            base_color: linear_from_hex(color).extend(0.4),
            alpha: AlphaMode::Blend,
            double_sided: true,
            ..Material::dielectric("alpha blend", Vec3::ONE, 0.1)
        });
        let aside = DMat4::from_translation(DVec3::new(x, 0.0, 0.0));
        scene.add_instance("alpha blend", pane, glass, stand(4, z, 0.45) * aside * upright);
    }
}

fn special(scene: &mut Scene) {
    let tube = scene.add_mesh(open_tube());
    let both =
        Material { double_sided: true, ..Material::dielectric("double sided", linear_from_hex(0xd8_a8_30), 0.5) };
    let both = scene.add_material(both);
    let lying = stand(5, 1.2, 0.4) * DMat4::from_rotation_y(0.6) * DMat4::from_rotation_x(1.2);
    scene.add_instance("double sided", tube, both, lying);

    let mut painted = torus(0.32, 0.14, 64, 32);
    // A rainbow around the axis: red, green and blue are a third of a turn apart.
    painted.colors = painted
        .uv0
        .iter()
        .map(|uv| {
            let third = std::f32::consts::TAU / 3.0;
            let channel = |k: f32| 0.5 + 0.5 * (uv.x * std::f32::consts::TAU - k * third).cos();
            Vec4::new(channel(0.0), channel(1.0), channel(2.0), 1.0)
        })
        .collect();
    let painted = scene.add_mesh(painted);
    let white = Material::dielectric("vertex colors", Vec3::splat(0.9), 0.4);
    let white = scene.add_material(white);
    let lean = DMat4::from_rotation_x(0.9);
    scene.add_instance("vertex colors", painted, white, stand(6, 1.2, 0.4) * lean);

    let ball = scene.add_mesh(sphere(0.4, 48, 24));
    // Unlit colors are luminances: as bright as white paper in the sun.
    let unlit =
        scene.add_material(Material { unlit: true, ..Material::dielectric("unlit", Vec3::new(0.8, 0.2, 0.6), 1.0) });
    scene.add_instance("unlit", ball, unlit, stand(7, 1.2, 0.4));
}

/// Returns a cylinder without caps.
fn open_tube() -> Mesh {
    let mut mesh = cylinder(0.35, 0.4, 48);
    mesh.name = "open tube".into();
    let upright = |t: &[u32]| t.iter().any(|i| mesh.normals[*i as usize].y == 0.0);
    let side: Vec<u32> = mesh.indices.chunks_exact(3).filter(|t| upright(t)).flatten().copied().collect();
    mesh.indices = side;
    mesh
}
