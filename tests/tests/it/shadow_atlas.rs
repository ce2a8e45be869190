//! Shadow maps of punctual lights that share layers: pictures equal those with one layer per map, for any neighbors.

use crate::stage::gpu;
use framegraph_passes::gpu_scene::shadow_views::{MomentSettings, Place, ShadowFilter, ShadowSettings};
use framegraph_passes::{LightSearch, Settings};
use framegraph_scene::geometry::cuboid;
use framegraph_scene::{Camera, Light, LightKind, Material, Projection, Scene};
use glam::{DMat4, DVec3, Vec3};
use std::error::Error;
use tests::measure::lights::Night;

/// Size of a layer, and of a map of the light, in texels.
const LAYER: u32 = 256;
const MAP: u32 = 64;

/// Returns a light over a floor with posts and three slabs. With `beside`, also three spot lights, too faint to be
/// visible, each close to a slab that fills its map.
fn yard(beside: bool) -> Scene {
    let mut scene = Scene { name: "yard".into(), ..Scene::default() };
    let chalk = scene.add_material(Material::dielectric("chalk", Vec3::splat(0.5), 1.0));
    let mut add = |at: [f64; 3], half: [f32; 3]| {
        let mesh = scene.add_mesh(cuboid(half.into()));
        scene.add_instance("box", mesh, chalk, DMat4::from_translation(at.into()));
    };
    add([0.0, -0.5, 0.0], [5.0, 0.5, 5.0]);
    for at in [[0.7, 0.2, 0.4], [-0.9, 0.3, 0.8], [0.3, 0.25, -1.2], [-0.5, 0.2, -0.6], [1.3, 0.2, 1.3]] {
        add(at, [0.12, at[1] as f32, 0.12]);
    }
    let spots = [-2.0, 0.0, 2.0].map(|x| DVec3::new(x, 3.0, -3.0));
    spots.iter().for_each(|at| add((*at - DVec3::Y * 0.1).into(), [0.08, 0.02, 0.08]));
    let point = LightKind::Point { intensity_candela: 200.0, range_m: Some(4.0) };
    let lamp = Light::directional("lamp", Vec3::NEG_Y, 1.0);
    scene.lights.push(Light { kind: point, position: DVec3::new(0.0, 1.0, 0.0), ..lamp.clone() });
    let spot =
        LightKind::Spot { intensity_candela: 1e-9, range_m: Some(9.0), inner_cone_rad: 0.3, outer_cone_rad: 0.4 };
    let faint = spots.map(|position| Light { kind: spot, position, ..lamp.clone() });
    scene.lights.extend(faint.into_iter().filter(|_| beside));
    scene
}

/// Returns the number of pixels with a channel that differs by more than 1/255 on a linear scale.
fn off(a: &[[f32; 4]], b: &[[f32; 4]]) -> usize {
    let differs = |(a, b): &(&[f32; 4], &[f32; 4])| a.iter().zip(*b).any(|(a, b)| (a - b).abs() > 1.0 / 255.0);
    a.iter().zip(b).filter(differs).count()
}

/// The light's six maps are next to each other and to three entirely dark ones, and are compared with six separate
/// layers. Every filter, wide penumbrae, blur and levels are tested. Moments of four samples are close to those of one
/// sample.
#[test]
fn nothing_bleeds_from_map_to_map() -> Result<(), Box<dyn Error>> {
    let Some(gpu) = gpu("nothing_bleeds_from_map_to_map") else { return Ok(()) };
    let projection = Projection::perspective(0.22, 0.1);
    let camera = Camera::look_at(DVec3::new(0.0, 10.0, 17.0), DVec3::ZERO, DVec3::Y, projection)?;
    let moments = MomentSettings { blur_texels: 9.0, levels: 8, ..ShadowSettings::DEFAULT.moments };
    let shared = ShadowSettings { cascades: 0, local_maps: 9, local_layers: 2, ..ShadowSettings::texels(LAYER) };
    for filter in ShadowFilter::ALL {
        let shared = ShadowSettings { filter, moments, bulb_m: Some(0.4), ..shared };
        // Levels down to one texel per map, like the maps of 64 texels in layers of 256.
        let own_levels = MomentSettings { levels: 7, ..moments };
        let alone = ShadowSettings { local_maps: 6, local_layers: 6, map_texels: MAP, moments: own_levels, ..shared };
        let shoot = |beside, shadows| -> Result<_, Box<dyn Error>> {
            let settings = Settings { shadows: Some(shadows), ..Settings::DEFAULT };
            let mut night = Night::new(&gpu, yard(beside), camera.clone(), [96, 96], settings)?;
            let view = night.view(LightSearch::All);
            let maps = &view.shadows.as_ref().ok_or("shadows")?.maps;
            let places: Vec<Place> = maps.iter().map(|map| map.place).collect();
            Ok((places, night.shoot(&gpu, view, 1)?.linear))
        };
        let (places, found) = shoot(true, shared)?;
        let (own, expected) = shoot(false, alone)?;
        let at = |layer, x, y, texels| Place { layer, corner: [x, y], texels };
        assert_eq!(places[..3], [at(0, 0, 0, 128), at(0, 128, 0, 128), at(0, 0, 128, 128)]);
        assert_eq!(places[3..5], [at(0, 128, 128, MAP), at(0, 192, 128, MAP)]);
        assert_eq!(places[7..], [at(1, 0, 0, MAP), at(1, 64, 0, MAP)]);
        assert_eq!(own, (0..6).map(|layer| at(layer, 0, 0, MAP)).collect::<Vec<_>>());
        let brightest = found.iter().map(|texel| texel[0]).fold(0.0, f32::max);
        assert!(brightest > 0.1, "{filter:?}: nothing is lit");
        // Positions in a layer are rounded differently, so texels at edges may change.
        let differ = off(&found, &expected);
        println!("{filter:?}: {differ} pixels differ");
        assert!(differ <= 9, "{filter:?}: {differ} pixels differ");
        if filter.moments().is_some() {
            let sampled = ShadowSettings { moments: MomentSettings { samples: 4, ..moments }, ..shared };
            let differ = off(&shoot(true, sampled)?.1, &found);
            println!("{filter:?} of four samples: {differ} pixels differ");
            assert!(differ <= 600, "{filter:?} of four samples: {differ} pixels differ");
        }
    }
    Ok(())
}
