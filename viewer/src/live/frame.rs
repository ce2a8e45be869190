//! The standard frame of a scene, executed repeatedly into a texture for egui.

mod planner;

use super::camera::Rig;
use super::capture::{Capture, Document};
use super::factors::Factors;
use super::loading::Loaded;
use super::screen::Screen;
use crate::standard_frame::declare;
use egui::TextureId;
use framegraph::{Options, Plan};
use framegraph_passes::effects::exposure::Measurement;
use framegraph_passes::feature_culling::{EnvironmentSummary, SceneSummary, decide};
use framegraph_passes::gpu_scene::shadow_views::{ShadowSettings, local_layers, local_maps};
use framegraph_passes::gpu_scene::view::{Background, ViewSettings};
use framegraph_passes::light::sun::has_sun;
use framegraph_passes::{
    CameraView, Effect, EffectSet, FactInput, FactMemory, Facts, FrameIndex, FrameSettings, Settings, ViewId, World,
};
use framegraph_scene::{Camera, Material, MaterialId};
use framegraph_wgpu::debug::Modes;
use framegraph_wgpu::{ExecutorOptions, FrameLoop};
use glam::{DVec2, Vec2};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

/// Debug modes and animation state of a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DrawOptions {
    /// Debug modes.
    pub modes: Modes,
    /// Disables feature culling.
    pub forced: bool,
    /// Animation time in seconds.
    pub time_s: f64,
    /// True while the animation plays.
    pub playing: bool,
}

/// Target texture of the frame.
struct Picture {
    texture: wgpu::Texture,
    size_px: [u32; 2],
    id: TextureId,
}

/// Everything on which a view depends.
#[derive(Clone, Debug, PartialEq)]
struct ViewInputs {
    document: Document,
    camera: Camera,
    size_px: [u32; 2],
    settings: Settings,
    moment: Option<(usize, f64)>,
    light: u64,
}

/// Scene that is being drawn.
pub struct Running {
    screen: Screen,
    /// Scene with its light.
    pub loaded: Loaded,
    /// Interactive camera.
    pub rig: Rig,
    /// Decisions of feature culling for the last frame.
    pub facts: Facts,
    frames: FrameLoop<World>,
    poison: bool,
    picture: Option<Picture>,
    memory: FactMemory,
    view_inputs: Option<ViewInputs>,
    posed: Option<(usize, f64)>,
    /// Materials of the scene file.
    materials: Vec<Material>,
    /// Materials drawn with edited factors.
    painted: BTreeMap<usize, Factors>,
    requested: Settings,
    /// Number of light changes.
    light: u64,
    index: u32,
    key: Option<(Settings, Options)>,
    plans: u64,
    /// Number of frames that the device has not finished.
    queued: Arc<AtomicU32>,
}

/// Maximum number of queued frames.
const QUEUED: u32 = 2;

impl Running {
    /// Creates a frame that has not been drawn yet.
    pub fn new(screen: &Screen, loaded: Loaded) -> Self {
        Self {
            screen: screen.clone(),
            rig: Rig::new(&loaded.scene, 16.0 / 9.0),
            materials: loaded.scene.materials.clone(),
            painted: BTreeMap::new(),
            loaded,
            facts: Facts::default(),
            frames: frames(screen, false),
            poison: false,
            picture: None,
            memory: FactMemory::default(),
            view_inputs: None,
            posed: None,
            requested: Settings::DEFAULT,
            light: 0,
            index: 0,
            key: None,
            plans: 0,
            queued: Arc::default(),
        }
    }

    /// Replaces the light.
    pub fn relight(&mut self, lit: super::loading::Lit) {
        self.loaded.relight(lit);
        self.light += 1;
    }

    /// Draws one frame. On failure the previous picture stays. `progress` is called with the number of steps whose
    /// pipelines exist, and of all steps, if the plan is new.
    ///
    /// # Errors
    /// One line with the error of the frame or the device.
    pub fn draw(
        &mut self,
        size_px: [u32; 2],
        document: &Document,
        requested: &DrawOptions,
        progress: &mut dyn FnMut(u64, u64),
    ) -> Result<(), String> {
        document.frame.settings.shading.precision.check(&self.screen.gpu).map_err(|e| e.to_string())?;
        self.pose(document.capture.animation, requested.time_s)?;
        self.paint(&document.materials)?;
        let settings = self.settings(size_px, document, requested);
        self.update_view(size_px, document, &settings)?;
        let mut options = Options { inline: document.frame.inline, ..Options::for_frame(size_px[0], size_px[1]) };
        let mut execute = ExecutorOptions::default();
        requested.modes.apply(&mut options, &mut execute);
        if self.poison != execute.poison {
            (self.frames, self.poison) = (frames(&self.screen, execute.poison), execute.poison);
        }
        *self.frames.options_mut() = options;
        let texture = self.texture(size_px);
        let (facts, world) = (&self.facts, &self.loaded.world);
        let declared = |frame: &mut framegraph_wgpu::Frame<World>, imports: &mut framegraph_wgpu::Imports| {
            let output = declare(frame, &settings, facts)?;
            imports.texture(output, &texture);
            Ok::<_, framegraph_passes::StageError>(())
        };
        let key = (settings, options);
        if self.key != Some(key) {
            self.frames.declare(size_px, declared).map_err(|error| error.to_string())?;
            let made = self.frames.warm_up(world, &mut |at| progress(at.done as u64, at.total as u64));
            made.map_err(|error| error.to_string())?;
        }
        let ran = self.frames.run(size_px, world, declared);
        self.index = self.index.wrapping_add(1);
        ran.map_err(|error| error.to_string())?;
        self.queued.fetch_add(1, Ordering::Relaxed);
        let queued = self.queued.clone();
        self.screen.gpu.queue.on_submitted_work_done(move || {
            queued.fetch_sub(1, Ordering::Relaxed);
        });
        if self.key != Some(key) {
            (self.key, self.plans) = (Some(key), self.plans + 1);
        }
        Ok(())
    }

    /// Returns whether the device has not finished earlier frames, so that another one would have to wait.
    pub fn is_busy(&self) -> bool {
        // A lost device is reported by the next frame.
        let _ = self.screen.gpu.poll();
        self.queued.load(Ordering::Relaxed) >= QUEUED
    }

    /// Restarts histories and temporal effects, as after a camera cut.
    pub fn restart(&mut self) {
        self.frames.executor_mut().reset_histories();
        (self.view_inputs, self.index) = (None, 0);
    }

    /// Poses the scene at an animation time.
    fn pose(&mut self, animation: Option<usize>, time_s: f64) -> Result<(), String> {
        let moment = animation.map(|number| (number, time_s));
        if moment == self.posed {
            return Ok(());
        }
        let Loaded { scene, lights, survey, prepared, world, .. } = &mut self.loaded;
        // Pose all lights, including those that the selected sun excludes.
        scene.lights.clone_from(lights);
        let posed = scene.pose(animation, time_s).map_err(|e| e.to_string());
        lights.clone_from(&scene.lights);
        world.scene.repose(&self.screen.gpu, scene).map_err(|e| e.to_string())?;
        prepared.update(scene, &(0..scene.instances.len()).collect::<Vec<_>>());
        if !scene.motion.rest.materials.is_empty() {
            for (material, _) in &scene.motion.rest.materials {
                self.materials[material.index()] = scene.materials[material.index()].clone();
                // Its edited factors are applied again over the posed ones.
                self.painted.remove(&material.index());
            }
            *survey = Arc::new(SceneSummary::new(scene));
        }
        self.posed = moment;
        posed
    }

    /// Returns a material of the scene file.
    pub fn material(&self, number: usize) -> Option<&Material> {
        self.materials.get(number)
    }

    /// Applies edited factors, and restores materials that are no longer edited.
    fn paint(&mut self, wanted: &BTreeMap<usize, Factors>) -> Result<(), String> {
        if self.painted == *wanted {
            return Ok(());
        }
        let Loaded { scene, world, survey, .. } = &mut self.loaded;
        for (number, own) in self.materials.iter().enumerate() {
            if self.painted.get(&number) != wanted.get(&number) {
                let material = wanted.get(&number).map_or_else(|| own.clone(), |factors| factors.on(own));
                let written = world.scene.write_material(&self.screen.gpu, MaterialId::new(number), &material);
                written.map_err(|error| error.to_string())?;
                scene.materials[number] = material;
            }
        }
        *survey = Arc::new(SceneSummary::new(scene));
        (self.painted, self.view_inputs) = (wanted.clone(), None);
        Ok(())
    }

    /// Returns the drawn settings, without effects that the scene lacks or feature culling drops.
    fn settings(&mut self, size_px: [u32; 2], document: &Document, requested: &DrawOptions) -> Settings {
        let FrameSettings { lights, lod_error_px, visible_layers, settings, .. } = document.frame;
        let capture = &document.capture;
        self.loaded.set_sun(capture.sun, self.turned_rad(capture));
        let Self { loaded, rig, memory, .. } = self;
        let (scene, image) = (&loaded.scene, &loaded.world.lighting.image);
        let camera = rig.camera(capture.fov_y_rad());
        let cascades = |own: &ShadowSettings| if has_sun(scene, image.sun.as_ref()) { own.cascades } else { 0 };
        let shadows = settings.shadows.map(|own| {
            let cascades = cascades(&own);
            let local_maps = local_maps(scene, cascades).min(own.local_maps);
            let own = ShadowSettings { cascades, local_maps, ..own };
            ShadowSettings { local_layers: local_layers(scene, camera.eye, &own), ..own }
        });
        let shadows = shadows.filter(|shadows| shadows.layers() > 0);
        let drawn_px = settings.drawn_px(size_px);
        let settings = Settings { shadows, moving: requested.playing, ..settings }.for_scene(scene, drawn_px);
        self.requested = settings;
        if requested.forced {
            self.facts = Facts::default();
            return settings;
        }
        // Cascade tinting requires the cascades.
        let tinted = shadows.is_some_and(|shadows| shadows.show_cascades);
        let shown = [Effect::SunShadows, Effect::Cascades].into_iter().filter(|_| tinted);
        let seen = ViewSettings {
            camera,
            size_px: drawn_px,
            ev100: capture.exposure.ev100(loaded.metered_ev100),
            environment_intensity: capture.environment_intensity,
            shadows,
            lights,
            lod_error_px,
            visible_layers,
        };
        self.facts = decide(
            &FactInput {
                scene,
                survey: &loaded.survey,
                around: EnvironmentSummary::from(image),
                background: &loaded.background(capture.background),
                views: std::slice::from_ref(&seen),
                settings: &settings,
                measured: Measurement::Off,
                forced: shown.collect::<EffectSet>(),
                max_steps: FactInput::MAX_CODES,
            },
            memory,
        );
        self.facts.apply(&settings)
    }

    /// Returns the rotation of the environment in radians; a clear sky moves its sun instead.
    fn turned_rad(&self, capture: &Capture) -> f64 {
        if matches!(self.loaded.background, Background::Environment) { capture.turned_rad() } else { 0.0 }
    }

    /// Updates the view.
    fn update_view(&mut self, size_px: [u32; 2], document: &Document, settings: &Settings) -> Result<(), String> {
        let capture = &document.capture;
        let camera = self.rig.camera(capture.fov_y_rad());
        let view_inputs = ViewInputs {
            document: document.clone(),
            camera: camera.clone(),
            size_px,
            settings: *settings,
            moment: self.posed,
            light: self.light,
        };
        let jitter = settings.taa.map_or(DVec2::ZERO, |taa| taa.jitter_px(self.index));
        let turned = self.turned_rad(capture);
        let Loaded { scene, prepared, world, .. } = &self.loaded;
        let failed = |error: framegraph_passes::PassError| error.to_string();
        if self.view_inputs.as_ref() == Some(&view_inputs) {
            let world = &mut self.loaded.world;
            world.frame_index = FrameIndex(self.index);
            return world.views.again(ViewId::MAIN, jitter).map_err(failed);
        }
        let seen = ViewSettings {
            camera,
            size_px: settings.drawn_px(size_px),
            ev100: capture.exposure.ev100(self.loaded.metered_ev100),
            environment_intensity: capture.environment_intensity,
            shadows: settings.shadows,
            lights: document.frame.lights,
            lod_error_px: document.frame.lod_error_px,
            visible_layers: document.frame.visible_layers,
        };
        let background = self.loaded.background(capture.background);
        let mut view = CameraView::prepared(scene, prepared, &world.lighting.image, &background, &seen);
        view.frame.environment_rotation = Vec2::new(turned.cos() as f32, -turned.sin() as f32);
        if self.view_inputs.is_some() {
            view = view.after(&world.views.get(ViewId::MAIN).map_err(failed)?.view);
        }
        view.jitter(jitter);
        let world = &mut self.loaded.world;
        world.frame_index = FrameIndex(self.index);
        world.set_view(&self.screen.gpu, ViewId::MAIN, view).map_err(failed)?;
        self.view_inputs = Some(view_inputs);
        Ok(())
    }

    /// Returns the target texture of the frame.
    fn texture(&mut self, size_px: [u32; 2]) -> wgpu::Texture {
        if let Some(picture) = self.picture.as_ref().filter(|picture| picture.size_px == size_px) {
            return picture.texture.clone();
        }
        let [width, height] = size_px.map(|side| side.max(1));
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC
            | wgpu::TextureUsages::COPY_DST;
        let texture = self.screen.gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("viewport"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8Unorm,
            usage,
            view_formats: &[],
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let id = self.screen.show(&view, self.picture.as_ref().map(|picture| picture.id));
        self.picture = Some(Picture { texture: texture.clone(), size_px, id });
        texture
    }

    /// Returns egui's id and the size of the picture; `None` before the first frame.
    pub fn picture(&self) -> Option<(TextureId, [u32; 2])> {
        self.picture.as_ref().map(|picture| (picture.id, picture.size_px))
    }

    /// Returns the texture of the picture.
    pub fn picture_texture(&self) -> Option<&wgpu::Texture> {
        self.picture.as_ref().map(|picture| &picture.texture)
    }

    /// Counts distinct plans, by settings, size or options.
    pub fn plans(&self) -> u64 {
        self.plans
    }

    /// Counts drawn frames.
    pub fn drawn(&self) -> u32 {
        self.index
    }

    /// Returns the last executed plan.
    pub fn plan(&self) -> &Plan {
        self.frames.plan()
    }

    /// Returns frame, plan, executor and imports of the last executed frame.
    pub fn frames(&self) -> &FrameLoop<World> {
        &self.frames
    }

    /// Returns the device.
    pub fn screen(&self) -> &Screen {
        &self.screen
    }

    /// Returns whether uninitialized memory is poisoned.
    pub fn is_poisoned(&self) -> bool {
        self.poison
    }
}

/// Creates a frame loop that records frame times.
fn frames(screen: &Screen, poison: bool) -> FrameLoop<World> {
    let execute = ExecutorOptions { trace: true, poison, ..ExecutorOptions::default() };
    FrameLoop::with(&screen.gpu, Options::default(), execute)
}
