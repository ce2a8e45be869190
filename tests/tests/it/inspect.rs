//! Inspection of every resource in the standard frame, without side effects.

use crate::stage::{Shot, declared, gpu, lighting, view_of};
use framegraph::{Placement, Plan, Scratch, compile, dump};
use framegraph_passes::gpu_scene::shadow_views::ShadowSettings;
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::{Settings, World};
use framegraph_scene::environment::Sky;
use framegraph_scene::{Scene, progress};
use framegraph_wgpu::inspect::{DisplayMode, Inspector, all_targets};
use framegraph_wgpu::{Executor, Imports, read_texture};
use std::error::Error;

#[test]
fn every_version_of_the_standard_frame_is_seen() -> Result<(), Box<dyn Error>> {
    let Some(gpu) = gpu("every_version_of_the_standard_frame_is_seen") else { return Ok(()) };
    for (samples, fxaa) in [(1, true), (4, false), (4, true)] {
        let settings = Settings { samples, fxaa, shadows: Some(ShadowSettings::texels(256)), ..Settings::default() };
        let shot = Shot { size_px: [48, 27], ..Shot::small(settings) };
        let scene = Scene::open("spheres", &mut progress::silent)?;
        let environment = Sky::default().environment(64)?;
        let lighting = lighting(&gpu, &environment, &settings.shading)?;
        let view = view_of(&scene, &lighting.image, &Background::Environment, &shot);
        let near_m = scene.default_camera(16.0 / 9.0).projection.near_m() as f32;
        let world = World::new(&gpu, &scene, lighting, [view], &mut progress::silent)?;
        let (frame, io) = declared(&settings);
        let mut plan = Plan::new();
        let options = framegraph::Options::for_frame(48, 27);
        compile(frame.graph(), &gpu.caps(), &options, &mut Scratch::new(), &mut plan)?;
        let (mut executor, imports) = (Executor::new(&gpu), Imports::new());
        executor.execute(&plan, &frame, &world, &imports)?;
        let picture = |executor: &Executor| -> Result<Vec<u8>, Box<dyn Error>> {
            let texture = executor.texture(&plan, io.output).ok_or("no picture")?;
            Ok(read_texture(&gpu, texture)?.rgba8())
        };
        let (text, expected, made) = (dump::text(&plan), picture(&executor)?, executor.objects());

        let placed = |wanted: fn(&Placement) -> bool| plan.resources().iter().any(|r| wanted(&r.placement));
        assert!(placed(|p| *p == Placement::Memoryless), "something that never leaves the tile");
        assert!(placed(|p| *p == Placement::Inlined), "something that is nowhere");
        let mut inspector = Inspector::new(&gpu);
        let all = all_targets(&plan);
        let names: Vec<_> = all.iter().map(|s| s.name.as_str()).collect();
        for needed in ["shadow_map", "depth", "hdr", "output"] {
            assert!(names.contains(&needed), "{needed} is missing from {names:?}");
        }
        assert_eq!(names.contains(&"hdr_samples"), samples > 1);
        for seen in all {
            let found = inspector.inspect_target(&executor, &plan, &frame, &world, &imports, seen.clone())?;
            let title = found.title();
            let [width, height] = found.texels.size;
            let side = if seen.name == "shadow_map" { [256, 256] } else { [48, 27] };
            assert_eq!((found.texels.size, found.texels.bits.len()), (side, (width * height) as usize), "{title}");
            assert_eq!(found.texels.non_finite(4), 0, "{title}");
            let [low, high] =
                found.texels.display(DisplayMode::False { channel: Default::default(), range: None }, 1.0).range;
            assert!(low < high, "{title} is {low} everywhere");
            if seen.name == "output" {
                assert!(
                    found.texels.display(DisplayMode::Auto, near_m).rgba8 == expected,
                    "{title} is not the picture"
                );
            }
            if seen.name == "depth" {
                let distances = found.texels.distances_m(near_m).ok_or("no depths")?;
                // The spheres are a few meters away; the plane below extends farther.
                let [nearest, farthest] =
                    [f32::min, f32::max].map(|pick| distances.iter().copied().fold(distances[0], pick));
                assert!(nearest > near_m && farthest > 1.5 * nearest, "from {nearest} m to {farthest} m");
            }
        }

        assert_eq!(dump::text(&plan), text, "the plan under study");
        assert_eq!(executor.objects(), made, "what its executor holds");
        assert!(picture(&executor)? == expected, "the picture that was there");
        executor.execute(&plan, &frame, &world, &imports)?;
        assert!(picture(&executor)? == expected, "the next picture");
    }
    Ok(())
}
