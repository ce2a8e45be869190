//! Light of views, and that threads change nothing.

use super::*;
use crate::ibl::IblSettings;
use crate::ibl::cache::Cache;
use framegraph_scene::environment::ShBands;
use framegraph_scene::{Environment, progress};
use framegraph_wgpu::Gpu;

/// Irradiance / π of an even light is its radiance, times intensity and exposure; bands that were left out are zero.
#[test]
fn ambient_light_is_scaled_and_padded() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Gpu::noop()?;
    let environment = Environment::uniform(DVec3::new(1.0, 2.0, 4.0))?;
    let projection = Projection::perspective(1.0, 0.1);
    let camera = Camera::look_at(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, projection)?;
    let (size_px, ev100) = ([16, 9], 0.0);
    let settings =
        ViewSettings { camera, size_px, ev100, environment_intensity: 0.5, shadows: None, lights: LightSearch::All };
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

/// Culling, sorting, placing and lights on several threads: the same view as on one, of a scene that is large enough for all of
/// them to be asked.
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
        environment_intensity: 1.0,
        shadows: Some(ShadowSettings::texels(64)),
        lights: LightSearch::default(),
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
