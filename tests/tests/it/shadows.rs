//! Shadows of masked and unmasked surfaces; surfaces without casters are fully lit.

use crate::stage::{gpu, lighting};
use framegraph_passes::Shading;
use framegraph_passes::gpu_scene::shadow_views::{Fit, ShadowSettings, Splits};
use framegraph_scene::material::AlphaMode;
use framegraph_scene::texture::{Sampler, TextureRole};
use framegraph_scene::{Environment, Light, Material, Mesh, Specular};
use glam::{DMat4, DQuat, DVec3, Vec2, Vec3, Vec4};
use std::error::Error;
use std::f64::consts::PI;
use tests::measure::board::{Board, card};

type TestResult = Result<(), Box<dyn Error>>;

/// Direction toward the sun: an object 1 m in front of the board casts its shadow on the next cell to the right.
const TOWARD: DVec3 = DVec3::new(-1.0, 0.0, 1.0);

fn chalk() -> Material {
    let specular = Some(Specular { factor: 0.0, ..Specular::default() });
    Material { specular, ..Material::dielectric("chalk", Vec3::ONE, 1.0) }
}

/// Creates floors in every other cell and a caster in front of each of the others; compares the floors' light.
fn cast(name: &str, mut board: Board, casters: &[(&str, Material, Mesh, DMat4, f64)]) -> TestResult {
    let Some(gpu) = gpu(name) else { return Ok(()) };
    for (_, material, mesh, placed, _) in casters {
        let before = DMat4::from_translation(DVec3::Z) * *placed;
        board.hang(material.clone(), mesh.clone(), before);
        board.hang(chalk(), card(1.0, DVec3::Z, DVec3::X, 1.0), DMat4::IDENTITY);
    }
    board.scene.lights = vec![Light::directional("sun", -TOWARD.as_vec3(), PI as f32)];
    board.shadows = Some(ShadowSettings::texels(1024));
    let shading = Shading::default();
    let seen = board.render_lit(&gpu, lighting(&gpu, &Environment::uniform(DVec3::ZERO)?, &shading)?, &shading)?;
    let cosine = TOWARD.normalize().z;
    for (pair, (name, .., lit)) in seen.chunks_exact(2).zip(casters) {
        assert!((pair[1].nits - lit * cosine).abs().max_element() < 1e-3, "{name}: {} for {lit}", pair[1].nits);
    }
    Ok(())
}

#[test]
fn shadows_have_the_holes_of_their_masks() -> TestResult {
    let mut board = Board::default();
    let square = card(0.9, DVec3::Z, DVec3::X, 1.0);
    // Alpha 0.4; other channels have other values.
    let faint = board.texture(1, &[[255, 255, 255, 102]], TextureRole::Color, Sampler::default());
    // The left half is opaque, the right half is transparent.
    let half = board.texture(2, &[[0, 0, 0, 255], [255, 255, 255, 0]], TextureRole::Color, Sampler::default());
    let mask = |cutoff, factor: f32, texture| Material {
        alpha: AlphaMode::Mask { cutoff },
        base_color: Vec4::new(1.0, 1.0, 1.0, factor),
        base_color_texture: texture,
        ..chalk()
    };
    let pale = |alpha| Mesh { colors: vec![Vec4::new(1.0, 1.0, 1.0, alpha); 4], ..square.clone() };
    let at = |u: f32| Mesh { uv0: vec![Vec2::new(u, 0.5); 4], ..square.clone() };
    let second = framegraph_scene::texture::TextureSlot { uv_set: 1, ..half };
    let two_sets = Mesh { uv1: vec![Vec2::new(0.9, 0.5); 4], ..at(0.1) };
    let still = DMat4::IDENTITY;
    let blended = Material { alpha: AlphaMode::Blend, ..chalk() };
    let casters = [
        ("opaque", chalk(), square.clone(), still, 0.0),
        ("kept by its factor", mask(0.5, 0.6, None), square.clone(), still, 0.0),
        ("cut by its factor", mask(0.5, 0.4, None), square.clone(), still, 1.0),
        ("kept by its texture", mask(0.3, 1.0, Some(faint)), square.clone(), still, 0.0),
        ("cut by its texture", mask(0.5, 1.0, Some(faint)), square.clone(), still, 1.0),
        ("cut by texture and factor", mask(0.3, 0.6, Some(faint)), square.clone(), still, 1.0),
        ("kept by its vertices", mask(0.5, 1.0, None), pale(0.6), still, 0.0),
        ("cut by its vertices", mask(0.5, 1.0, None), pale(0.4), still, 1.0),
        ("the half that is there", mask(0.5, 1.0, Some(half)), at(0.1), still, 0.0),
        ("the half that is not", mask(0.5, 1.0, Some(half)), at(0.9), still, 1.0),
        ("the second coordinates", mask(0.5, 1.0, Some(second)), two_sets, still, 1.0),
        // Blended surfaces cast no shadow.
        ("blended", blended, square, still, 1.0),
    ];
    // Twenty cells per row, with shadows to the right: the last cell's would miss the board.
    for (part, casters) in casters.chunks(10).enumerate() {
        cast(&format!("shadows_have_the_holes_of_their_masks {part}"), board.clone(), casters)?;
    }
    Ok(())
}

#[test]
fn casters_of_all_sides_cast() -> TestResult {
    let square = card(0.9, DVec3::Z, DVec3::X, 1.0);
    let mirror = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let around = DMat4::from_quat(DQuat::from_rotation_y(PI));
    let both = Material { double_sided: true, ..chalk() };
    let small = card(0.3, DVec3::Z, DVec3::X, 1.0);
    let stretched = DMat4::from_scale(DVec3::new(3.0, 3.0, 0.5));
    let casters = [
        ("mirrored", chalk(), square.clone(), mirror, 0.0),
        ("of two sides, from behind", both, square.clone(), around, 0.0),
        ("of one side, from behind", chalk(), square.clone(), around, 1.0),
        ("scaled", chalk(), small, stretched, 0.0),
        // The shadow of this caster is between two cells.
        ("too near", chalk(), square, DMat4::from_translation(DVec3::NEG_Z * 0.9), 1.0),
    ];
    cast("casters_of_all_sides_cast", Board::default(), &casters)
}

/// A floor at grazing light with a low-resolution map: no texel shadows itself. The bias does not light the area under
/// a caster near the floor.
#[test]
fn what_nothing_shades_is_lit_in_full() -> TestResult {
    let Some(gpu) = gpu("what_nothing_shades_is_lit_in_full") else { return Ok(()) };
    let shading = Shading::default();
    for toward in [DVec3::new(-2.0, 0.3, 1.0), DVec3::new(0.3, 3.0, 1.0), DVec3::new(0.1, 0.2, 1.0)] {
        let mut board = Board { shadows: Some(ShadowSettings::texels(64)), ..Board::default() };
        for _ in 0..60 {
            board.hang(chalk(), card(1.0, DVec3::Z, DVec3::X, 1.0), DMat4::IDENTITY);
        }
        board.scene.lights = vec![Light::directional("sun", -toward.as_vec3(), PI as f32)];
        let seen = board.render_lit(&gpu, lighting(&gpu, &Environment::uniform(DVec3::ZERO)?, &shading)?, &shading)?;
        let cosine = toward.normalize().z;
        for (index, seen) in seen[..60].iter().enumerate() {
            assert!((seen.nits - cosine).abs().max_element() < 1e-3, "{toward} {index}: {} for {cosine}", seen.nits);
        }
    }
    Ok(())
}

/// Cascades in debug colors: each index has a color, and nothing beyond the last has one.
#[test]
fn each_cascade_has_its_color() -> TestResult {
    let Some(gpu) = gpu("each_cascade_has_its_color") else { return Ok(()) };
    let shading = Shading::default();
    let tints = [[1.0, 0.25, 0.25], [0.25, 1.0, 0.25], [0.25, 0.25, 1.0], [1.0, 1.0, 0.25], [1.0; 3]].map(DVec3::from);
    // The board is 5 m from the eye, between 2 and 9 m: about half of the range.
    let splits = [[0.8, 0.85, 0.9], [0.2, 0.8, 0.9], [0.1, 0.2, 0.8], [0.1, 0.2, 0.3], [0.1, 0.2, 0.3]];
    for (number, (tint, splits)) in tints.into_iter().zip(splits).enumerate() {
        let settings = ShadowSettings {
            cascades: 4,
            splits: Splits::At(splits),
            far_m: (number == 4).then_some(4.0),
            show_cascades: true,
            ..ShadowSettings::texels(64)
        };
        let mut board = Board { shadows: Some(settings), ..Board::default() };
        board.hang(chalk(), card(1.0, DVec3::Z, DVec3::X, 1.0), DMat4::IDENTITY);
        for z in [3.0, -4.0] {
            board.hang(chalk(), card(1.0, DVec3::Z, DVec3::X, 1.0), DMat4::from_translation(DVec3::Z * z));
        }
        board.scene.lights = vec![Light::directional("sun", Vec3::NEG_Z, PI as f32)];
        let seen = board.render_lit(&gpu, lighting(&gpu, &Environment::uniform(DVec3::ZERO)?, &shading)?, &shading)?;
        // Tolerance for half floats.
        assert!((seen[0].nits - tint).abs().max_element() < 2e-3, "cascade {number}: {} for {tint}", seen[0].nits);
    }
    Ok(())
}

/// A shadow's edge matches an independent implementation of the 3×3 tent: weights, texels and normal offset (one texel
/// along both axes of the map). Only the map's placement is taken from the view.
#[test]
fn edges_are_blurred_by_a_tent_of_three_texels() -> TestResult {
    let Some(gpu) = gpu("edges_are_blurred_by_a_tent_of_three_texels") else { return Ok(()) };
    const TEXELS: u32 = 64;
    let toward = DVec3::new(-0.9, 0.5, 1.0).normalize();
    let mut board = Board {
        shadows: Some(ShadowSettings { fit: Fit::Stable, ..ShadowSettings::texels(TEXELS) }),
        ..Board::default()
    };
    for _ in 0..79 {
        board.hang(chalk(), card(1.0, DVec3::Z, DVec3::X, 1.0), DMat4::IDENTITY);
    }
    // A square rotated onto its corner, too close to the eye to be visible; its shadow is in the center of the board.
    let caster = DMat4::from_translation(DVec3::new(-13.55, 3.75, 4.5)) * DMat4::from_quat(DQuat::from_rotation_z(0.6));
    board.hang(chalk(), card(3.0, DVec3::Z, DVec3::X, 1.0), caster);
    board.scene.lights = vec![Light::directional("sun", -toward.as_vec3(), PI as f32)];
    let shading = Shading::default();
    let dark = Environment::uniform(DVec3::ZERO)?;
    let lit = lighting(&gpu, &dark, &shading)?;
    let map = board.view(&lit)?.shadows.ok_or("a view with a map")?.maps[0].uniforms;
    let seen = board.render_lit(&gpu, lit, &shading)?;
    let clip_from_world = map.clip_from_world.as_dmat4();
    // Position in texels of the map, to the right and down.
    let texel_of = |world: DVec3| {
        let clip = clip_from_world.project_point3(world - board.camera_m());
        glam::DVec2::new(0.5 + 0.5 * clip.x, 0.5 - 0.5 * clip.y) * f64::from(TEXELS)
    };
    let caster_from_world = (DMat4::from_translation(board.middle(79)) * caster).inverse();
    // Along the light from the floor to the caster's plane; the map is seen from the sun, so any depth will do.
    let corners = [(-1.5, -1.5), (1.5, -1.5), (1.5, 1.5), (-1.5, 1.5)]
        .map(|(x, y)| texel_of(caster_from_world.inverse().transform_point3(DVec3::new(x, y, 0.0))));
    let covered = |at: glam::DVec2| {
        let sides = (0..4).map(|i| (corners[(i + 1) % 4] - corners[i]).perp_dot(at - corners[i]));
        let sides: Vec<f64> = sides.collect();
        sides.iter().all(|s| *s >= 0.0) || sides.iter().all(|s| *s <= 0.0)
    };
    let slope = f64::from(map.right.z.abs() + map.up.z.abs());
    let mut partly = 0;
    for (index, seen) in seen[..79].iter().enumerate() {
        let offset = DVec3::Z * slope;
        let at = texel_of(board.middle(index) + offset);
        let mut visible = 0.0;
        for row in -2..=2 {
            for column in -2..=2 {
                let texel = at.floor() + glam::DVec2::new(f64::from(column), f64::from(row)) + 0.5;
                let tent = (2.0 - (texel - at).abs()).max(glam::DVec2::ZERO) / 4.0;
                visible += if covered(texel) { 0.0 } else { tent.x * tent.y };
            }
        }
        partly += usize::from(visible > 0.05 && visible < 0.95);
        let expected = visible * toward.z;
        // Filters have 8-bit weights.
        let apart = (seen.nits - expected).abs().max_element();
        assert!(apart < 0.015, "{index}: {} for {expected}", seen.nits);
    }
    assert!(partly > 8, "only {partly} places lie at the edge");
    Ok(())
}
