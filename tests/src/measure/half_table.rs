//! Rows of the tables in `docs/measurements/half-floats.md`, printed by the program `shading_errors` and compared by tests.

use crate::compare::{Difference, compare};
use crate::executors;
use crate::measure::half::{Form, LobeError, lobe_error};
use crate::mirror;
use crate::stage::light_cache;
use framegraph::{Extent, Format, Options, Plan, Scratch, Target, TextureDesc, compile};
use framegraph_passes::gpu_scene::shadow_views::ShadowSettings;
use framegraph_passes::gpu_scene::view::{Background, ViewSettings};
use framegraph_passes::light::ibl::{DfgSettings, IblSettings};
use framegraph_passes::light::shading::LightSettings;
use framegraph_passes::{CameraView, Lighting, PostSettings, Precision, Settings, Shading, World, standard};
use framegraph_scene::environment::Sky;
use framegraph_scene::{Scene, progress};
use framegraph_shader_mirrors::cases::{self, Case, Deviation};
use framegraph_wgpu::Frame;
use framegraph_wgpu::{Gpu, Imports, read_texture};
use std::error::Error;

/// Points in each function's domain; a quarter are corners.
pub const POINTS: usize = 2048;
/// Samples of a lobe.
pub const SAMPLES: u32 = 4096;
/// Roughness of the lobes.
pub const ROUGHNESS: [f64; 5] = [0.03, 0.045, 0.089, 0.2, 0.5];
/// Built-in scenes of the pictures.
pub const SCENES: [&str; 5] = ["spheres", "columns", "materials", "lobes", "glass"];

/// Error of a function with an f16 build, against its f64 mirror.
#[derive(Clone, Debug)]
pub struct MirrorRow {
    /// File and function.
    pub name: String,
    /// Error in f32.
    pub full: Deviation,
    /// Error in f16, for inputs rounded to f16.
    pub half: Deviation,
}

/// Measures every function with an f16 build.
///
/// # Errors
/// The first function that exceeds its bound, or an error of the device.
pub fn mirrors(gpu: &Gpu) -> Result<Vec<MirrorRow>, Box<dyn Error>> {
    let row = |half: Case| {
        let full = cases::all().find(|case| (case.file, case.function) == (half.file, half.function));
        let full = full.ok_or("a half of nothing")?;
        let name = format!("{}::{}", half.file, half.function);
        let [full, half] = [mirror::compare(gpu, full, POINTS)?, mirror::compare(gpu, &half, POINTS)?];
        Ok(MirrorRow { name, full, half })
    };
    cases::half().map(row).collect()
}

/// Returns the errors of every form of the distribution at one roughness.
///
/// # Errors
/// The device fails.
pub fn lobes(gpu: &Gpu, roughness: f64) -> Result<[LobeError; Form::ALL.len()], Box<dyn Error>> {
    let mut errors = [LobeError { median: 0.0, p99: 0.0 }; Form::ALL.len()];
    for (error, form) in errors.iter_mut().zip(Form::ALL) {
        *error = lobe_error(gpu, form, roughness, SAMPLES)?;
    }
    Ok(errors)
}

/// A built-in scene under the default sky, rendered with several shading settings.
#[derive(Debug)]
pub struct Studio {
    world: World,
    settings: Settings,
    size_px: [u32; 2],
}

impl Studio {
    /// Loads a scene.
    ///
    /// # Errors
    /// The scene is unknown, or the device fails.
    pub fn new(gpu: &Gpu, scene: &str) -> Result<Self, Box<dyn Error>> {
        let size_px = [320, 180];
        // FXAA is off, since it would amplify small differences at edges.
        let post = PostSettings { dither: 0.0, ..PostSettings::DEFAULT };
        let settings =
            Settings { post, fxaa: false, shadows: Some(ShadowSettings::texels(1024)), ..Settings::default() };
        let scene = Scene::open(scene, &mut progress::silent)?;
        let environment = Sky::default().environment(128)?;
        let Shading { bands, visibility, .. } = settings.shading;
        let light = LightSettings {
            image: IblSettings { cube_texels: 64, bands, ..IblSettings::default() },
            dfg: DfgSettings { texels: 32, visibility },
        };
        let lighting = Lighting::new(gpu, &environment, &light, &light_cache(), &mut progress::silent)?;
        let moment = ViewSettings {
            camera: scene.default_camera(f64::from(size_px[0]) / f64::from(size_px[1])),
            size_px,
            shadows: settings.shadows,
            ..ViewSettings::default()
        };
        let view = CameraView::new(&scene, &lighting.image, &Background::Environment, &moment);
        let settings = settings.for_scene(&scene, size_px);
        let world = World::new(gpu, &scene, lighting, [view], &mut progress::silent)?;
        Ok(Self { world, settings, size_px })
    }

    /// Renders the scene with roughness of at least `floor`. Returns 8-bit display colors, four bytes per pixel.
    ///
    /// # Errors
    /// The device fails.
    pub fn shoot(&self, gpu: &Gpu, precision: Precision, floor: f32) -> Result<Vec<u8>, Box<dyn Error>> {
        // Specular anti-aliasing is off, since it would widen highlights regardless of the floor.
        let shading = Shading { precision, roughness_floor: floor, specular_aa: None, ..self.settings.shading };
        let mut frame = Frame::new();
        let output = frame.graph_mut().texture("output", TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb));
        let io = standard(&mut frame, &Settings { shading, ..self.settings }, Target::from(output))?;
        frame.graph_mut().readback(io.output)?;
        let mut plan = Plan::new();
        let options = Options::for_frame(self.size_px[0], self.size_px[1]);
        compile(frame.graph(), &gpu.caps(), &options, &mut Scratch::new(), &mut plan)?;
        let mut executor = executors::lend(gpu);
        executor.execute(&plan, &frame, &self.world, &Imports::new())?;
        let texture = executor.texture(&plan, io.output).ok_or("the frame left no picture")?;
        Ok(read_texture(gpu, texture)?.rgba8())
    }

    /// Compares f16 and f32, once with roughness of at least `floor` and once of at least 0.089.
    ///
    /// # Errors
    /// The device fails.
    pub fn difference(&self, gpu: &Gpu, floor: f32) -> Result<Difference, Box<dyn Error>> {
        let half = self.shoot(gpu, Precision::Half, Precision::Half.roughness_floor())?;
        let full = self.shoot(gpu, Precision::Full, floor)?;
        Ok(compare(&half, &full).ok_or("two pictures of one size")?)
    }
}
