//! Cached shadow maps: number of rendered maps, and equality with new maps.

use crate::stage::gpu;
use framegraph_passes::effects::shadow::{KeptShadows, Redraw};
use framegraph_passes::gpu_scene::shadow_views::{Fit, MomentSettings, ShadowFilter, ShadowSettings};
use framegraph_passes::{LightSearch, Settings};
use framegraph_scene::{Light, Scene, progress};
use framegraph_wgpu::Gpu;
use glam::{DVec3, Vec3};
use std::collections::BTreeSet;
use std::error::Error;
use tests::measure::lights::Night;

type TestResult = Result<(), Box<dyn Error>>;

/// Creates two lights with six maps each and a spot light with one, above a block, and a moon if there are cascades.
fn night(gpu: &Gpu, shadows: ShadowSettings) -> Result<Night, Box<dyn Error>> {
    let mut scene = Scene::open("lamps:3", &mut progress::silent)?;
    // Close together, so that all are visible and cast shadows.
    for (light, x) in scene.lights.iter_mut().zip([-1.5, 1.5, 0.0]) {
        light.position = DVec3::new(x, 1.2, -3.0);
    }
    let block = scene.instances.iter().position(|instance| instance.name == "block").ok_or("a block")?;
    let at = scene.instances[block].bounds.center();
    shift(&mut scene, block, DVec3::new(0.0, at.y, -3.0) - at);
    if shadows.cascades > 0 {
        scene.lights.push(Light { color: Vec3::new(0.2, 0.3, 0.5), ..Light::directional("moon", Vec3::NEG_ONE, 3.0) });
    }
    let camera = scene.cameras[1].clone();
    Night::new(gpu, scene, camera, [128, 72], Settings { shadows: Some(shadows), ..Settings::DEFAULT })
}

fn shift(scene: &mut Scene, instance: usize, by: DVec3) {
    let moved = &mut scene.instances[instance];
    moved.world_from_model.w_axis += by.extend(0.0);
    moved.bounds.min += by;
    moved.bounds.max += by;
}

/// Returns the number of pixels with a channel that differs by more than 1/255 on a linear scale.
fn off(a: &[[f32; 4]], b: &[[f32; 4]]) -> usize {
    let differs = |(a, b): &(&[f32; 4], &[f32; 4])| a.iter().zip(*b).any(|(a, b)| (a - b).abs() > 1.0 / 255.0);
    a.iter().zip(b).filter(differs).count()
}

/// Thirteen maps of 64 texels, four per layer.
const LOCAL: ShadowSettings =
    ShadowSettings { cascades: 0, local_maps: 13, local_layers: 4, ..ShadowSettings::texels(128) };

/// The second frame of a still scene draws no map, also after camera motion. A moving object redraws the maps that see
/// it.
#[test]
fn still_maps_are_drawn_once() -> TestResult {
    let Some(gpu) = gpu("still_maps_are_drawn_once") else { return Ok(()) };
    let moments = MomentSettings { blur_texels: 3.0, levels: 3, ..LOCAL.moments };
    let blurred = ShadowSettings { filter: ShadowFilter::Vsm, moments, ..LOCAL };
    let averaged = ShadowSettings { moments: MomentSettings { samples: 4, ..moments }, ..blurred };
    [LOCAL, blurred, averaged].into_iter().try_for_each(|shadows| drawn_once(&gpu, shadows))
}

fn drawn_once(gpu: &Gpu, shadows: ShadowSettings) -> TestResult {
    let (mut night, mut kept) = (night(gpu, shadows)?, KeptShadows::default());
    let search = LightSearch::default();
    let shoot = |night: &mut Night, kept: &mut KeptShadows| -> Result<(usize, usize), Box<dyn Error>> {
        let own = night.shoot_keeping(gpu, night.view(search), kept)?;
        let anew = night.shoot(gpu, night.view(search), 1)?;
        assert_eq!(anew.layers, 4);
        Ok((own.layers, off(&own.linear, &anew.linear)))
    };
    let fitted = |night: &Night| night.view(search).shadows.ok_or("shadows");
    assert_eq!(kept.due(&fitted(&night)?), (0..13).map(|map| (map, Redraw::First)).collect::<Vec<_>>());
    assert_eq!(shoot(&mut night, &mut kept)?, (4, 0), "the first frame: {shadows:?}");
    assert_eq!(shoot(&mut night, &mut kept)?, (0, 0), "a still frame");
    // Positions are rounded relative to another eye, so a texel at an edge may change.
    night.seen.camera.eye += DVec3::new(0.05, 0.02, 0.03);
    let (layers, differ) = shoot(&mut night, &mut kept)?;
    assert!(layers == 0 && differ <= 4, "a camera that moves: {layers} layers, {differ} pixels");

    let block = night.scene.instances.iter().position(|instance| instance.name == "block").ok_or("a block")?;
    shift(&mut night.scene, block, DVec3::new(0.3, 0.0, 0.2));
    let due = kept.due(&fitted(&night)?);
    assert!(due.iter().all(|(_, why)| *why == Redraw::Casters) && (2..13).contains(&due.len()), "{due:?}");
    let maps = &fitted(&night)?.maps;
    let drawn: BTreeSet<u16> = due.iter().map(|(map, _)| maps[usize::from(*map)].place.layer).collect();
    let (layers, differ) = shoot(&mut night, &mut kept)?;
    assert!(layers == drawn.len() && differ <= 4, "a block that moves: {layers} layers, {differ} pixels");

    // Moving a light may change the order of importance and thus the layout; maps of the other layout stay cached.
    night.scene.lights[2].position.y += 0.2;
    let due = kept.due(&fitted(&night)?);
    assert!(due.len() == 1 && due[0].1 == Redraw::Light, "{due:?}");
    let (layers, differ) = shoot(&mut night, &mut kept)?;
    assert!(layers == 1 && differ <= 4, "a lamp that moves: {layers} layers, {differ} pixels");
    Ok(())
}

/// The comparison detects a map that should have been redrawn. A frame that was declared but not executed is drawn
/// again.
#[test]
fn a_stale_map_is_seen() -> TestResult {
    let Some(gpu) = gpu("a_stale_map_is_seen") else { return Ok(()) };
    let (mut night, mut kept) = (night(&gpu, LOCAL)?, KeptShadows::default());
    let search = LightSearch::default();
    night.shoot_keeping(&gpu, night.view(search), &mut kept)?;
    let block = night.scene.instances.iter().position(|instance| instance.name == "block").ok_or("a block")?;
    shift(&mut night.scene, block, DVec3::new(0.8, 0.0, 0.6));
    let view = night.view(search);
    // Marks the maps as drawn, although they are not.
    kept.drawn(view.shadows.as_ref().ok_or("shadows")?);
    let stale = night.shoot_keeping(&gpu, view.clone(), &mut kept)?;
    let right = night.shoot(&gpu, view.clone(), 1)?;
    assert!(stale.layers == 0 && off(&stale.linear, &right.linear) > 20, "{}", off(&stale.linear, &right.linear));

    let mut failed = KeptShadows::default();
    let shadows = view.shadows.as_ref().ok_or("shadows")?;
    failed.declare(
        &gpu,
        &mut framegraph_wgpu::Frame::<framegraph_passes::World>::new(),
        Default::default(),
        shadows,
    )?;
    assert_eq!(failed.due(shadows).len(), 13, "nothing was executed");
    Ok(())
}

/// Cascades stay cached while the camera is still, and moments together with their levels. Another size is another
/// texture.
#[test]
fn cascades_and_moments_stay_too() -> TestResult {
    let Some(gpu) = gpu("cascades_and_moments_stay_too") else { return Ok(()) };
    let moments = MomentSettings { blur_texels: 3.0, levels: 3, ..ShadowSettings::DEFAULT.moments };
    let sunny = ShadowSettings { cascades: 2, local_maps: 1, fit: Fit::Tight { lispsm: false }, ..LOCAL };
    for shadows in [sunny, ShadowSettings { filter: ShadowFilter::Vsm, moments, ..sunny }] {
        let (mut night, mut kept) = (night(&gpu, shadows)?, KeptShadows::default());
        let search = LightSearch::default();
        let first = night.shoot_keeping(&gpu, night.view(search), &mut kept)?;
        let second = night.shoot_keeping(&gpu, night.view(search), &mut kept)?;
        let anew = night.shoot(&gpu, night.view(search), 1)?;
        assert_eq!((first.layers, second.layers), (anew.layers, 0));
        assert_eq!((off(&first.linear, &anew.linear), off(&second.linear, &anew.linear)), (0, 0));
        night.seen.camera.eye.x += 0.5;
        let view = night.view(search);
        let due = kept.due(view.shadows.as_ref().ok_or("shadows")?);
        assert_eq!(due, [(0, Redraw::Light), (1, Redraw::Light)], "cascades follow the camera, the spot does not");
        night.settings.shadows = Some(ShadowSettings { map_texels: 64, ..shadows });
        night.seen.shadows = night.settings.shadows;
        assert_eq!(night.shoot_keeping(&gpu, night.view(search), &mut kept)?.layers, anew.layers, "another size");
    }
    Ok(())
}
