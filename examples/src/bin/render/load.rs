//! Loads the scene, its light and its view from the command line, with progress output.

use crate::args::Args;
use crate::light::{BackgroundSource, EnvironmentSource, Sun};
use crate::run::{Failure, device, input};
use framegraph_passes::gpu_scene::lighting::LightingError;
use framegraph_passes::gpu_scene::upload::GpuScene;
use framegraph_passes::gpu_scene::view::{Background, ViewSettings};
use framegraph_passes::light::ibl::cache::Cache;
use framegraph_passes::{CameraView, Lighting, World};
use framegraph_scene::environment::{Sky, SunExtraction};
use framegraph_scene::{ColorTable, Environment, Light, LightKind, LoadOptions, Progress, Scene, SceneError};
use framegraph_wgpu::Gpu;
use program::interrupt;
use program::progress::Shown;
use std::ops::ControlFlow;
use std::path::PathBuf;

/// Width of the environment map of a clear sky, in texels. A larger map would add no detail.
const SKY_MAP_TEXELS: u32 = 512;

/// Scene with its environment and background.
pub struct Loaded {
    /// The scene.
    pub scene: Scene,
    /// Environment light.
    pub environment: Environment,
    /// Visible background.
    pub background: Background,
    /// Metered exposure value at ISO 100, without the environment intensity.
    pub metered_ev100: f32,
}

/// Loads the color lookup table of `--look`.
///
/// # Errors
/// One line that names the file, the line and the reason.
pub fn colors(args: &Args) -> Result<Option<ColorTable>, String> {
    let load = |file: &PathBuf| ColorTable::load(file).map_err(|error| format!("--look: {error}"));
    let colors = args.grade.color_table.as_ref().map(load).transpose()?;
    colors.iter().flat_map(|colors| &colors.warnings).for_each(|warning| warn(warning));
    Ok(colors)
}

/// Loads the scene and the environment.
///
/// # Errors
/// One line that names the file and the reason.
pub fn load(args: &Args, options: &LoadOptions) -> Result<Loaded, SceneError> {
    let mut shown = Shown::default();
    let mut scene = Scene::open_with(&args.scene, options, &mut |p| show(&mut shown, p))?;
    if args.frame.lod_error_px > 0.0 {
        scene.make_levels(&mut |p| show(&mut shown, p))?;
    }
    let asked = &args.lighting;
    let mut environment = match &asked.environment {
        EnvironmentSource::File(path) => Environment::load_with(path, options, &mut |p| show(&mut shown, p))?,
        EnvironmentSource::Uniform(nits) => Environment::uniform(*nits)?,
        EnvironmentSource::Sky => sky(args, &scene).environment(SKY_MAP_TEXELS)?,
    };
    let background = match (&asked.environment, asked.background) {
        (_, BackgroundSource::Constant(nits)) => Background::Constant(nits.as_vec3()),
        (EnvironmentSource::Sky, _) | (_, BackgroundSource::Sky) => Background::clear_sky(&sky(args, &scene)),
        (_, BackgroundSource::Environment) => Background::Environment,
    };
    // A sun inside the map casts no shadow, and prefiltering cannot represent it.
    let extraction = if asked.sun == Sun::InMap { SunExtraction::Apart } else { environment.extract_sun() };
    let own = matches!(extraction, SunExtraction::Extracted { .. }) && asked.sun == Sun::FromScene;
    match asked.sun {
        Sun::FromScene | Sun::InMap => {}
        Sun::Off => {
            environment.sun = None;
            scene.lights.retain(|light| !matches!(light.kind, LightKind::Directional { .. }));
        }
        Sun::Custom { toward, illuminance_lux, diameter_deg } => {
            environment.sun = Some(Light {
                kind: LightKind::Directional {
                    illuminance_lux: illuminance_lux as f32,
                    angular_radius_rad: (0.5 * diameter_deg).to_radians() as f32,
                },
                ..Light::directional("sun", -toward.as_vec3(), 0.0)
            });
        }
    }
    for sun in scene.lights.iter_mut().chain(&mut environment.sun) {
        sun.halo = asked.disk.halo(sun.halo);
    }
    let metered_ev100 = environment.metered_ev100(&scene);
    shown.clear();
    if own {
        program::note(format_args!("{}: {extraction}", environment.name));
        // An extracted sun scales with its environment.
        environment.sun = environment.sun.map(|sun| times(sun, asked.intensity));
    }
    for warning in scene.warnings.iter().chain(&environment.warnings) {
        warn(warning);
    }
    Ok(Loaded { scene, environment, background, metered_ev100 })
}

/// Returns a directional light with `factor` times the illuminance.
fn times(mut light: Light, factor: f32) -> Light {
    if let LightKind::Directional { illuminance_lux, .. } = &mut light.kind {
        *illuminance_lux *= factor;
    }
    light
}

/// Returns the clear sky for a custom sun above the horizon, over the ground of the scene.
fn sky(args: &Args, scene: &Scene) -> Sky {
    let usual = Sky::default();
    let ground_albedo = scene.ground_albedo.map_or(usual.ground_albedo, |albedo| albedo.as_dvec3());
    match args.lighting.sun {
        Sun::Custom { toward, .. } if toward.y > 0.0 => Sky { toward_sun: toward, ground_albedo, ..usual },
        _ => Sky { ground_albedo, ..usual },
    }
}

/// Returns the view settings of the command line.
///
/// # Errors
/// The named camera does not exist, or `--camera-from-gltf` is set and the scene has no camera.
pub fn view(args: &Args, loaded: &Loaded) -> Result<ViewSettings, String> {
    let [width, height] = args.size_px;
    let aspect = f64::from(width) / f64::from(height);
    let mut camera = match (&args.camera, args.camera_from_gltf) {
        (Some(choice), _) => choice.resolve(&loaded.scene, aspect).map_err(|error| error.to_string())?,
        (None, false) => loaded.scene.default_camera(aspect),
        (None, true) => match loaded.scene.cameras.first() {
            Some(first) => first.clone(),
            None => return Err(format!("--camera-from-gltf: `{}` has no camera", args.scene)),
        },
    };
    camera.projection = camera.projection.unstretched(aspect);
    let shadows = args.shadows.of(&loaded.scene, loaded.environment.sun.as_ref(), camera.eye);
    Ok(ViewSettings {
        camera,
        size_px: args.frame.settings.drawn_px(args.size_px),
        ev100: args.lighting.ev100.unwrap_or(loaded.metered_ev100),
        environment_intensity: args.lighting.intensity,
        shadows,
        lights: args.frame.lights,
        lod_error_px: args.frame.lod_error_px,
        visible_layers: args.frame.visible_layers,
    })
}

/// Prefilters the environment, or loads the result from the cache.
///
/// # Errors
/// One line that names the failure.
pub fn light(gpu: &Gpu, args: &Args, loaded: &Loaded) -> Result<Lighting, LightingError> {
    let mut shown = Shown::default();
    let settings = args.frame.settings.shading.light(args.frame.quality);
    let lighting =
        Lighting::new(gpu, &loaded.environment, &settings, &Cache::from_env(), &mut |p| show(&mut shown, p))?;
    shown.clear();
    lighting.warnings().for_each(warn);
    Ok(lighting)
}

/// Uploads the scene and frees its images.
///
/// # Errors
/// One line that names the file and the reason.
pub fn upload(
    gpu: &Gpu,
    loaded: &mut Loaded,
    options: &LoadOptions,
    lighting: Lighting,
    view: CameraView,
) -> Result<World, Failure> {
    let mut shown = Shown::default();
    let scene = &mut loaded.scene;
    let scene = GpuScene::upload_freeing(gpu, scene, &options.memory, &mut |p| show(&mut shown, p)).map_err(input)?;
    shown.clear();
    scene.warnings.iter().for_each(|warning| warn(warning));
    World::of(gpu, scene, lighting, [view]).map_err(device)
}

fn warn(warning: &str) {
    program::note(format_args!("warning: {warning}"));
}

/// Shows a step of the work and stops it after a signal.
fn show(shown: &mut Shown, Progress { stage, done, total, item }: Progress<'_>) -> ControlFlow<()> {
    shown.step(stage, done, total, item);
    interrupt::flow()
}
