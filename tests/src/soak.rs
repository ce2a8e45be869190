//! Long-running test of the standard frame. Window size, effects, scene, aliasing and shaders change, and the device is
//! lost. The final state is compared with a fresh run.

use crate::stage::Stage;
use framegraph::Alias;
use framegraph_passes::effects::bloom::BloomSettings;
use framegraph_passes::effects::dof::DofSettings;
use framegraph_passes::effects::fog::FogSettings;
use framegraph_passes::gpu_scene::shadow_views::{ShadowFilter, ShadowSettings};
use framegraph_passes::{OcclusionSettings, ReflectionSettings, Settings, TaaSettings, Upscale, World};
use framegraph_wgpu::{FrameLoop, Gpu, OpenError, PoolCounts, Workers, read_texture};
use std::error::Error;

/// Parameters of a frame, which change randomly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Width and height of the picture, in pixels.
    pub size_px: [u32; 2],
    /// Index of the scene.
    pub scene: usize,
    /// Index of the settings.
    pub variant: usize,
    /// Aliasing mode of textures.
    pub alias: Alias,
}

/// Final state of a run, which a fresh run also draws.
const LAST: State = State { size_px: [64, 36], scene: 0, variant: 0, alias: Alias::Pool };
/// Size of a shadow map, in texels.
const SHADOW_TEXELS: u32 = 128;

/// Resources in use after a number of frames.
#[derive(Clone, Copy, Debug)]
pub struct Held {
    /// Number of frames so far.
    pub frames: usize,
    /// Textures in the executor's pool.
    pub textures: PoolCounts,
    /// Resident memory of the program in bytes; zero if the system does not report it.
    pub resident_bytes: u64,
    /// Number of replaced shaders so far.
    pub reloaded: usize,
    /// Number of lost and reopened devices so far.
    pub lost: usize,
}

/// Disturbances during a run.
#[derive(Clone, Copy, Debug)]
pub struct Trouble {
    /// Number of frames after which all shaders are replaced by an equivalent text.
    pub reload_every: usize,
    /// Number of frames after which the device is lost and everything is created again.
    pub lose_every: usize,
    /// Opens a device after a loss.
    pub open: fn() -> Result<Gpu, OpenError>,
}

/// A long run.
pub struct Soak {
    gpu: Gpu,
    frames: FrameLoop<World>,
    stages: Vec<Stage>,
    state: u64,
    /// Number of frames drawn.
    drawn: u32,
    largest_px: u32,
    /// Number of variants.
    variants: u32,
    trouble: Option<Trouble>,
    reloaded: usize,
    lost: usize,
}

/// Scenes with different features: opaque surfaces, many lights, transmission.
const SCENES: [&str; 3] = ["spheres", "lamps:3", "glass"];

/// Returns combinations of effects, the simplest first.
fn variants() -> [Settings; 10] {
    let shadows = |cascades| Some(ShadowSettings { cascades, ..ShadowSettings::texels(SHADOW_TEXELS) });
    let plain = Settings { shadows: shadows(1), ..Settings::DEFAULT };
    let moments = ShadowSettings { filter: ShadowFilter::Evsm, ..ShadowSettings::texels(SHADOW_TEXELS) };
    let (bloom, dof) = (Some(BloomSettings::DEFAULT), Some(DofSettings::DEFAULT));
    [
        plain,
        Settings { samples: 4, shadows: shadows(3), ..plain },
        Settings { shadows: None, fxaa: false, ..plain },
        Settings { occlusion: Some(OcclusionSettings::SAO), split_post: true, ..plain },
        Settings { reflections: Some(ReflectionSettings::DEFAULT), ..plain },
        Settings { taa: Some(TaaSettings::DEFAULT), fxaa: false, ..plain },
        Settings { bloom, fog: Some(FogSettings::DEFAULT), ..plain },
        Settings { dof, samples: 4, ..plain },
        Settings { shadows: Some(moments), upscale: Some(Upscale::DEFAULT), ..plain },
        Settings { taa: Some(TaaSettings::DEFAULT), upscale: Some(Upscale::DEFAULT), bloom, dof, ..plain },
    ]
}

impl Soak {
    /// Creates a run with windows of at most `largest_px` in width and height.
    ///
    /// # Errors
    /// A scene cannot be created.
    pub fn new(gpu: &Gpu, largest_px: u32) -> Result<Self, Box<dyn Error>> {
        Self::of(gpu, largest_px, variants().len() as u32, SCENES.len())
    }

    /// Creates a run with simple effects and the first scene only, whose shaders compile quickly.
    ///
    /// # Errors
    /// A scene cannot be created.
    pub fn simple(gpu: &Gpu, largest_px: u32) -> Result<Self, Box<dyn Error>> {
        Self::of(gpu, largest_px, 2, 1)
    }

    fn of(gpu: &Gpu, largest_px: u32, variants: u32, scenes: usize) -> Result<Self, Box<dyn Error>> {
        let (stages, frames) = (stages(gpu, scenes)?, frames(gpu)?);
        let (gpu, trouble) = (gpu.clone(), None);
        Ok(Self { gpu, frames, stages, state: 1, drawn: 0, largest_px, variants, trouble, reloaded: 0, lost: 0 })
    }

    /// Adds disturbances to the run.
    #[must_use]
    pub fn with(self, trouble: Trouble) -> Self {
        Self { trouble: Some(trouble), ..self }
    }

    fn random(&mut self, below: u32) -> u32 {
        self.state = self.state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.state >> 33) as u32 % below
    }

    /// Changes window size, effects or scene, or several of them. Small windows are more frequent than large ones, down
    /// to one pixel.
    fn next(&mut self, before: State) -> State {
        let mut state = before;
        let changed = self.random(15) + 1;
        if changed & 1 != 0 {
            let octaves = self.largest_px.ilog2() + 1;
            state.size_px = [0; 2].map(|_: u32| {
                let most = 1 << self.random(octaves);
                (most + self.random(most)).min(self.largest_px)
            });
        }
        if changed & 2 != 0 {
            state.variant = self.random(self.variants) as usize;
        }
        if changed & 4 != 0 {
            state.scene = self.random(self.stages.len() as u32) as usize;
        }
        if changed & 8 != 0 {
            state.alias = [Alias::Pool, Alias::Heap][self.random(2) as usize];
        }
        state
    }

    /// Draws `count` frames and reports resources every `every` frames. Returns the bytes of the last frame, which is
    /// in the final state.
    ///
    /// # Errors
    /// Any error of any frame.
    pub fn run(&mut self, count: usize, every: usize, mut told: impl FnMut(Held)) -> Result<Vec<u8>, Box<dyn Error>> {
        let (mut state, mut left) = (LAST, 0);
        for number in 0..count {
            if left == 0 {
                (state, left) = (self.next(state), self.random(9) + 1);
            }
            left -= 1;
            self.draw(state).map_err(|error| format!("frame {number}, {state:?}: {error}"))?;
            if let Some(trouble) = self.trouble {
                self.suffer(trouble, number + 1, state).map_err(|error| format!("after frame {number}: {error}"))?;
            }
            if (number + 1) % every == 0 {
                self.gpu.wait()?;
                let textures = self.frames.executor().texture_pool();
                let (reloaded, lost) = (self.reloaded, self.lost);
                told(Held { frames: number + 1, textures, resident_bytes: resident_bytes(), reloaded, lost });
            }
        }
        self.draw(LAST)
    }

    fn suffer(&mut self, trouble: Trouble, drawn: usize, state: State) -> Result<(), Box<dyn Error>> {
        if drawn.is_multiple_of(trouble.reload_every.max(1)) {
            for program in self.stages[state.scene].world.programs.made() {
                let shader = program.shader();
                let text = format!("{}\n// Replaced after frame {drawn}.", shader.text());
                self.frames.executor_mut().reload_shader(&shader, &text)?;
                self.reloaded += 1;
            }
        }
        if drawn.is_multiple_of(trouble.lose_every.max(1)) {
            self.gpu.device.destroy();
            // The loss is reported once no work is in flight; earlier frames may still be accepted.
            let told = (0..50).find_map(|_| self.draw(state).err()).ok_or("a lost device was not reported")?;
            if !told.to_string().contains("the device was lost") {
                return Err(format!("unexpected error of a lost device: {told}").into());
            }
            self.gpu = (trouble.open)()?;
            (self.stages, self.frames) = (stages(&self.gpu, self.stages.len())?, frames(&self.gpu)?);
            self.lost += 1;
        }
        Ok(())
    }

    /// Returns the bytes of the final state, drawn by a fresh run.
    ///
    /// # Errors
    /// Any error of the frame.
    pub fn fresh(gpu: &Gpu) -> Result<Vec<u8>, Box<dyn Error>> {
        Self::simple(gpu, 64)?.draw(LAST)
    }

    fn draw(&mut self, state: State) -> Result<Vec<u8>, Box<dyn Error>> {
        let State { size_px, scene, variant, alias } = state;
        self.frames.options_mut().alias = alias;
        let picture = self.stages[scene].draw(&mut self.frames, &variants()[variant], size_px, self.drawn)?;
        self.drawn += 1;
        if state != LAST {
            return Ok(Vec::new());
        }
        let picture = self.frames.executor().texture(self.frames.plan(), picture);
        Ok(read_texture(&self.gpu, picture.ok_or("the frame left no picture")?)?.rgba8())
    }
}

/// Creates the first scenes on a device.
fn stages(gpu: &Gpu, count: usize) -> Result<Vec<Stage>, Box<dyn Error>> {
    SCENES.into_iter().take(count).map(|name| Stage::new(gpu, name)).collect()
}

/// Creates a frame loop that records on several cores where that is faster.
fn frames(gpu: &Gpu) -> Result<FrameLoop<World>, Box<dyn Error>> {
    let mut frames = FrameLoop::new(gpu);
    frames.record_on(Some(Workers::new()?));
    Ok(frames)
}

/// Returns the resident memory of this program on Linux.
fn resident_bytes() -> u64 {
    let text = std::fs::read_to_string("/proc/self/statm").unwrap_or_default();
    let pages: Option<u64> = text.split_whitespace().nth(1).and_then(|pages| pages.parse().ok());
    pages.unwrap_or(0) * 4096
}
