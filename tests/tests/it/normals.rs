//! Normals: maps, tangents; mirrored, stretched and flattened objects; both sides of a surface. Three colored lights
//! separate the components.

use crate::stage::{gpu, lighting};
use framegraph_passes::Shading;
use framegraph_scene::texture::{Filter, Sampler, TextureRole};
use framegraph_scene::{Environment, Material, Mesh, Specular};
use glam::{DMat3, DMat4, DQuat, DVec3, Vec2, Vec3};
use std::error::Error;
use std::f64::consts::PI;
use tests::measure::board::{Board, card, punctual_lights};
use truth::surface::Surface;

type TestResult = Result<(), Box<dyn Error>>;

/// Unit vectors toward the red, the green and the blue light.
const TOWARD: [DVec3; 3] = [DVec3::new(0.6, 0.0, 0.8), DVec3::new(0.0, 0.6, 0.8), DVec3::new(-0.36, -0.48, 0.8)];
const ALBEDO: DVec3 = DVec3::new(0.9, 0.7, 0.5);
/// Shading normal and tangent of every card.
const NORMAL: DVec3 = DVec3::new(0.36, -0.48, 0.8);
const TANGENT: DVec3 = DVec3::new(0.8, 0.6, 0.0);
/// Texel of a normal map: (0.569, -0.294, 0.725).
const TEXEL: [u8; 4] = [200, 90, 220, 0];

/// Returns TEXEL's normal by glTF 2.0: x and y are scaled, in the basis of normal, tangent and bitangent.
fn mapped(normal: DVec3, tangent: DVec3, handedness: f64, scale: f64) -> DVec3 {
    let [x, y, z] = [TEXEL[0], TEXEL[1], TEXEL[2]].map(|c| f64::from(c) / 255.0 * 2.0 - 1.0);
    (tangent * (x * scale) + normal.cross(tangent) * (handedness * y * scale) + normal * z).normalize()
}

/// Returns the radiance of a surface with a normal.
fn expected(normal: DVec3) -> DVec3 {
    let chalk = Surface::chalk(ALBEDO, normal);
    DVec3::new(
        chalk.per_light(DVec3::Z, TOWARD[0]).x,
        chalk.per_light(DVec3::Z, TOWARD[1]).y,
        chalk.per_light(DVec3::Z, TOWARD[2]).z,
    )
}

fn turned(axis: DVec3, angle: f64) -> DMat4 {
    DMat4::from_quat(DQuat::from_axis_angle(axis, angle))
}

#[test]
fn normals_are_those_of_the_object_in_its_place() -> TestResult {
    let Some(gpu) = gpu("normals_are_those_of_the_object_in_its_place") else { return Ok(()) };
    let mut board = Board::default();
    board.scene.lights = punctual_lights(TOWARD);
    let nearest = Sampler { mag: Filter::Nearest, min: Filter::Nearest, mip: None, ..Sampler::default() };
    let map = board.texture(1, &[TEXEL], TextureRole::Normal, nearest);
    // The right half of a map whose left half has another normal, with the second texture coordinates.
    let second = board.texture(2, &[[10, 240, 200, 255], TEXEL], TextureRole::Normal, nearest);
    let chalk = Material {
        specular: Some(Specular { factor: 0.0, ..Specular::default() }),
        ..Material::dielectric("chalk", ALBEDO.as_vec3(), 1.0)
    };
    let bumpy = |scale: f32| Material { normal_texture: Some(map), normal_scale: scale, ..chalk.clone() };
    let both = |material: Material| Material { double_sided: true, ..material };
    let of = |handedness: f32| card(0.45, NORMAL, TANGENT, handedness);
    let plain = of(1.0);

    let (mirror, turn, around) =
        (DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0)), turned(DVec3::Z, 0.7), turned(DVec3::Y, PI));
    let toward_back = DMat4::from_scale(DVec3::new(1.0, 1.0, -1.0));
    let stretch = DVec3::new(2.0, 0.9, 3.0);
    let stretched = DMat4::from_scale(stretch);
    let stretched_normal = (NORMAL / stretch).normalize();
    let own = mapped(NORMAL, TANGENT, 1.0, 1.0);
    let still = DMat4::IDENTITY;
    let carry = |by: DMat4, v: DVec3| DMat3::from_mat4(by) * v;

    let no_normals = Mesh { normals: vec![Vec3::ZERO; 4], ..plain.clone() };
    let no_tangents = Mesh { tangents: Vec::new(), ..plain.clone() };
    let along_normal = Mesh { tangents: vec![NORMAL.as_vec3().extend(1.0); 4], ..plain.clone() };
    // Duff's frame is the smallest rotation that takes z to the normal.
    let frame = DQuat::from_rotation_arc(DVec3::Z, NORMAL) * DVec3::X;
    let two_sets = Mesh { uv0: vec![Vec2::new(0.25, 0.5); 4], uv1: vec![Vec2::new(0.75, 0.5); 4], ..plain.clone() };
    let of_second = |uv_set: u32| Material {
        normal_texture: Some(framegraph_scene::texture::TextureSlot { uv_set, ..second }),
        ..chalk.clone()
    };
    let left = {
        let [x, y, z] = [10.0, 240.0, 200.0].map(|c: f64| c / 255.0 * 2.0 - 1.0);
        (TANGENT * x + NORMAL.cross(TANGENT) * y + NORMAL * z).normalize()
    };
    let hidden = DVec3::ZERO;
    let seen_as = |normal: DVec3| Some(normal);
    let cases = [
        ("plain", chalk.clone(), plain.clone(), still, seen_as(NORMAL)),
        ("mapped", bumpy(1.0), plain.clone(), still, seen_as(own)),
        ("map of less depth", bumpy(0.4), plain.clone(), still, seen_as(mapped(NORMAL, TANGENT, 1.0, 0.4))),
        ("left-handed", bumpy(1.0), of(-1.0), still, seen_as(mapped(NORMAL, TANGENT, -1.0, 1.0))),
        ("turned", bumpy(1.0), plain.clone(), turn, seen_as(carry(turn, own))),
        ("mirrored", chalk.clone(), plain.clone(), mirror, seen_as(carry(mirror, NORMAL))),
        ("mirrored and mapped", bumpy(1.0), plain.clone(), mirror, seen_as(carry(mirror, own))),
        (
            "mirrored, left-handed",
            bumpy(1.0),
            of(-1.0),
            mirror,
            seen_as(carry(mirror, mapped(NORMAL, TANGENT, -1.0, 1.0))),
        ),
        ("mirrored and turned", bumpy(1.0), plain.clone(), turn * mirror, seen_as(carry(turn * mirror, own))),
        ("stretched", chalk.clone(), plain.clone(), stretched, seen_as(stretched_normal)),
        ("stretched and mapped", bumpy(1.0), plain.clone(), stretched, {
            seen_as(mapped(stretched_normal, (TANGENT * stretch).normalize(), 1.0, 1.0))
        }),
        ("flattened", chalk.clone(), plain.clone(), DMat4::from_scale(DVec3::new(1.0, 1.0, 0.0)), seen_as(DVec3::Z)),
        ("from behind", both(bumpy(1.0)), plain.clone(), around, seen_as(-carry(around, own))),
        ("from behind, one-sided", bumpy(1.0), plain.clone(), around, None),
        (
            "mirrored, from behind",
            both(bumpy(1.0)),
            plain.clone(),
            around * mirror,
            seen_as(-carry(around * mirror, own)),
        ),
        ("mirrored, from behind, one-sided", bumpy(1.0), plain.clone(), around * mirror, None),
        ("mirrored in depth", both(bumpy(1.0)), plain.clone(), toward_back, seen_as(-carry(toward_back, own))),
        ("mirrored in depth, one-sided", chalk.clone(), plain.clone(), toward_back, None),
        ("both sides, from the front", both(bumpy(1.0)), plain.clone(), still, seen_as(own)),
        ("both sides, mirrored", both(bumpy(1.0)), plain.clone(), mirror, seen_as(carry(mirror, own))),
        ("no normals", chalk.clone(), no_normals.clone(), still, seen_as(DVec3::Z)),
        ("no normals, from behind", both(chalk.clone()), no_normals, around, seen_as(DVec3::Z)),
        ("no tangents", bumpy(1.0), no_tangents, still, seen_as(mapped(NORMAL, frame, 1.0, 1.0))),
        ("tangents along the normal", bumpy(1.0), along_normal, still, seen_as(mapped(NORMAL, frame, 1.0, 1.0))),
        ("the first coordinates", of_second(0), two_sets.clone(), still, seen_as(left)),
        ("the second coordinates", of_second(1), two_sets, still, seen_as(own)),
    ];
    for (_, material, mesh, placed, _) in &cases {
        board.hang(material.clone(), mesh.clone(), *placed);
    }
    let shading = Shading::default();
    let dark = lighting(&gpu, &Environment::uniform(DVec3::ZERO)?, &shading)?;
    let seen = board.render_lit(&gpu, dark, &shading)?;
    let mut wrong = Vec::new();
    for ((name, .., normal), seen) in cases.iter().zip(&seen) {
        let expected = normal.map_or(hidden, expected);
        // Half floats: 5e-4 nits.
        let apart = (seen.nits - expected).abs().max_element();
        if apart >= 1e-3 {
            wrong.push(format!("{name}: {} for {expected}", seen.nits));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    Ok(())
}
