//! Light of views, and equality of views made on several threads.

use super::*;
use crate::light::ibl::IblSettings;
use crate::light::ibl::cache::Cache;
use framegraph_scene::environment::ShBands;
use framegraph_scene::{Environment, progress};
use framegraph_wgpu::Gpu;

/// Irradiance / π of uniform light is its radiance times intensity and exposure. Omitted bands are zero.
#[test]
fn ambient_light_is_scaled_and_padded() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Gpu::noop()?;
    let environment = Environment::uniform(DVec3::new(1.0, 2.0, 4.0))?;
    let projection = Projection::perspective(1.0, 0.1);
    let camera = Camera::look_at(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, projection)?;
    let (size_px, ev100) = ([16, 9], 0.0);
    let settings = ViewSettings {
        camera,
        size_px,
        ev100,
        environment_intensity: 0.5,
        shadows: None,
        lights: LightSearch::All,
        ..ViewSettings::default()
    };
    let exposure = CameraView::empty(&settings).frame.exposure;
    for bands in [ShBands::Two, ShBands::Three, ShBands::Five] {
        let ibl = IblSettings { cube_texels: 64, bands, ..IblSettings::default() };
        let light = ImageLight::new(&gpu, &environment, &ibl, &Cache::off(), &mut progress::silent)?;
        let sh = CameraView::new(&Scene::default(), &light, &Background::None, &settings).frame.sh;
        let expected = Vec4::new(0.5, 1.0, 2.0, 0.0) * exposure;
        assert!((sh[0] - expected).length() < 1e-6, "{:?} for {expected:?}", sh[0]);
        assert_eq!(sh[8] == Vec4::ZERO, bands == ShBands::Two);
        assert!(sh.iter().all(|c| c.w == 0.0));
    }
    Ok(())
}

/// Views made on several threads equal those made on one, for a scene large enough to use all threads.
#[test]
fn views_made_on_several_threads_are_the_same() -> Result<(), Box<dyn std::error::Error>> {
    use framegraph_scene::geometry::cuboid;
    use framegraph_scene::{Light, LightKind, Material};
    let mut scene = Scene::default();
    let meshes = [0.1, 0.2].map(|size| scene.add_mesh(cuboid(Vec3::splat(size))));
    let clay = [0.1, 0.9].map(|hue| scene.add_material(Material::dielectric("clay", Vec3::splat(hue), 0.4)));
    for i in 0..100_000_usize {
        let at = DVec3::new((i * 7919 % 293) as f64, (i * 104_729 % 211) as f64, (i * 31 % 173) as f64);
        scene.add_instance("", meshes[i % 2], clay[i / 2 % 2], DMat4::from_translation(at));
    }
    scene.lights.push(Light::directional("sun", Vec3::new(-0.4, -0.8, -0.3).normalize(), 50_000.0));
    let lamp = LightKind::Point { intensity_candela: 900.0, range_m: None };
    scene.lights.push(Light { kind: lamp, position: DVec3::splat(60.0), ..Light::directional("lamp", Vec3::X, 0.0) });
    let gpu = Gpu::noop()?;
    let even = Environment::uniform(DVec3::ONE)?;
    let ibl = IblSettings { cube_texels: 64, ..IblSettings::default() };
    let light = ImageLight::new(&gpu, &even, &ibl, &Cache::off(), &mut progress::silent)?;
    let camera = Camera::look_at(
        DVec3::new(140.0, 100.0, 250.0),
        DVec3::new(140.0, 100.0, 0.0),
        DVec3::Y,
        Projection::perspective(1.0, 0.1),
    )?;
    let settings = ViewSettings {
        camera,
        size_px: [64, 64],
        ev100: 14.0,
        shadows: Some(ShadowSettings::texels(64)),
        ..ViewSettings::default()
    };
    let mut prepared = PreparedScene::new(&scene);
    let view = |prepared: &_| CameraView::prepared(&scene, prepared, &light, &Background::None, &settings);
    let alone = view(&prepared);
    prepared.workers = Some(framegraph_wgpu::Workers::with_threads(3)?);
    let shared = view(&prepared);
    assert!(alone.visible.opaque.len() > 10_000 && alone.visible.culled > 10_000, "{}", alone.visible.culled);
    assert!(alone.visible == shared.visible && alone.draws == shared.draws && alone.origins == shared.origins);
    assert_eq!((&alone.lights, &alone.light_lists), (&shared.lights, &shared.light_lists));
    Ok(())
}

/// Levels of detail get coarser with distance. The picture and all shadow maps of all views that share them use the
/// same level. A change of level invalidates a cached map of a punctual light.
#[test]
fn an_instance_has_one_level_of_detail_in_all_that_is_drawn() -> Result<(), Box<dyn std::error::Error>> {
    use framegraph_scene::geometry::sphere;
    use framegraph_scene::{Light, LightKind, Material};
    let mut scene = Scene::default();
    let (ball, clay) = (scene.add_mesh(sphere(0.5, 64, 32)), scene.add_material(Material::default()));
    scene.add_instance("ball", ball, clay, DMat4::IDENTITY);
    scene.make_levels(&mut progress::silent)?;
    scene.lights.push(Light::directional("sun", Vec3::new(-0.4, -0.8, -0.3).normalize(), 50_000.0));
    let lamp = LightKind::Point { intensity_candela: 900.0, range_m: Some(9.0) };
    scene.lights.push(Light {
        kind: lamp,
        position: DVec3::new(0.0, 2.0, 0.0),
        ..Light::directional("lamp", Vec3::X, 0.0)
    });
    let gpu = Gpu::noop()?;
    let ibl = IblSettings { cube_texels: 64, ..IblSettings::default() };
    let even = Environment::uniform(DVec3::ONE)?;
    let light = ImageLight::new(&gpu, &even, &ibl, &Cache::off(), &mut progress::silent)?;
    let seen = |far_m: f64, lod_error_px: f32, map_texels: u32| ViewSettings {
        camera: Camera::look_at(DVec3::Z * far_m, DVec3::ZERO, DVec3::Y, Projection::perspective(1.0, 0.1))
            .expect("a camera"),
        size_px: [320, 240],
        ev100: 14.0,
        environment_intensity: 1.0,
        shadows: Some(ShadowSettings {
            cascades: 2,
            local_maps: 6,
            local_layers: 6,
            ..ShadowSettings::texels(map_texels)
        }),
        lights: LightSearch::All,
        lod_error_px,
        visible_layers: 1,
    };
    let view = |settings: &ViewSettings| CameraView::new(&scene, &light, &Background::None, settings);
    // Level of the ball, the same in every draw.
    let level = |view: &CameraView| {
        let lists = view.draws.depth.iter().chain(&view.draws.surfaces).chain(view.draws.casters.iter().flatten());
        let all: Vec<u8> = lists.flatten().map(|batch| batch.level).collect();
        assert!(all.len() >= 4 && all.iter().all(|level| *level == all[0]), "{all:?}");
        all[0]
    };
    let coarse = |far_m| seen(far_m, 1.0, 8);
    let found = [1.0, 3.0, 9.0, 27.0].map(|far_m| level(&view(&coarse(far_m))));
    assert!(found.windows(2).all(|pair| pair[0] < pair[1]), "{found:?}");
    assert!([1.0, 27.0].map(|far_m| level(&view(&seen(far_m, 0.0, 8)))) == [0; 2]);
    assert!(level(&view(&seen(27.0, 1.0, 4096))) < found[3], "texels of maps are as small as that");
    let together = CameraView::together(&scene, &light, &Background::None, &[coarse(27.0), coarse(1.0), coarse(9.0)]);
    assert_eq!(together.iter().map(level).collect::<Vec<_>>(), [found[0]; 3]);
    // The second view alone would allow a coarser level.
    let together = CameraView::together(&scene, &light, &Background::None, &[seen(27.0, 1.0, 64), seen(27.0, 4.0, 64)]);
    let levels: Vec<u8> = together.iter().map(level).collect();
    assert!(levels[0] == levels[1] && level(&view(&seen(27.0, 4.0, 64))) > levels[0], "{levels:?}");
    // Keys of the maps of a punctual light, which do not depend on the eye.
    let keys = |far_m, lod_error_px| {
        let shadows = view(&seen(far_m, lod_error_px, 64)).shadows;
        shadows.map_or(Vec::new(), |shadows| shadows.keys()[shadows.cascades..].to_vec())
    };
    assert!(keys(1.0, 0.0).len() == 6 && keys(1.0, 0.0) == keys(3.0, 0.0), "they do");
    assert!(keys(1.0, 1.0) != keys(3.0, 1.0), "maps of other levels are taken for the same");
    Ok(())
}
