//! Uniform environment light.

use crate::stage::{self, Shot};
use framegraph::{Plan, Scratch, compile};
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::{Settings, World};
use framegraph_scene::environment::EquirectMap;
use framegraph_scene::{Environment, Scene, progress};
use framegraph_wgpu::{Imports, read_texture};
use glam::{DVec3, Vec3};
use std::error::Error;
use tests::executors;

type TestResult = Result<(), Box<dyn Error>>;

/// Under uniform light, shading reads no cube. The picture equals the one with a cube, which holds powers of two
/// exactly, to one 8-bit step.
#[test]
fn even_light_is_shaded_without_the_cube() -> TestResult {
    let Some(gpu) = stage::gpu("even_light_is_shaded_without_the_cube") else { return Ok(()) };
    let nits = DVec3::new(4096.0, 2048.0, 1024.0);
    let shot = Shot { ev100: 11.0, ..Shot::small(Settings { shadows: None, ..Settings::DEFAULT }) };
    let scene = Scene::open("spheres", &mut progress::silent)?;
    let settings = shot.settings.for_scene(&scene, shot.size_px);
    let picture = |environment: &Environment| -> Result<(Vec<u8>, bool), Box<dyn Error>> {
        let lighting = stage::lighting(&gpu, environment, &settings.shading)?;
        let view = stage::view_of(&scene, &lighting.image, &Background::Constant(Vec3::ONE), &shot);
        let world = World::new(&gpu, &scene, lighting, [view], &mut progress::silent)?;
        let (frame, io) = stage::declared(&settings);
        let mut plan = Plan::new();
        compile(frame.graph(), &gpu.caps(), &shot.options, &mut Scratch::new(), &mut plan)?;
        let mut executor = executors::lend(&gpu);
        executor.execute(&plan, &frame, &world, &Imports::new())?;
        let texture = executor.texture(&plan, io.output).ok_or("the frame left no picture")?;
        let mapped = world.programs.made().iter().any(|program| program.name().contains("ENVIRONMENT_MAP"));
        Ok((read_texture(&gpu, texture)?.rgba8(), mapped))
    };
    let even = Environment::uniform(nits)?;
    let mut texels = even.map.texels().to_vec();
    texels[0][0] = f32::from_bits(texels[0][0].to_bits() + 1);
    let nearly = Environment { map: EquirectMap::new(even.map.width(), even.map.height(), texels), ..even.clone() };
    assert!(even.map.is_even() && !nearly.map.is_even());
    let ((own, with_cube), (other, by_cube)) = (picture(&even)?, picture(&nearly)?);
    assert!(!with_cube && by_cube);
    let most = own.iter().zip(&other).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(most <= Some(1), "{most:?} codes apart");
    Ok(())
}
