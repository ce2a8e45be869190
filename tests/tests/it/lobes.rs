//! Material lobes and shading options in the standard frame, compared with their formulas.

use crate::stage::{Set, Shot, gpu, precisions};
use framegraph_passes::SettingsTable;
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::{PostSettings, Quality, Settings, Shading};
use framegraph_scene::material::{Anisotropy, ClearCoat, Sheen, Specular, Subsurface};
use framegraph_scene::texture::{Image, Sampler, TextureRole, TextureSlot, UvTransform};
use framegraph_scene::{Environment, Light, Material};
use framegraph_wgpu::Gpu;
use glam::{DVec3, Vec2, Vec3};
use std::error::Error;
use std::f64::consts::PI;
use tests::measure::cards::{Card, Wall};
use truth::albedo::cloth;

type TestResult = Result<(), Box<dyn Error>>;

const NOV: [f64; 4] = [0.15, 0.4, 0.7, 1.0];

fn black(roughness: f32) -> Material {
    Material::dielectric("black", Vec3::ZERO, roughness)
}

fn coat(factor: f32, roughness: f32) -> Option<ClearCoat> {
    Some(ClearCoat { factor, roughness, normal_scale: 1.0, ..ClearCoat::default() })
}

/// Creates a card of each material at each angle.
fn wall(materials: &[Material]) -> Wall {
    let card = |material: &Material| NOV.map(|nov| Card { material: material.clone(), nov });
    Wall { cards: materials.iter().flat_map(card).collect(), ..Wall::default() }
}

/// Returns each material's reflected radiance under a uniform nit, at each angle.
fn in_even_light(gpu: &Gpu, wall: &Wall, shading: &Shading) -> Result<Vec<Vec<f64>>, Box<dyn Error>> {
    let seen = wall.render(gpu, &Environment::uniform(DVec3::ONE)?, shading)?;
    Ok(seen[..wall.cards.len()].chunks(NOV.len()).map(|c| c.iter().map(|s| s.nits.x).collect()).collect())
}

/// Returns each material's reflected radiance under one light of π lux from (0.36, 0.48, 0.8), at each angle.
fn in_one_light(gpu: &Gpu, materials: &[Material], shading: &Shading) -> Result<Vec<Vec<f64>>, Box<dyn Error>> {
    let light = Light::directional("lamp", -TOWARD.as_vec3(), PI as f32);
    let wall = Wall { light: Some(light), ..wall(materials) };
    let seen = wall.render(gpu, &Environment::uniform(DVec3::ZERO)?, shading)?;
    Ok(seen[..wall.cards.len()].chunks(NOV.len()).map(|c| c.iter().map(|s| s.nits.x).collect()).collect())
}

const TOWARD: DVec3 = DVec3::new(0.36, 0.48, 0.8);

/// Returns normal, tangent and bitangent of a card; the viewer is at +z.
fn frame(nov: f64) -> [DVec3; 3] {
    let sin = (1.0 - nov * nov).sqrt();
    let (n, t) = (DVec3::new(sin, 0.0, nov), DVec3::new(nov, 0.0, -sin));
    [n, t, n.cross(t)]
}

fn schlick(f0: f64, cos: f64) -> f64 {
    f0 + (1.0 - f0) * (1.0 - cos).powi(5)
}

fn close(what: &str, got: &[f64], expected: impl Fn(f64) -> f64, relative: f64, absolute: f64) {
    for (got, nov) in got.iter().zip(NOV) {
        let expected = expected(nov);
        assert!((got - expected).abs() <= absolute + relative * expected, "{what} at {nov}: {got} for {expected}");
    }
}

/// Uniform light needs no integral. A coat reflects Schlick's share and transmits the rest, cloth reflects its albedo,
/// and KHR_materials_specular can disable reflection.
#[test]
fn lobes_in_even_light_reflect_what_they_must() -> TestResult {
    let Some(gpu) = gpu("lobes_in_even_light_reflect_what_they_must") else { return Ok(()) };
    let white = Material::metal("white", Vec3::ONE, 0.5);
    let materials = [
        // A base of index 1.5 under a coat of 1.5 has no interface, so only the coat reflects.
        Material { clear_coat: coat(1.0, 0.1), ..black(0.5) },
        Material { clear_coat: coat(0.5, 0.1), ..white.clone() },
        Material { clear_coat: coat(1.0, 0.1), ..white.clone() },
        Material {
            sheen: Some(Sheen { color: Vec3::splat(0.8), roughness: 0.6, ..Sheen::default() }),
            specular: Some(Specular { factor: 0.0, ..Specular::default() }),
            ..black(0.5)
        },
        Material { specular: Some(Specular { factor: 0.0, ..Specular::default() }), ..black(0.5) },
        Material { anisotropy: Some(Anisotropy { strength: 0.9, ..Anisotropy::default() }), ..white },
    ];
    let seen = in_even_light(&gpu, &wall(&materials), &Shading::default())?;
    // Half floats with an error of 0.05 %, tables of 64².
    let fresnel = |nov: f64| schlick(0.04, nov);
    close("a coat over nothing", &seen[0], fresnel, 2e-3, 1e-4);
    close("half a coat over white", &seen[1], |_| 1.0, 2e-3, 0.0);
    close("a coat over white", &seen[2], |_| 1.0, 2e-3, 0.0);
    close("sheen", &seen[3], |nov| 0.8 * cloth(nov, 0.6), 0.02, 2e-3);
    close("no reflection at all", &seen[4], |_| 0.0, 0.0, 1e-6);
    close("grooved white", &seen[5], |_| 1.0, 2e-3, 0.0);
    Ok(())
}

/// With the option, a base under a coat reflects as in air, minus the coat's share. Without it, a dielectric of the
/// coat's index reflects nothing.
#[test]
fn a_base_under_a_coat_keeps_its_reflectance_on_demand() -> TestResult {
    let Some(gpu) = gpu("a_base_under_a_coat_keeps_its_reflectance_on_demand") else { return Ok(()) };
    let gold = Material::metal("gold", Vec3::new(0.3, 0.6, 0.9), 0.4);
    let coated = |base: &Material| Material { clear_coat: coat(1.0, 0.1), ..base.clone() };
    let keeping = |base: &Material| Material {
        clear_coat: coat(1.0, 0.1).map(|coat| ClearCoat { keeps_base_f0: true, ..coat }),
        ..base.clone()
    };
    let [dark, gold_keeps] = [black(0.5), keeping(&gold)];
    let materials = [gold.clone(), coated(&gold), dark.clone(), coated(&dark), gold_keeps, keeping(&dark)];
    let kept = Shading { coat_ior_change: false, ..Shading::default() };
    let [kept, changed] = [kept, Shading::default()].map(|shading| in_even_light(&gpu, &wall(&materials), &shading));
    let (kept, changed) = (kept?, changed?);
    for (bare, under) in [(0, 1), (2, 3)] {
        for (index, nov) in NOV.into_iter().enumerate() {
            let fresnel = schlick(0.04, nov);
            let expected = fresnel + (1.0 - fresnel) * kept[bare][index];
            let found = kept[under][index];
            // Half floats with an error of 0.05 %, tables of 64².
            assert!((found - expected).abs() < 2e-3 * expected + 1e-4, "{under} at {nov}: {found} for {expected}");
            assert!(changed[under][index] < found - 1e-3, "{under} at {nov}: the coat lowers what the base reflects");
        }
    }
    assert_eq!(kept[0], changed[0], "without a coat nothing changes");
    // A material's own switch is that of the frame for it alone, to the bit.
    assert_eq!((&changed[4], &changed[5]), (&kept[1], &kept[3]));
    assert_eq!((&kept[4], &kept[5]), (&kept[1], &kept[3]), "both switches are one");
    Ok(())
}

/// One light: the lobes' formulas, implemented independently in f64.
#[test]
fn lobes_in_one_light_are_their_formulas() -> TestResult {
    let Some(gpu) = gpu("lobes_in_one_light_are_their_formulas") else { return Ok(()) };
    let none = Some(Specular { factor: 0.0, ..Specular::default() });
    let grooved = |strength: f32, rotation_rad: f32| Material {
        anisotropy: Some(Anisotropy { strength, rotation_rad, ..Anisotropy::default() }),
        ..Material::metal("brushed", Vec3::splat(0.5), 0.5)
    };
    let materials = [
        Material { clear_coat: coat(0.75, 0.3), specular: none, ..black(0.5) },
        Material {
            sheen: Some(Sheen { color: Vec3::splat(0.8), roughness: 0.6, ..Sheen::default() }),
            specular: none,
            ..black(0.5)
        },
        grooved(0.8, 0.0),
        grooved(0.8, 0.7),
        grooved(0.0, 0.0),
        Material::metal("plain", Vec3::splat(0.5), 0.5),
    ];
    let shading = Shading { compensate_punctual: false, ..Shading::default() };
    let seen = in_one_light(&gpu, &materials, &shading)?;
    let view = DVec3::Z;
    let h = (TOWARD + view).normalize();
    let loh = TOWARD.dot(h);
    let coat = |nov: f64| {
        let [n, ..] = frame(nov);
        let (a2, c) = (0.3_f64.powi(4), n.dot(h));
        let d = a2 / (PI * (c * c * (a2 - 1.0) + 1.0).powi(2));
        PI * 0.75 * schlick(0.04, loh) * d / (4.0 * loh * loh) * n.dot(TOWARD).max(0.0)
    };
    close("coat", &seen[0], coat, 3e-3, 1e-5);
    let sheen = |nov: f64| {
        let [n, ..] = frame(nov);
        let (inverse, l) = (1.0 / 0.36, n.dot(TOWARD));
        let sin = (1.0 - n.dot(h).powi(2)).max(1.0 / 128.0).sqrt();
        let d = (2.0 + inverse) * sin.powf(inverse) / (2.0 * PI);
        PI * 0.8 * d / (4.0 * (l + nov - l * nov)) * l
    };
    close("sheen", &seen[1], sheen, 3e-3, 1e-5);
    // Burley's distribution and Heitz's Λ, with the roughness of KHR_materials_anisotropy.
    let stretched = |strength: f64, turn: f64| {
        move |nov: f64| {
            let [n, t, b] = frame(nov);
            let (t, b) = (t * turn.cos() + b * turn.sin(), b * turn.cos() - t * turn.sin());
            let along = 0.25 + 0.75 * strength * strength;
            let slope = |w: DVec3| ((along * w.dot(t)).powi(2) + (0.25 * w.dot(b)).powi(2)) / w.dot(n).powi(2);
            let e = (h.dot(t) / along).powi(2) + (h.dot(b) / 0.25).powi(2) + h.dot(n).powi(2);
            let d = 1.0 / (PI * along * 0.25 * e * e);
            let lambda = |w: DVec3| 0.5 * ((1.0 + slope(w)).sqrt() - 1.0);
            let g = 1.0 / (1.0 + lambda(view) + lambda(TOWARD));
            PI * d * g / (4.0 * nov) * schlick(0.5, loh)
        }
    };
    close("grooves", &seen[2], stretched(0.8, 0.0), 3e-3, 1e-5);
    close("grooves turned", &seen[3], stretched(0.8, f64::from(0.7_f32)), 3e-3, 1e-5);
    close("grooves of no depth", &seen[4], stretched(0.0, 0.0), 3e-3, 1e-5);
    close("no grooves", &seen[5], stretched(0.0, 0.0), 3e-3, 1e-5);
    // Anisotropy of strength zero is compensated by the same factor as no anisotropy.
    let whole = in_one_light(&gpu, &materials[4..], &Shading { compensate_punctual: true, ..shading })?;
    for (of, (grooved, plain)) in whole[0].iter().zip(&whole[1]).enumerate() {
        assert!(*plain > 1.02 * seen[5][of] && (grooved / plain - 1.0).abs() < 5e-3, "{grooved} for {plain}");
    }
    // Negative control: rotated and unrotated anisotropy differ by more than the tolerance.
    assert!(seen[2].iter().zip(&seen[3]).any(|(a, b)| (a / b - 1.0).abs() > 0.05));
    Ok(())
}

/// Filament's subsurface and cloth models, written out again: under a light before the surface, one behind it and even light, in
/// both precisions.
#[test]
fn light_is_scattered_below_surfaces_as_in_filament() -> TestResult {
    let name = "light_is_scattered_below_surfaces_as_in_filament";
    let Some(gpu) = gpu(name) else { return Ok(()) };
    let none = Some(Specular { factor: 0.0, ..Specular::default() });
    let (color, power, thickness, tint) = (0.75, 3.0, 0.25, 0.3);
    let below = Subsurface { color: Vec3::splat(color as f32), power: power as f32, thickness: thickness as f32 };
    let chalk = Material { specular: none, ..Material::dielectric("chalk", Vec3::splat(0.5), 0.5) };
    let materials = [
        Material { subsurface: Some(below), specular: none, ..black(0.5) },
        Material { cloth_subsurface: Some(Vec3::splat(tint as f32)), ..chalk.clone() },
        chalk,
    ];
    let unit = |x: f64| x.clamp(0.0, 1.0);
    let wrapped = |cos: f64| unit((cos + 0.5) / 2.25) * unit(tint + unit(cos));
    for precision in precisions(name, &gpu) {
        let shading = Shading { precision, ..Shading::default() };
        for toward in [TOWARD, TOWARD * DVec3::new(1.0, 1.0, -1.0)] {
            let light = Some(Light::directional("lamp", -toward.as_vec3(), PI as f32));
            let wall = Wall { light, ..wall(&materials) };
            let seen = wall.render(&gpu, &Environment::uniform(DVec3::ZERO)?, &shading)?;
            let seen: Vec<f64> = seen.iter().map(|seen| seen.nits.x).collect();
            let nol = |nov: f64| frame(nov)[0].dot(toward);
            let scattered = |nov: f64| {
                let forward = ((unit(-toward.z) - 1.0) * power).exp2();
                let back = 0.5 * unit(unit(nol(nov)) * thickness + 1.0 - thickness);
                color * (back + (1.0 - back) * forward) * (1.0 - thickness)
            };
            // Half floats round normals near the terminator.
            close("subsurface", &seen[..4], scattered, 4e-3, 5e-4);
            close("cloth", &seen[4..8], |nov| 0.5 * wrapped(nol(nov)), 4e-3, 5e-4);
            close("chalk", &seen[8..12], |nov| 0.5 * unit(nol(nov)), 4e-3, 5e-4);
        }
        let even = in_even_light(&gpu, &wall(&materials), &shading)?;
        close("subsurface", &even[0], |_| color * (1.0 - thickness) / PI, 4e-3, 0.0);
        close("cloth", &even[1], |nov| 0.5 * wrapped(nov), 4e-3, 0.0);
    }
    Ok(())
}

/// Ambient occlusion of 0.5: unchanged at low quality, with interreflections at high quality; specular occlusion in
/// both.
#[test]
fn occlusion_is_as_the_quality_has_it() -> TestResult {
    let Some(gpu) = gpu("occlusion_is_as_the_quality_has_it") else { return Ok(()) };
    let mut scene = framegraph_scene::Scene::default();
    let half = Image::from_rgba8("half", 1, 1, vec![128, 128, 128, 255]);
    let texture = scene.add_texture(half, TextureRole::Linear, Sampler::default());
    let slot =
        Some(TextureSlot { texture, uv_set: 0, transform: UvTransform { scale: Vec2::ONE, ..Default::default() } });
    let chalk = Material {
        specular: Some(Specular { factor: 0.0, ..Specular::default() }),
        occlusion_texture: slot,
        ..Material::dielectric("chalk", Vec3::splat(0.8), 1.0)
    };
    let mirror = Material { occlusion_texture: slot, ..Material::metal("mirror", Vec3::ONE, 0.8) };
    let wall = Wall { scene, ..wall(&[chalk, mirror]) };
    let open = 128.0 / 255.0;
    let low = in_even_light(&gpu, &wall, &Quality::Low.shading())?;
    close("chalk, low", &low[0], |_| 0.8 * open, 2e-3, 0.0);
    let lagarde = |nov: f64| ((nov + open).powf((-16.0 * 0.64_f64 - 1.0).exp2()) - 1.0 + open).clamp(0.0, 1.0);
    close("mirror, low", &low[1], lagarde, 3e-3, 0.0);
    let bounced = |albedo: f64, v: f64| {
        let (a, b, c) = (2.0404 * albedo - 0.3324, 0.6417 - 4.7951 * albedo, 2.7552 * albedo + 0.6903);
        v.max(((v * a + b) * v + c) * v).min(1.0)
    };
    let high = in_even_light(&gpu, &wall, &Quality::High.shading())?;
    close("chalk, high", &high[0], |_| 0.8 * bounced(0.8, open), 2e-3, 0.0);
    close("mirror, high", &high[1], |nov| bounced(1.0, lagarde(nov)), 3e-3, 0.0);
    Ok(())
}

/// Each shading option changes the cards that it applies to, and no bit of the others.
#[test]
fn every_choice_of_shading_shows() -> TestResult {
    let Some(gpu) = gpu("every_choice_of_shading_shows") else { return Ok(()) };
    let mut scene = framegraph_scene::Scene::default();
    let half = Image::from_rgba8("half", 1, 1, vec![128, 128, 128, 255]);
    let texture = scene.add_texture(half, TextureRole::Linear, Sampler::default());
    let slot = Some(TextureSlot { texture, uv_set: 0, transform: UvTransform::default() });
    let materials = [
        Material::metal("rough", Vec3::splat(0.9), 0.7),
        Material::metal("smooth", Vec3::splat(0.9), 0.0),
        // An f0 of 0.002, below that of any solid.
        Material { ior: 1.1, ..black(0.3) },
        Material { occlusion_texture: slot, ..Material::dielectric("chalk", Vec3::splat(0.8), 0.9) },
        Material { clear_coat: coat(1.0, 0.1), ..Material::metal("coated", Vec3::new(0.3, 0.6, 0.9), 0.4) },
        Material { unlit: true, ..Material::dielectric("unlit", Vec3::splat(0.5), 1.0) },
    ];
    let light = Light::directional("lamp", -TOWARD.as_vec3(), 2.0);
    let wall = Wall { scene, light: Some(light), ..wall(&materials) };
    let sky = framegraph_scene::environment::Sky::default().environment(64)?;
    let sky = Environment { map: dimmed(&sky.map), sun: None, ..sky };
    let seen = |shading: &Shading| -> Result<Vec<DVec3>, Box<dyn Error>> {
        let seen = wall.render(&gpu, &sky, shading)?;
        Ok(seen.iter().map(|s| s.nits).collect())
    };
    let base = Quality::High.shading();
    let before = seen(&base)?;
    assert_eq!(seen(&base)?, before, "the same twice");
    let unlit = materials.len() * NOV.len() - NOV.len()..;
    for (key, value) in test_report::share([
        ("visibility", "fast"),
        ("table", "fast"),
        ("floor", "0.3"),
        ("f90-fades", "off"),
        ("compensation", "punctual"),
        ("compensation", "image"),
        ("bands", "2"),
        ("bands", "5"),
        ("multi-bounce", "off"),
        ("specular-occlusion", "off"),
        ("micro-shadows", "off"),
        ("fast-coat", "on"),
        ("coat-ior-change", "off"),
    ]) {
        let mut shading = base;
        shading.set(key, value)?;
        let after = seen(&shading)?;
        let changed = after.iter().zip(&before).filter(|(a, b)| a != b).count();
        assert!(changed > 0, "{key}={value} changes nothing");
        assert_eq!(after[unlit.clone()], before[unlit.clone()], "{key}={value} changes what is not lit");
    }
    Ok(())
}

/// Specular anti-aliasing widens highlights on curved surfaces, and changes no bit of flat ones.
#[test]
fn highlights_are_widened_where_normals_turn() -> TestResult {
    let Some(gpu) = gpu("highlights_are_widened_where_normals_turn") else { return Ok(()) };
    let on = Quality::High.shading();
    let off = Shading { specular_aa: None, ..on };
    let post = PostSettings { dither: 0.0, ..PostSettings::DEFAULT };
    // So dark that only the sun's reflections in smooth spheres remain.
    let dark =
        |shading| Shot { ev100: 20.0, ..Shot::small(Settings { shading, fxaa: false, post, ..Settings::default() }) };
    let set = Set::new(&gpu, "spheres", &dark(off), &Background::None)?;
    let lit = |shading| -> Result<usize, Box<dyn Error>> {
        let (picture, _) = set.shoot(&gpu, &dark(shading))?;
        Ok(picture.chunks_exact(4).filter(|t| t[0] > 16).count())
    };
    let [wide, narrow] = [lit(on)?, lit(off)?];
    // At least a fifth more pixels. A filter that widens everything would fill the spheres, a fifth of the picture.
    assert!(narrow > 0 && wide * 5 > narrow * 6 && wide < 160 * 90 / 5, "highlights of {wide} pixels for {narrow}");
    let flat = wall(&[Material::metal("smooth", Vec3::splat(0.9), 0.1), black(0.3)]);
    assert_eq!(in_even_light(&gpu, &flat, &on)?, in_even_light(&gpu, &flat, &off)?);
    Ok(())
}

/// Scales the clear sky's map to a brightness near 1.
fn dimmed(map: &framegraph_scene::environment::EquirectMap) -> framegraph_scene::environment::EquirectMap {
    let texels = map.texels().iter().map(|[r, g, b, a]| [r / 8000.0, g / 8000.0, b / 8000.0, *a]).collect();
    framegraph_scene::environment::EquirectMap::new(map.width(), map.height(), texels)
}
