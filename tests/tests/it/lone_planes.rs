//! Shadows of the sun without casters: a single plane or convex box has no shadow, for any filter and fit.

use crate::stage::gpu;
use framegraph_passes::feature_culling::Effect;
use framegraph_passes::gpu_scene::shadow_views::{Fit, ShadowFilter, ShadowSettings};
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::{Settings, Shading};
use framegraph_scene::geometry::{cuboid, plane};
use framegraph_scene::{Camera, Light, Material, Mesh, Projection, Scene};
use glam::{DMat4, DQuat, DVec3, Vec2, Vec3};
use std::error::Error;
use tests::measure::facts::{Case, Drawn, Easel};

type TestResult = Result<(), Box<dyn Error>>;

/// Angles between the plane and the horizon in radians, about an axis that differs from the camera's and the sun's.
const TILTS: [f64; 4] = [0.0, 0.02, 0.4, -0.3];
const SUN: DVec3 = DVec3::new(1.0, 1.0, 0.5);

fn case(mesh: Mesh, tilt: f64) -> Result<Case, Box<dyn Error>> {
    let eye = DVec3::new(0.0, 1.2, 3.0);
    let at = DVec3::new(0.0, 0.0, 1.4);
    let camera = Camera::look_at(eye, at, DVec3::Y, Projection::perspective(1.2, 0.1))?;
    let mut scene = Scene { cameras: vec![camera], ..Scene::default() };
    let material = Material { double_sided: true, ..Material::dielectric("chalk", Vec3::splat(0.7), 0.8) };
    let (mesh, material) = (scene.add_mesh(mesh), scene.add_material(material));
    let turned = DQuat::from_axis_angle(DVec3::new(0.8, 0.0, 0.6), tilt);
    scene.add_instance("alone", mesh, material, DMat4::from_rotation_translation(turned, DVec3::NEG_Y));
    scene.lights.push(Light::directional("sun", -SUN.normalize().as_vec3(), 90_000.0));
    let asked = Settings { fxaa: false, shading: Shading::default(), ..Settings::DEFAULT };
    let background = Background::Constant(Vec3::ONE);
    Ok(Case { name: "alone", scene, nits: DVec3::splat(1000.0), background, asked, ev100: 14.0, size_px: [48, 32] })
}

#[test]
fn what_stands_alone_has_no_shadow_on_it() -> TestResult {
    let Some(gpu) = gpu("what_stands_alone_has_no_shadow_on_it") else { return Ok(()) };
    let mut easel = Easel::new(&gpu);
    let filters = [ShadowFilter::Pcf, ShadowFilter::Dpcf, ShadowFilter::Pcss, ShadowFilter::Vsm];
    let fits = [Fit::Tight { lispsm: true }, Fit::Tight { lispsm: false }, Fit::Stable];
    let mut failures = Vec::new();
    for tilt in TILTS {
        let meshes = [
            ("plane", plane(Vec2::splat(20.0), 1, Vec2::ONE)),
            ("thin box", cuboid(Vec3::new(10.0, 1e-4, 10.0))),
            ("box", cuboid(Vec3::new(1.5, 0.2, 1.5))),
        ];
        for (name, mesh) in meshes {
            let mut drawn = Drawn::new(&gpu, case(mesh, tilt)?)?;
            let bare = drawn.case.asked.without(Effect::SunShadows);
            let lit = drawn.picture(&mut easel, &bare)?;
            for filter in filters {
                for fit in fits {
                    let shadows = ShadowSettings { filter, fit, ..ShadowSettings::texels(1024) };
                    let seen = drawn.picture(&mut easel, &Settings { shadows: Some(shadows), ..bare })?;
                    let pairs = seen.chunks_exact(4).zip(lit.chunks_exact(4));
                    // Another shader variant gives the same result within one 8-bit step.
                    let dark = pairs.filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 1)).count();
                    if dark > 0 {
                        failures.push(format!("{name} tilted by {tilt}: {dark} pixels, {filter:?} {fit:?}"));
                    }
                }
            }
        }
    }
    assert!(failures.is_empty(), "{} pictures:\n{}", failures.len(), failures.join("\n"));
    Ok(())
}
