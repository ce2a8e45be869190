//! Live frame next to its plan: the standard frame of `framegraph_passes`, drawn on the device of the window.
//!
//! | file | content |
//! | --- | --- |
//! | `screen.rs` | the device, and registration of textures with egui |
//! | `loading.rs` | a scene and its light, loaded in the background |
//! | `shown.rs`, `relighting.rs` | the displayed scene; new light after changes |
//! | `capture.rs`, `factors.rs`, `camera.rs` | exposure, lens, light and animation; edited materials; the interactive camera |
//! | `frame.rs` | the frame, executed repeatedly |
//! | `settings_panel.rs`, `file_request.rs` | state of the settings panel; file dialogs that panels request |
//! | `driving.rs`, `drawing.rs` | when and on which thread frames are drawn, and the state of that |
//! | `times.rs` | frame times for the views |
//! | `preview.rs`, `bisecting.rs` | contents of textures; bisection of debug modes |
//! | `panel/` | the panels |

pub mod bisecting;
pub mod camera;
pub mod capture;
mod drawing;
mod driving;
pub mod factors;
pub mod file_request;
pub mod frame;
pub mod loading;
pub mod panel;
pub mod preview;
mod relighting;
pub mod screen;
pub mod settings_panel;
mod shown;
#[cfg(test)]
mod tests;
mod times;

use crate::history::History;
use crate::job::Job;
use crate::session::Session;
use bisecting::Bisecting;
use camera::Rig;
use capture::Document;
use file_request::FileRequest;
use frame::{DrawOptions, Running};
use loading::{EnvironmentSource, Lit, Loaded};
use preview::Preview;
use program::input;
use program::outputs::Outputs;
use screen::Screen;
use shown::{LightRequest, Shown};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Frames drawn after a change: feature culling settles in eight, histories and temporal effects soon after.
const AFTER_CHANGE: u32 = 16;
/// Frames drawn after a change with temporal anti-aliasing.
const AFTER_CHANGE_TAA: u32 = 48;

/// Result of a job.
type JobResult<T> = Result<T, String>;

/// Live frame with all its settings.
pub struct Live {
    screen: Screen,
    wake: Arc<dyn Fn() + Send + Sync>,
    /// Running frame; `None` until the scene is loaded.
    pub running: Option<Running>,
    /// Interactive camera; `None` until the scene is loaded.
    pub rig: Option<Rig>,
    /// Settings and capture with undo and redo.
    pub history: History<Document>,
    /// Debug modes and animation state.
    pub options: DrawOptions,
    /// Draws continuously, even without changes.
    pub continuous: bool,
    /// Fraction of the viewport's pixels drawn along each side.
    pub share: f32,
    /// Texture preview.
    pub preview: Preview,
    /// File dialog that a panel requests.
    pub file_request: Option<FileRequest>,
    /// Index of the material being edited.
    pub material: Option<usize>,
    /// Running bisection of debug modes.
    pub bisecting: Option<Bisecting>,
    /// Typed budget limits.
    pub budget: String,
    /// Typed path of a settings file.
    pub path: String,
    /// State of the settings panel.
    pub settings: settings_panel::SettingsPanel,
    loading: Option<Job<JobResult<(Loaded, Vec<String>)>>>,
    relighting: Option<(Job<JobResult<Lit>>, LightRequest)>,
    /// Light that the user stopped or that failed.
    declined: Option<LightRequest>,
    /// Displayed scene; `None` until it is loaded.
    shown: Option<Shown>,
    wanted: EnvironmentSource,
    /// Number of frames still to draw.
    left: u32,
    reported_plans: u64,
    drawn_with: (Document, framegraph_wgpu::debug::Modes),
    refused: Option<String>,
    times_at: Option<Instant>,
    clock: times::Clock,
    size_px: [u32; 2],
    drawing: drawing::Drawing,
}

impl Live {
    /// Starts loading a scene: a built-in name or a path. Other threads call `wake` when a result is available.
    pub fn new(
        screen: Screen,
        document: Document,
        scene: &str,
        environment: Option<&Path>,
        wake: impl Fn() + Send + Sync + 'static,
    ) -> Self {
        let wanted = environment.map_or(EnvironmentSource::Sky(None), |path| EnvironmentSource::File(path.to_owned()));
        let mut live = Self {
            screen,
            wake: Arc::new(wake),
            running: None,
            rig: None,
            history: History::new(document),
            options: DrawOptions::default(),
            continuous: false,
            share: 1.0,
            preview: Preview::default(),
            file_request: None,
            material: None,
            bisecting: None,
            budget: String::new(),
            path: String::new(),
            settings: settings_panel::SettingsPanel::default(),
            loading: None,
            relighting: None,
            declined: None,
            shown: None,
            wanted,
            left: AFTER_CHANGE,
            reported_plans: 0,
            drawn_with: Default::default(),
            refused: None,
            times_at: None,
            clock: times::Clock::default(),
            size_px: [0; 2],
            drawing: drawing::Drawing::default(),
        };
        live.load(scene);
        live
    }

    /// Loads a scene in the background. The displayed scene stays until loading succeeds.
    pub fn load(&mut self, name: &str) {
        let shown = self.shown.as_ref().filter(|shown| shown.name == name);
        let variant = shown.and_then(|shown| shown.variant.clone());
        self.load_variant(name, variant);
    }

    /// Loads a scene with a material variant, like [`load`](Self::load).
    pub fn load_variant(&mut self, name: &str, variant: Option<String>) {
        let (gpu, name, environment) = (self.screen.gpu.clone(), name.to_owned(), self.wanted.clone());
        let (settings, levels) = (self.light_settings(), self.document().frame.lod_error_px > 0.0);
        let wake = self.wake.clone();
        self.relighting = None;
        self.loading = Some(Job::start(
            format!("loading {name}"),
            move || wake(),
            move |handle| loading::load(&gpu, &name, &environment, &settings, (levels, variant), handle),
        ));
    }

    /// Opens a scene, an environment or a settings file by its extension; returns false for other files.
    pub fn open(&mut self, path: &Path, session: &mut Session) -> bool {
        let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        match ending.as_deref() {
            Some("gltf" | "glb") => self.load(&path.to_string_lossy()),
            Some("hdr" | "exr" | "ktx" | "ktx2") => self.set_environment(Some(path.to_owned())),
            Some("ron") => {
                let name = path.to_string_lossy();
                let says_frame = || input::text(path, input::MAX_TEXT_BYTES).is_ok_and(|t| t.contains("frame: ("));
                match crate::standard_frame::settings(&name) {
                    Ok(frame) => self.set(Document { frame, ..self.document().clone() }, false),
                    // Graphs also end in `.ron`. Only settings files report their errors.
                    Err(_) if !says_frame() => return false,
                    Err(error) => session.say(error),
                }
            }
            _ => return false,
        }
        true
    }

    /// Returns the current settings and capture.
    pub fn document(&self) -> &Document {
        self.history.now()
    }

    /// Changes settings and capture. While `going_on` is set, such as during a drag, all changes form one undo step.
    pub fn set(&mut self, document: Document, going_on: bool) {
        self.history.set(document, going_on);
        self.again();
    }

    /// Draws more frames after a change.
    pub fn again(&mut self) {
        let over_time = self.document().frame.settings.taa.is_some();
        self.left = if over_time { AFTER_CHANGE_TAA } else { AFTER_CHANGE };
        self.refused = None;
    }

    /// Returns the description and progress of the background work.
    pub fn doing(&self) -> Option<(&str, Option<f32>)> {
        let loading = self.loading.as_ref().map(|job| (job.doing.as_str(), job.progress()));
        let relighting = || self.relighting.as_ref().map(|(job, _)| (job.doing.as_str(), job.progress()));
        loading.or_else(relighting).or_else(|| self.drawing.doing())
    }

    /// Returns whether [`cancel`](Self::cancel) has an effect. Drawing can be cancelled only while pipelines are compiled
    /// or debug modes are compared.
    pub fn can_cancel(&self) -> bool {
        self.loading.is_some() || self.relighting.is_some() || self.drawing.can_stop()
    }

    /// Cancels the background work and keeps the displayed frame with its light. Pipelines that are being compiled are
    /// finished, and the settings that need them are undone.
    pub fn cancel(&mut self) {
        let loading = self.loading.take().is_some();
        if !self.stop_relighting() && !loading {
            self.drawing.stop();
        }
    }

    /// Applies finished background work and advances the animation.
    pub fn tick(&mut self, session: &mut Session, passed_s: f32) {
        self.collect(session, Duration::ZERO);
        if let Some((job, result)) = self.loading.as_ref().and_then(|job| Some((job, job.poll()?))) {
            let failure = job.failure();
            self.loading = None;
            match result {
                Ok(Ok((loaded, warnings))) => {
                    self.preview = Preview::default();
                    self.bisecting = None;
                    self.wanted = loaded.environment.clone();
                    (self.shown, self.declined) = (Some(Shown::of(&loaded)), None);
                    let mut capture = self.document().capture;
                    capture.animation = None;
                    let materials = std::collections::BTreeMap::new();
                    self.history.set(Document { capture, materials, ..self.document().clone() }, false);
                    self.material = None;
                    self.options.playing = false;
                    session.begin_document();
                    let running = Running::new(&self.screen, loaded);
                    (self.rig, self.drawing) = (Some(running.rig.clone()), self.drawing.restarted());
                    self.running = Some(running);
                    self.reported_plans = 0;
                    warnings.into_iter().take(3).for_each(|warning| session.say(warning));
                    self.again();
                }
                Ok(Err(error)) => session.say(error),
                Err(()) => session.say(failure),
            }
        }
        self.relight(session);
        if self.options.playing && passed_s > 0.0 {
            self.options.time_s += f64::from(passed_s.min(0.25));
            let length_s = self.running.as_ref().and_then(|running| {
                let animation = running.loaded.scene.motion.animations.get(self.document().capture.animation?)?;
                Some(animation.duration_s())
            });
            if let Some(length_s) = length_s.filter(|length| *length > 0.0) {
                self.options.time_s %= length_s;
            }
            self.again();
        }
    }

    /// Waits until all background work is done; returns false after `at_most`.
    pub fn settle(&mut self, session: &mut Session, at_most: Duration) -> bool {
        let end = Instant::now() + at_most;
        while Instant::now() < end {
            self.tick(session, 0.0);
            if self.doing().is_none() && !self.drawing.is_working() {
                return true;
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        false
    }

    /// Shows the plan of this frame again after a file was shown.
    pub fn show_plan(&mut self, session: &mut Session) {
        session.forget_plan();
        self.reported_plans = 0;
        self.again();
    }

    /// Sets the size of the viewport and returns whether it changed.
    pub fn take_size(&mut self, size_px: [u32; 2]) -> bool {
        std::mem::replace(&mut self.size_px, size_px) != size_px
    }

    /// Returns the recent frames per second.
    pub fn frames_per_s(&self) -> Option<f32> {
        self.clock.frames_per_s()
    }

    /// Saves the settings to a file.
    ///
    /// # Errors
    /// One line that names the file.
    pub fn save(&self, path: &Path) -> Result<(), String> {
        let text = self.document().frame.to_ron()?;
        Outputs::one_beside(path, text.as_bytes(), &self.read()).map_err(|error| error.to_string())
    }

    /// Returns the input files of the displayed frame.
    pub fn read(&self) -> Vec<PathBuf> {
        self.shown.as_ref().map_or_else(Vec::new, Shown::files)
    }

    /// Returns the metered exposure value at ISO 100; 0 until the scene is loaded.
    pub fn metered_ev100(&self) -> f32 {
        self.shown.as_ref().map_or(0.0, |shown| shown.metered_ev100)
    }

    /// Returns the name of the current or requested environment.
    pub fn environment(&self) -> String {
        self.wanted.to_string()
    }

    /// Lights the scene with a clear sky or an environment picture.
    pub fn set_environment(&mut self, path: Option<PathBuf>) {
        self.wanted = path.map_or(EnvironmentSource::Sky(None), EnvironmentSource::File);
        self.declined = None;
        self.again();
    }
}
