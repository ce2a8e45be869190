//! Tests of `custom_pass`: effects against the CPU, counts of the plan, and the program as a process.

mod blur;
mod outline;
mod plan;
mod program;
mod steady;

use custom_pass::app::{App, Screen};
use custom_pass::engine::{Engine, EngineError};
use custom_pass::frame::Settings;
use framegraph_wgpu::{Pixels, read_texture};
use wgpu::{Instance, InstanceDescriptor, Texture, TextureFormat};

type TestResult = Result<(), Box<dyn std::error::Error>>;

const BOTH: Settings = Settings { blur: true, outline: true };
const NEITHER: Settings = Settings { blur: false, outline: false };
const GLOW: Settings = Settings { blur: true, outline: false };
const LINES: Settings = Settings { blur: false, outline: true };

/// Reports a skipped test with its reason.
fn skip(test: &str, why: &str) -> TestResult {
    test_report::skip(test, why);
    Ok(())
}

/// Runs `test` with an engine, or reports a skip without an adapter.
fn with_engine(name: &str, test: impl FnOnce(Engine) -> TestResult) -> TestResult {
    match Engine::open(&Instance::new(InstanceDescriptor::new_without_display_handle_from_env()), None) {
        Ok(engine) => test(engine),
        Err(why @ EngineError::NoAdapter(_)) => skip(name, &why.to_string()),
        Err(other) => Err(other.into()),
    }
}

/// Creates the engine with its graph.
fn app(engine: Engine, settings: Settings) -> Result<App, Box<dyn std::error::Error>> {
    Ok(App::new(engine, TextureFormat::Rgba8UnormSrgb, settings)?)
}

/// Renders the picture at `time_s`; the executed counts must equal the planned ones.
fn picture(app: &mut App, time_s: f32, image: &Texture) -> Result<Pixels, Box<dyn std::error::Error>> {
    app.draw(time_s, Screen::Texture(image))?;
    assert_eq!(app.frames.executor().executed(), app.frames.plan().counts());
    Ok(read_texture(app.frames.executor().gpu(), image)?)
}
