//! Frames of [`SceneLoop`] while the camera moves, compared with the same frames drawn by hand.

use crate::stage::gpu;
use framegraph::{Entry, Exit, Extent, Format, Target, TextureDesc};
use framegraph_passes::effects::reflection::ReflectionSettings;
use framegraph_passes::effects::taa::TaaSettings;
use framegraph_passes::frame::scene_loop::SceneLoop;
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::{CameraView, FrameIndex, Settings, ViewId, ViewSettings, standard};
use framegraph_scene::environment::Sky;
use framegraph_scene::{Scene, progress};
use framegraph_wgpu::{FrameLoop, texture_2d, wgpu};
use glam::DVec3;
use std::error::Error;

const SIZE_PX: [u32; 2] = [96, 54];
const FRAMES: u32 = 6;

/// Returns the view of a frame of a camera that moves to the right.
fn panned(first: &ViewSettings, index: u32) -> ViewSettings {
    let mut view = first.clone();
    view.camera.eye += view.camera.world_from_view * DVec3::X * 0.15 * f64::from(index);
    view
}

/// Draws the frames with views made here, and returns the last one. `follows` reprojects from the previous frame.
fn by_hand(shown: &mut SceneLoop, first: &ViewSettings, follows: bool) -> Result<Vec<u8>, Box<dyn Error>> {
    let gpu = shown.gpu.clone();
    let mut frames = FrameLoop::new(&gpu);
    let settings = shown.settings.for_scene(&shown.scene, SIZE_PX);
    let [width, height] = SIZE_PX;
    let texture = gpu.device.create_texture(&texture_2d(
        "by hand",
        [width, height],
        wgpu::TextureFormat::Rgba8UnormSrgb,
        wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
    ));
    let world = &mut shown.world;
    for index in 0..FRAMES {
        let seen = panned(first, index);
        let mut view = CameraView::new(&shown.scene, &world.lighting.image, &Background::Environment, &seen);
        if follows && index > 0 {
            view = view.after(&world.views.get(ViewId::MAIN)?.view.clone());
        }
        if let Some(taa) = &settings.taa {
            view.jitter(taa.jitter_px(index));
        }
        world.set_view(&gpu, ViewId::MAIN, view)?;
        world.frame_index = FrameIndex(index);
        let ran = frames.run(SIZE_PX, world, |frame, imports| {
            let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb);
            let picture = frame.graph_mut().import_texture("picture", desc, Entry::Undefined, Exit::Keep);
            imports.texture(picture, &texture);
            standard(frame, &settings, Target::from(picture))
        })?;
        assert!(ran.is_some());
    }
    Ok(framegraph_wgpu::read_texture(&gpu, &texture)?.rgba8())
}

/// Returns the mean difference of two pictures, in 8-bit steps.
fn steps(a: &[u8], b: &[u8]) -> f64 {
    a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>() / a.len() as f64
}

/// A panning camera with temporal anti-aliasing and reflections: the pictures are those of views that follow each other.
/// Views that assume the same camera in the previous frame differ, which shows that the comparison has something to find.
#[test]
fn a_moving_camera_is_reprojected() -> Result<(), Box<dyn Error>> {
    let Some(gpu) = gpu("a_moving_camera_is_reprojected") else { return Ok(()) };
    let scene = Scene::open("columns", &mut progress::silent)?;
    let mut shown = SceneLoop::on(&gpu, scene, &Sky::default().environment(16)?, SIZE_PX)?;
    let plain = Settings { shadows: None, fxaa: false, ..Settings::DEFAULT };
    let (taa, reflections) = (Some(TaaSettings::DEFAULT), Some(ReflectionSettings::DEFAULT));
    for settings in
        [Settings { taa, ..plain }, Settings { reflections, ..plain }, Settings { taa, reflections, ..plain }]
    {
        shown.settings = settings;
        shown.world.frame_index = FrameIndex(0);
        shown.frames = FrameLoop::new(&gpu);
        let first = shown.view().clone();
        for index in 0..FRAMES {
            shown.set_view(panned(&first, index))?;
            assert!(shown.draw()?);
        }
        let found = shown.pixels()?.rgba8();
        let [following, unmoved] = [by_hand(&mut shown, &first, true)?, by_hand(&mut shown, &first, false)?];
        let off = steps(&found, &unmoved);
        println!("{off:.3} 8-bit steps from frames that assume a still camera");
        assert!(found == following, "{} 8-bit steps from frames by hand", steps(&found, &following));
        // 0.01 with reflections alone: few pixels of the columns mirror the picture.
        assert!(off > 0.005, "{off} 8-bit steps");
        shown.set_view(first)?;
    }
    Ok(())
}
