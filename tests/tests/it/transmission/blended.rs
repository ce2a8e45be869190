//! Surfaces that transmit and blend: alpha is the coverage, and covered parts show the transmitted light (glTF 2.0,
//! section 3.9.4, and KHR_materials_transmission).

use super::{TestResult, middle, pane, stage};
use crate::stage::{Shot, gpu};
use framegraph_passes::effects::exposure::Measurement;
use framegraph_passes::feature_culling::{
    Decision, Effect, EffectSet, EnvironmentSummary, FactInput, FactMemory, Facts, SceneSummary, decide,
};
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::{Preset, Settings};
use framegraph_scene::environment::ShBands;
use framegraph_scene::geometry::{plane, sphere};
use framegraph_scene::motion::{Body, Moves, Shape};
use framegraph_scene::{AlphaMode, Material, MeshId, Scene, Volume};
use glam::{DMat4, DVec3, Vec2, Vec3, Vec4};
use tests::measure::facts::{Case, Drawn, Easel, SIZE_PX};

const ALPHAS: [AlphaMode; 3] = [AlphaMode::Opaque, AlphaMode::Mask { cutoff: 0.25 }, AlphaMode::Blend];

/// Returns a transmissive material with an alpha mode and a coverage of 0.5.
fn glass(alpha: AlphaMode, volume: bool, double_sided: bool) -> Material {
    let tint = Vec3::new(0.9, 0.5, 0.2);
    let volume = volume.then(|| Volume { thickness: 0.2, ..Volume::default() });
    Material { alpha, base_color: tint.extend(0.5), double_sided, ..pane(tint, volume) }
}

/// Returns a case that looks down on a floor.
fn case(scene: Scene, asked: Settings) -> Case {
    let asked = asked.for_scene(&scene, SIZE_PX);
    Case {
        name: "glass",
        scene,
        nits: DVec3::splat(2000.0),
        background: Background::Environment,
        asked,
        ev100: 10.5,
        size_px: SIZE_PX,
    }
}

/// Returns the feature culling of a case.
fn facts(case: &Case) -> Facts {
    let sh = [Vec4::ONE; 18];
    let around = EnvironmentSummary { irradiance: &sh, bands: ShBands::Three, luminance_nits: 2000.0, sun: None };
    let input = FactInput {
        scene: &case.scene,
        survey: &SceneSummary::new(&case.scene),
        around,
        background: &case.background,
        views: &[case.view(&case.asked, SIZE_PX)],
        settings: &case.asked,
        forced: EffectSet::NONE,
        measured: Measurement::Off,
        max_steps: FactInput::MAX_CODES,
    };
    decide(&input, &mut FactMemory::default())
}

/// A visible transmissive surface keeps the picture behind it, in any alpha mode. Outside of the view it does not.
#[test]
fn the_picture_behind_is_kept_for_every_alpha_mode() {
    for alpha in ALPHAS {
        for (volume, double_sided) in [(false, false), (false, true), (true, false), (true, true)] {
            for (layers, other) in [(0, false), (1, false), (2, false), (1, true), (2, true)] {
                let mut scene = stage(Some(glass(alpha, volume, double_sided)));
                if other {
                    let (mesh, material) =
                        (scene.instances[1].mesh, scene.add_material(glass(AlphaMode::Opaque, false, false)));
                    scene.add_instance("other", mesh, material, DMat4::from_translation(DVec3::Y * 0.5));
                }
                let case = |scene: &Scene| case(scene.clone(), Settings { glass_layers: layers, ..Settings::DEFAULT });
                let seen = case(&scene);
                let applied = facts(&seen).apply(&seen.asked);
                assert_eq!(applied.scene_levels, seen.asked.scene_levels, "{alpha:?}, {layers} layers, {other}");
                assert!(applied.scene_levels > 0 && (applied.blended || alpha != AlphaMode::Blend));
                for instance in scene.instances.iter_mut().skip(1) {
                    instance.world_from_model.w_axis.y += 100.0;
                    instance.bounds = instance.bounds.transformed(&DMat4::from_translation(DVec3::Y * 100.0));
                }
                let row = facts(&case(&scene)).of(Effect::Transmission).map(|row| row.decision);
                assert_eq!(row, Some(Decision::Dropped), "{alpha:?}, behind the camera");
            }
        }
    }
}

/// At normal incidence, a pane of alpha a blends its transmitted light over the floor by a, regardless of other glass
/// beside it, layers and samples.
#[test]
fn alpha_covers_with_what_is_transmitted() -> TestResult {
    let Some(gpu) = gpu("alpha_covers_with_what_is_transmitted") else { return Ok(()) };
    let most = if gpu.info().backend == wgpu::Backend::Gl { 1 } else { 4 };
    let tint = Vec3::new(0.9, 0.5, 0.2);
    for (samples, glass_layers, other, alpha) in [(1, 1, false, 0.25), (1, 2, true, 0.75), (4, 2, true, 0.25)] {
        if samples > most {
            continue;
        }
        let settings = Settings { samples, glass_layers, ..Settings::default() };
        let seen = |pane: Option<Material>| {
            let mut scene = stage(pane);
            if other {
                let mesh = scene.add_mesh(sphere(0.2, 12, 8));
                let material = scene.add_material(super::pane(Vec3::ONE, None));
                scene.add_instance("beside", mesh, material, DMat4::from_translation(DVec3::new(1.3, 0.5, 0.0)));
            }
            let size_px = Shot::small(settings).size_px;
            middle(&gpu, &scene, settings.for_scene(&scene, size_px))
        };
        let floor = seen(None)?;
        let covered = Material { alpha: AlphaMode::Blend, base_color: tint.extend(alpha), ..pane(tint, None) };
        let found = seen(Some(covered))?;
        let expected = floor.lerp(floor * tint, alpha);
        // Four roundings to half floats.
        let off = ((found - expected) / expected).abs().max_element();
        assert!(off < 5e-3, "{samples} samples, {glass_layers} layers: {found} against {expected}");
        // Negative control: another coverage.
        let other = floor.lerp(floor * tint, 1.0 - alpha);
        assert!(((found - other) / other).abs().max_element() > 0.1);
    }
    Ok(())
}

/// Returns panes and balls of one alpha mode: thin and with a volume, single- and double-sided, one of them with
/// skinning.
fn shelf(alpha: AlphaMode) -> Scene {
    let mut scene = stage(None);
    let (mesh, ball) = (scene.add_mesh(plane(Vec2::splat(0.7), 1, Vec2::ONE)), scene.add_mesh(sphere(0.35, 12, 8)));
    for (i, (volume, double_sided)) in
        [(false, false), (false, true), (true, false), (true, true)].into_iter().enumerate()
    {
        let material = scene.add_material(glass(alpha, volume, double_sided));
        let x = 0.8 * i as f64 - 1.2;
        scene.add_instance("pane", mesh, material, DMat4::from_translation(DVec3::new(x, 0.6, 0.8)));
        scene.add_instance("ball", ball, material, DMat4::from_translation(DVec3::new(x, 0.6, -0.4)));
    }
    let own = scene.meshes[mesh.index()].clone();
    let rest = Shape { positions: own.positions.clone(), normals: own.normals.clone(), tangents: own.tangents.clone() };
    let mesh = scene.add_mesh(own);
    let (instance, material) = (scene.instances.len(), scene.instances[1].material);
    scene.add_instance("body", mesh, material, DMat4::from_translation(DVec3::new(0.0, 0.6, -1.2)));
    let body = Body { mesh: MeshId::new(mesh.index()), instance, node: 0, skin: None, rest, moves: Moves::default() };
    scene.motion.bodies.push(body);
    scene
}

/// Every preset draws glass of every alpha mode, after feature culling. Blended glass is visible, and differs from
/// opaque glass.
#[test]
fn every_preset_draws_glass_of_every_alpha_mode() -> TestResult {
    let Some(gpu) = gpu("every_preset_draws_glass_of_every_alpha_mode") else { return Ok(()) };
    let mut easel = Easel::new(&gpu);
    for preset in Preset::ALL {
        let asked = preset.frame().settings;
        if asked.samples > 1 && gpu.info().backend == wgpu::Backend::Gl {
            continue;
        }
        let mut pictures = Vec::new();
        for scene in ALPHAS.map(shelf).into_iter().chain([stage(None)]) {
            let mut drawn = Drawn::new(&gpu, case(scene, asked))?;
            let asked = drawn.case.asked;
            let settings = drawn.facts(&asked, EffectSet::NONE, &mut FactMemory::default()).apply(&asked);
            pictures.push(drawn.picture(&mut easel, &settings)?);
        }
        let differ = |a: usize, b: usize| {
            let pairs = pictures[a].chunks_exact(4).zip(pictures[b].chunks_exact(4));
            pairs.filter(|(a, b)| (0..3).any(|c| a[c].abs_diff(b[c]) > 4)).count()
        };
        let [opaque, blended, apart, cut] = [differ(0, 3), differ(2, 3), differ(0, 2), differ(0, 1)];
        // Masked glass with alpha above the cutoff equals opaque glass.
        assert!(opaque > 300 && blended > 300 && apart > 200, "{}: {opaque} {blended} {apart}", preset.name());
        assert_eq!(cut, 0, "{}: masked glass", preset.name());
    }
    Ok(())
}
