//! Stereo views: both eyes are two layers that one pass draws, with one shadow map and one culling.

use crate::stage::{gpu, lighting};
use framegraph::{Extent, Format, Options, Plan, Scratch, Target, Texture, TextureDesc, compile};
use framegraph_passes::gpu_scene::shadow_views::ShadowSettings;
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::{
    CameraView, Handles, PreparedScene, Settings, Slot, StageError, ViewId, ViewSettings, World, stages,
};
use framegraph_scene::environment::Sky;
use framegraph_scene::{Scene, progress};
use framegraph_wgpu::{Executor, Frame, Gpu, Imports, Readback, Subresource};
use std::error::Error;
use tests::compare::compare;

const SIZE: [u32; 2] = [64, 48];

/// Declares a view of one or two layers with shadow maps of the first view.
fn declared(settings: &Settings, view: ViewId, layers: u16) -> Result<(Frame<World>, Texture), StageError> {
    let mut frame = Frame::new();
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb).layers(layers);
    let output = frame.graph_mut().texture("output", desc);
    let handles = Handles::for_view(view, Extent::FRAME);
    let handles = if layers > 1 { handles.stereo() } else { handles };
    let picture = stages(settings).declare(&mut frame, handles, Target::from(output))?.get(Slot::PICTURE)?;
    frame.graph_mut().readback(picture)?;
    Ok((frame, picture))
}

/// Draws a frame. Returns the bytes of each layer.
fn drawn(
    gpu: &Gpu,
    world: &World,
    (frame, picture): &(Frame<World>, Texture),
    layers: u32,
) -> Result<(Vec<Vec<u8>>, Plan), Box<dyn Error>> {
    let (mut plan, mut executor) = (Plan::new(), Executor::new(gpu));
    let options = Options::for_frame(SIZE[0], SIZE[1]);
    compile(frame.graph(), &gpu.caps(), &options, &mut Scratch::new(), &mut plan)?;
    executor.execute(&plan, frame, world, &Imports::new())?;
    assert_eq!(executor.executed(), plan.counts(), "executed against planned");
    let texture = executor.texture(&plan, *picture).ok_or("the frame left no picture")?;
    let read = |layer| -> Result<_, Box<dyn Error>> {
        let part = Subresource { layer, ..Subresource::FIRST };
        Ok(Readback::start(gpu, texture, part)?.wait(gpu)?.bytes)
    };
    Ok(((0..layers).map(read).collect::<Result<_, _>>()?, plan))
}

/// Each layer equals the frame of a view that has the eye's matrices. The counts are those of one view.
#[test]
fn two_eyes_are_drawn_by_the_passes_of_one() -> Result<(), Box<dyn Error>> {
    let test = "two_eyes_are_drawn_by_the_passes_of_one";
    let (Some(gpu), Some(measured)) = (gpu(test), gpu(test)) else { return Ok(()) };
    let draws_both = measured.max_attached_layers()? > 1;
    gpu.trust_attached_layers();
    if gpu.max_attached_layers()? < 2 {
        test_report::skip(test, "the device has no multiview");
        return Ok(());
    }
    let scene = Scene::open("spheres", &mut progress::silent)?;
    let shadows = Some(ShadowSettings::texels(64));
    let settings = Settings { shadows, ..Settings::DEFAULT }.for_scene(&scene, SIZE).for_stereo();
    let lighting = lighting(&gpu, &Sky::default().environment(32)?, &settings.shading)?;
    let camera = scene.default_camera(f64::from(SIZE[0]) / f64::from(SIZE[1]));
    let seen = ViewSettings { camera, size_px: SIZE, shadows, ..ViewSettings::default() };
    let prepared = PreparedScene::new(&scene);
    let both = CameraView::stereo(&scene, &prepared, &lighting.image, &Background::Environment, &seen, 0.5);
    let eyes = both.eyes.ok_or("a stereo view has eyes")?;
    let alone = eyes.map(|eye| {
        let mut view = CameraView { eyes: None, ..both.clone() };
        (view.frame.clip_from_world, view.frame.camera) = (eye.clip_from_world, eye.camera);
        view.frame.world_from_clip = eye.clip_from_world.inverse();
        view
    });
    let views = [both].into_iter().chain(alone);
    let world = World::new(&gpu, &scene, lighting, views, &mut progress::silent)?;
    let (layers, plan) = drawn(&gpu, &world, &declared(&settings, ViewId(0), 2)?, 2)?;
    let of = |eye: u32| drawn(&gpu, &world, &declared(&settings, ViewId(1 + eye), 1)?, 1);
    let (left, right) = (of(0)?, of(1)?);
    let (two, one) = (plan.counts(), left.1.counts());
    assert_eq!((two.passes, two.steps, two.inlined), (one.passes, one.steps, one.inlined));
    assert_eq!((two.resolves, two.unresolves), (one.resolves, one.unresolves));
    assert_eq!(one.inlined, 1, "post-processing is part of shading");
    let difference = |a: &[u8], b: &[u8]| compare(a, b).map_or(u8::MAX, |found| found.largest_codes);
    // Negative control.
    assert!(difference(&left.0[0], &right.0[0]) > 20, "the eyes are 0.5 m apart");
    if !draws_both {
        test_report::skip(test, "the driver draws both eyes into the first layer; only counts are compared");
        return Ok(());
    }
    for (drawn, (alone, _)) in layers.iter().zip([left, right]) {
        assert!(difference(drawn, &alone[0]) <= 1, "{:?}", compare(drawn, &alone[0]));
    }
    Ok(())
}
