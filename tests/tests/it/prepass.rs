//! Frames with and without a depth prepass: bit-exact pictures, and the cost in passes, loads and stores.

use crate::stage::{Set, Shot, gpu};
use framegraph::Options;
use framegraph_passes::effects::exposure::Measurement;
use framegraph_passes::effects::taa::TaaSettings;
use framegraph_passes::feature_culling::{
    Decision, Effect, EffectSet, EnvironmentSummary, FactInput, FactMemory, SceneSummary, decide,
};
use framegraph_passes::gpu_scene::shadow_views::ShadowSettings;
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::{LightSearch, OcclusionSettings, Settings, ViewSettings};
use framegraph_scene::environment::ShBands;
use framegraph_scene::geometry::{cuboid, plane, sphere};
use framegraph_scene::{AlphaMode, Camera, Material, Mesh, Projection, Scene, progress};
use glam::{DMat4, DVec3, Vec2, Vec3, Vec4};
use std::error::Error;

/// Returns boards and blocks with coplanar faces of several colors and sides. The last face at equal depth is visible,
/// unless its material masks it, as all of the fifth is.
fn boards() -> Scene {
    let mut scene = Scene::default();
    let mesh = scene.add_mesh(plane(Vec2::splat(1.0), 2, Vec2::ONE));
    let block = scene.add_mesh(cuboid(Vec3::splat(0.4)));
    for number in 0..5_u32 {
        let hue = number as f32 / 4.0;
        let clay = Material::dielectric("clay", Vec3::new(hue, 0.5, 1.0 - hue), 0.5);
        let material = scene.add_material(match number {
            3 => Material { alpha: AlphaMode::Mask { cutoff: 0.5 }, ..clay },
            4 => Material { alpha: AlphaMode::Mask { cutoff: 1.5 }, ..clay },
            _ => Material { double_sided: number == 1, ..clay },
        });
        let at = DVec3::new(0.6 * f64::from(number), 0.0, 0.4 * f64::from(number % 2));
        scene.add_instance("board", mesh, material, DMat4::from_translation(at));
        scene.add_instance("block", block, material, DMat4::from_translation(at + DVec3::Y * 0.3));
    }
    scene
}

/// Returns a floor whose center is offset toward the eye by `floor_z_m`, with an object over it that covers a part of
/// it. `more` copies of the object are beyond the far plane.
fn over_a_floor(mesh: Mesh, floor_z_m: f64, more: usize) -> Scene {
    let mut scene = Scene::default();
    let material = scene.add_material(Material::default());
    let floor = scene.add_mesh(plane(Vec2::splat(9.0), 1, Vec2::ONE));
    scene.add_instance("floor", floor, material, DMat4::from_translation(DVec3::Z * floor_z_m));
    let mesh = scene.add_mesh(mesh);
    for number in 0..=more {
        let at = DVec3::new(0.0, 0.5, -0.01 * number as f64);
        scene.add_instance("thing", mesh, material, DMat4::from_translation(at));
    }
    scene
}

/// Returns true if feature culling drops the prepass, and the reason.
fn decided(scene: &Scene, asked: Settings) -> (bool, String) {
    let camera =
        Camera::look_at(DVec3::new(0.2, 1.2, 3.2), DVec3::Y * 0.4, DVec3::Y, Projection::perspective(0.8, 0.1));
    let view = ViewSettings {
        camera: camera.expect("a camera"),
        size_px: [64, 64],
        ev100: 10.0,
        shadows: None,
        lights: LightSearch::All,
        lod_error_px: 3.0,
        ..ViewSettings::default()
    };
    let irradiance = &[Vec4::ONE; 18];
    let input = FactInput {
        scene,
        survey: &SceneSummary::new(scene),
        around: EnvironmentSummary { irradiance, bands: ShBands::Three, luminance_nits: 1.0, sun: None },
        background: &Background::Environment,
        views: &[view],
        settings: &asked,
        forced: EffectSet::NONE,
        measured: Measurement::Off,
        max_steps: FactInput::MAX_CODES,
    };
    let facts = decide(&input, &mut FactMemory::default());
    let fact = facts.of(Effect::Prepass).expect("a prepass is asked for");
    (fact.decision == Decision::Dropped, fact.reason.clone())
}

/// Objects drawn after the floor beneath them make the prepass worthwhile, unless they have too many triangles. Objects
/// drawn before the floor already hide it.
#[test]
fn a_prepass_is_drawn_where_it_saves_more_than_it_costs() {
    let plain = Settings { shadows: None, ..Settings::DEFAULT };
    let block = || cuboid(Vec3::splat(0.5));
    let mut in_levels = over_a_floor(sphere(0.5, 96, 48), 2.0, 0);
    in_levels.make_levels(&mut progress::silent).expect("levels");
    let cases = [
        (in_levels, false, "and it saves "),
        (over_a_floor(block(), 2.0, 0), false, "and it saves "),
        (over_a_floor(block(), -4.0, 0), true, "and it saves 0 thousand"),
        (over_a_floor(sphere(0.5, 96, 48), 2.0, 0), true, "and it saves "),
        (over_a_floor(sphere(0.5, 96, 48), 2.0, 2048), false, "of more than 2048 nothing is known"),
        (Scene::default(), true, "0 triangles"),
    ];
    for (scene, dropped, why) in cases {
        let (found, reason) = decided(&scene, plain);
        assert!(found == dropped && reason.contains(why), "{dropped}: {reason}");
    }
    let moving = Settings { moving: true, taa: Some(TaaSettings::DEFAULT), ..plain };
    assert!(!decided(&Scene::default(), moving).0, "velocity is drawn over its depth");
}

/// A prepass does not change the picture. It costs a pass, and no load or store unless an effect reads its depth.
/// Without a prepass, the effect draws depth itself. With one, depth is loaded and stored once, and geometry is drawn once
/// less. With several samples no prepass is declared for an effect.
#[test]
fn a_prepass_changes_no_bit_and_costs_at_most_one_load_and_store() -> Result<(), Box<dyn Error>> {
    let Some(gpu) = gpu("a_prepass_changes_no_bit_and_costs_at_most_one_load_and_store") else { return Ok(()) };
    let plain = Settings { shadows: Some(ShadowSettings::texels(128)), ..Settings::DEFAULT };
    let occluded = Settings { occlusion: Some(OcclusionSettings::SAO), ..plain };
    let around = Settings { samples: 4, ..occluded };
    for (name, own) in
        [("boards", plain), ("boards", occluded), ("boards", around), ("materials", occluded), ("glass", plain)]
    {
        let scene = || if name == "boards" { Ok(boards()) } else { Scene::open(name, &mut progress::silent) };
        let size_px = [96, 64];
        let options = Options { inline: own.samples == 1, ..Options::for_frame(96, 64) };
        let shot = |prepass| Shot { size_px, options, ..Shot::small(Settings { prepass, ..own }) };
        let set = Set::of(&gpu, scene()?, &shot(true), &Background::Environment)?;
        let (with, drawn) = set.shoot(&gpu, &shot(true))?;
        let (without, left_out) = set.shoot(&gpu, &shot(false))?;
        assert!(with == without, "{name}, {} samples: the picture is another", own.samples);
        let (more, less) = (drawn.counts(), left_out.counts());
        let [passes, moved] = match (own.occlusion, own.samples) {
            (None, _) => [1, 0],
            (Some(_), 1) => [1, 1],
            _ => [0, 0],
        };
        assert_eq!(more.passes, less.passes + passes, "{name}");
        assert_eq!((more.unresolves, more.resolves), (less.unresolves + moved, less.resolves + moved), "{name}");
        let (more, less) = (drawn.traffic(size_px), left_out.traffic(size_px));
        // Depth has four bytes a texel.
        let moved_bytes = u64::from(moved * 4 * size_px[0] * size_px[1]);
        assert_eq!(more.loaded_bytes, less.loaded_bytes + moved_bytes, "{name}");
        assert_eq!(more.stored_bytes, less.stored_bytes + moved_bytes, "{name}");
        if moved == 0 {
            assert_eq!(drawn.memory().bytes, left_out.memory().bytes, "{name}");
        }
    }
    Ok(())
}
