//! Diffuse transmission, compared with a grid of directions over the whole sphere.

use super::{TestResult, gradient, near};
use crate::stage::gpu;
use framegraph_passes::gpu_scene::shadow_views::ShadowSettings;
use framegraph_passes::{Precision, Shading};
use framegraph_scene::geometry::plane;
use framegraph_scene::material::{DiffuseTransmission, Specular, Transmission, Volume};
use framegraph_scene::texture::{Filter, Sampler, TextureRole};
use framegraph_scene::{Environment, Light, LightKind, Material};
use glam::{DMat4, DVec3, Vec2, Vec3};
use std::f64::consts::{FRAC_PI_2, PI};
use tests::measure::board::{Board, card};
use truth::translucent::Sheet;

const NORMAL: DVec3 = DVec3::new(0.36, -0.48, 0.8);
const FRONT: Vec3 = Vec3::new(0.2, 0.5, 0.1);
const BACK: Vec3 = Vec3::new(0.9, 0.8, 0.3);

/// Returns a surface without specular reflection.
fn leaf(scattered: DiffuseTransmission) -> Material {
    Material {
        specular: Some(Specular { factor: 0.0, ..Specular::default() }),
        diffuse_transmission: Some(scattered),
        ..Material::dielectric("leaf", FRONT, 0.5)
    }
}

fn scattered(factor: f32, volume: Option<Volume>) -> DiffuseTransmission {
    DiffuseTransmission { factor, color: BACK, volume, ..DiffuseTransmission::default() }
}

fn sheet(factor: f64) -> Sheet {
    let (front, back) = (FRONT.as_dvec3(), BACK.as_dvec3());
    Sheet { normal: NORMAL, front, back, factor, left: DVec3::ONE }
}

fn leaning() -> framegraph_scene::Mesh {
    card(1.0, NORMAL, DVec3::new(0.8, 0.6, 0.0), 1.0)
}

/// Returns a volume 0.5 m thick in the mesh, with an attenuation color at 1 m.
fn body(color: Vec3) -> Volume {
    Volume { thickness: 0.5, attenuation_color: color, attenuation_distance_m: 1.0, ..Volume::default() }
}

/// Each factor, a volume, and both textures, under light that depends on direction, compared with a grid over the
/// sphere. The depth of a volume is the mesh's thickness times the object's scale, and absorption is applied along it.
#[test]
fn light_from_all_around_is_scattered_through() -> TestResult {
    let Some(gpu) = gpu("light_from_all_around_is_scattered_through") else { return Ok(()) };
    let mut board = Board::default();
    let nearest = Sampler { mag: Filter::Nearest, min: Filter::Nearest, mip: None, ..Sampler::default() };
    let texture = Some(board.texture(1, &[[255, 0, 255, 153]], TextureRole::Linear, nearest));
    let color_texture = Some(board.texture(1, &[[255, 0, 255, 0]], TextureRole::Color, nearest));
    let left = Vec3::new(0.25, 0.81, 1.0);
    let textured = DiffuseTransmission { texture, color_texture, ..scattered(0.8, None) };
    let metal = Material { metallic: 1.0, base_color: Vec3::ZERO.extend(1.0), ..leaf(scattered(1.0, None)) };
    let glass = Some(Transmission { factor: 1.0, ..Transmission::default() });
    let (unit, twice) = (DMat4::IDENTITY, DMat4::from_scale(DVec3::new(1.0, 1.0, 4.0)));
    let through = |factor: f64, left: DVec3| Sheet { left, ..sheet(factor) };
    let cases = [
        ("none", leaf(scattered(0.0, None)), unit, sheet(0.0)),
        ("half", leaf(scattered(0.5, None)), unit, sheet(0.5)),
        ("all", leaf(scattered(1.0, None)), unit, sheet(1.0)),
        ("body", leaf(scattered(1.0, Some(body(left)))), unit, through(1.0, DVec3::new(0.5, 0.9, 1.0))),
        ("scaled", leaf(scattered(1.0, Some(body(left)))), twice, through(1.0, left.as_dvec3())),
        ("textures", leaf(textured), unit, Sheet { back: BACK.as_dvec3() * DVec3::new(1.0, 0.0, 1.0), ..sheet(0.48) }),
        ("metal", metal, unit, Sheet { front: DVec3::ZERO, back: DVec3::ZERO, ..sheet(1.0) }),
    ];
    for (_, material, placed, _) in &cases {
        // The shading normal is the mesh's, so a scale along the view changes its tilt.
        let mesh = if *placed == unit {
            leaning()
        } else {
            card(1.0, DVec3::new(NORMAL.x, NORMAL.y, NORMAL.z * 4.0).normalize(), DVec3::new(0.8, 0.6, 0.0), 1.0)
        };
        board.hang(material.clone(), mesh, *placed);
    }
    let light = |d: DVec3| DVec3::new(1.0 + 0.5 * d.x - 0.3 * d.z, 1.0 - 0.7 * d.z, 1.0 + 0.6 * d.y);
    let seen = board.render(&gpu, &gradient(light)?, &Shading::default())?;
    for ((name, _, placed, sheet), seen) in cases.iter().zip(&seen) {
        let scale = if *placed == unit { "" } else { " (a mean scale of 2)" };
        // Half floats, and a map of 128 texels; a black metal reflects at grazing angles.
        near(&format!("{name}{scale}"), seen, sheet.seen(64, light), 6e-3, 3e-3);
    }
    // Negative control: some channels are darker from the front than from behind.
    let (front, back) = (sheet(0.0).seen(64, light), sheet(1.0).seen(64, light));
    assert!((front / FRONT.as_dvec3() - back / BACK.as_dvec3()).abs().max_element() > 0.3);
    // Transmission reduces the diffuse light of both sides.
    let mut board = Board::default();
    board.hang(Material { transmission: glass, ..leaf(scattered(0.5, None)) }, leaning(), unit);
    let shown = board.render(&gpu, &Environment::uniform(DVec3::ONE)?, &Shading::default())?;
    near("clear", &shown[0], FRONT.as_dvec3(), 6e-3, 1e-3);
    Ok(())
}

/// A surface that is white on both sides reflects and transmits all light, for any factor; with a specular layer, no
/// more than that.
#[test]
fn nothing_is_lost_in_a_white_furnace() -> TestResult {
    let Some(gpu) = gpu("nothing_is_lost_in_a_white_furnace") else { return Ok(()) };
    let mut board = Board::default();
    let factors = [0.0, 0.25, 0.5, 1.0];
    for factor in factors {
        let white = DiffuseTransmission { factor, ..DiffuseTransmission::default() };
        let chalk = Material { base_color: Vec3::ONE.extend(1.0), ..leaf(white) };
        board.hang(chalk.clone(), leaning(), DMat4::IDENTITY);
        board.hang(Material { specular: None, ..chalk }, leaning(), DMat4::IDENTITY);
    }
    let seen = board.render(&gpu, &Environment::uniform(DVec3::ONE)?, &Shading::default())?;
    for (factor, pair) in factors.into_iter().zip(seen.chunks_exact(2)) {
        near(&format!("chalk of {factor}"), &pair[0], DVec3::ONE, 4e-3, 0.0);
        // Compensation brightens glossy white slightly, as without diffuse transmission.
        near(&format!("glossy of {factor}"), &pair[1], DVec3::ONE, 0.02, 0.0);
    }
    Ok(())
}

/// A directional, a point and a spot light on either side: Lambert's law for the lit side.
#[test]
fn lights_from_behind_shine_through() -> TestResult {
    let Some(gpu) = gpu("lights_from_behind_shine_through") else { return Ok(()) };
    let dark = Environment::uniform(DVec3::ZERO)?;
    let shading = Shading::default();
    for to_light in [DVec3::new(0.6, 0.0, 0.8), DVec3::new(0.6, 0.0, -0.8), DVec3::new(-0.36, 0.48, -0.8)] {
        let (lux, distance_m) = (PI, 3.0);
        let intensity_candela = (lux * distance_m * distance_m) as f32;
        let cone = [0.3, 0.4];
        for kind in [
            LightKind::Directional { illuminance_lux: lux as f32, angular_radius_rad: 0.0 },
            LightKind::Point { intensity_candela, range_m: None },
            LightKind::Spot { intensity_candela, range_m: None, inner_cone_rad: cone[0], outer_cone_rad: cone[1] },
        ] {
            let mut board = Board::default();
            board.hang(leaf(scattered(0.4, None)), leaning(), DMat4::IDENTITY);
            let position = board.middle(0) + to_light * distance_m;
            board.scene.lights.push(Light { kind, position, ..Light::directional("lamp", -to_light.as_vec3(), 1.0) });
            let seen = board.render(&gpu, &dark, &shading)?;
            let expected = sheet(0.4).scattered(to_light) * lux;
            assert!(expected.max_element() > 0.05, "{expected}");
            near(&format!("{kind:?} from {to_light}"), &seen[0], expected, 6e-3, 1e-4);
        }
    }
    Ok(())
}

/// With shadows, a sheet lit from behind does not shadow itself, but an occluder on the other side does. A closed body
/// is lit on its far side, at the distance of its thickness.
#[test]
fn a_sheet_does_not_shadow_itself_from_behind() -> TestResult {
    let Some(gpu) = gpu("a_sheet_does_not_shadow_itself_from_behind") else { return Ok(()) };
    let dark = Environment::uniform(DVec3::ZERO)?;
    let to_light = DVec3::new(0.28, 0.0, -0.96);
    let facing = |side_m: f32| card(side_m, DVec3::Z, DVec3::X, 1.0);
    let lit = |hidden: bool, depth_m: Option<f64>| -> Result<DVec3, Box<dyn std::error::Error>> {
        let mut board = Board { shadows: Some(ShadowSettings::default()), ..Board::default() };
        let volume = depth_m.map(|depth| Volume { thickness: depth as f32, ..Volume::default() });
        let material = Material { double_sided: true, ..leaf(scattered(1.0, volume)) };
        board.hang(material.clone(), facing(0.9), DMat4::IDENTITY);
        let middle = board.middle(0);
        board.scene.lights = vec![Light::directional("sun", -to_light.as_vec3(), PI as f32)];
        let mut stand = |material: Material, at: DVec3| {
            let mesh = board.scene.add_mesh(plane(Vec2::splat(3.0), 1, Vec2::ONE));
            let material = board.scene.add_material(material);
            let upright = DMat4::from_translation(middle + at) * DMat4::from_rotation_x(FRAC_PI_2);
            board.scene.add_instance("wall", mesh, material, upright);
        };
        if hidden {
            let wall = Material { double_sided: true, ..Material::dielectric("wall", Vec3::ONE, 1.0) };
            stand(wall, to_light * 1.5);
        }
        if let Some(depth) = depth_m {
            stand(material, DVec3::NEG_Z * depth);
        }
        Ok(board.render(&gpu, &dark, &Shading::default())?[0].nits)
    };
    let expected = Sheet { normal: DVec3::Z, ..sheet(1.0) }.scattered(to_light) * PI;
    for (name, hidden, depth_m, expected) in [
        ("sheet", false, None, expected),
        ("hidden sheet", true, None, DVec3::ZERO),
        ("body", false, Some(0.4), expected),
        ("hidden body", true, Some(0.4), DVec3::ZERO),
    ] {
        let seen = lit(hidden, depth_m)?;
        assert!((seen - expected).abs().max_element() < 6e-3, "{name}: {seen} for {expected}");
    }
    Ok(())
}

/// Impossible volumes give finite results, also in half floats.
#[test]
fn impossible_bodies_are_finite() -> TestResult {
    let Some(gpu) = gpu("impossible_bodies_are_finite") else { return Ok(()) };
    let mut board = Board::default();
    for thickness in [1e-30, 1.0, f32::MAX] {
        for attenuation_distance_m in [1e-30, f32::INFINITY] {
            let volume =
                Volume { thickness, attenuation_distance_m, attenuation_color: Vec3::ZERO, ..Volume::default() };
            board.hang(leaf(scattered(1.0, Some(volume))), leaning(), DMat4::IDENTITY);
            let clear = Volume { attenuation_color: Vec3::ONE, ..volume };
            board.hang(leaf(scattered(1.0, Some(clear))), leaning(), DMat4::from_scale(DVec3::splat(1e-3)));
        }
    }
    let along = NORMAL.cross(DVec3::Z).normalize();
    for toward in [NORMAL, -NORMAL, along] {
        board.scene.lights.push(Light::directional("lamp", -toward.as_vec3(), 1.0));
    }
    for precision in [Precision::Full, Precision::Half] {
        let shading = Shading { precision, ..Shading::default() };
        if shading.precision.check(&gpu).is_err() {
            continue;
        }
        let seen = board.render(&gpu, &Environment::uniform(DVec3::ONE)?, &shading)?;
        for (piece, seen) in board.pieces.iter().zip(&seen) {
            let body = piece.material.volume();
            assert!(seen.nits.is_finite() && seen.nits.min_element() >= 0.0, "{body:?}: {}", seen.nits);
        }
    }
    Ok(())
}
