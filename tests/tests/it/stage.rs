//! The standard frame in tests: planning without a device, drawing with one.

use framegraph::{Caps, Extent, Format, Options, Plan, Scratch, Target, Texture, TextureDesc, compile};
use framegraph_passes::gpu_scene::lighting::LightingError;
use framegraph_passes::gpu_scene::view::{Background, ViewSettings};
use framegraph_passes::light::ibl::{DfgSettings, IblSettings, ImageLight};
use framegraph_passes::light::shading::LightSettings;
use framegraph_passes::{CameraView, FrameIo, Lighting, Precision, Settings, Shading, World, standard};
use framegraph_scene::environment::Sky;
use framegraph_scene::{Environment, Scene, progress};
use framegraph_wgpu::Frame;
use framegraph_wgpu::{AdapterRequest, Gpu, Imports, read_texture};
use std::error::Error;
use tests::executors;
use tests::stage::light_cache;

/// Declares the standard frame with a readback of its picture.
pub fn declared(settings: &Settings) -> (Frame<World>, FrameIo) {
    let mut frame = Frame::new();
    frame.allow_threads();
    let output = frame.graph_mut().texture("output", TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb));
    let io = standard(&mut frame, settings, Target::from(output)).expect("the standard frame is sound");
    frame.graph_mut().readback(io.output).unwrap();
    (frame, io)
}

/// Plans the frame for a device.
pub fn plan(settings: &Settings, caps: &Caps, options: &Options) -> Plan {
    let mut plan = Plan::new();
    let (frame, _) = declared(settings);
    compile(frame.graph(), caps, options, &mut Scratch::new(), &mut plan).expect("the standard frame compiles");
    plan
}

/// Returns the best adapter, or reports `test` as skipped.
pub fn gpu(test: &str) -> Option<Gpu> {
    match Gpu::open(&AdapterRequest::from_env()) {
        Ok(gpu) => {
            test_report::adapter(&gpu.describe());
            Some(gpu)
        }
        Err(error) => {
            test_report::skip(test, &error.to_string());
            None
        }
    }
}

/// Returns the precisions that the device supports; reports a skip for the others.
pub fn precisions(test: &str, gpu: &Gpu) -> Vec<Precision> {
    let has = |precision: &Precision| match precision.check(gpu) {
        Ok(()) => true,
        Err(error) => {
            test_report::skip(test, &error.to_string());
            false
        }
    };
    Precision::ALL.into_iter().filter(has).collect()
}

/// Settings of a picture other than the scene.
#[derive(Clone, Copy, Debug)]
pub struct Shot {
    pub size_px: [u32; 2],
    pub ev100: f32,
    pub settings: Settings,
    pub options: Options,
}

impl Shot {
    /// Returns a small picture in daylight.
    pub fn small(settings: Settings) -> Self {
        let size_px = [160, 90];
        Self { size_px, ev100: 14.5, settings, options: Options::for_frame(size_px[0], size_px[1]) }
    }
}

/// A scene under the default sky, on the GPU, which can be rendered repeatedly.
pub struct Set {
    world: World,
    scene: Scene,
}

impl Set {
    /// Loads a built-in scene with the shot's size, exposure and shadows.
    pub fn new(gpu: &Gpu, scene: &str, shot: &Shot, background: &Background) -> Result<Self, Box<dyn Error>> {
        Self::of(gpu, Scene::open(scene, &mut progress::silent)?, shot, background)
    }

    /// Uploads a scene with the shot's size, exposure and shadows.
    pub fn of(gpu: &Gpu, scene: Scene, shot: &Shot, background: &Background) -> Result<Self, Box<dyn Error>> {
        let environment = Sky::default().environment(128)?;
        let lighting = lighting(gpu, &environment, &shot.settings.shading)?;
        let view = view_of(&scene, &lighting.image, background, shot);
        let world = World::new(gpu, &scene, lighting, [view], &mut progress::silent)?;
        Ok(Self { world, scene })
    }

    /// Returns the data that passes read.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// Returns the data that passes read, for changes.
    pub fn world_mut(&mut self) -> &mut World {
        &mut self.world
    }

    /// Renders the scene. Returns 8-bit display values, four bytes per pixel, and the plan.
    pub fn shoot(&self, gpu: &Gpu, shot: &Shot) -> Result<(Vec<u8>, Plan), Box<dyn Error>> {
        let (frame, io) = declared(&shot.settings.for_scene(&self.scene, shot.size_px));
        self.render(gpu, &frame, io.output, &shot.options)
    }

    /// Renders a frame and reads one of its pictures back. Checks that execution matches the plan.
    pub fn render(
        &self,
        gpu: &Gpu,
        frame: &Frame<World>,
        picture: Texture,
        options: &Options,
    ) -> Result<(Vec<u8>, Plan), Box<dyn Error>> {
        let mut plan = Plan::new();
        let mut executor = executors::lend(gpu);
        executor.compile(frame.graph(), options, &mut Scratch::new(), &mut plan)?;
        executor.execute(&plan, frame, &self.world, &Imports::new())?;
        assert_eq!(executor.executed(), plan.counts(), "executed against planned");
        let texture = executor.texture(&plan, picture).ok_or("the frame left no picture")?;
        Ok((read_texture(gpu, texture)?.rgba8(), plan))
    }
}

/// Computes image-based light at the lowest resolution.
pub fn lighting(gpu: &Gpu, environment: &Environment, shading: &Shading) -> Result<Lighting, LightingError> {
    let settings = LightSettings {
        image: IblSettings {
            cube_texels: 64,
            bands: shading.bands,
            format: shading.environment_format,
            ..IblSettings::default()
        },
        dfg: DfgSettings { texels: 32, visibility: shading.table },
    };
    Lighting::new(gpu, environment, &settings, &light_cache(), &mut progress::silent)
}

/// Returns the view of a shot.
pub fn view_of(scene: &Scene, light: &ImageLight, background: &Background, shot: &Shot) -> CameraView {
    let Shot { size_px: [width, height], ev100, settings, .. } = *shot;
    let camera = scene.default_camera(f64::from(width) / f64::from(height));
    let moment = ViewSettings {
        camera,
        size_px: settings.drawn_px([width, height]),
        ev100,
        shadows: settings.shadows,
        ..ViewSettings::default()
    };
    CameraView::new(scene, light, background, &moment)
}

/// Renders a built-in scene under the default sky. Returns 8-bit display values, four bytes per pixel.
pub fn picture(gpu: &Gpu, scene: &str, shot: &Shot) -> Result<Vec<u8>, Box<dyn Error>> {
    Ok(Set::new(gpu, scene, shot, &Background::Environment)?.shoot(gpu, shot)?.0)
}
