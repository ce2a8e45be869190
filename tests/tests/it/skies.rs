//! Surfaces under a sky that grows brighter along x in red, along y in green and along z in blue. The color of a lobe
//! therefore shows its direction, component by component.

use crate::stage::{Shot, declared, gpu, lighting, view_of};
use framegraph::{Plan, Scratch, compile};
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::light::ibl::{DfgSettings, IblSettings};
use framegraph_passes::light::shading::LightSettings;
use framegraph_passes::{Lighting, Quality, Settings, Shading, World};
use framegraph_scene::environment::{EquirectMap, ShBands};
use framegraph_scene::material::{Anisotropy, ClearCoat, Sheen, Specular};
use framegraph_scene::texture::{Sampler, TextureRole};
use framegraph_scene::{Camera, Environment, Material, Projection, Scene, progress};
use framegraph_shader_mirrors::occlusion::specular_occlusion;
use framegraph_wgpu::{Gpu, Imports, read_texture};
use glam::{DMat4, DVec3, Vec3};
use std::error::Error;
use tests::executors;
use tests::measure::board::{Board, card};
use tests::stage::light_cache;
use truth::lobe::gathered;
use truth::surface::{self, Coat, Grooves, Surface};

type TestResult = Result<(), Box<dyn Error>>;

/// Slope of the sky: 1 + 0.8 x in red, and so on.
const SLOPE: f64 = 0.8;
const NORMAL: DVec3 = DVec3::new(0.36, -0.48, 0.8);
const TANGENT: DVec3 = DVec3::new(0.8, 0.6, 0.0);
/// Roughness of level 3 of the five, so that nothing is interpolated.
const ROUGHNESS: f64 = 0.5;

fn sky() -> Environment {
    let map = EquirectMap::from_fn(256, 128, |d| DVec3::ONE + d * SLOPE);
    Environment { name: "slope".into(), map, sun: None, filtered: None, warnings: Vec::new() }
}

/// Returns the color of a lobe: the slope is reduced by the lobe's mean cosine, by quadrature.
fn of_lobe(direction: DVec3, roughness: f64) -> DVec3 {
    DVec3::ONE + direction * SLOPE * gathered(DVec3::Z, roughness, |l| DVec3::splat(l.z)).z
}

/// Returns irradiance over π; the mean cosine of a cosine lobe is 2/3.
fn on_surface(normal: DVec3) -> DVec3 {
    DVec3::ONE + normal * (SLOPE * 2.0 / 3.0)
}

#[test]
fn every_lobe_gathers_from_where_it_points() -> TestResult {
    let Some(gpu) = gpu("every_lobe_gathers_from_where_it_points") else { return Ok(()) };
    let base = DVec3::new(0.9, 0.7, 0.5);
    let chalk = Material {
        specular: Some(Specular { factor: 0.0, ..Specular::default() }),
        ..Material::dielectric("chalk", base.as_vec3(), 1.0)
    };
    let black = Material { base_color: Vec3::ZERO.extend(1.0), ..chalk.clone() };
    let metal = |roughness: f64| Material::metal("metal", base.as_vec3(), roughness as f32);
    let surface = |metallic, roughness| Surface::metal_rough(base, metallic, roughness, 0.04, NORMAL);
    let coat = ClearCoat { factor: 0.8, roughness: ROUGHNESS as f32, normal_scale: 1.0, ..ClearCoat::default() };
    let sheen = Sheen { color: Vec3::new(0.9, 0.7, 0.5), roughness: ROUGHNESS as f32, ..Sheen::default() };
    let turn = 0.7_f64;
    let along = TANGENT * turn.cos() + NORMAL.cross(TANGENT) * turn.sin();
    let brushed = |strength: f64| Material {
        anisotropy: Some(Anisotropy { strength: strength as f32, rotation_rad: turn as f32, texture: None }),
        ..metal(ROUGHNESS)
    };
    let nothing = Surface::chalk(DVec3::ZERO, NORMAL);
    let cases = [
        ("chalk", chalk.clone(), Surface::chalk(base, NORMAL)),
        ("metal", metal(ROUGHNESS), surface(1.0, ROUGHNESS)),
        ("rough metal", metal(1.0), surface(1.0, 1.0)),
        ("plastic", Material::dielectric("plastic", base.as_vec3(), ROUGHNESS as f32), surface(0.0, ROUGHNESS)),
        (
            "coat",
            Material { clear_coat: Some(coat), ..black.clone() },
            Surface { coat: Some(Coat { normal: NORMAL, factor: 0.8, roughness: ROUGHNESS }), ..nothing },
        ),
        (
            "coat over metal",
            Material { clear_coat: Some(coat), ..metal(ROUGHNESS) },
            Surface {
                coat: Some(Coat { normal: NORMAL, factor: 0.8, roughness: ROUGHNESS }),
                ..surface(1.0, ROUGHNESS)
            },
        ),
        (
            "sheen over chalk",
            Material { sheen: Some(sheen), ..chalk },
            Surface {
                sheen: Some(surface::Sheen { color: sheen.color.as_dvec3(), roughness: ROUGHNESS }),
                ..Surface::chalk(base, NORMAL)
            },
        ),
        (
            "grooves",
            brushed(0.6),
            Surface { grooves: Some(Grooves { along, strength: 0.6 }), ..surface(1.0, ROUGHNESS) },
        ),
        (
            "deep grooves",
            brushed(1.0),
            Surface { grooves: Some(Grooves { along, strength: 1.0 }), ..surface(1.0, ROUGHNESS) },
        ),
    ];
    let mut board = Board::default();
    for (_, material, _) in &cases {
        board.hang(material.clone(), card(0.9, NORMAL, TANGENT, 1.0), DMat4::IDENTITY);
    }
    for ((name, _, surface), seen) in cases.iter().zip(&under_sky(&gpu, &board)?) {
        near(name, *seen, surface.of_sky(DVec3::Z, of_lobe, on_surface));
    }
    Ok(())
}

/// Returns the radiance of a board at the highest quality.
fn under_sky(gpu: &Gpu, board: &Board) -> Result<Vec<DVec3>, Box<dyn Error>> {
    let shading = Quality::High.shading();
    // A level of 32 texels; larger texels would not represent the slope linearly.
    let settings = LightSettings {
        image: IblSettings { cube_texels: 256, ..IblSettings::default() },
        dfg: DfgSettings { texels: 64, visibility: shading.table },
    };
    let lighting = Lighting::new(gpu, &sky(), &settings, &light_cache(), &mut progress::silent)?;
    Ok(board.render_lit(gpu, lighting, &shading)?.iter().map(|seen| seen.nits).collect())
}

/// The cube has six bits of red and green and five of blue.
fn near(name: &str, seen: DVec3, expected: DVec3) {
    let apart = ((seen - expected) / expected.max(DVec3::splat(0.1))).abs().max_element();
    program::line(format_args!("{name}: {seen} for {expected}: {apart:.5}"));
    assert!(apart < 1e-2, "{name}: {seen} for {expected}");
}

/// On a rough black base: a coat uses its own normal map, and occlusion of coat and sheen depends on the roughness of
/// their own layer.
#[test]
fn layers_have_their_own_normal_and_occlusion() -> TestResult {
    let Some(gpu) = gpu("layers_have_their_own_normal_and_occlusion") else { return Ok(()) };
    let mut board = Board::default();
    let mut even = |texel, role| Some(board.texture(1, &[texel], role, Sampler::default()));
    let open = 102;
    let crevice = even([open, 255, 255, 255], TextureRole::Linear);
    let (bump, dent) = ([170, 100, 230, 255], [100, 150, 230, 255]);
    let [own, base] = [even(bump, TextureRole::Normal), even(dent, TextureRole::Normal)];
    let normal = {
        let [x, y, z] = [bump[0], bump[1], bump[2]].map(|c| f64::from(c) / 255.0 * 2.0 - 1.0);
        (TANGENT * x + NORMAL.cross(TANGENT) * y + NORMAL * z).normalize()
    };
    let black = Material {
        specular: Some(Specular { factor: 0.0, ..Specular::default() }),
        normal_texture: base,
        ..Material::dielectric("black", Vec3::ZERO, 1.0)
    };
    let coat = ClearCoat { factor: 0.8, roughness: ROUGHNESS as f32, normal_scale: 1.0, ..ClearCoat::default() };
    let coated = |coat| Material { clear_coat: Some(coat), ..black.clone() };
    let mapped = |roughness: f64| ClearCoat { normal_texture: own, roughness: roughness as f32, ..coat };
    let under = |normal| {
        let coat = Some(Coat { normal, factor: 0.8, roughness: ROUGHNESS });
        Surface { coat, ..Surface::chalk(DVec3::ZERO, NORMAL) }
    };
    let whole = [
        ("coat over a map", coated(coat), under(NORMAL)),
        ("coat with its map", coated(mapped(ROUGHNESS)), under(normal)),
    ];
    // A roughness far from the base's.
    let sheen = Sheen { color: Vec3::ONE, roughness: 0.5, ..Sheen::default() };
    let fibers = Material { sheen: Some(sheen), normal_texture: None, roughness: 0.0, ..black.clone() };
    let hidden = [("hidden coat", coated(mapped(0.2)), normal, 0.04), ("hidden sheen", fibers, NORMAL, 0.25)];
    let mut hang = |material| board.hang(material, card(0.9, NORMAL, TANGENT, 1.0), DMat4::IDENTITY);
    for (_, material, _) in &whole {
        hang(material.clone());
    }
    for (_, material, ..) in &hidden {
        hang(material.clone());
        hang(Material { occlusion_texture: crevice, occlusion_strength: 1.0, ..material.clone() });
    }
    let seen = under_sky(&gpu, &board)?;
    for ((name, _, surface), seen) in whole.iter().zip(&seen) {
        near(name, *seen, surface.of_sky(DVec3::Z, of_lobe, on_surface));
    }
    for ((name, _, normal, alpha), pair) in hidden.iter().zip(seen[whole.len()..].chunks(2)) {
        let left = specular_occlusion(normal.z, f64::from(open) / 255.0, *alpha);
        near(name, pair[1] / pair[0], DVec3::splat(left));
    }
    Ok(())
}

/// Direction in which the sky's camera looks.
const AHEAD: DVec3 = DVec3::new(1.0, 0.1, 0.2);

/// Draws the sky alone, at an exposure of 1.
fn sky_seen_by(
    gpu: &Gpu,
    settings: &Settings,
    environment: &Environment,
    projection: Projection,
) -> Result<Vec<[f32; 4]>, Box<dyn Error>> {
    let shot = Shot { ev100: (1.0_f32 / 1.2).log2(), ..Shot::small(*settings) };
    let lighting = lighting(gpu, environment, &settings.shading)?;
    let mut scene = Scene::default();
    scene.cameras.push(Camera::look_at(DVec3::ZERO, AHEAD, DVec3::Y, projection)?);
    let view = view_of(&scene, &lighting.image, &Background::Environment, &shot);
    let world = World::new(gpu, &scene, lighting, [view], &mut progress::silent)?;
    let (mut frame, io) = declared(settings);
    frame.graph_mut().readback(io.hdr)?;
    let mut plan = Plan::new();
    compile(frame.graph(), &gpu.caps(), &shot.options, &mut Scratch::new(), &mut plan)?;
    let mut executor = executors::lend(gpu);
    executor.execute(&plan, &frame, &world, &Imports::new())?;
    Ok(read_texture(gpu, executor.texture(&plan, io.hdr).ok_or("the frame left no picture")?)?.rgba())
}

/// Every number of bands represents the slope exactly, since the first band contains it; all directions are tested, as
/// a wrong sign affects only some. The background is the map itself and not a blurred level: it has a texel's radiance
/// at the texel's center.
#[test]
fn the_sky_is_shown_in_full() -> TestResult {
    let Some(gpu) = gpu("the_sky_is_shown_in_full") else { return Ok(()) };
    // Texels alternate between bright and dark, each 22.5° wide.
    let texels = (0..16 * 8).map(|i: u32| [((i % 16 + i / 16) % 2) as f32; 4]).collect();
    let environment = Environment { map: EquirectMap::new(16, 8, texels), name: "checkered".into(), ..sky() };
    let settings = Settings { shadows: None, fxaa: false, ..Settings::DEFAULT };
    let seen = sky_seen_by(&gpu, &settings, &environment, Projection::perspective(1.0, 0.1))?;
    let (least, most) = seen.iter().fold((f32::MAX, 0.0_f32), |(least, most), c| (least.min(c[0]), most.max(c[0])));
    // A pixel is 1/35 of a texel, so some pixel is within 1/70 of a texel's center along both axes. With a tenth of the
    // next level, which is gray, the range would be 0.05 to 0.95.
    assert!(least < 0.035 && most > 0.965, "{least} to {most}");
    Ok(())
}

/// An orthographic camera sees the same direction in every pixel, here none of the world's axes.
#[test]
fn a_parallel_projection_shows_one_place_of_the_sky() -> TestResult {
    let Some(gpu) = gpu("a_parallel_projection_shows_one_place_of_the_sky") else { return Ok(()) };
    let settings = Settings { shadows: None, fxaa: false, ..Settings::DEFAULT };
    let projection = Projection::Orthographic { half_width_m: None, half_height_m: 2.0, near_m: 0.1, far_m: 100.0 };
    for seen in sky_seen_by(&gpu, &settings, &sky(), projection)? {
        // Half floats, and a texel of the map is 0.025 wide.
        let expected = DVec3::ONE + AHEAD.normalize() * SLOPE;
        let apart = (DVec3::new(seen[0].into(), seen[1].into(), seen[2].into()) - expected).abs().max_element();
        assert!(apart < 3e-3, "{seen:?} for {expected}");
    }
    Ok(())
}

#[test]
fn every_number_of_bands_shows_a_slope() -> TestResult {
    let Some(gpu) = gpu("every_number_of_bands_shows_a_slope") else { return Ok(()) };
    let chalk = Material {
        specular: Some(Specular { factor: 0.0, ..Specular::default() }),
        ..Material::dielectric("chalk", Vec3::ONE, 1.0)
    };
    let mut board = Board::default();
    let normals = [NORMAL, DVec3::new(-0.48, 0.36, 0.8), DVec3::new(0.6, 0.64, 0.48), DVec3::new(-0.8, -0.36, 0.48)];
    for normal in normals {
        board.hang(chalk.clone(), card(0.9, normal, normal.any_orthonormal_vector(), 1.0), DMat4::IDENTITY);
    }
    for bands in [ShBands::Two, ShBands::Three, ShBands::Five] {
        let shading = Shading { bands, ..Shading::default() };
        let seen = board.render_lit(&gpu, lighting(&gpu, &sky(), &shading)?, &shading)?;
        for (normal, seen) in normals.into_iter().zip(seen) {
            let apart = (seen.nits - on_surface(normal)).abs().max_element();
            assert!(apart < 2e-3, "{bands:?} {normal}: {} for {}", seen.nits, on_surface(normal));
        }
    }
    Ok(())
}
