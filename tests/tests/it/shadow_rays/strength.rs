//! Strength of shadows, a number of each light.

use super::set::{Lamp, Set};
use super::{camera, scene_of};
use crate::stage::gpu;
use framegraph_passes::gpu_scene::shadow_views::ShadowSettings;
use framegraph_scene::material::AlphaMode;
use framegraph_scene::{Light, LightKind, Material};
use glam::{DVec3, Vec3};
use std::error::Error;

/// Light that a shadow takes is its strength times what a whole shadow takes: of the sun and of a spot. A strength of 0 is a
/// frame without shadows.
#[test]
fn shadows_take_the_share_that_their_light_says() -> Result<(), Box<dyn Error>> {
    let Some(gpu) = gpu("shadows_take_the_share_that_their_light_says") else { return Ok(()) };
    let scene = scene_of(&[([0.0, -0.5, 0.0], [20.0, 0.5, 20.0]), ([0.0, 1.0, 0.0], [0.7, 1.0, 0.7])]);
    let set = Set::new(scene, camera([1.0, 2.5, 5.0], [0.5, 0.3, -0.5], 50.0)?, DVec3::Y);
    let sun = Light::directional("sun", Vec3::new(-0.5, -0.8, -0.3), 1e5);
    let cone = LightKind::Spot { intensity_candela: 1e6, range_m: None, inner_cone_rad: 0.7, outer_cone_rad: 0.8 };
    let spot = Light { kind: cone, position: DVec3::new(2.0, 4.0, 1.5), ..sun.clone() };
    for (light, cascades, local_maps) in [(sun, 1, 0), (spot, 0, 1)] {
        let shadows = ShadowSettings { cascades, local_maps, map_texels: 512, ..ShadowSettings::DEFAULT };
        let seen = |shadow_strength: f32, shadows| {
            Set { lamp: Lamp::Local(Light { shadow_strength, ..light.clone() }), ..set.clone() }.radiance(&gpu, shadows)
        };
        let (lit, whole, part) = (seen(1.0, None)?, seen(1.0, Some(shadows))?, seen(0.25, Some(shadows))?);
        assert_eq!(seen(0.0, Some(shadows))?, lit, "{}: no strength", light.name);
        let mut shadowed = 0;
        for ((lit, whole), part) in lit.iter().zip(&whole).zip(&part) {
            let expected = whole + 0.75 * (lit - whole);
            assert!((part - expected).abs() <= 2e-3 * expected + 1e-4, "{}: {part} for {expected}", light.name);
            shadowed += usize::from(*whole < 0.1 * lit);
        }
        assert!(shadowed > 50, "{}: {shadowed} pixels in shadow", light.name);
    }
    Ok(())
}

/// A white catcher shows its strength where the sun is in shadow, and nothing where it is not or where there are no shadows.
#[test]
fn a_shadow_catcher_shows_shadows_alone() -> Result<(), Box<dyn Error>> {
    let Some(gpu) = gpu("a_shadow_catcher_shows_shadows_alone") else { return Ok(()) };
    let mut scene = scene_of(&[([0.0, -0.5, 0.0], [20.0, 0.5, 20.0]), ([0.0, 1.0, 0.0], [0.7, 1.0, 0.7])]);
    // The box casts, and shows nothing itself.
    let black = scene.add_material(Material { unlit: true, ..Material::dielectric("black", Vec3::ZERO, 1.0) });
    scene.instances[1].material = black;
    let floor = Material { unlit: true, alpha: AlphaMode::Blend, ..Material::dielectric("floor", Vec3::ONE, 1.0) };
    let floor = scene.add_material(Material { shadow_catcher: Some(0.5), ..floor });
    scene.instances[0].material = floor;
    let camera = camera([1.0, 2.5, 5.0], [0.5, 0.3, -0.5], 50.0)?;
    let sun = Lamp::Local(Light::directional("sun", Vec3::new(-0.5, -0.8, -0.3), 1e5));
    let set = Set { lamp: sun, ..Set::new(scene, camera, DVec3::Y) };
    let shadows = ShadowSettings { cascades: 1, local_maps: 0, map_texels: 512, ..ShadowSettings::DEFAULT };
    let seen = set.radiance(&gpu, Some(shadows))?;
    let dark = seen.iter().filter(|red| (**red - 0.5).abs() < 1e-3).count();
    let clear = seen.iter().filter(|red| **red == 0.0).count();
    assert!(seen.iter().all(|red| (0.0..=0.501).contains(red)));
    assert!(dark > 50 && clear > seen.len() / 2 && dark + clear > seen.len() * 9 / 10, "{dark} dark, {clear} clear");
    assert!(set.radiance(&gpu, None)?.iter().all(|red| *red == 0.0), "without shadows nothing is seen");
    Ok(())
}
