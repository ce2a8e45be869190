//! Material inputs of glTF: factors, channels, texture coordinates and units, compared with known results.
//!
//! Each texture has its texel at its own position, set of coordinates and transform, and the inverted texel everywhere
//! else. A wrong lookup therefore gives another value.

mod lobes;

use crate::stage::{Set, Shot, gpu, lighting};
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::{Quality, Settings, Shading};
use framegraph_scene::material::{AlphaMode, EmissiveUnit};
use framegraph_scene::texture::{Filter, Sampler, TextureRole, TextureSlot, UvTransform};
use framegraph_scene::{Environment, Material, Mesh, Specular};
use framegraph_wgpu::Gpu;
use glam::{DMat4, DVec3, Vec2, Vec3, Vec4};
use std::error::Error;
use tests::measure::board::{Board, EXPOSURE, card, punctual_lights};
use truth::surface::Surface;

type TestResult = Result<(), Box<dyn Error>>;

/// Unit vectors toward the red, the green and the blue light.
const TOWARD: [DVec3; 3] = [DVec3::new(0.6, 0.0, 0.8), DVec3::new(0.0, 0.6, 0.8), DVec3::new(-0.36, -0.48, 0.8)];
/// Shading normal and tangent of every card.
const NORMAL: DVec3 = DVec3::new(0.36, -0.48, 0.8);
const TANGENT: DVec3 = DVec3::new(0.8, 0.6, 0.0);
/// A different value in each channel: 0.2, 0.4, 0.6, 0.8.
const TEXEL: [u8; 4] = [51, 102, 153, 204];

/// Positions along a texture.
const PLACES: usize = 16;

/// Returns the card: its first coordinates are at position 0, its second at position 8.
fn mesh() -> Mesh {
    let at = |place: f32| vec![Vec2::new((place + 0.5) / PLACES as f32, 0.5); 4];
    Mesh { uv0: at(0.0), uv1: at(8.0), ..card(0.9, NORMAL, TANGENT, 1.0) }
}

/// Adds a texture with `texel` at one position only.
fn shown(board: &mut Board, place: usize, role: TextureRole, texel: [u8; 4]) -> Option<TextureSlot> {
    let nearest = Sampler { mag: Filter::Nearest, min: Filter::Nearest, mip: None, ..Sampler::default() };
    let mut texels = [texel.map(|c| 255 - c); PLACES];
    texels[place] = texel;
    let slot = board.texture(PLACES as u32, &texels, role, nearest);
    let uv_set = place as u32 % 2;
    let from = if uv_set == 0 { 0.0 } else { 8.0 };
    let offset = Vec2::new((place as f32 - from) / PLACES as f32, 0.0);
    Some(TextureSlot { uv_set, transform: UvTransform { offset, ..UvTransform::default() }, ..slot })
}

/// Decodes sRGB by IEC 61966-2-1.
fn linear(code: u8) -> f64 {
    let c = f64::from(code) / 255.0;
    if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

fn linear_color(texel: [u8; 4]) -> DVec3 {
    DVec3::new(linear(texel[0]), linear(texel[1]), linear(texel[2]))
}

/// Returns the radiance under the three lights.
fn under_lights(surface: &Surface) -> DVec3 {
    let [r, g, b] = TOWARD.map(|toward| surface.per_light(DVec3::Z, toward));
    DVec3::new(r.x, g.y, b.z)
}

/// Relative error of two roundings to half floats.
const HALF_FLOATS: f64 = 3e-3;
/// Relative error of the driver's sRGB decoding: Vulkan allows half an 8-bit step, and lavapipe uses a polynomial.
const DECODED: f64 = 1e-2;

/// Renders cards of `materials` and compares each with its expected radiance, within a relative error.
fn compare(
    gpu: &Gpu,
    mut board: Board,
    environment: &Environment,
    shading: &Shading,
    within: f64,
    cases: Vec<(&str, Material, DVec3)>,
) -> TestResult {
    for (_, material, _) in &cases {
        board.hang(material.clone(), mesh(), DMat4::IDENTITY);
    }
    let seen = board.render_lit(gpu, lighting(gpu, environment, shading)?, shading)?;
    for ((name, _, expected), seen) in cases.iter().zip(&seen) {
        let apart = ((seen.nits - expected) / expected.max(DVec3::splat(0.05))).abs().max_element();
        assert!(apart < within, "{name}: {} for {expected}", seen.nits);
    }
    Ok(())
}

fn lit() -> Board {
    let mut board = Board::default();
    board.scene.lights = punctual_lights(TOWARD);
    board
}

fn no_specular() -> Option<Specular> {
    Some(Specular { factor: 0.0, ..Specular::default() })
}

/// Unlit and emissive colors, in display units or in nits, are displayed unchanged.
#[test]
fn colors_and_emission_are_factor_times_texture() -> TestResult {
    let Some(gpu) = gpu("colors_and_emission_are_factor_times_texture") else { return Ok(()) };
    let mut board = Board::default();
    let base = shown(&mut board, 3, TextureRole::Color, TEXEL);
    let glow = shown(&mut board, 6, TextureRole::Color, TEXEL);
    let factor = Vec3::new(0.9, 0.5, 0.7);
    let color = factor.as_dvec3() * linear_color(TEXEL);
    let unlit =
        Material { base_color: factor.extend(1.0), base_color_texture: base, unlit: true, ..Material::default() };
    let glowing = |emissive_unit| Material {
        emissive: factor * 3.0,
        emissive_texture: glow,
        emissive_unit,
        specular: no_specular(),
        ..Material::dielectric("glow", Vec3::ZERO, 1.0)
    };
    let dark = Environment::uniform(DVec3::ZERO)?;
    let cases = vec![
        ("unlit", unlit.clone(), color / EXPOSURE),
        ("unlit, factor alone", Material { base_color_texture: None, ..unlit }, factor.as_dvec3() / EXPOSURE),
        ("display", glowing(EmissiveUnit::Display), 3.0 * color / EXPOSURE),
        ("nits", glowing(EmissiveUnit::Nits), 3.0 * color),
        (
            "nits, factor alone",
            Material { emissive_texture: None, ..glowing(EmissiveUnit::Nits) },
            3.0 * factor.as_dvec3(),
        ),
    ];
    compare(&gpu, board, &dark, &Shading::default(), DECODED, cases)
}

/// Vertex colors multiply the base color; alpha in mode BLEND is the coverage.
#[test]
fn vertex_colors_and_alpha_multiply() -> TestResult {
    let Some(gpu) = gpu("vertex_colors_and_alpha_multiply") else { return Ok(()) };
    let mut board = Board::default();
    let base = shown(&mut board, 5, TextureRole::Color, TEXEL);
    let colors = Vec4::new(0.5, 1.5, 0.25, 0.625);
    let mesh = Mesh { colors: vec![colors; 4], ..mesh() };
    let unlit = |alpha: AlphaMode| Material {
        base_color: Vec4::new(0.9, 0.5, 0.7, 0.75),
        base_color_texture: base,
        unlit: true,
        alpha,
        ..Material::default()
    };
    let color = DVec3::new(0.9 * 0.5, 0.5 * 1.5, 0.7 * 0.25) * linear_color(TEXEL) / EXPOSURE;
    // Alpha: factor, vertex, texture (0.8, not decoded).
    let alpha = 0.75 * 0.625 * 0.8;
    let behind = DVec3::new(1.0, 0.5, 0.25);
    let cases = [
        ("opaque", AlphaMode::Opaque, color),
        ("blended", AlphaMode::Blend, color * alpha + behind * (1.0 - alpha)),
        ("kept by its mask", AlphaMode::Mask { cutoff: alpha as f32 - 0.01 }, color),
        ("cut out by its mask", AlphaMode::Mask { cutoff: alpha as f32 + 0.01 }, behind),
    ];
    for (_, alpha, _) in &cases {
        board.hang(unlit(*alpha), mesh.clone(), DMat4::IDENTITY);
    }
    let seen = board.render(&gpu, &Environment::uniform(behind)?, &Shading::default())?;
    for ((name, _, expected), seen) in cases.iter().zip(&seen) {
        assert!((seen.nits - expected).abs().max_element() < 2e-3, "{name}: {} for {expected}", seen.nits);
    }
    Ok(())
}

/// Roughness is in green, metalness in blue; f0 follows from the index of refraction.
#[test]
fn metalness_and_roughness_are_their_channels() -> TestResult {
    let Some(gpu) = gpu("metalness_and_roughness_are_their_channels") else { return Ok(()) };
    let mut board = lit();
    let texture = shown(&mut board, 9, TextureRole::Linear, TEXEL);
    let base = Vec3::new(0.9, 0.5, 0.3);
    let factors = Material { metallic: 0.9, ..Material::dielectric("both", base, 0.8) };
    let surface = |metallic, roughness, f0| Surface::metal_rough(base.as_dvec3(), metallic, roughness, f0, NORMAL);
    let cases = vec![
        ("factors", factors.clone(), under_lights(&surface(0.9, 0.8, 0.04))),
        (
            "factors times texture",
            Material { metallic_roughness_texture: texture, ..factors.clone() },
            under_lights(&surface(0.9 * 0.6, 0.8 * 0.4, 0.04)),
        ),
        (
            "diamond",
            Material { ior: 2.4, metallic: 0.0, roughness: 0.3, ..factors },
            under_lights(&surface(0.0, 0.3, (1.4_f64 / 3.4).powi(2))),
        ),
    ];
    let shading = Shading { compensate_punctual: false, ..Shading::default() };
    compare(&gpu, board, &Environment::uniform(DVec3::ZERO)?, &shading, HALF_FLOATS, cases)
}

/// Occlusion is in red, and its strength applies to image-based light but not to punctual lights. For the sun, the
/// brightest or last of several directional lights, it adds micro-shadowing. The formula is the square of n·l over the
/// sine of the open cone (Chan, "Material Advances in Call of Duty: WWII", 2018).
#[test]
fn occlusion_is_its_channel_by_its_strength() -> TestResult {
    let Some(gpu) = gpu("occlusion_is_its_channel_by_its_strength") else { return Ok(()) };
    let mut board = Board::default();
    let texture = shown(&mut board, 4, TextureRole::Linear, TEXEL);
    let others = [11, 0].map(|place| shown(&mut board, place, TextureRole::Linear, TEXEL));
    let albedo = Vec3::new(0.8, 0.4, 0.2);
    let chalk = |strength: f32| Material {
        occlusion_texture: texture,
        occlusion_strength: strength,
        specular: no_specular(),
        ..Material::dielectric("chalk", albedo, 1.0)
    };
    let light = DVec3::new(1.0, 0.5, 0.25);
    let open = |strength: f64| albedo.as_dvec3() * light * (1.0 + strength * (0.2 - 1.0));
    let mut cases = [1.0, 0.5, 0.0].map(|strength| ("occluded", chalk(strength as f32), open(strength))).to_vec();
    // One texture at one position, and at two.
    let rough = |texture| Material { metallic_roughness_texture: texture, ..chalk(1.0) };
    cases.extend([("packed", rough(texture), open(1.0)), ("apart", rough(others[0]), open(1.0))]);
    // Untransformed first coordinates, alone and packed.
    let plain = |texture| Material { occlusion_texture: others[1], metallic_roughness_texture: texture, ..chalk(1.0) };
    cases.extend([None, others[1]].map(|texture| ("plain", plain(texture), open(1.0))));
    compare(&gpu, board, &Environment::uniform(light)?, &Quality::Low.shading(), HALF_FLOATS, cases)?;
    let mut board = lit();
    let _ = shown(&mut board, 4, TextureRole::Linear, TEXEL);
    let hidden = (NORMAL.dot(TOWARD[2]) / (1.0_f64 - 0.2).sqrt()).min(1.0).powi(2);
    let expected = under_lights(&Surface::chalk(albedo.as_dvec3(), NORMAL)) * DVec3::new(1.0, 1.0, hidden);
    let lamp = vec![("by a lamp", chalk(1.0), expected)];
    compare(&gpu, board, &Environment::uniform(DVec3::ZERO)?, &Quality::Low.shading(), HALF_FLOATS, lamp)
}

/// Without a shadow map, with inlined post-processing. Mesa 22.3's software driver crashed on a branch that depended on
/// both the texture's strength and a texel.
#[test]
fn occlusion_shows_where_nothing_casts_shadows() -> TestResult {
    let Some(gpu) = gpu("occlusion_shows_where_nothing_casts_shadows") else { return Ok(()) };
    let shot = Shot::small(Settings { shadows: None, ..Settings::DEFAULT });
    let picture = |strength: f32| -> Result<Vec<u8>, Box<dyn Error>> {
        let mut board = Board::default();
        let occlusion_texture = shown(&mut board, 4, TextureRole::Linear, TEXEL);
        let chalk = Material::dielectric("chalk", Vec3::splat(0.5), 1.0);
        let id = board.scene.add_material(Material { occlusion_texture, occlusion_strength: strength, ..chalk });
        let card = board.scene.add_mesh(mesh());
        board.scene.add_instance("card", card, id, DMat4::IDENTITY);
        Ok(Set::of(&gpu, board.scene, &shot, &Background::Environment)?.shoot(&gpu, &shot)?.0)
    };
    let [open, occluded] = [picture(0.0)?, picture(1.0)?];
    let darker = open.iter().zip(&occluded).filter(|(open, occluded)| occluded < open).count();
    assert!(darker > 300, "{darker} channels are darker");
    Ok(())
}
