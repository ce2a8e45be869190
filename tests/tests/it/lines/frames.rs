//! Every kind of frame draws lines and points: presets, temporal and screen-space effects, long lists, shadows.

use super::{SIZE, TestResult, mesh, plain, put, radiance, scene, unlit};
use crate::stage::{Shot, gpu, lighting, view_of};
use framegraph::{Options, Plan, Scratch, Target, compile};
use framegraph_passes::feature_culling::{EffectSet, FactMemory};
use framegraph_passes::gpu_scene::indirect::LEAST_BATCHES;
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::stages::{Handles, Slot};
use framegraph_passes::{OcclusionSettings, Preset, ReflectionSettings, Settings, TaaSettings, World, stages};
use framegraph_scene::geometry::cuboid;
use framegraph_scene::{AlphaMode, Environment, Light, Material, Mesh, Scene, Topology, progress};
use framegraph_wgpu::{Frame, Imports, read_texture};
use glam::{DMat4, DVec2, DVec3, Vec3};
use tests::executors;
use tests::measure::facts::{Case, Drawn, Easel, SIZE_PX};

const BOTH: [Topology; 2] = [Topology::Lines, Topology::Points];

/// Returns a zigzag across the picture.
fn zigzag(topology: Topology) -> Mesh {
    let side = SIZE as f64;
    let places: Vec<DVec2> =
        (0..40).map(|i| DVec2::new(f64::from(i * 13 % 48), f64::from(i * 31 % 48)) / 48.0 * side).collect();
    mesh(topology, &places)
}

fn with_normals(own: Mesh) -> Mesh {
    Mesh { normals: vec![Vec3::Z; own.positions.len()], ..own }
}

/// Returns lines or points with every kind of material, with or without triangles.
fn every_kind(topology: Topology, triangles: bool) -> Scene {
    let mut scene = scene();
    let clay = Material::dielectric("clay", Vec3::new(0.8, 0.4, 0.2), 0.7);
    let masked = Material { alpha: AlphaMode::Mask { cutoff: 0.5 }, ..unlit(Vec3::ONE) };
    let blended = Material { alpha: AlphaMode::Blend, ..clay.clone() };
    put(&mut scene, with_normals(zigzag(topology)), clay.clone(), DVec3::ZERO);
    put(&mut scene, zigzag(topology), masked, DVec3::new(3.0, 1.0, 1.0));
    put(&mut scene, with_normals(zigzag(topology)), blended, DVec3::new(0.0, 2.0, 2.0));
    if triangles {
        put(&mut scene, cuboid(Vec3::splat(8.0)), clay, DVec3::NEG_Z * 10.0);
    }
    scene.lights.push(Light::directional("sun", Vec3::new(0.3, -0.4, -1.0).normalize(), 2e4));
    scene
}

/// Every preset draws points alone, and lines with triangles, after feature culling.
#[test]
fn every_preset_draws_lines_and_points() -> TestResult {
    let Some(gpu) = gpu("every_preset_draws_lines_and_points") else { return Ok(()) };
    let mut easel = Easel::new(&gpu);
    for preset in Preset::ALL {
        let asked = preset.frame().settings;
        if asked.samples > 1 && gpu.info().backend == wgpu::Backend::Gl {
            continue;
        }
        for (topology, triangles) in [(Topology::Points, false), (Topology::Lines, true)] {
            let scene = every_kind(topology, triangles);
            let case = |scene: Scene| {
                let asked = asked.for_scene(&scene, SIZE_PX);
                Case {
                    name: "lines",
                    scene,
                    nits: DVec3::splat(2000.0),
                    background: Background::None,
                    asked,
                    ev100: 10.5,
                    size_px: SIZE_PX,
                }
            };
            let mut bare = scene.clone();
            bare.instances.retain(|instance| bare.meshes[instance.mesh.index()].has_area());
            let mut pictures = Vec::new();
            for scene in [scene, bare] {
                let mut drawn = Drawn::new(&gpu, case(scene))?;
                let asked = drawn.case.asked;
                let settings = drawn.facts(&asked, EffectSet::NONE, &mut FactMemory::default()).apply(&asked);
                pictures.push(drawn.picture(&mut easel, &settings)?);
            }
            let pairs = pictures[0].chunks_exact(4).zip(pictures[1].chunks_exact(4));
            let seen = pairs.filter(|(a, b)| (0..3).any(|c| a[c].abs_diff(b[c]) > 8)).count();
            assert!(seen > 60, "{}, {}, {triangles}: {seen} pixels", preset.name(), topology.name());
        }
    }
    Ok(())
}

/// Screen-space and temporal effects work with lines and points: lit pixels stay where they are.
#[test]
fn effects_around_and_over_time_draw_lines_and_points() -> TestResult {
    let Some(gpu) = gpu("effects_around_and_over_time_draw_lines_and_points") else { return Ok(()) };
    for topology in BOTH {
        let scene = every_kind(topology, true);
        let lit = |settings| -> Result<Vec<bool>, Box<dyn std::error::Error>> {
            Ok(radiance(&gpu, &scene, settings)?.iter().map(|light| light.max_element() > 0.02).collect())
        };
        let expected = lit(plain(1, true, true))?;
        for settings in [
            Settings { occlusion: Some(OcclusionSettings::SAO), ..plain(1, true, true) },
            Settings { taa: Some(TaaSettings::DEFAULT), moving: true, ..plain(1, true, false) },
            Settings {
                occlusion: Some(OcclusionSettings::SAO),
                taa: Some(TaaSettings::DEFAULT),
                ..plain(1, false, true)
            },
            Settings { reflections: Some(ReflectionSettings::DEFAULT), ..plain(1, true, false) },
        ] {
            // The filter of temporal anti-aliasing spreads by one pixel.
            let found = lit(settings)?;
            let near = |lit: &[bool], at: usize| {
                let [x, y] = [at % SIZE, at / SIZE].map(|c| c.saturating_sub(1)..(c + 2).min(SIZE));
                y.flat_map(|y| x.clone().map(move |x| y * SIZE + x)).any(|at| lit[at])
            };
            let stray = |a: &[bool], b: &[bool]| (0..a.len()).filter(|at| a[*at] && !near(b, *at)).count();
            let apart = [stray(&found, &expected), stray(&expected, &found)];
            assert_eq!(apart, [0; 2], "{}: {settings:?}", topology.name());
        }
    }
    Ok(())
}

/// Lines and points cast no shadow: the wall behind them is unchanged where it is visible.
#[test]
fn lines_and_points_cast_no_shadow() -> TestResult {
    let Some(gpu) = gpu("lines_and_points_cast_no_shadow") else { return Ok(()) };
    for topology in BOTH {
        let with = |drawn: bool| {
            let mut scene = scene();
            let clay = Material::dielectric("clay", Vec3::splat(0.5), 0.7);
            put(&mut scene, cuboid(Vec3::new(20.0, 20.0, 1.0)), clay.clone(), DVec3::NEG_Z * 5.0);
            // A block that casts a shadow, so that there are maps.
            put(&mut scene, cuboid(Vec3::splat(2.0)), clay.clone(), DVec3::new(15.0, 15.0, 0.0));
            if drawn {
                put(&mut scene, with_normals(zigzag(topology)), clay, DVec3::ZERO);
            }
            scene.lights.push(Light::directional("sun", Vec3::new(0.8, -0.2, -1.0).normalize(), 2.0));
            radiance(&gpu, &scene, plain(1, true, true))
        };
        let (with, without) = (with(true)?, with(false)?);
        let darker = with.iter().zip(&without).filter(|(a, b)| a.x < 0.8 * b.x && b.x > 0.1).count();
        assert_eq!(darker, 0, "{}", topology.name());
        assert!(with != without, "{} are seen", topology.name());
    }
    Ok(())
}

/// Long lists use indirect draws, grouped by topology: the picture equals that of one draw per instance.
#[test]
fn long_lists_of_all_topologies_are_drawn_indirectly() -> TestResult {
    let Some(gpu) = gpu("long_lists_of_all_topologies_are_drawn_indirectly") else { return Ok(()) };
    let mut scene = scene();
    let mut places = Vec::new();
    let material = scene.add_material(unlit(Vec3::ONE));
    // One mesh each, so that no draws are shared.
    for i in 0..LEAST_BATCHES + 30 {
        let (x, y) = ((i * 7 % 45) as f64 + 1.5, (i * 11 % 45) as f64 + 1.5);
        let at = DVec2::new(x, y);
        let own = match i % 3 {
            0 => mesh(Topology::Points, &[at]),
            1 => mesh(Topology::Lines, &[at - DVec2::X * 0.9, at + DVec2::X * 0.9]),
            _ => {
                let corners =
                    mesh(Topology::Points, &[at + DVec2::new(-0.6, 0.6), at + DVec2::new(0.6, 0.6), at - DVec2::Y]);
                Mesh { topology: Topology::Triangles, ..with_normals(corners) }
            }
        };
        places.push((x as usize, y as usize));
        let own = scene.add_mesh(own);
        scene.add_instance("it", own, material, DMat4::IDENTITY);
    }
    let light = radiance(&gpu, &scene, plain(1, true, false))?;
    for (number, (x, y)) in places.into_iter().enumerate() {
        assert!(light[y * SIZE + x].x > 0.99, "instance {number} at {x}, {y}");
    }
    Ok(())
}

/// Moving lines and points have the correct velocity.
#[test]
fn lines_and_points_that_move_have_velocity() -> TestResult {
    let Some(gpu) = gpu("lines_and_points_that_move_have_velocity") else { return Ok(()) };
    let mut scene = scene();
    put(
        &mut scene,
        mesh(Topology::Lines, &[DVec2::new(4.0, 10.5), DVec2::new(30.0, 10.5)]),
        unlit(Vec3::ONE),
        DVec3::ZERO,
    );
    put(&mut scene, mesh(Topology::Points, &[DVec2::new(9.5, 20.5)]), unlit(Vec3::ONE), DVec3::ZERO);
    let size_px = [SIZE as u32; 2];
    let settings = Settings { taa: Some(TaaSettings::DEFAULT), moving: true, ..plain(1, true, false) };
    let settings = settings.for_scene(&scene, size_px);
    let shot = Shot { size_px, ev100: 0.0, settings, options: Options::for_frame(size_px[0], size_px[1]) };
    let light = lighting(&gpu, &Environment::uniform(DVec3::splat(0.1))?, &settings.shading)?;
    let before = view_of(&scene, &light.image, &Background::None, &shot);
    for instance in &mut scene.instances {
        instance.world_from_model = DMat4::from_translation(DVec3::new(6.0, 0.0, 0.0));
        instance.bounds = instance.bounds.transformed(&instance.world_from_model);
    }
    let view = view_of(&scene, &light.image, &Background::None, &shot).after(&before);
    let world = World::new(&gpu, &scene, light, [view], &mut progress::silent)?;
    let mut frame = Frame::<World>::new();
    let handles = stages(&settings).declare(&mut frame, Handles::default(), Target::New)?;
    let velocity = handles.find(Slot::VELOCITY).ok_or("something moves")?;
    frame.graph_mut().readback(velocity)?;
    let mut plan = Plan::new();
    compile(frame.graph(), &gpu.caps(), &shot.options, &mut Scratch::new(), &mut plan)?;
    let mut executor = executors::lend(&gpu);
    executor.execute(&plan, &frame, &world, &Imports::new())?;
    let found = read_texture(&gpu, executor.texture(&plan, velocity).ok_or("there is no velocity")?)?.rgba();
    for (x, y, moves) in [(20, 10, true), (15, 20, true), (9, 20, false), (20, 11, false), (6, 10, false)] {
        let [right, down, _, samples] = found[y * SIZE + x];
        // Velocity to the previous position: six pixels to the left; half floats.
        let way = if moves { -6.0 / SIZE as f32 } else { 0.0 };
        assert!((right - way).abs() < 1e-4 && down.abs() < 1e-4, "pixel {x}, {y}: {right} {down}");
        assert_eq!(samples > 0.0, moves, "pixel {x}, {y}");
    }
    Ok(())
}

/// Lines and points on a wall, with its normal, are lit like the wall: the normal bias moves them out of its shadow
/// map.
#[test]
fn lines_and_points_on_a_wall_are_lit_as_the_wall_is() -> TestResult {
    let Some(gpu) = gpu("lines_and_points_on_a_wall_are_lit_as_the_wall_is") else { return Ok(()) };
    let turned = DMat4::from_rotation_y(0.9) * DMat4::from_rotation_x(0.4);
    let picture = |topology: Option<Topology>| {
        let mut scene = scene();
        let clay = Material::dielectric("clay", Vec3::splat(0.5), 1.0);
        put(&mut scene, cuboid(Vec3::new(16.0, 16.0, 0.5)), clay, DVec3::ZERO);
        if let Some(topology) = topology {
            let own = with_normals(zigzag(topology));
            put(&mut scene, own, Material::dielectric("chalk", Vec3::splat(0.8), 1.0), DVec3::ZERO);
            scene.instances[1].world_from_model = DMat4::from_scale(DVec3::new(0.6, 0.6, 1.0));
            scene.instances[1].world_from_model.w_axis.z = 0.52;
        }
        for instance in &mut scene.instances {
            instance.world_from_model = turned * instance.world_from_model;
            instance.bounds = scene.meshes[instance.mesh.index()].bounds.transformed(&instance.world_from_model);
        }
        let along = turned.transform_vector3(DVec3::new(0.9, 0.3, -0.35)).normalize();
        scene.lights.push(Light::directional("sun", along.as_vec3(), 4.0));
        radiance(&gpu, &scene, plain(1, true, true))
    };
    let wall = picture(None)?;
    for topology in BOTH {
        let found = picture(Some(topology))?;
        let lit = |at: &usize| wall[*at].x > 0.1;
        let darker = (0..wall.len()).filter(lit).filter(|at| found[*at].x < 0.9 * wall[*at].x).count();
        // Negative control: their own albedo is visible.
        let brighter = (0..wall.len()).filter(lit).filter(|at| found[*at].x > 1.4 * wall[*at].x).count();
        assert!(darker == 0 && brighter > 15, "{}: {darker} darker, {brighter} brighter", topology.name());
    }
    Ok(())
}
