//! From the command line to a scene, its light and its view; shows what it is doing.

use crate::args::Args;
use glam::DVec3;
use passes::view::{Background, ViewSettings};
use passes::world::WorldError;
use passes::{View, World};
use renderer::scene::environment::Sky;
use renderer::scene::{Environment, LightKind, Progress, Scene, SceneError};
use renderer::wgpu::Gpu;
use shaders::reference::sky::Preetham;
use std::io::{IsTerminal, Write};
use std::ops::ControlFlow;

/// Width of the map that a clear sky is evaluated into: it has no detail that more would show.
const SKY_MAP_TEXELS: u32 = 512;

/// A scene with what lights it.
pub struct Loaded {
    /// The scene.
    pub scene: Scene,
    /// What lights it from all around.
    pub environment: Environment,
    /// What stands behind it.
    pub background: Background,
}

/// Loads what the command line names.
///
/// # Errors
/// One line that names the file and the reason.
pub fn load(args: &Args) -> Result<Loaded, SceneError> {
    let mut shown = Shown::new();
    let scene = Scene::open(&args.scene, &mut |p| shown.show(p))?;
    let (environment, background) = match &args.environment {
        Some(path) => (Environment::load(path, &mut |p| shown.show(p))?, Background::Environment),
        None => clear_sky()?,
    };
    shown.done();
    for warning in scene.warnings.iter().chain(&environment.warnings) {
        eprintln!("warning: {warning}");
    }
    Ok(Loaded { scene, environment, background })
}

fn clear_sky() -> Result<(Environment, Background), SceneError> {
    let sky = Sky::default();
    let environment = sky.environment(SKY_MAP_TEXELS)?;
    let sun_lux = environment.sun.as_ref().map_or(DVec3::ZERO, |sun| match sun.kind {
        LightKind::Directional { illuminance_lux, .. } => sun.color.as_dvec3() * f64::from(illuminance_lux),
        _ => DVec3::ZERO,
    });
    let model = Preetham::new(sky.toward_sun, sky.turbidity, sky.ground_albedo, sun_lux);
    Ok((environment, Background::ClearSky(model)))
}

/// The view that the command line asks for.
///
/// # Errors
/// When the scene has no camera of that name.
pub fn view(args: &Args, loaded: &Loaded) -> Result<ViewSettings, SceneError> {
    let [width, height] = args.size_px;
    let aspect = f64::from(width) / f64::from(height);
    let camera = match &args.camera {
        Some(choice) => choice.resolve(&loaded.scene, aspect)?,
        None => loaded.scene.default_camera(aspect),
    };
    Ok(ViewSettings {
        camera,
        size_px: args.size_px,
        ev100: args.ev100.unwrap_or_else(|| metered(loaded)),
        environment_intensity: 1.0,
        shadow_map_texels: args.shadows.then_some(2048),
        frame_index: 0,
    })
}

/// The exposure value that shows a white card as white: lit by half the sphere of the environment, and by the sun at 60°
/// from its normal. Its luminance is E / π, and 1 / (1.2 · 2^EV100) of that is to be 1.
fn metered(loaded: &Loaded) -> f32 {
    let sky_lux = std::f64::consts::PI * loaded.environment.average_luminance_nits();
    let directional = |kind: LightKind| match kind {
        LightKind::Directional { illuminance_lux, .. } => f64::from(illuminance_lux),
        _ => 0.0,
    };
    let own = loaded.environment.sun.iter().map(|sun| directional(sun.kind)).sum::<f64>();
    let suns =
        if own > 0.0 { own } else { loaded.scene.lights.iter().map(|l| directional(l.kind)).fold(0.0, f64::max) };
    let nits = (sky_lux + 0.5 * suns) / std::f64::consts::PI;
    if nits > 0.0 { (nits / 1.2).log2() as f32 } else { 0.0 }
}

/// Copies what was loaded to the device.
///
/// # Errors
/// One line that names the file and the reason.
pub fn upload(gpu: &Gpu, loaded: &Loaded, moment: View) -> Result<World, WorldError> {
    let mut shown = Shown::new();
    let world = World::new(gpu, &loaded.scene, &loaded.environment, moment, &mut |p| shown.show(p))?;
    shown.done();
    world.scene.warnings.iter().for_each(|warning| eprintln!("warning: {warning}"));
    Ok(world)
}

/// Progress on standard error: one line that is written over on a terminal, a line for each stage elsewhere.
struct Shown {
    terminal: bool,
    last: String,
}

impl Shown {
    fn new() -> Self {
        Self { terminal: std::io::stderr().is_terminal(), last: String::new() }
    }

    fn show(&mut self, progress: Progress<'_>) -> ControlFlow<()> {
        let Progress { stage, done, total, item } = progress;
        let mut err = std::io::stderr().lock();
        // What cannot be shown must not stop the load.
        if self.terminal {
            let _ = write!(err, "\r\x1b[K{stage} {done}/{total} {item}");
            let _ = err.flush();
        } else if done == total && self.last != stage.to_string() {
            let _ = writeln!(err, "{stage}: {total}");
            self.last = stage.to_string();
        }
        ControlFlow::Continue(())
    }

    fn done(&self) {
        if self.terminal {
            eprint!("\r\x1b[K");
        }
    }
}
