//! Two views of one scene in one graph, with one shadow map and one upload.

use crate::stage::{gpu, lighting};
use framegraph::{
    DeclareError, Extent, Format, Intent, Options, Pass, PassBuilder, Plan, Scratch, Target, Texture, TextureDesc,
    compile,
};
use framegraph_passes::effects::shadow::shadow_maps;
use framegraph_passes::gpu_scene::shadow_views::ShadowSettings;
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::light::ibl::ImageLight;
use framegraph_passes::{CameraView, Handles, Settings, Slot, StageError, ViewId, ViewSettings, World, stages};
use framegraph_scene::environment::Sky;
use framegraph_scene::{Scene, progress};
use framegraph_wgpu::{Cx, Frame, Gpu, Imports, Record, RecordError, read_texture};
use glam::DVec3;
use std::error::Error;
use tests::compare::compare;
use tests::executors;

type TestResult = Result<(), Box<dyn Error>>;

/// Size of a view; the frame has two of them side by side.
const VIEW: [u32; 2] = [120, 90];
const HALF: Extent = Extent::absolute(VIEW[0], VIEW[1]);

/// Copies two pictures side by side.
struct SideBySide {
    halves: [Texture; 2],
}

impl Pass for SideBySide {
    type Io = ([framegraph::View; 2], Texture);

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Self::Io, DeclareError> {
        let [left, right] = self.halves;
        let both = pass.texture("both", TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb));
        let halves = [pass.copy_source(left)?, pass.copy_source(right)?];
        Ok((halves, pass.copy_target(both, Intent::Overwrite)?))
    }
}

impl<W: ?Sized> Record<W> for SideBySide {
    fn record(&self, (halves, both): &Self::Io, _: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let both = cx.texture_of(*both)?;
        for (index, half) in halves.iter().enumerate() {
            let half = cx.texture(*half)?;
            let mut place = both.as_image_copy();
            place.origin.x = index as u32 * VIEW[0];
            cx.encoder()?.copy_texture_to_texture(half.as_image_copy(), place, half.size());
        }
        Ok(())
    }
}

/// Returns the scene from its own camera, and from 0.7 m to the left, with shadow maps fitted to both.
fn views(scene: &Scene, light: &ImageLight, settings: &Settings) -> Vec<CameraView> {
    let camera = scene.default_camera(f64::from(VIEW[0]) / f64::from(VIEW[1]));
    let seen = [0.0, 0.7].map(|left_m| {
        let mut camera = camera.clone();
        camera.eye -= camera.world_from_view * DVec3::X * left_m;
        ViewSettings { camera, size_px: VIEW, shadows: settings.shadows, ..ViewSettings::default() }
    });
    CameraView::together(scene, light, &Background::Environment, &seen)
}

/// Declares both views with one shadow map, copied side by side.
fn both(settings: &Settings) -> Result<(Frame<World>, Texture), StageError> {
    let mut frame = Frame::new();
    let stages = stages(settings);
    let left = Handles::for_view(ViewId(0), HALF);
    let left = frame.scope("left", |frame| stages.declare(frame, left, Target::New))?;
    let right = Handles::for_view(ViewId(1), HALF).sharing_shadows(&left);
    let right = frame.scope("right", |frame| stages.declare(frame, right, Target::New))?;
    let halves = [left.get(Slot::PICTURE)?, right.get(Slot::PICTURE)?];
    let both = frame.add("side_by_side", SideBySide { halves })?.1;
    frame.graph_mut().readback(both)?;
    Ok((frame, both))
}

/// Declares one view alone, with a shadow map placed for view `shadow`.
fn alone(settings: &Settings, view: ViewId, shadow: ViewId) -> Result<(Frame<World>, Texture), StageError> {
    let mut frame = Frame::new();
    let maps = shadow_maps(&mut frame, shadow, &settings.shadows.unwrap_or_default())?;
    let maps = maps.expect("the settings have maps");
    let handles = Handles::for_view(view, Extent::FRAME).with_shadow_maps(Slot::SHADOW_MAP, maps);
    let picture = stages(settings).declare(&mut frame, handles, Target::New)?.get(Slot::PICTURE)?;
    frame.graph_mut().readback(picture)?;
    Ok((frame, picture))
}

fn render(
    gpu: &Gpu,
    world: &World,
    (frame, picture): &(Frame<World>, Texture),
    size: [u32; 2],
) -> Result<(Vec<u8>, Plan), Box<dyn Error>> {
    let mut plan = Plan::new();
    let options = Options::for_frame(size[0], size[1]);
    compile(frame.graph(), &gpu.caps(), &options, &mut Scratch::new(), &mut plan)?;
    let mut executor = executors::lend(gpu);
    executor.execute(&plan, frame, world, &Imports::new())?;
    assert_eq!(executor.executed(), plan.counts(), "executed against planned");
    let texture = executor.texture(&plan, *picture).ok_or("the frame left no picture")?;
    Ok((read_texture(gpu, texture)?.rgba8(), plan))
}

/// Returns the left or right half of a picture of two views.
fn half(both: &[u8], index: usize) -> Vec<u8> {
    let row = 4 * VIEW[0] as usize;
    both.chunks_exact(2 * row).flat_map(|line| &line[index * row..(index + 1) * row]).copied().collect()
}

/// With inlining, a single view has two steps besides the shadow (prepass, color and post; fxaa) and two stores (ldr
/// and picture). Two views have these twice, the shadow map once, and the copy.
#[test]
fn two_views_share_a_shadow_map_and_an_upload() -> TestResult {
    let Some(gpu) = gpu("two_views_share_a_shadow_map_and_an_upload") else { return Ok(()) };
    for samples in [1, 4] {
        let settings = Settings { samples, shadows: Some(ShadowSettings::texels(512)), ..Settings::DEFAULT };
        let scene = Scene::open("columns", &mut progress::silent)?;
        let lighting = lighting(&gpu, &Sky::default().environment(128)?, &settings.shading)?;
        let views = views(&scene, &lighting.image, &settings);
        // Meshes, materials and textures are uploaded once: the world has one `GpuScene` for all views.
        let world = World::new(&gpu, &scene, lighting, views, &mut progress::silent)?;

        let (picture, plan) = render(&gpu, &world, &both(&settings)?, [2 * VIEW[0], VIEW[1]])?;
        let one = render(&gpu, &world, &alone(&settings, ViewId(0), ViewId(0))?, VIEW)?.1.counts();
        let two = plan.counts();
        assert_eq!((one.steps, one.resolves, one.unresolves, one.passes), (3, 3, 0, 5));
        assert_eq!((two.steps, two.resolves, two.unresolves, two.passes), (1 + 2 * 2 + 1, 1 + 2 * 2, 0, 1 + 2 * 4 + 1));
        assert_eq!((two.inlined, two.memoryless), (2 * one.inlined, 2 * one.memoryless));
        let graph = plan.graph();
        let maps = graph.pass_ids().filter(|pass| graph.pass_name(*pass).ends_with("shadow")).count();
        assert_eq!(maps, 1);

        // Each half equals the view's own frame with the first view's shadow map, bit for bit.
        let halves = [half(&picture, 0), half(&picture, 1)];
        for (index, half) in halves.iter().enumerate() {
            let own = render(&gpu, &world, &alone(&settings, ViewId(index as u32), ViewId(0))?, VIEW)?.0;
            assert!(*half == own, "{samples} samples: view {index} differs from its own frame");
        }
        assert_ne!(halves[0], halves[1], "the cameras stand apart");
        // With its own shadow map, positions are rounded differently, so a texel at a shadow's edge may change. A
        // thousandth of the picture is two such texels seen from nearby.
        let own = render(&gpu, &world, &alone(&settings, ViewId(1), ViewId(1))?, VIEW)?.0;
        let differing = halves[1].chunks_exact(4).zip(own.chunks_exact(4)).filter(|(a, b)| a != b).count();
        println!("{samples} samples: {differing} texels differ: {:?}", compare(&halves[1], &own));
        assert!(differing * 1000 <= own.len() / 4, "{differing} texels differ");
    }
    Ok(())
}

/// A pass of a missing view is an error that names it.
#[test]
fn a_view_that_is_missing_is_named() -> TestResult {
    let Some(gpu) = gpu("a_view_that_is_missing_is_named") else { return Ok(()) };
    let settings = Settings { shadows: Some(ShadowSettings::texels(64)), ..Settings::DEFAULT };
    let scene = Scene::open("spheres", &mut progress::silent)?;
    let lighting = lighting(&gpu, &Sky::default().environment(128)?, &settings.shading)?;
    let view = views(&scene, &lighting.image, &settings).into_iter().take(1);
    let world = World::new(&gpu, &scene, lighting, view, &mut progress::silent)?;
    let told = render(&gpu, &world, &both(&settings)?, [2 * VIEW[0], VIEW[1]]).map(drop).map_err(|e| e.to_string());
    let told = told.err().unwrap_or_default();
    assert!(told.contains("`right/prepass`") && told.contains("view 1") && told.contains("there are 1"), "{told}");
    Ok(())
}
