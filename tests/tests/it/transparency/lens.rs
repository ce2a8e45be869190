//! Depth of field of a blended surface in focus.

use super::{Drawn, SIZE_PX, TestResult, apart, clear, looking, rays};
use crate::stage::gpu;
use framegraph_passes::effects::depth::structure::Resolution;
use framegraph_passes::effects::dof::FILM_HEIGHT_M;
use framegraph_passes::{DofSettings, Settings, Transparency};
use framegraph_scene::Scene;
use framegraph_scene::geometry::plane;
use glam::{DMat4, DQuat, DVec3, Vec2, Vec3};
use std::f64::consts::FRAC_PI_2;

const DOCUMENT: &str = include_str!("../../../../docs/design/lens.md");

/// Returns a pane in focus over the left half of distant bars.
fn scene() -> Scene {
    let mut scene = Scene { name: "pane".into(), ..Scene::default() };
    let bar = scene.add_mesh(plane(Vec2::new(2.0, 20.0), 1, Vec2::ONE));
    let upright = |at: DVec3| DMat4::from_rotation_translation(DQuat::from_rotation_x(FRAC_PI_2), at);
    for (number, x) in (-5..=5).enumerate() {
        let color = if number % 2 == 0 { Vec3::new(0.9, 0.8, 0.2) } else { Vec3::new(0.1, 0.2, 0.6) };
        let material = scene.add_material(clear(color, 1.0));
        scene.add_instance("bar", bar, material, upright(DVec3::new(2.0 * f64::from(x), 0.0, -20.0)));
    }
    let pane = scene.add_mesh(plane(Vec2::new(1.0, 1.4), 1, Vec2::ONE));
    let material = scene.add_material(clear(Vec3::new(0.9, 0.1, 0.1), 0.8));
    scene.add_instance("pane", pane, material, upright(DVec3::new(-0.5, 0.0, -4.0)));
    scene.cameras = looking(DVec3::ZERO, DVec3::NEG_Z);
    scene
}

/// Drawn after the blur, a pane in focus is as sharp as through the lens; drawn before, it is blurred like the bars.
#[test]
fn a_pane_in_focus() -> TestResult {
    let Some(gpu) = gpu("a_pane_in_focus") else { return Ok(()) };
    let drawn = Drawn::new(&gpu, scene())?;
    let own = DofSettings { focus_m: 4.0, f_number: 0.1, resolution: Resolution::Full, ..DofSettings::DEFAULT };
    let focal_m = 0.5 * f64::from(FILM_HEIGHT_M) / 0.3_f64.tan();
    let truth = rays::through_lens(&drawn.scene, SIZE_PX, (4.0, 0.5 * focal_m / 0.1), 96);
    let of = |blended_after| {
        let dof = Some(DofSettings { blended_after, ..own });
        let settings = Settings { dof, transparency: Transparency::Peeled { layers: 1 }, ..Settings::DEFAULT };
        let found = drawn.texels_of(&gpu, settings)?;
        Ok::<_, Box<dyn std::error::Error>>(apart(&found, &truth, 0.0)[0])
    };
    let [before, after] = [of(false)?, of(true)?];
    for (name, found) in [("before the blur", before), ("after it", after)] {
        let row = DOCUMENT.lines().find_map(|line| line.strip_prefix(&format!("| {name} | ")));
        let stated: f64 = row.and_then(|row| row.trim_end_matches(" |").parse().ok()).unwrap_or(0.0);
        assert!(
            (found - stated).abs() < 0.2 * stated,
            "{name}: {found} of {before} {after}, and docs/design/lens.md has {stated}"
        );
    }
    assert!(after < 0.5 * before, "{before} {after}");
    Ok(())
}
