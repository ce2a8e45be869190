//! Many lights: pictures with froxels equal pictures with a loop over all lights.

mod hard;

use crate::stage::gpu;
use framegraph_passes::gpu_scene::punctual::{Found, FroxelSettings, LightSearch};
use framegraph_passes::gpu_scene::shadow_views::ShadowSettings;
use framegraph_passes::{Precision, Settings, Shading};
use framegraph_scene::material::AlphaMode;
use framegraph_scene::{Camera, Light, Projection, Scene, progress};
use framegraph_wgpu::Gpu;
use glam::{DVec3, Vec3};
use std::error::Error;
use tests::measure::lights::Night;

type TestResult = Result<(), Box<dyn Error>>;

const FROXELS: LightSearch = LightSearch::Froxels(FroxelSettings::DEFAULT);
const PLAIN: Settings = Settings { shadows: None, ..Settings::DEFAULT };

fn punctual_lights(count: u32) -> Result<Scene, Box<dyn Error>> {
    Ok(Scene::open(&format!("lamps:{count}"), &mut progress::silent)?)
}

/// Returns the largest difference of a channel in 1/255 on a linear scale, and checks that some pixel is lit. Half
/// floats near 1 have eleven bits, which is finer.
fn apart(a: &[[f32; 4]], b: &[[f32; 4]]) -> f32 {
    assert_eq!(a.len(), b.len());
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    pairs.map(|(a, b)| 255.0 * (a - b).abs()).fold(0.0, f32::max)
}

fn brightest(picture: &[[f32; 4]]) -> f32 {
    picture.iter().flat_map(|texel| &texel[..3]).copied().fold(0.0, f32::max)
}

/// Draws both ways, and checks that lists exist. Sums in the same order are bit-exact, so one step is an ample
/// tolerance.
fn same(gpu: &Gpu, what: &str, mut night: Night) -> TestResult {
    let view = night.view(FROXELS);
    assert!(matches!(view.light_report.found, Found::ByFroxels { .. }), "{what}: {}", view.light_report);
    let by_froxels = night.shoot(gpu, view, 1)?.linear;
    let all = night.shoot(gpu, night.view(LightSearch::All), 1)?.linear;
    let largest = apart(&by_froxels, &all);
    assert!(largest <= 1.0, "{what}: {largest} codes apart");
    assert!(brightest(&all) > 0.01, "{what}: nothing is lit");
    Ok(())
}

/// Tested from the scene's cameras, from between the lights, and in orthographic projection. Also tested in odd sizes,
/// with four samples, in half floats, with shadows, and with blended surfaces.
#[test]
fn froxels_show_what_all_lights_show() -> TestResult {
    let Some(gpu) = gpu("froxels_show_what_all_lights_show") else { return Ok(()) };
    let scene = punctual_lights(200)?;
    let own = |index: usize| scene.cameras[index].clone();
    let look = |eye, at, projection| Camera::look_at(eye, at, DVec3::Y, projection);
    let lamp = scene.lights[0].position;
    let inside = look(lamp, lamp + DVec3::new(0.3, -0.4, -1.0), Projection::perspective(1.2, 0.05))?;
    let parallel = Projection::Orthographic { half_width_m: None, half_height_m: 8.0, near_m: -20.0, far_m: 60.0 };
    let above = look(DVec3::new(0.0, 5.0, -10.0), DVec3::new(0.0, 0.0, -14.0), parallel)?;
    let four = Settings { samples: 4, ..PLAIN };
    let half = Settings { shading: Shading { precision: Precision::Half, ..Shading::default() }, ..PLAIN };
    let shadows = ShadowSettings { cascades: 0, local_maps: 12, ..ShadowSettings::texels(256) };
    let shadowed = Settings { shadows: Some(shadows), ..PLAIN };
    for (what, camera, size, settings) in test_report::share([
        ("gate", own(0), [160, 90], PLAIN),
        ("ground", own(1), [161, 91], four),
        ("inside", inside, [96, 96], PLAIN),
        ("above", above, [120, 80], PLAIN),
        ("a column", own(1), [1, 777], PLAIN),
        ("a pixel", own(0), [1, 1], four),
        ("shadows", own(1), [96, 54], shadowed),
        ("half floats", own(1), [96, 54], half),
    ]) {
        if let Err(error) = settings.shading.precision.check(&gpu) {
            test_report::skip(&format!("lights, {what}"), &error.to_string());
            continue;
        }
        same(&gpu, what, Night::new(&gpu, scene.clone(), camera, size, settings)?)?;
    }
    let mut blended = scene.clone();
    for material in blended.materials.iter_mut().filter(|material| material.name == "stone") {
        material.alpha = AlphaMode::Blend;
        material.base_color.w = 0.5;
    }
    same(&gpu, "blended", Night::new(&gpu, blended, own(1), [96, 54], PLAIN)?)
}

/// Lights without a range are in no list but still light the scene; at 1000 km from the origin, nothing changes.
#[test]
fn endless_lights_and_far_places_are_lit() -> TestResult {
    let Some(gpu) = gpu("endless_lights_and_far_places_are_lit") else { return Ok(()) };
    let mut scene = punctual_lights(60)?;
    scene.lights.push(Light { color: Vec3::new(0.1, 0.2, 0.3), ..Light::directional("moon", Vec3::NEG_ONE, 2.0) });
    scene.lights.push(Light { color: Vec3::X, ..Light::directional("second", Vec3::new(1.0, -1.0, 0.0), 1.0) });
    let far = DVec3::new(1e6, -3e5, 7e5);
    let mut moved = scene.clone();
    moved.lights.iter_mut().for_each(|light| light.position += far);
    for instance in &mut moved.instances {
        instance.world_from_model.w_axis += far.extend(0.0);
        instance.bounds.min += far;
        instance.bounds.max += far;
    }
    let camera = scene.cameras[1].clone();
    let away = Camera { eye: camera.eye + far, ..camera.clone() };
    let mut here = Night::new(&gpu, scene, camera, [96, 54], PLAIN)?;
    let mut there = Night::new(&gpu, moved, away, [96, 54], PLAIN)?;
    let a = here.shoot(&gpu, here.view(FROXELS), 1)?.linear;
    let b = there.shoot(&gpu, there.view(FROXELS), 1)?.linear;
    // At 1000 km, f64 has steps of 0.1 nm; pixels at edges may change.
    let off = a.iter().zip(&b).filter(|(a, b)| apart(&[**a], &[**b]) > 1.0).count();
    assert!(off <= a.len() / 500, "{off} pixels of {}", a.len());
    same(&gpu, "endless", here)?;
    same(&gpu, "far", there)
}

/// Two views in one graph with different sizes, cameras and froxels have their own lists: each picture equals that of
/// the view alone, bit for bit. Negative control: a view that reads the other's lists.
#[test]
fn views_of_a_graph_have_lists_of_their_own() -> TestResult {
    let Some(gpu) = gpu("views_of_a_graph_have_lists_of_their_own") else { return Ok(()) };
    let scene = punctual_lights(200)?;
    let cameras = scene.cameras.clone();
    let mut night = Night::new(&gpu, scene, cameras[0].clone(), [96, 54], PLAIN)?;
    let finer = LightSearch::Froxels(FroxelSettings { tiles: 400, slices: 24, ..FroxelSettings::DEFAULT });
    let mut views = Vec::new();
    for (camera, size, search) in [(0, [96, 54], FROXELS), (1, [70, 70], finer)] {
        night.seen.camera = cameras[camera].clone();
        night.seen.size_px = size;
        views.push(night.view(search));
    }
    let counts = views.iter().map(|view| view.light_lists.as_ref().map(|lists| lists.uniforms.counts));
    let counts: Vec<_> = counts.collect();
    assert!(counts.iter().all(Option::is_some) && counts[0] != counts[1], "{counts:?}");
    let together = night.shoot_together(&gpu, views.clone())?;
    for (number, view) in views.iter().enumerate() {
        let alone = night.shoot_together(&gpu, vec![view.clone()])?;
        assert!(together[number] == alone[0], "view {number} differs: {} codes", apart(&together[number], &alone[0]));
        assert!(brightest(&alone[0]) > 0.01, "view {number}: nothing is lit");
    }
    let mut mixed = views;
    mixed[1].light_lists = mixed[0].light_lists.clone();
    let mixed = night.shoot_together(&gpu, mixed)?;
    assert!(mixed[0] == together[0] && apart(&mixed[1], &together[1]) > 1.0, "the lists of the other view");
    Ok(())
}

/// Negative controls: a light that is missing from the lists, and lists shifted by one froxel.
#[test]
fn a_light_that_is_missing_is_seen() -> TestResult {
    let Some(gpu) = gpu("a_light_that_is_missing_is_seen") else { return Ok(()) };
    let scene = punctual_lights(60)?;
    let camera = scene.cameras[1].clone();
    let mut night = Night::new(&gpu, scene, camera, [160, 90], PLAIN)?;
    let whole = night.shoot(&gpu, night.view(FROXELS), 1)?.linear;
    let mut shifted = night.view(FROXELS);
    let lists = shifted.light_lists.as_mut().ok_or("lists")?;
    let froxels = lists.uniforms.counts.iter().product::<u32>() as usize;
    lists.words[..=froxels].rotate_left(1);
    assert!(apart(&whole, &night.shoot(&gpu, shifted, 1)?.linear) > 1.0, "shifted lists");
    let mut missing = night.view(FROXELS);
    let lists = missing.light_lists.as_mut().ok_or("lists")?;
    let words = &mut lists.words[froxels + 1..];
    // The most frequent light in the lists is replaced by another one that adds nothing there.
    let most = (0..60).max_by_key(|light| words.iter().filter(|word| *word == light).count()).unwrap_or(0);
    words.iter_mut().filter(|word| **word == most).for_each(|word| *word = (most + 30) % 60);
    assert!(apart(&whole, &night.shoot(&gpu, missing, 1)?.linear) > 1.0, "light {most}");
    Ok(())
}
