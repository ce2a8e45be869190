//! Loading a scene with its light, on a thread of its own.

use super::look::{Behind, Sun};
use crate::job::Handle;
use framegraph_passes::facts::Survey;
use framegraph_passes::ibl::cache::Cache;
use framegraph_passes::shading::LightSettings;
use framegraph_passes::upload::{GpuScene, block_formats};
use framegraph_passes::view::{Background, ViewSettings};
use framegraph_passes::{CameraView, LightSearch, Lighting, PreparedScene, World};
use framegraph_scene::environment::{Sky, SunExtraction};
use framegraph_scene::{Environment, Light, LightKind, LoadOptions, Progress, Scene};
use framegraph_wgpu::Gpu;
use glam::{DVec3, Vec3};
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;

/// Width of the map that a clear sky is evaluated into: it has no detail that more would show.
const SKY_MAP_TEXELS: u32 = 512;

/// What lights a scene from all around.
#[derive(Clone, Debug, PartialEq)]
pub enum Around {
    /// A clear sky, with its sun there; that of a clear afternoon where none is given.
    Sky(Option<DVec3>),
    /// An equirectangular picture, or a cube.
    File(PathBuf),
}

impl std::fmt::Display for Around {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Sky(_) => f.write_str("clear sky"),
            Self::File(path) => path.display().fmt(f),
        }
    }
}

/// Light from all around, on the device.
pub struct Lit {
    /// What it was made of.
    pub around: Around,
    /// What it was made with.
    pub settings: LightSettings,
    /// The light, with the environment's own sun.
    pub lighting: Lighting,
    /// The environment's own sun.
    pub sun: Option<Light>,
    /// What is seen behind the scene.
    pub background: Background,
    /// The exposure value for this light.
    pub metered_ev100: f32,
    /// What was repaired, a line each.
    pub warnings: Vec<String>,
}

/// A scene on the device, with what is known of it on the CPU.
pub struct Loaded {
    /// As it was asked for: a built-in name, or a path.
    pub name: String,
    /// The scene, without the texels of its images.
    pub scene: Scene,
    /// Its lights; those of `scene` change with the sun that is asked for.
    pub lights: Vec<Light>,
    /// What facts know of its surfaces.
    pub survey: Arc<Survey>,
    /// What views read of it.
    pub prepared: PreparedScene,
    /// On the device, with its light.
    pub world: World,
    /// The environment's own sun.
    pub sun: Option<Light>,
    /// What lights it.
    pub around: Around,
    /// What its light was made with.
    pub light_settings: LightSettings,
    /// What is seen behind it.
    pub background: Background,
    /// The exposure value for its light.
    pub metered_ev100: f32,
    /// Its meshes have levels of detail.
    pub levels: bool,
    /// The material variant that is shown.
    pub variant: Option<String>,
}

/// Loads a scene with a material variant, its light, and levels of detail where settings ask for them. The second value has
/// the warnings, a line each.
///
/// # Errors
/// One line that names the file and the reason; also when the work was cancelled.
pub fn load(
    gpu: &Gpu,
    name: &str,
    around: &Around,
    settings: &LightSettings,
    (levels, variant): (bool, Option<String>),
    handle: &Handle,
) -> Result<(Loaded, Vec<String>), String> {
    let options = LoadOptions { variant, block_formats: block_formats(gpu), ..LoadOptions::default() };
    let mut scene = Scene::open_with(name, &options, &mut |p| told(handle, p)).map_err(|e| e.to_string())?;
    scene.check().map_err(|error| format!("{name}: {error}"))?;
    if scene.instances.is_empty() {
        return Err(format!("{name}: the scene shows nothing: it has no mesh in it"));
    }
    if levels {
        scene.make_levels(&mut |p| told(handle, p)).map_err(|e| e.to_string())?;
    }
    let Lit { around, settings, lighting, sun, background, metered_ev100, mut warnings } =
        light(gpu, &scene, around, settings, handle)?;
    warnings.splice(0..0, scene.warnings.iter().cloned());
    let uploaded = GpuScene::upload_freeing(gpu, &mut scene, &options.memory, &mut |p| told(handle, p));
    let uploaded = uploaded.map_err(|e| e.to_string())?;
    warnings.extend(uploaded.warnings.iter().cloned());
    let prepared = PreparedScene::new(&scene);
    let first = ViewSettings {
        camera: scene.default_camera(1.0),
        size_px: [1, 1],
        ev100: metered_ev100,
        environment_intensity: 1.0,
        shadows: None,
        lights: LightSearch::All,
        lod_error_px: 0.0,
    };
    let view = CameraView::prepared(&scene, &prepared, &lighting.image, &background, &first);
    let world = World::of(gpu, uploaded, lighting, [view]).map_err(|e| e.to_string())?;
    let (lights, survey) = (scene.lights.clone(), Arc::new(Survey::new(&scene)));
    let name = name.to_owned();
    let light_settings = settings;
    let loaded = Loaded {
        name,
        scene,
        lights,
        survey,
        prepared,
        world,
        sun,
        around,
        light_settings,
        background,
        metered_ev100,
        levels,
        variant: options.variant,
    };
    Ok((loaded, warnings))
}

/// Makes light from all around a scene.
///
/// # Errors
/// As [`load`].
pub fn light(
    gpu: &Gpu,
    scene: &Scene,
    around: &Around,
    settings: &LightSettings,
    handle: &Handle,
) -> Result<Lit, String> {
    let mut environment = match around {
        Around::File(path) => {
            let loaded = Environment::load_with(path, &LoadOptions::default(), &mut |p| told(handle, p));
            loaded.map_err(|e| e.to_string())?
        }
        Around::Sky(toward) => sky(scene, *toward).environment(SKY_MAP_TEXELS).map_err(|e| e.to_string())?,
    };
    let background = match around {
        Around::Sky(toward) => Background::clear_sky(&sky(scene, *toward)),
        Around::File(_) => Background::Environment,
    };
    let mut warnings = environment.warnings.clone();
    // The sun of a map is light without a shadow, and what filters the map cannot hold it.
    if let extraction @ SunExtraction::Extracted { .. } = environment.extract_sun() {
        warnings.push(format!("{}: {extraction}", environment.name));
    }
    let metered_ev100 = environment.metered_ev100(scene);
    let lighting = Lighting::new(gpu, &environment, settings, &Cache::from_env(), &mut |p| told(handle, p));
    let lighting = lighting.map_err(|e| e.to_string())?;
    warnings.extend(lighting.warnings().map(str::to_owned));
    let sun = environment.sun;
    Ok(Lit { around: around.clone(), settings: *settings, lighting, sun, background, metered_ev100, warnings })
}

/// The clear sky over the ground of a scene.
fn sky(scene: &Scene, toward: Option<DVec3>) -> Sky {
    let usual = Sky::default();
    let ground_albedo = scene.ground_albedo.map_or(usual.ground_albedo, |albedo| albedo.as_dvec3());
    // A sun at the horizon or below it leaves the sky as it is.
    let toward_sun = toward.filter(|toward| toward.y > 0.01).unwrap_or(usual.toward_sun);
    Sky { toward_sun, ground_albedo, ..usual }
}

impl Loaded {
    /// The files of the scene and of its light: nothing is written over them.
    pub fn files(&self) -> impl Iterator<Item = &PathBuf> {
        let around = if let Around::File(file) = &self.around { Some(file) } else { None };
        self.scene.files.iter().chain(around)
    }

    /// Takes other light.
    pub fn relight(&mut self, lit: Lit) {
        let Lit { around, settings, lighting, sun, background, metered_ev100, .. } = lit;
        (self.around, self.light_settings, self.world.lighting) = (around, settings, lighting);
        (self.sun, self.background, self.metered_ev100) = (sun, background, metered_ev100);
    }

    /// Sets the sun that shines.
    pub fn set_sun(&mut self, sun: Sun, turned_rad: f64) {
        let is_sun = |light: &Light| matches!(light.kind, LightKind::Directional { .. });
        self.world.lighting.image.sun = sun.light(self.sun.as_ref(), turned_rad);
        self.scene.lights = self.lights.clone();
        if sun == Sun::Off {
            self.scene.lights.retain(|light| !is_sun(light));
        }
    }

    /// What is seen behind the scene.
    pub fn background(&self, behind: Behind) -> Background {
        match behind {
            Behind::Environment => self.background.clone(),
            Behind::Constant(nits) => Background::Constant(Vec3::from_array(nits)),
        }
    }
}

/// Tells a step of the work, and asks it to stop once nobody waits for it.
fn told(handle: &Handle, progress: Progress<'_>) -> ControlFlow<()> {
    handle.step(progress.done as u64, progress.total as u64);
    if handle.is_cancelled() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}
