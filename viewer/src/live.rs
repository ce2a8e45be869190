//! A frame of one's own beside its plan: the standard frame of `framegraph_passes`, drawn on the device that draws the window.
//!
//! | file | what |
//! | --- | --- |
//! | `screen.rs` | the device, and where egui finds textures of it |
//! | `loading.rs` | a scene and its light, on a thread of its own |
//! | `look.rs`, `factors.rs`, `camera.rs` | what goes beside settings; materials that are changed; a camera that is moved by hand |
//! | `frame.rs` | the frame, executed again and again |
//! | `shown.rs`, `asked_file.rs` | what the panel of settings keeps; what panels ask a file for |
//! | `times.rs` | its times, as views show them |
//! | `preview.rs`, `bisecting.rs` | textures of it; which liberty of the compiler changes it |
//! | `panel/` | what is seen of all this |

pub mod asked_file;
pub mod bisecting;
pub mod camera;
pub mod factors;
pub mod frame;
pub mod loading;
pub mod look;
pub mod panel;
pub mod preview;
pub mod screen;
pub mod shown;
mod times;

use crate::history::History;
use crate::job::Job;
use crate::plan_data::PlanData;
use crate::session::Session;
use asked_file::AskedFile;
use bisecting::Bisecting;
use frame::{Asked, Running};
use loading::{Around, Lit, Loaded};
use look::{Document, Sun};
use preview::Preview;
use program::input;
use program::outputs::Outputs;
use screen::Screen;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Frames that are drawn after a change: facts settle in eight, histories and effects over time soon after.
const AFTER_CHANGE: u32 = 16;
/// And where frames are added up over time.
const ADDED_UP: u32 = 48;
/// Seconds between two updates of times.
const TIMES_S: f32 = 0.5;

/// What a job brings.
type Brought<T> = Result<T, String>;

/// A frame that is drawn, and all that is set about it.
pub struct Live {
    screen: Screen,
    wake: Arc<dyn Fn() + Send + Sync>,
    /// The scene, once it is loaded.
    pub running: Option<Running>,
    /// Settings and look, with what undo and redo go back to.
    pub history: History<Document>,
    /// What the frame is asked for beside them.
    pub asked: Asked,
    /// Frames are drawn without a pause, though nothing changes.
    pub continuous: bool,
    /// Share of the viewport's pixels that is drawn along each side.
    pub share: f32,
    /// A texture that is looked at.
    pub preview: Preview,
    /// A file that a panel asks for, by a dialog of the desktop.
    pub asks_file: Option<AskedFile>,
    /// The material that is looked at.
    pub material: Option<usize>,
    /// Debug modes that are tried one after the other.
    pub bisecting: Option<Bisecting>,
    /// The limits that are watched, as they are typed.
    pub budget: String,
    /// The file of settings that is opened or written next, as it is typed.
    pub path: String,
    /// What the panel of settings holds.
    pub settings: shown::SettingsPanel,
    loading: Option<Job<Brought<(Loaded, Vec<String>)>>>,
    relighting: Option<Job<Brought<Lit>>>,
    wanted: Around,
    /// Frames that are still to be drawn.
    left: u32,
    told: u64,
    drawn_with: (Document, framegraph_wgpu::debug::Modes),
    refused: Option<String>,
    times_at: Option<Instant>,
    clock: times::Clock,
    size_px: [u32; 2],
}

impl Live {
    /// Begins to load a scene, a built-in name or a path; `wake` is called from other threads when there is something new.
    pub fn new(
        screen: Screen,
        document: Document,
        scene: &str,
        environment: Option<&Path>,
        wake: impl Fn() + Send + Sync + 'static,
    ) -> Self {
        let wanted = environment.map_or(Around::Sky(None), |path| Around::File(path.to_owned()));
        let mut live = Self {
            screen,
            wake: Arc::new(wake),
            running: None,
            history: History::new(document),
            asked: Asked::default(),
            continuous: false,
            share: 1.0,
            preview: Preview::default(),
            asks_file: None,
            material: None,
            bisecting: None,
            budget: String::new(),
            path: String::new(),
            settings: shown::SettingsPanel::default(),
            loading: None,
            relighting: None,
            wanted,
            left: AFTER_CHANGE,
            told: 0,
            drawn_with: Default::default(),
            refused: None,
            times_at: None,
            clock: times::Clock::default(),
            size_px: [0; 2],
        };
        live.load(scene);
        live
    }

    /// Loads a scene on a thread of its own. The one that is shown stays until it is there, or if it is none.
    pub fn load(&mut self, name: &str) {
        let shown = self.running.as_ref().map(|running| &running.loaded).filter(|loaded| loaded.name == name);
        let variant = shown.and_then(|loaded| loaded.variant.clone());
        self.load_variant(name, variant);
    }

    /// Loads a scene with the materials of a variant, as [`load`](Self::load) does.
    pub fn load_variant(&mut self, name: &str, variant: Option<String>) {
        let (gpu, name, around) = (self.screen.gpu.clone(), name.to_owned(), self.wanted.clone());
        let (settings, levels) = (self.light_settings(), self.document().frame.lod_error_px > 0.0);
        let wake = self.wake.clone();
        self.relighting = None;
        self.loading = Some(Job::start(
            format!("loading {name}"),
            move || wake(),
            move |handle| loading::load(&gpu, &name, &around, &settings, (levels, variant), handle),
        ));
    }

    /// Opens a file by its ending: a scene, a picture of light from all around, or settings; false for others.
    pub fn open(&mut self, path: &Path, session: &mut Session) -> bool {
        let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        match ending.as_deref() {
            Some("gltf" | "glb") => self.load(&path.to_string_lossy()),
            Some("hdr" | "exr" | "ktx" | "ktx2") => self.wanted = Around::File(path.to_owned()),
            Some("ron") => {
                let name = path.to_string_lossy();
                let says_frame = || input::text(path, input::MAX_TEXT_BYTES).is_ok_and(|t| t.contains("frame: ("));
                match crate::standard_frame::settings(&name) {
                    Ok(frame) => self.set(Document { frame, ..self.document().clone() }, false),
                    // A graph is another kind of file; settings say what is wrong with them.
                    Err(_) if !says_frame() => return false,
                    Err(error) => session.say(error),
                }
            }
            _ => return false,
        }
        true
    }

    /// Settings and look as they are.
    pub fn document(&self) -> &Document {
        self.history.now()
    }

    /// Changes settings and look. As long as `going_on`, as while a slider is dragged, changes are one step of undo.
    pub fn set(&mut self, document: Document, going_on: bool) {
        self.history.set(document, going_on);
        self.again();
    }

    /// Draws some frames more: something has changed.
    pub fn again(&mut self) {
        let over_time = self.document().frame.settings.taa.is_some();
        self.left = if over_time { ADDED_UP } else { AFTER_CHANGE };
        self.refused = None;
    }

    /// What is done on another thread, how far it is, and whether it can be ended.
    pub fn doing(&self) -> Option<(&str, Option<f32>)> {
        let loading = self.loading.as_ref().map(|job| (job.doing.as_str(), job.progress()));
        loading.or(self.relighting.as_ref().map(|job| (job.doing.as_str(), job.progress())))
    }

    /// Ends it; what is shown stays.
    pub fn cancel(&mut self) {
        self.loading = None;
        if self.relighting.take().is_some()
            && let Some(running) = &self.running
        {
            self.wanted = running.loaded.around.clone();
        }
    }

    /// What light the shown settings are to be made with.
    fn light_settings(&self) -> framegraph_passes::shading::LightSettings {
        let frame = &self.document().frame;
        frame.settings.shading.light(frame.quality)
    }

    /// Takes what other threads have brought, and lets time pass.
    pub fn tick(&mut self, session: &mut Session, passed_s: f32) {
        if let Some(result) = self.loading.as_ref().and_then(Job::poll) {
            self.loading = None;
            match result {
                Ok(Ok((loaded, warnings))) => {
                    warnings.into_iter().take(3).for_each(|warning| session.say(warning));
                    self.preview = Preview::default();
                    self.bisecting = None;
                    self.wanted = loaded.around.clone();
                    let mut look = self.document().look;
                    look.animation = None;
                    let materials = std::collections::BTreeMap::new();
                    self.history.set(Document { look, materials, ..self.document().clone() }, false);
                    self.material = None;
                    self.asked.playing = false;
                    self.running = Some(Running::new(&self.screen, loaded));
                    self.told = 0;
                    self.again();
                }
                Ok(Err(error)) => session.say(error),
                Err(()) => session.say("loading ended without a result: this is a fault of the viewer".into()),
            }
        }
        self.relight(session);
        if self.asked.playing && passed_s > 0.0 {
            self.asked.time_s += f64::from(passed_s.min(0.25));
            let length_s = self.running.as_ref().and_then(|running| {
                let animation = running.loaded.scene.motion.animations.get(self.document().look.animation?)?;
                Some(animation.duration_s())
            });
            if let Some(length_s) = length_s.filter(|length| *length > 0.0) {
                self.asked.time_s %= length_s;
            }
            self.again();
        }
    }

    /// Waits until nothing is loaded or made any more; false when that takes longer than `at_most`.
    pub fn settle(&mut self, session: &mut Session, at_most: Duration) -> bool {
        let end = Instant::now() + at_most;
        while Instant::now() < end {
            self.tick(session, 0.0);
            if self.doing().is_none() {
                return true;
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        false
    }

    /// Makes other light where the settings or the sun of a clear sky ask for it.
    fn relight(&mut self, session: &mut Session) {
        if let Some(result) = self.relighting.as_ref().and_then(Job::poll) {
            self.relighting = None;
            match (result, &mut self.running) {
                (Ok(Ok(lit)), Some(running)) => {
                    running.relight(lit);
                    self.again();
                }
                (Ok(Err(error)), Some(running)) => {
                    session.say(error);
                    self.wanted = running.loaded.around.clone();
                }
                _ => {}
            }
        }
        let sun = self.document().look.sun;
        if let Around::Sky(own) = &mut self.wanted {
            *own = if let Sun::Given { .. } = sun { sun.toward() } else { None };
        }
        let (settings, levels) = (self.light_settings(), self.document().frame.lod_error_px > 0.0);
        let Some(loaded) = self.running.as_mut().map(|running| &mut running.loaded) else { return };
        if self.loading.is_none() && levels && !std::mem::replace(&mut loaded.levels, true) {
            let name = loaded.name.clone();
            return self.load(&name);
        }
        let other = loaded.around != self.wanted || loaded.light_settings != settings;
        if !other || self.relighting.is_some() || self.loading.is_some() || self.refused.is_some() {
            return;
        }
        let (gpu, around, wake) = (self.screen.gpu.clone(), self.wanted.clone(), self.wake.clone());
        // What light is made for: materials do not matter, the ground's color and the lights do.
        let scene = framegraph_scene::Scene {
            ground_albedo: loaded.scene.ground_albedo,
            lights: loaded.lights.clone(),
            ..framegraph_scene::Scene::default()
        };
        self.relighting = Some(Job::start(
            "making light",
            move || wake(),
            move |handle| loading::light(&gpu, &scene, &around, &settings, handle),
        ));
    }

    /// Whether a frame is to be drawn.
    pub fn wants_frame(&self) -> bool {
        self.running.is_some() && (self.left > 0 || self.continuous || self.asked.playing)
    }

    /// Draws the frame of that size, if it is to be drawn, and tells the session of its plan and times.
    pub fn draw(&mut self, size_px: [u32; 2], session: &mut Session) {
        if !self.wants_frame() || size_px.contains(&0) {
            return;
        }
        self.left = self.left.saturating_sub(1);
        let document = self.history.now().clone();
        let Some(running) = &mut self.running else { return };
        // What light is not there yet for is drawn with the light that is.
        let mut drawn = document.clone();
        let lit = running.loaded.light_settings;
        drawn.frame.settings.shading.bands = lit.image.bands;
        drawn.frame.settings.shading.table = lit.dfg.visibility;
        if let Err(error) = running.draw(size_px, &drawn, &self.asked) {
            if self.refused.as_ref() != Some(&error) {
                session.say(error.clone());
            }
            (self.refused, self.left) = (Some(error), 0);
            return;
        }
        self.clock.tick(Instant::now());
        self.tell(session);
    }

    /// Tells the session of plan and times, where it shows this frame.
    fn tell(&mut self, session: &mut Session) {
        let Some(running) = &self.running else { return };
        let shows = session.is_live() || session.plan.is_none();
        if shows && running.plans() != self.told {
            let name = format!("live frame, {}", running.loaded.name);
            let drawn = (self.history.now().clone(), self.asked.modes.clone());
            let changed = self.told > 0 && drawn != self.drawn_with;
            match PlanData::of(running.plan(), &name) {
                Ok(plan) => {
                    let (planner, base) = running.planner(self.history.now(), &self.asked.modes);
                    session.show_live(planner, base, Arc::new(plan), changed);
                }
                Err(error) => session.say(error.to_string()),
            }
            self.told = running.plans();
            self.drawn_with = drawn;
        }
        if shows && self.times_at.is_none_or(|at| at.elapsed().as_secs_f32() >= TIMES_S) {
            self.times_at = Some(Instant::now());
            if let Some(trace) = running.frames().executor().timing().trace() {
                session.take_times(times::of(trace));
            }
        }
    }

    /// Shows the plan of this frame again, after a file was shown.
    pub fn show_plan(&mut self, session: &mut Session) {
        session.forget_plan();
        self.told = 0;
        self.again();
    }

    /// Notes the size of the viewport; returns whether it is another one.
    pub fn take_size(&mut self, size_px: [u32; 2]) -> bool {
        std::mem::replace(&mut self.size_px, size_px) != size_px
    }

    /// Frames a second, over the latest ones.
    pub fn frames_per_s(&self) -> Option<f32> {
        self.clock.frames_per_s()
    }

    /// Writes the settings as a file.
    ///
    /// # Errors
    /// One line that names the file.
    pub fn save(&self, path: &Path) -> Result<(), String> {
        let text = self.document().frame.to_ron()?;
        Outputs::one_beside(path, text.as_bytes(), &self.read()).map_err(|error| error.to_string())
    }

    /// The files that what is shown was read from.
    pub fn read(&self) -> Vec<PathBuf> {
        self.running.iter().flat_map(|running| running.loaded.files()).cloned().collect()
    }

    /// The environment that is shown or made, in words.
    pub fn around(&self) -> String {
        self.wanted.to_string()
    }

    /// Lights the scene by a clear sky, or by a picture.
    pub fn set_around(&mut self, path: Option<PathBuf>) {
        self.wanted = path.map_or(Around::Sky(None), Around::File);
        self.again();
    }
}
