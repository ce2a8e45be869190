//! Thin films: the model compared with Airy's sum over the spectrum, and pictures compared with the model.

use super::{TestResult, black, near};
use crate::stage::gpu;
use framegraph_passes::{Precision, Shading};
use framegraph_scene::material::{ClearCoat, Iridescence, Specular, Transmission, Volume};
use framegraph_scene::texture::{Filter, Sampler, TextureRole};
use framegraph_scene::{Environment, Light, Material};
use framegraph_shader_mirrors::thin_film::{film_sensitivity, thin_film_reflectance};
use glam::{DMat4, DVec3, Vec3};
use std::f64::consts::PI;
use tests::measure::board::{Board, card};
use tests::measure::cards::{Card, Wall};
use truth::albedo::ggx_of;
use truth::film;

const NOV: [f64; 4] = [0.15, 0.4, 0.7, 1.0];
const TOWARD: DVec3 = DVec3::new(0.36, 0.48, 0.8);

/// Returns the model's root mean square error over indices and thicknesses of films. `thicker` scales the model's
/// thickness.
fn model_error(f0s: &[f64], cosines: &[f64], thicker: f64) -> f64 {
    let (mut sum, mut count) = (0.0, 0);
    for f0 in f0s {
        for ior in [1.2, 1.33, 1.5, 1.8, 2.4] {
            for cosine in cosines {
                for step in 0..8 {
                    let thickness_nm = 100.0 + 110.0 * f64::from(step);
                    let truth = film::reflectance(*cosine, ior, thickness_nm, *f0);
                    let model = thin_film_reflectance(*cosine, ior, thickness_nm * thicker, DVec3::splat(*f0));
                    sum += (model - truth).length_squared() / 3.0;
                    count += 1;
                }
            }
        }
    }
    (sum / f64::from(count)).sqrt()
}

/// The model uses Schlick's curve instead of Fresnel's, two internal reflections, and Gaussians for color matching. Its
/// error is bounded within 26°, within 60° and beyond 72°, where Schlick's curve is inaccurate on both sides of the
/// film.
#[test]
fn the_model_is_near_airys_sum() {
    let (dielectrics, metals) = ([0.02, 0.04, 0.17], [0.5, 0.9]);
    let (steep, tilted, grazing) = ([1.0, 0.9], [0.7, 0.5], [0.3, 0.15]);
    for (f0s, cosines, most) in [
        (&dielectrics[..], steep, 0.012),
        (&dielectrics[..], tilted, 0.025),
        (&dielectrics[..], grazing, 0.09),
        (&metals[..], steep, 0.025),
        (&metals[..], tilted, 0.05),
        (&metals[..], grazing, 0.2),
    ] {
        let error = model_error(f0s, &cosines, 1.0);
        assert!(error < most, "{f0s:?} at {cosines:?}: {error:.4}");
    }
    // Negative control: films that are 15 % thicker.
    assert!(model_error(&dielectrics, &steep, 1.15) > 0.05);
    assert!(model_error(&metals, &tilted, 1.15) > 0.1);
}

/// Spectral waves for optical paths up to 2.6 µm, integrated with tabulated color matching functions and with their
/// Gaussian fits. The fits are off by at most a fifth of a wave's amplitude, in red.
#[test]
fn the_fits_of_the_eye_are_near_its_tables() {
    let mut worst = 0.0_f64;
    for step in 0..40 {
        let path_nm = 65.0 * f64::from(step);
        for turns in [0.0, 0.25, 0.5] {
            let truth = film::rec709(|wavelength_nm| (2.0 * PI * (path_nm / wavelength_nm + turns)).cos());
            worst = worst.max((film_sensitivity(path_nm, DVec3::splat(turns)) - truth).abs().max_element());
        }
    }
    assert!(worst < 0.2, "{worst}");
    let even = film_sensitivity(0.0, DVec3::ZERO) - film::rec709(|_| 1.0);
    assert!(even.abs().max_element() < 3e-3, "{even}");
}

fn film(ior: f32, thickness_nm: f32) -> Option<Iridescence> {
    Some(Iridescence { ior, max_thickness_nm: thickness_nm, ..Iridescence::default() })
}

/// Returns the model's reflectance of a film, with the shader's f32 parameters.
fn model(cosine: f64, ior: f32, thickness_nm: f32, f0: Vec3) -> DVec3 {
    thin_film_reflectance(cosine, ior.into(), thickness_nm.into(), f0.as_dvec3())
}

fn schlick(f0: DVec3, cosine: f64) -> DVec3 {
    f0 + (DVec3::ONE - f0) * (1.0 - cosine).powi(5)
}

fn cards(materials: &[Material]) -> Vec<Card> {
    materials.iter().flat_map(|material| NOV.map(|nov| Card { material: material.clone(), nov })).collect()
}

/// One light: GGX implemented independently, with the film's reflectance at v·h as the Fresnel term; diffuse gets the
/// rest.
#[test]
fn films_in_one_light_are_their_formula() -> TestResult {
    let Some(gpu) = gpu("films_in_one_light_are_their_formula") else { return Ok(()) };
    let copper = Vec3::new(0.95, 0.64, 0.54);
    let on = |iridescence, material: Material| Material { iridescence, ..material };
    let half = film(1.8, 420.0).map(|film| Iridescence { factor: 0.5, ..film });
    let white = Material::dielectric("white", Vec3::splat(0.8), 0.5);
    let weak = Some(Specular { factor: 0.25, ..Specular::default() });
    let materials = [
        on(film(1.8, 420.0), black(0.5)),
        on(film(1.3, 250.0), Material::metal("copper", copper, 0.5)),
        on(half, black(0.5)),
        on(film(2.2, 300.0), white.clone()),
        on(film(1.8, 0.0), white),
        Material { specular: weak, ..on(film(1.8, 420.0), black(0.5)) },
    ];
    let light = Light::directional("lamp", -TOWARD.as_vec3(), PI as f32);
    let wall = Wall { light: Some(light), cards: cards(&materials), ..Wall::default() };
    let shading = Shading { compensate_punctual: false, ..Shading::default() };
    let seen = wall.render(&gpu, &Environment::uniform(DVec3::ZERO)?, &shading)?;
    let view = DVec3::Z;
    let h = (TOWARD + view).normalize();
    let voh = view.dot(h);
    let glass = DVec3::splat(0.04);
    let (bright, hued) = (model(voh, 1.8, 420.0, Vec3::splat(0.04)), model(voh, 2.2, 300.0, Vec3::splat(0.04)));
    let expected = [
        (bright, 0.0),
        (model(voh, 1.3, 250.0, copper), 0.0),
        (0.5 * (bright + schlick(glass, voh)), 0.0),
        (hued, 0.8 * (1.0 - hued.max_element())),
        (schlick(glass, voh), 0.8),
        (bright * 0.25, 0.0),
    ];
    for (index, (card, seen)) in wall.cards.iter().zip(&seen).enumerate() {
        let (fresnel, diffuse) = expected[index / NOV.len()];
        let n = DVec3::new((1.0 - card.nov * card.nov).sqrt(), 0.0, card.nov);
        let (a2, nol, noh) = (0.0625, n.dot(TOWARD), n.dot(h));
        let d = a2 / (PI * (noh * noh * (a2 - 1.0) + 1.0).powi(2));
        let lambda = |c: f64| 0.5 * ((1.0 + a2 * (1.0 - c * c) / (c * c)).sqrt() - 1.0);
        let lobe = PI * d / (4.0 * card.nov * (1.0 + lambda(card.nov) + lambda(nol)));
        let name = format!("{} {} at {}", index / NOV.len(), card.material.name, card.nov);
        near(&name, seen, fresnel * lobe + DVec3::splat(diffuse * nol), 4e-3, 1e-4);
    }
    // Negative control: films differ from their base.
    assert!((seen[0].nits - seen[16].nits).abs().max_element() > 0.02);
    Ok(())
}

/// In uniform light, a smooth film reflects its reflectance at n·v, and a rough one the mean over its facets. The
/// shader approximates this mean by Schlick's curve through the reflectance at n·v.
#[test]
fn films_in_even_light_reflect_the_mean_of_their_facets() -> TestResult {
    let Some(gpu) = gpu("films_in_even_light_reflect_the_mean_of_their_facets") else { return Ok(()) };
    let (ior, thickness_nm, f0) = (1.8, 250.0, Vec3::splat(0.04));
    let on = |roughness| Material { iridescence: film(ior, thickness_nm), ..black(roughness) };
    let white = Material { iridescence: film(ior, thickness_nm), ..Material::dielectric("white", Vec3::ONE, 0.1) };
    let wall = Wall { cards: cards(&[on(0.1), on(0.5), on(0.8), white]), ..Wall::default() };
    let shading = Shading { compensate_image: false, ..Shading::default() };
    let seen = wall.render(&gpu, &Environment::uniform(DVec3::ONE)?, &shading)?;
    let mut worst = [0.0_f64; 3];
    for (index, nov) in NOV.into_iter().enumerate() {
        for (row, roughness) in [0.1, 0.5, 0.8].into_iter().enumerate() {
            let mean = |c: usize| ggx_of(nov, roughness, |voh| model(voh, ior, thickness_nm, f0)[c]);
            let truth = DVec3::new(mean(0), mean(1), mean(2));
            worst[row] = worst[row].max((seen[row * 4 + index].nits - truth).abs().max_element());
        }
        // Furnace: white under a film reflects no more than it receives, and no less than its darkest channel
        // transmits.
        let back = seen[12 + index].nits;
        assert!(back.max_element() < 1.01 && back.min_element() > 0.6, "white at {nov}: {back}");
    }
    // Half floats and the table; then the error of Schlick's curve over increasingly wide lobes.
    assert!(worst[0] < 2e-3 && worst[1] < 0.045 && worst[2] < 0.065, "{worst:?}");
    Ok(())
}

/// The film's share is in red, and its thickness between two limits in green of another texture.
#[test]
fn films_are_their_channels() -> TestResult {
    let Some(gpu) = gpu("films_are_their_channels") else { return Ok(()) };
    let mut board = Board::default();
    let nearest = Sampler { mag: Filter::Nearest, min: Filter::Nearest, mip: None, ..Sampler::default() };
    let share = board.texture(1, &[[153, 0, 255, 0]], TextureRole::Linear, nearest);
    let thickness = board.texture(1, &[[255, 102, 0, 255]], TextureRole::Linear, nearest);
    let plain = Iridescence { ior: 1.8, min_thickness_nm: 500.0, max_thickness_nm: 300.0, ..Iridescence::default() };
    let textured = Iridescence { texture: Some(share), ..plain };
    let thinned = Iridescence { thickness_texture: Some(thickness), ..plain };
    let normal = DVec3::new(0.6, 0.0, 0.8);
    let of = |share: f64, thickness_nm: f32| {
        let bare = schlick(DVec3::splat(0.04), 0.8);
        bare.lerp(model(0.8, 1.8, thickness_nm, Vec3::splat(0.04)), share)
    };
    // 500 and 300 nm, two fifths of the way.
    let cases = [
        ("factors", plain, of(1.0, 300.0)),
        ("share", textured, of(0.6, 300.0)),
        ("thickness", thinned, of(1.0, 420.0)),
        ("both", Iridescence { texture: Some(share), ..thinned }, of(0.6, 420.0)),
    ];
    for (_, film, _) in &cases {
        let leaning = card(1.0, normal, DVec3::new(0.8, 0.0, -0.6), 1.0);
        board.hang(Material { iridescence: Some(*film), ..black(0.05) }, leaning, DMat4::IDENTITY);
    }
    let seen = board.render(&gpu, &Environment::uniform(DVec3::ONE)?, &Shading::default())?;
    for ((name, _, expected), seen) in cases.into_iter().zip(&seen) {
        // The table of a smooth lobe, which gathers light around the mirror direction.
        near(name, seen, expected, 0.02, 2e-3);
    }
    Ok(())
}

/// Impossible films, seen from every angle under a light and in half floats, reflect between nothing and all of the
/// light.
#[test]
fn impossible_films_are_finite() -> TestResult {
    let Some(gpu) = gpu("impossible_films_are_finite") else { return Ok(()) };
    let mut materials = Vec::new();
    for ior in [1.0, 1.5, 1e6] {
        for thickness_nm in [0.0, 1e-3, 1e5, f32::MAX] {
            for base in [black(0.0), Material::metal("mirror", Vec3::ONE, 0.0)] {
                materials.push(Material { ior: 1.0, iridescence: film(ior, thickness_nm), ..base });
            }
        }
    }
    let coat = Some(ClearCoat { factor: 1.0, ..ClearCoat::default() });
    let none = Some(Specular { factor: 0.0, ..Specular::default() });
    let volume = Some(Volume { thickness: 1e30, ..Volume::default() });
    let glass = Some(Transmission { factor: 1.0, texture: None, volume });
    materials.push(Material { clear_coat: coat, iridescence: film(1.8, 300.0), ..black(0.2) });
    materials.push(Material { specular: none, iridescence: film(1.8, 300.0), ..black(0.2) });
    materials.push(Material {
        transmission: glass,
        dispersion: Some(f32::MAX),
        iridescence: film(1.8, 300.0),
        ..black(0.2)
    });
    let nov = [1e-4, 0.5, 1.0];
    let cards = materials.iter().flat_map(|material| nov.map(|nov| Card { material: material.clone(), nov })).collect();
    let light = Light::directional("lamp", -TOWARD.as_vec3(), PI as f32);
    let wall = Wall { light: Some(light), cards, ..Wall::default() };
    for precision in [Precision::Full, Precision::Half] {
        let shading = Shading { precision, ..Shading::default() };
        if shading.precision.check(&gpu).is_err() {
            continue;
        }
        let seen = wall.render(&gpu, &Environment::uniform(DVec3::ONE)?, &shading)?;
        for (card, seen) in wall.cards.iter().zip(&seen) {
            let film = &card.material.iridescence;
            assert!(seen.nits.is_finite() && seen.nits.min_element() >= 0.0, "{film:?} at {}: {}", card.nov, seen.nits);
        }
    }
    Ok(())
}
