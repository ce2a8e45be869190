//! Transmissive surfaces seen through others.

use super::{EYE_M, FOV_Y_RAD, TestResult, counts, middle_row, pane, stage};
use crate::stage::{Shot, gpu};
use framegraph::Counts;
use framegraph_passes::Settings;
use framegraph_passes::effects::transmission::MAX_GLASS_LAYERS;
use framegraph_scene::geometry::{plane, sphere};
use framegraph_scene::{Camera, Material, Projection, Scene, Volume};
use framegraph_wgpu::Gpu;
use glam::{DMat4, DVec3, Vec2, Vec3};
use std::error::Error;

/// Passes of an additional layer:
///
/// step             attachment    load       store
/// transparent      hdr           LOAD       STORE   (the next layer's copy samples it)
///                  depth         LOAD       STORE   (so does it)
/// scene/copy       scene level 0 don't care STORE
/// scene/level      scene level 1 don't care STORE   (and so on)
///
/// Filament has no such layers. With one layer, the frame is unchanged.
#[test]
fn a_layer_costs_its_picture_and_color_and_depth_once_more() {
    for samples in [1, 4] {
        let of =
            |layers: u8| counts(Settings { samples, scene_levels: 4, glass_layers: layers, ..Settings::default() });
        let one = of(1);
        assert_eq!(one, counts(Settings { samples, scene_levels: 4, ..Settings::default() }));
        for layers in 2..=MAX_GLASS_LAYERS {
            let further = u32::from(layers) - 1;
            // Each layer is resolved for the copy.
            let averages = if samples > 1 { further } else { 0 };
            let expected = Counts {
                unresolves: one.unresolves + 2 * further,
                resolves: one.resolves + (4 + 2) * further + averages,
                multisample_resolves: one.multisample_resolves + averages,
                steps: one.steps + 5 * further,
                render_passes: one.render_passes + 5 * further,
                passes: one.passes + 5 * further,
                ..one
            };
            assert_eq!(of(layers), expected, "{samples} samples, {layers} layers");
        }
    }
}

/// Returns a stack of panes with these tints, from bottom to top, over the center of the floor.
fn stack(tints: &[Vec3]) -> Scene {
    let mut scene = stage(None);
    let mesh = scene.add_mesh(plane(Vec2::splat(2.0), 1, Vec2::ONE));
    // The order differs from the order of heights, so the view must sort them.
    for index in (0..tints.len()).step_by(2).chain((1..tints.len()).step_by(2)) {
        let material = scene.add_material(pane(tints[index], None));
        let height = DVec3::Y * (0.5 + 0.25 * index as f64);
        scene.add_instance("pane", mesh, material, DMat4::from_translation(height));
    }
    scene
}

fn middle(gpu: &Gpu, scene: &Scene, settings: Settings) -> Result<Vec3, Box<dyn Error>> {
    let size_px = Shot::small(settings).size_px;
    let row = middle_row(gpu, scene, settings.for_scene(scene, size_px))?;
    Ok(row[row.len() / 2])
}

/// A floor through panes is multiplied by the tint of each pane with a layer. One layer shows the uppermost pane; with
/// more panes than layers, the uppermost pane of the last layer hides those below.
#[test]
fn tints_of_panes_behind_panes_multiply() -> TestResult {
    let Some(gpu) = gpu("tints_of_panes_behind_panes_multiply") else { return Ok(()) };
    let tints =
        [(0.9, 0.5, 0.4), (0.5, 0.9, 0.6), (0.7, 0.6, 0.95), (0.95, 0.8, 0.55), (0.6, 0.7, 0.8)].map(Vec3::from);
    // OpenGL does not read multisampled depth.
    let most = if gpu.info().backend == wgpu::Backend::Gl { 1 } else { 4 };
    for samples in [1, 4].into_iter().filter(|samples| *samples <= most) {
        let floor = middle(&gpu, &stack(&[]), Settings { samples, ..Settings::default() })?;
        for (panes, layers) in [(1, 1), (2, 1), (2, 2), (3, 2), (4, 4), (5, 4)] {
            let settings = Settings { samples, glass_layers: layers, ..Settings::default() };
            let found = middle(&gpu, &stack(&tints[..panes]), settings)?;
            let through = tints[..panes].iter().rev().take(layers.into()).fold(floor, |light, tint| light * *tint);
            // Three roundings to half floats per layer.
            let off = ((found - through) / through).abs().max_element();
            assert!(off < 4e-3 * f32::from(layers), "{panes} panes, {layers} layers: {found}, not {through}");
            // Negative control: one tint more or less.
            let other = through * tints[panes - 1];
            assert!(((found - other) / other).abs().max_element() > 0.05);
        }
    }
    Ok(())
}

/// Layers apply only to overlapping surfaces: glass side by side needs one layer, bit for bit.
#[test]
fn panes_side_by_side_need_one_layer() -> TestResult {
    let Some(gpu) = gpu("panes_side_by_side_need_one_layer") else { return Ok(()) };
    let mut scene = stage(None);
    let mesh = scene.add_mesh(plane(Vec2::splat(0.8), 1, Vec2::ONE));
    for (x, tint) in [(-0.6, Vec3::new(0.9, 0.5, 0.2)), (0.6, Vec3::new(0.2, 0.5, 0.9))] {
        let material = scene.add_material(pane(tint, None));
        scene.add_instance("pane", mesh, material, DMat4::from_translation(DVec3::new(x, 1.0 + x, 0.0)));
    }
    let size_px = Shot::small(Settings::default()).size_px;
    let row = |glass_layers| {
        middle_row(&gpu, &scene, Settings { glass_layers, ..Settings::default() }.for_scene(&scene, size_px))
    };
    assert!(row(1)? == row(2)?);
    Ok(())
}

/// A ball of glass shows the edge of a checkerboard behind it as a continuous edge in every row. Its position follows
/// from refraction: a ray that enters at x exits at 2 / 1.5 − 1 times x. The edge therefore appears three times as far
/// from the ball's center.
#[test]
fn balls_bend_an_edge_and_do_not_break_it() -> TestResult {
    let Some(gpu) = gpu("balls_bend_an_edge_and_do_not_break_it") else { return Ok(()) };
    const OFF_M: f64 = 0.06;
    let mut scene = Scene { name: "lens".into(), ..Scene::default() };
    let half = scene.add_mesh(plane(Vec2::splat(40.0), 1, Vec2::ONE));
    for (name, x, color) in [("dark", -20.0, 0.05), ("bright", 20.0, 0.8)] {
        let material = scene.add_material(Material::dielectric(name, Vec3::splat(color), 0.9));
        scene.add_instance(name, half, material, DMat4::from_translation(DVec3::X * x));
    }
    let ball = scene.add_mesh(sphere(0.5, 96, 48));
    let glass = scene.add_material(pane(Vec3::ONE, Some(Volume { thickness: 1.0, ..Volume::default() })));
    scene.add_instance("ball", ball, glass, DMat4::from_translation(DVec3::new(OFF_M, 1.0, 0.0)));
    let projection = Projection::perspective(FOV_Y_RAD, 0.1);
    scene.cameras.extend(Camera::look_at(DVec3::Y * EYE_M, DVec3::ZERO, DVec3::NEG_Z, projection));
    let settings = Settings::default();
    let size_px = Shot::small(settings).size_px;
    let texels = super::texels(&gpu, &scene, settings.for_scene(&scene, size_px))?;
    let width = size_px[0] as usize;
    let rows: Vec<&[Vec3]> = texels.chunks_exact(width).collect();
    let middle = 0.5 * (rows[0][8].y + rows[0][width - 8].y);
    // Rows covered by the ball, without its rim, which reflects the sky.
    let pixels_per_m = 0.5 * f64::from(size_px[1]) / ((EYE_M - 1.0) * (FOV_Y_RAD / 2.0).tan());
    let off_px = OFF_M * pixels_per_m;
    let (center, reach) = (width as f64 / 2.0 + off_px, 0.7 * 0.5 * pixels_per_m);
    let mut before: Option<f64> = None;
    for (y, row) in rows.iter().enumerate() {
        let height = y as f64 + 0.5 - f64::from(size_px[1]) / 2.0;
        if height.abs() > 0.6 * reach {
            continue;
        }
        let across = (reach * reach - height * height).sqrt();
        let inside = (center - across).ceil() as usize..(center + across) as usize;
        let steps: Vec<usize> =
            inside.clone().skip(1).filter(|x| (row[*x].y > middle) != (row[*x - 1].y > middle)).collect();
        assert_eq!(steps.len(), 1, "row {y}: one edge among {inside:?}, not at {steps:?}");
        let at = steps[0] as f64;
        assert!(before.is_none_or(|before| (before - at).abs() <= 2.0), "row {y}: from {before:?} to {at}");
        before = Some(at);
    }
    // To within one pixel; one pixel left or right is a fifth.
    let bent = before.map(|at| (center - at) / off_px);
    assert!(bent.is_some_and(|bent| (2.3..4.0).contains(&bent)), "{bent:?}");
    Ok(())
}
