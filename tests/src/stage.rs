//! A scene on a device, drawn repeatedly by the standard frame.

use framegraph::{Extent, Format, Target, Texture, TextureDesc};
use framegraph_passes::gpu_scene::view::{Background, ViewSettings};
use framegraph_passes::light::ibl::cache::Cache;
use framegraph_passes::light::ibl::{DfgSettings, IblSettings};
use framegraph_passes::light::shading::LightSettings;
use framegraph_passes::{CameraView, Lighting, PreparedScene, Settings, StageError, ViewId, World, standard};
use framegraph_scene::{Environment, Scene, progress};
use framegraph_wgpu::{FrameLoop, Gpu};
use glam::{DVec3, Vec3};
use std::error::Error;
use std::path::PathBuf;
use std::sync::OnceLock;
use std::time::UNIX_EPOCH;

/// Returns the cache of precomputed light of this build: a folder in the target folder, never the user's own. A new
/// build starts with an empty cache, so that tests notice changes in the code that computes light.
#[must_use]
pub fn light_cache() -> Cache {
    static CACHE: OnceLock<Cache> = OnceLock::new();
    CACHE.get_or_init(|| own_folder().map_or_else(|_| Cache::off(), Cache::at)).clone()
}

fn own_folder() -> std::io::Result<PathBuf> {
    let program = std::env::current_exe()?;
    let built = program.metadata()?.modified()?.duration_since(UNIX_EPOCH).unwrap_or_default().as_nanos();
    let all = program.with_extension("light");
    let own = all.join(built.to_string());
    if !own.exists() {
        // Remove the caches of earlier builds.
        let _ = std::fs::remove_dir_all(&all);
    }
    Ok(own)
}

/// A scene with its resources, under a uniform sky.
pub struct Stage {
    scene: Scene,
    prepared: PreparedScene,
    /// Data that passes read.
    pub world: World,
}

impl Stage {
    /// Creates a built-in scene.
    ///
    /// # Errors
    /// The scene cannot be created.
    pub fn new(gpu: &Gpu, name: &str) -> Result<Self, Box<dyn Error>> {
        let scene = Scene::open(name, &mut progress::silent)?;
        let prepared = PreparedScene::new(&scene);
        let shading = Settings::DEFAULT.shading;
        let image = IblSettings { cube_texels: 64, bands: shading.bands, ..IblSettings::default() };
        let light = LightSettings { image, dfg: DfgSettings { texels: 32, visibility: shading.table } };
        let even = Environment::uniform(DVec3::splat(2000.0))?;
        let lighting = Lighting::new(gpu, &even, &light, &light_cache(), &mut progress::silent)?;
        let first = view(&scene, &prepared, &lighting, &Settings::DEFAULT, [64, 36]);
        let world = World::new(gpu, &scene, lighting, [first], &mut progress::silent)?;
        Ok(Self { scene, prepared, world })
    }

    /// Draws a frame of `frames` with a new view, and returns its picture. With temporal anti-aliasing, `number`
    /// selects the jitter.
    ///
    /// # Errors
    /// Any error of the frame.
    pub fn draw(
        &mut self,
        frames: &mut FrameLoop<World>,
        settings: &Settings,
        size_px: [u32; 2],
        number: u32,
    ) -> Result<Texture, Box<dyn Error>> {
        let Self { scene, prepared, world } = self;
        let gpu = frames.executor().gpu().clone();
        let drawn_px = settings.drawn_px(size_px);
        let settings = settings.for_scene(scene, drawn_px);
        let mut seen = view(scene, prepared, &world.lighting, &settings, drawn_px);
        if let Some(taa) = &settings.taa {
            seen.jitter(taa.jitter_px(number));
        }
        world.set_view(&gpu, ViewId::MAIN, seen)?;
        let ran = frames.run(size_px, world, |frame, _| {
            let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb);
            let output = frame.graph_mut().texture("output", desc);
            let io = standard(frame, &settings, Target::from(output))?;
            frame.graph_mut().readback(io.output).map_err(StageError::from)?;
            Ok::<_, StageError>(io.output)
        })?;
        Ok(ran.ok_or("a picture without texels")?.io)
    }
}

fn view(
    scene: &Scene,
    prepared: &PreparedScene,
    lighting: &Lighting,
    settings: &Settings,
    size_px: [u32; 2],
) -> CameraView {
    let seen = ViewSettings {
        camera: scene.default_camera(f64::from(size_px[0]) / f64::from(size_px[1])),
        size_px,
        ev100: 12.0,
        shadows: settings.shadows,
        ..ViewSettings::default()
    };
    CameraView::prepared(scene, prepared, &lighting.image, &Background::Constant(Vec3::ONE), &seen)
}
