//! Loading of a scene and its light in the background.

use super::capture::{BackgroundSource, Sun};
use crate::job::Handle;
use framegraph_passes::feature_culling::SceneSummary;
use framegraph_passes::gpu_scene::upload::{GpuScene, block_formats};
use framegraph_passes::gpu_scene::view::{Background, ViewSettings};
use framegraph_passes::light::ibl::cache::Cache;
use framegraph_passes::light::shading::LightSettings;
use framegraph_passes::{CameraView, LightSearch, Lighting, PreparedScene, World};
use framegraph_scene::environment::{Sky, SunExtraction};
use framegraph_scene::{Environment, Light, LightKind, LoadOptions, Progress, Scene};
use framegraph_wgpu::Gpu;
use glam::{DVec3, Vec3};
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;

/// Width of the environment map of a clear sky, in texels. A larger map would add no detail.
const SKY_MAP_TEXELS: u32 = 512;

/// Source of the environment light.
#[derive(Clone, Debug, PartialEq)]
pub enum EnvironmentSource {
    /// Clear sky with the direction toward its sun; `None` for a clear afternoon.
    Sky(Option<DVec3>),
    /// Equirectangular picture or cube map.
    File(PathBuf),
}

impl std::fmt::Display for EnvironmentSource {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Sky(_) => f.write_str("clear sky"),
            Self::File(path) => path.display().fmt(f),
        }
    }
}

/// Image-based light on the device.
pub struct Lit {
    /// Source of the light.
    pub environment: EnvironmentSource,
    /// Settings of the light.
    pub settings: LightSettings,
    /// The light, with the sun of the environment.
    pub lighting: Lighting,
    /// Sun of the environment.
    pub sun: Option<Light>,
    /// Visible background.
    pub background: Background,
    /// Metered exposure value at ISO 100.
    pub metered_ev100: f32,
    /// Warnings, one line each.
    pub warnings: Vec<String>,
}

/// Scene on the device with its CPU data.
pub struct Loaded {
    /// Requested name: a built-in scene or a path.
    pub name: String,
    /// Scene without the texels of its images.
    pub scene: Scene,
    /// All lights of the scene; those of `scene` depend on the selected sun.
    pub lights: Vec<Light>,
    /// Summary of the materials for feature culling.
    pub survey: Arc<SceneSummary>,
    /// Scene data for views.
    pub prepared: PreparedScene,
    /// Scene and light on the device.
    pub world: World,
    /// Sun of the environment.
    pub sun: Option<Light>,
    /// Source of the environment light.
    pub environment: EnvironmentSource,
    /// Settings of the light.
    pub light_settings: LightSettings,
    /// Visible background.
    pub background: Background,
    /// Metered exposure value at ISO 100.
    pub metered_ev100: f32,
    /// True if meshes have levels of detail.
    pub levels: bool,
    /// Selected material variant.
    pub variant: Option<String>,
}

/// Loads a scene with a material variant, its light, and levels of detail if required. Also returns warnings, one line
/// each.
///
/// # Errors
/// One line that names the file and the reason; also after cancellation.
pub fn load(
    gpu: &Gpu,
    name: &str,
    source: &EnvironmentSource,
    settings: &LightSettings,
    (levels, variant): (bool, Option<String>),
    handle: &Handle,
) -> Result<(Loaded, Vec<String>), String> {
    let options = LoadOptions { variant, block_formats: block_formats(gpu), ..LoadOptions::default() };
    let mut scene = Scene::open_with(name, &options, &mut |p| report(handle, p)).map_err(|e| e.to_string())?;
    scene.check().map_err(|error| format!("{name}: {error}"))?;
    if scene.instances.is_empty() {
        return Err(format!("{name}: the scene has no mesh; open another one"));
    }
    if levels {
        scene.make_levels(&mut |p| report(handle, p)).map_err(|e| e.to_string())?;
    }
    let Lit { environment, settings, lighting, sun, background, metered_ev100, mut warnings } =
        light(gpu, &scene, source, settings, handle)?;
    warnings.splice(0..0, scene.warnings.iter().cloned());
    let uploaded = GpuScene::upload_freeing(gpu, &mut scene, &options.memory, &mut |p| report(handle, p));
    let uploaded = uploaded.map_err(|e| e.to_string())?;
    warnings.extend(uploaded.warnings.iter().cloned());
    let prepared = PreparedScene::new(&scene);
    let first = ViewSettings {
        camera: scene.default_camera(1.0),
        size_px: [1, 1],
        ev100: metered_ev100,
        shadows: None,
        lights: LightSearch::All,
        ..ViewSettings::default()
    };
    let view = CameraView::prepared(&scene, &prepared, &lighting.image, &background, &first);
    let world = World::of(gpu, uploaded, lighting, [view]).map_err(|e| e.to_string())?;
    let (lights, survey) = (scene.lights.clone(), Arc::new(SceneSummary::new(&scene)));
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
        environment,
        light_settings,
        background,
        metered_ev100,
        levels,
        variant: options.variant,
    };
    Ok((loaded, warnings))
}

/// Creates image-based light.
///
/// # Errors
/// One line that names the file and the reason; also after cancellation.
pub fn light(
    gpu: &Gpu,
    scene: &Scene,
    source: &EnvironmentSource,
    settings: &LightSettings,
    handle: &Handle,
) -> Result<Lit, String> {
    let mut environment = match source {
        EnvironmentSource::File(path) => {
            let loaded = Environment::load_with(path, &LoadOptions::default(), &mut |p| report(handle, p));
            loaded.map_err(|e| e.to_string())?
        }
        EnvironmentSource::Sky(toward) => sky(scene, *toward).environment(SKY_MAP_TEXELS).map_err(|e| e.to_string())?,
    };
    let background = match source {
        EnvironmentSource::Sky(toward) => Background::clear_sky(&sky(scene, *toward)),
        EnvironmentSource::File(_) => Background::Environment,
    };
    let mut warnings = environment.warnings.clone();
    // A sun inside the map casts no shadow, and prefiltering cannot represent it.
    if let extraction @ SunExtraction::Extracted { .. } = environment.extract_sun() {
        warnings.push(format!("{}: {extraction}", environment.name));
    }
    let metered_ev100 = environment.metered_ev100(scene);
    let lighting = Lighting::new(gpu, &environment, settings, &Cache::from_env(), &mut |p| report(handle, p));
    let lighting = lighting.map_err(|e| e.to_string())?;
    warnings.extend(lighting.warnings().map(str::to_owned));
    let sun = environment.sun;
    Ok(Lit { environment: source.clone(), settings: *settings, lighting, sun, background, metered_ev100, warnings })
}

/// Returns the clear sky over the ground of a scene.
fn sky(scene: &Scene, toward: Option<DVec3>) -> Sky {
    let usual = Sky::default();
    let ground_albedo = scene.ground_albedo.map_or(usual.ground_albedo, |albedo| albedo.as_dvec3());
    // A sun at or below the horizon leaves the default sky.
    let toward_sun = toward.filter(|toward| toward.y > 0.01).unwrap_or(usual.toward_sun);
    Sky { toward_sun, ground_albedo, ..usual }
}

impl Loaded {
    /// Replaces the light.
    pub fn relight(&mut self, lit: Lit) {
        let Lit { environment, settings, lighting, sun, background, metered_ev100, .. } = lit;
        (self.environment, self.light_settings, self.world.lighting) = (environment, settings, lighting);
        (self.sun, self.background, self.metered_ev100) = (sun, background, metered_ev100);
    }

    /// Selects the sun.
    pub fn set_sun(&mut self, sun: Sun, turned_rad: f64) {
        let is_sun = |light: &Light| matches!(light.kind, LightKind::Directional { .. });
        self.world.lighting.image.sun = sun.light(self.sun.as_ref(), turned_rad);
        self.scene.lights = self.lights.clone();
        if sun == Sun::Off {
            self.scene.lights.retain(|light| !is_sun(light));
        }
    }

    /// Returns the visible background.
    pub fn background(&self, source: BackgroundSource) -> Background {
        match source {
            BackgroundSource::Environment => self.background.clone(),
            BackgroundSource::Constant(nits) => Background::Constant(Vec3::from_array(nits)),
        }
    }
}

/// Reports progress and stops the work after cancellation.
fn report(handle: &Handle, progress: Progress<'_>) -> ControlFlow<()> {
    handle.step(progress.done as u64, progress.total as u64);
    if handle.is_cancelled() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}
