//! Inputs of material lobes: channels of textures, and directions of anisotropy and coats.

use super::{
    HALF_FLOATS, NORMAL, TANGENT, TEXEL, TestResult, compare, linear_color, lit, mesh, no_specular, shown, under_lights,
};
use crate::stage::{gpu, lighting};
use framegraph_passes::Shading;
use framegraph_scene::material::{Anisotropy, ClearCoat, EmissiveUnit, Sheen, Specular, Transmission, Volume};
use framegraph_scene::texture::TextureRole;
use framegraph_scene::{Environment, Material};
use glam::{DMat3, DMat4, DQuat, DVec2, DVec3, Vec3};
use tests::measure::board::{Board, card};
use truth::albedo::cloth;
use truth::surface::{self, Coat, Grooves, Surface};

fn punctual() -> Shading {
    Shading { compensate_punctual: false, ..Shading::default() }
}

fn black() -> Material {
    Material { specular: no_specular(), ..Material::dielectric("black", Vec3::ZERO, 0.5) }
}

fn nothing() -> Surface {
    Surface::chalk(DVec3::ZERO, NORMAL)
}

/// Decodes a glTF 2.0 normal whose x and y are scaled.
fn mapped(texel: [u8; 4], scale: f64) -> DVec3 {
    let [x, y, z] = [texel[0], texel[1], texel[2]].map(|c| f64::from(c) / 255.0 * 2.0 - 1.0);
    (TANGENT * (x * scale) + NORMAL.cross(TANGENT) * (y * scale) + NORMAL * z).normalize()
}

/// Coverage is in red, roughness in green, with a normal map of its own. A coat has index 1.5 and attenuates the layers
/// below.
#[test]
fn a_coat_is_its_channels_over_what_is_below() -> TestResult {
    let Some(gpu) = gpu("a_coat_is_its_channels_over_what_is_below") else { return Ok(()) };
    let mut board = lit();
    let factor = shown(&mut board, 2, TextureRole::Linear, [204, 51, 102, 153]);
    let roughness = shown(&mut board, 5, TextureRole::Linear, [51, 153, 204, 102]);
    let (bump, dent) = ([200, 90, 220, 0], [100, 150, 230, 0]);
    let own_normal = shown(&mut board, 8, TextureRole::Normal, bump);
    let base_normal = shown(&mut board, 11, TextureRole::Normal, dent);
    // A normal away from the red and green light, which illuminate the base.
    let steep = [13, 128, 153, 0];
    let steep_normal = shown(&mut board, 4, TextureRole::Normal, steep);
    let base = Vec3::new(0.9, 0.5, 0.3);
    let bare = Material { normal_texture: base_normal, normal_scale: 0.7, ..Material::metal("metal", base, 0.4) };
    let below = Surface::metal_rough(base.as_dvec3(), 1.0, 0.4, 0.04, mapped(dent, 0.7));
    let plain = ClearCoat { factor: 0.9, roughness: 0.7, normal_scale: 0.5, ..ClearCoat::default() };
    let textured = ClearCoat { texture: factor, roughness_texture: roughness, normal_texture: own_normal, ..plain };
    let under = |material: &Material, coat: ClearCoat| Material { clear_coat: Some(coat), ..material.clone() };
    let coated = |normal, factor, roughness| Some(Coat { normal, factor, roughness });
    let cases = vec![
        // A coat without a normal map does not use the base's.
        ("factors", under(&bare, plain), under_lights(&Surface { coat: coated(NORMAL, 0.9, 0.7), ..below })),
        (
            "textures",
            under(&bare, textured),
            under_lights(&Surface { coat: coated(mapped(bump, 0.5), 0.9 * 0.8, 0.7 * 0.6), ..below }),
        ),
        (
            "turned away",
            under(&black(), ClearCoat { normal_texture: steep_normal, normal_scale: 1.0, ..plain }),
            under_lights(&Surface { coat: coated(mapped(steep, 1.0), 0.9, 0.7), ..nothing() }),
        ),
        (
            "over nothing",
            under(&black(), textured),
            under_lights(&Surface { coat: coated(mapped(bump, 0.5), 0.9 * 0.8, 0.7 * 0.6), ..nothing() }),
        ),
    ];
    compare(&gpu, board, &Environment::uniform(DVec3::ZERO)?, &punctual(), HALF_FLOATS, cases)
}

/// Color is in red, green and blue of one texture, roughness in alpha of another.
#[test]
fn sheen_is_its_channels() -> TestResult {
    let Some(gpu) = gpu("sheen_is_its_channels") else { return Ok(()) };
    let mut board = lit();
    let color_texture = shown(&mut board, 3, TextureRole::Color, [230, 150, 200, 10]);
    let roughness_texture = shown(&mut board, 12, TextureRole::Linear, TEXEL);
    let color = Vec3::new(0.9, 0.7, 0.5);
    let plain = Sheen { color, roughness: 0.75, ..Sheen::default() };
    let sheen = |sheen: Sheen| Material { sheen: Some(sheen), ..black() };
    let expected =
        |color, roughness| under_lights(&Surface { sheen: Some(surface::Sheen { color, roughness }), ..nothing() });
    let textured_color = color.as_dvec3() * linear_color([230, 150, 200, 0]);
    let cases = vec![
        ("factors", sheen(plain), expected(color.as_dvec3(), 0.75)),
        ("color", sheen(Sheen { color_texture, ..plain }), expected(textured_color, 0.75)),
        ("roughness", sheen(Sheen { roughness_texture, ..plain }), expected(color.as_dvec3(), 0.75 * 0.8)),
        ("both", sheen(Sheen { color_texture, roughness_texture, ..plain }), expected(textured_color, 0.75 * 0.8)),
    ];
    compare(&gpu, board, &Environment::uniform(DVec3::ZERO)?, &punctual(), HALF_FLOATS, cases)
}

/// The factor is in alpha, the tint in red, green and blue of another texture; the tint is clamped to full reflection.
#[test]
fn specular_is_its_channels() -> TestResult {
    let Some(gpu) = gpu("specular_is_its_channels") else { return Ok(()) };
    let mut board = lit();
    let texture = shown(&mut board, 7, TextureRole::Linear, TEXEL);
    let color_texture = shown(&mut board, 10, TextureRole::Color, [230, 150, 200, 10]);
    let color = Vec3::new(0.9, 2.0, 0.5);
    let plain = Specular { factor: 0.9, color, texture: None, color_texture: None };
    let specular = |specular: Specular, ior: f32| Material {
        specular: Some(specular),
        ior,
        ..Material::dielectric("black", Vec3::ZERO, 0.4)
    };
    let expected = |factor: f64, color: DVec3, f0: f64| {
        let f0 = (color * f0).min(DVec3::ONE) * factor;
        under_lights(&Surface { f0, f90: factor, roughness: 0.4, ..nothing() })
    };
    let (plain_color, tinted) = (color.as_dvec3(), color.as_dvec3() * linear_color([230, 150, 200, 0]));
    let dense = (9.0_f64 / 11.0).powi(2);
    let cases = vec![
        ("factors", specular(plain, 1.5), expected(0.9, plain_color, 0.04)),
        ("factor", specular(Specular { texture, ..plain }, 1.5), expected(0.9 * 0.8, plain_color, 0.04)),
        ("tint", specular(Specular { color_texture, ..plain }, 1.5), expected(0.9, tinted, 0.04)),
        ("held at one", specular(Specular { texture, ..plain }, 10.0), expected(0.9 * 0.8, plain_color, dense)),
    ];
    compare(&gpu, board, &Environment::uniform(DVec3::ZERO)?, &punctual(), HALF_FLOATS, cases)
}

/// The direction is in red and green, the strength in blue, rotated by the rotation. A mirrored object mirrors its
/// anisotropy.
#[test]
fn anisotropy_follows_texture_rotation_and_object() -> TestResult {
    let Some(gpu) = gpu("anisotropy_follows_texture_rotation_and_object") else { return Ok(()) };
    let mut board = lit();
    // (0.8, -0.6) to within one 8-bit step, and a strength of 0.8.
    let texel = [230, 51, 204, 0];
    let texture = shown(&mut board, 13, TextureRole::Linear, texel);
    // A zero direction, which selects the tangent.
    let none = board.texture(1, &[[128, 128, 204, 0]], TextureRole::Linear, Default::default());
    let stored = DVec2::new(f64::from(texel[0]), f64::from(texel[1])) / 127.5 - 1.0;
    let turn = |rotation_rad: f64, direction: DVec2| {
        let way = DVec2::from_angle(rotation_rad).rotate(direction.normalize());
        (TANGENT * way.x + NORMAL.cross(TANGENT) * way.y).normalize()
    };
    let plain = Anisotropy { strength: 0.9, rotation_rad: 0.3, texture: None };
    let brushed = |anisotropy| Material {
        anisotropy: Some(anisotropy),
        ..Material::metal("brushed", Vec3::new(0.9, 0.5, 0.3), 0.4)
    };
    let metal = Surface::metal_rough(DVec3::new(0.9, 0.5, 0.3), 1.0, 0.4, 0.04, NORMAL);
    let expected = |placed: DMat4, along: DVec3, strength: f64| {
        let carry = DMat3::from_mat4(placed);
        let grooves = Some(Grooves { along: carry * along, strength });
        under_lights(&Surface { normal: carry * NORMAL, grooves, ..metal })
    };
    let still = DMat4::IDENTITY;
    let mirror = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let turned = DMat4::from_quat(DQuat::from_rotation_z(0.7)) * mirror;
    let (own, mapped) = (turn(0.3, DVec2::X), turn(0.3, stored));
    let cases = [
        ("factors", plain, still, own, 0.9, 1.0),
        ("texture", Anisotropy { texture, ..plain }, still, mapped, 0.9 * 0.8, 1.0),
        ("texture without a direction", Anisotropy { texture: Some(none), ..plain }, still, own, 0.9 * 0.8, 1.0),
        ("mirrored", plain, mirror, own, 0.9, 1.0),
        ("mirrored texture", Anisotropy { texture, ..plain }, mirror, mapped, 0.9 * 0.8, 1.0),
        ("mirrored and turned", Anisotropy { texture, ..plain }, turned, mapped, 0.9 * 0.8, 1.0),
        (
            "left-handed",
            plain,
            still,
            {
                let way = DVec2::from_angle(0.3);
                TANGENT * way.x - NORMAL.cross(TANGENT) * way.y
            },
            0.9,
            -1.0,
        ),
    ];
    for (_, anisotropy, placed, .., handedness) in &cases {
        let shape = framegraph_scene::Mesh { tangents: card(0.9, NORMAL, TANGENT, *handedness).tangents, ..mesh() };
        board.hang(brushed(*anisotropy), shape, *placed);
    }
    let dark = lighting(&gpu, &Environment::uniform(DVec3::ZERO)?, &punctual())?;
    let seen = board.render_lit(&gpu, dark, &punctual())?;
    for ((name, _, placed, along, strength, _), seen) in cases.iter().zip(&seen) {
        let expected = expected(*placed, *along, *strength);
        let apart = ((seen.nits - expected) / expected.max(DVec3::splat(0.05))).abs().max_element();
        assert!(apart < 4e-3, "{name}: {} for {expected}", seen.nits);
    }
    Ok(())
}

/// Transmission is in red, thickness in green. At normal incidence, light passes through the thickness in m, which is
/// the mesh's times the object's mean scale.
#[test]
fn what_goes_through_a_body_is_its_channels_by_its_scale() -> TestResult {
    let Some(gpu) = gpu("what_goes_through_a_body_is_its_channels_by_its_scale") else { return Ok(()) };
    let mut board = Board::default();
    let texture = shown(&mut board, 1, TextureRole::Linear, [153, 51, 204, 102]);
    let thickness_texture = shown(&mut board, 14, TextureRole::Linear, [51, 204, 102, 153]);
    let tint = DVec3::new(0.9, 0.6, 0.3);
    let color = DVec3::new(0.25, 0.5, 0.8);
    let volume = Volume {
        thickness: 0.5,
        thickness_texture: None,
        attenuation_color: color.as_vec3(),
        attenuation_distance_m: 2.0,
    };
    let plain = Transmission { factor: 0.9, texture: None, volume: Some(volume) };
    let textured = Transmission { factor: 0.9, texture, volume: Some(Volume { thickness_texture, ..volume }) };
    let wall = Transmission { volume: None, ..plain };
    let glass = |transmission| Material {
        transmission: Some(transmission),
        specular: no_specular(),
        ..Material::dielectric("glass", tint.as_vec3(), 0.0)
    };
    let light = DVec3::new(1.0, 0.5, 0.25);
    let through = |share: f64, thickness_m: f64| {
        let left = DVec3::from(color.to_array().map(|c| c.powf(thickness_m / 2.0)));
        tint * light * (left * share + (1.0 - share))
    };
    let scale = DVec3::new(1.5, 1.0, 5.0);
    let cases = [
        ("wall", wall, DVec3::ONE, through(0.9, 0.0)),
        ("body", plain, DVec3::ONE, through(0.9, 0.5)),
        ("textures", textured, DVec3::ONE, through(0.9 * 0.6, 0.5 * 0.8)),
        ("scaled", plain, scale, through(0.9, 0.5 * 2.5)),
    ];
    for (_, transmission, scale, _) in &cases {
        let facing = card(0.6, DVec3::Z, DVec3::X, 1.0);
        let shape = framegraph_scene::Mesh { normals: facing.normals, tangents: facing.tangents, ..mesh() };
        let shrunk = DMat4::from_scale(*scale);
        board.hang(glass(*transmission), framegraph_scene::Mesh { positions: facing.positions, ..shape }, shrunk);
    }
    let shading = Shading::default();
    let even = lighting(&gpu, &Environment::uniform(light)?, &shading)?;
    let seen = board.render_lit(&gpu, even, &shading)?;
    for ((name, .., expected), seen) in cases.iter().zip(&seen) {
        // The picture behind has half floats, too.
        let apart = ((seen.nits - expected) / expected).abs().max_element();
        assert!(apart < 3e-3, "{name}: {} for {expected}", seen.nits);
    }
    Ok(())
}

/// Emission is attenuated by the layers above: by the coat's reflectance, and by the sheen's albedo.
#[test]
fn emission_leaves_through_the_layers() -> TestResult {
    let Some(gpu) = gpu("emission_leaves_through_the_layers") else { return Ok(()) };
    let glow = DVec3::new(2.0, 1.0, 0.5);
    let glowing = Material { emissive: glow.as_vec3(), emissive_unit: EmissiveUnit::Nits, ..black() };
    let coat = ClearCoat { factor: 0.8, roughness: 0.5, normal_scale: 1.0, ..ClearCoat::default() };
    let sheen = Sheen { color: Vec3::new(0.3, 0.9, 0.6), roughness: 0.6, ..Sheen::default() };
    // The normal is tilted away from the viewer by its z.
    let kept = 1.0 - 0.8 * (0.04 + 0.96 * (1.0 - NORMAL.z).powi(5));
    let under_sheen = 1.0 - 0.9 * cloth(NORMAL.z, 0.6);
    let both = Material { clear_coat: Some(coat), sheen: Some(sheen), ..glowing.clone() };
    let cases = vec![
        ("coat", Material { clear_coat: Some(coat), ..glowing.clone() }, glow * kept),
        ("sheen", Material { sheen: Some(sheen), ..glowing }, glow * under_sheen),
        ("both", both, glow * (kept * under_sheen)),
    ];
    compare(&gpu, Board::default(), &Environment::uniform(DVec3::ZERO)?, &Shading::default(), HALF_FLOATS, cases)
}
