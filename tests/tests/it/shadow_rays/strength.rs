//! Strength of shadows, a number of each light.

use super::set::{Lamp, Set};
use super::{camera, scene_of};
use crate::stage::gpu;
use framegraph_passes::shadow::ShadowSettings;
use framegraph_scene::{Light, LightKind};
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
