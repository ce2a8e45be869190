//! Frames with and without a depth prepass: the same picture to the bit, one pass less, and nothing loaded or stored for it.

use crate::stage::{Set, Shot, gpu};
use framegraph::Options;
use framegraph_passes::shadow::ShadowSettings;
use framegraph_passes::view::Background;
use framegraph_passes::{OcclusionSettings, Settings};
use framegraph_scene::geometry::{cuboid, plane};
use framegraph_scene::{AlphaMode, Material, Scene, progress};
use glam::{DMat4, DVec3, Vec2, Vec3};
use std::error::Error;

/// Boards and blocks with faces in one plane, of several colors and sides: of equally near ones the last is seen, unless it is masked
/// there, as all of the fifth is.
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

#[test]
fn a_prepass_changes_no_bit_and_moves_nothing() -> Result<(), Box<dyn Error>> {
    let Some(gpu) = gpu("a_prepass_changes_no_bit_and_moves_nothing") else { return Ok(()) };
    let plain = Settings { shadows: Some(ShadowSettings::texels(128)), ..Settings::DEFAULT };
    let around = Settings { occlusion: Some(OcclusionSettings::SAO), samples: 4, ..plain };
    for (name, own) in [("boards", plain), ("boards", around), ("materials", around), ("glass", plain)] {
        let scene = || if name == "boards" { Ok(boards()) } else { Scene::open(name, &mut progress::silent) };
        let size_px = [96, 64];
        let options = Options { inline: own.samples == 1, ..Options::for_frame(96, 64) };
        let shot = |prepass| Shot { size_px, options, ..Shot::small(Settings { prepass, ..own }) };
        let set = Set::of(&gpu, scene()?, &shot(true), &Background::Environment)?;
        let (with, drawn) = set.shoot(&gpu, &shot(true))?;
        let (without, left_out) = set.shoot(&gpu, &shot(false))?;
        assert!(with == without, "{name}, {} samples: the picture is another", own.samples);
        let (more, less) = (drawn.counts(), left_out.counts());
        assert_eq!((more.passes, more.resolves), (less.passes + 1, less.resolves), "{name}");
        assert_eq!(more.unresolves, less.unresolves, "{name}");
        assert_eq!(drawn.traffic(size_px), left_out.traffic(size_px), "{name}");
        assert_eq!(drawn.memory().bytes, left_out.memory().bytes, "{name}");
    }
    Ok(())
}
