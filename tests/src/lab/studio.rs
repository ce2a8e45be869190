//! Frames of built-in scenes: pictures, references and times.

use super::statistics::Times;
use super::technique::Outcome;
use crate::reference::metrics::Metrics;
use crate::reference::picture::Picture;
use crate::stage::light_cache;
use framegraph::{Extent, Format, Options, Plan, Scratch, Target, TextureDesc, compile};
use framegraph_passes::effects::exposure::Measurement;
use framegraph_passes::feature_culling::{EnvironmentSummary, SceneSummary, decide};
use framegraph_passes::gpu_scene::view::{Background, ViewSettings};
use framegraph_passes::light::shading::LightSettings;
use framegraph_passes::{
    CameraView, EffectSet, FactInput, FactMemory, Facts, FrameIndex, LightSearch, Lighting, Settings, ViewId, World,
    standard,
};
use framegraph_scene::environment::Sky;
use framegraph_scene::{Light, Scene, progress};
use framegraph_shader_mirrors::srgb::{linear_from_srgb_channel, srgb_from_linear_channel};
use framegraph_wgpu::{Executor, ExecutorOptions, Frame, Gpu, Imports, read_texture};
use glam::{DQuat, DVec2, Vec3};
use std::cell::RefCell;
use std::time::Instant;

use super::record::{PictureRecord, Rounds, StepRecord};

/// A frame to draw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setup {
    /// Name of a built-in scene.
    pub scene: &'static str,
    /// Exposure value at ISO 100.
    pub ev100: f32,
    /// Settings of the frame.
    pub settings: Settings,
    /// Settings of image-based light.
    pub light: LightSettings,
    /// Method by which shading finds lights.
    pub lights: LightSearch,
    /// Sun that replaces the scene's lights: direction, and angular radius in radians.
    pub sun: Option<(Vec3, f32)>,
}

/// Reference of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Truth {
    /// Another frame.
    Frame(Setup),
    /// The frame at a multiple of width and height, averaged as linear light after its tone curve.
    Supersampled(Setup, u32),
    /// Mean of several frames with hard shadows, each with the sun at another point of its disc.
    Suns(Setup, u32),
}

/// Device, picture size and caches for drawing frames.
#[derive(Debug)]
pub struct Studio<'a> {
    /// The device.
    pub gpu: &'a Gpu,
    /// Size of pictures, in pixels.
    pub size_px: [u32; 2],
    /// Number of frames per option.
    pub rounds: Rounds,
    /// References that were drawn, shared between techniques.
    truths: RefCell<Vec<(Truth, (Picture, f64))>>,
}

/// A frame that can be drawn repeatedly.
#[derive(Debug)]
pub struct Ready {
    scene: Scene,
    moment: ViewSettings,
    world: World,
    frame: Frame<World>,
    plan: Plan,
    executor: Executor,
    output: framegraph::Texture,
    size_px: [u32; 2],
    settings: Settings,
    drawn: u32,
}

/// Number of accumulated frames before a picture is taken. Half as many frames after it measure temporal noise.
const SUMMED: u32 = 32;
const TREMBLING: u32 = 16;

impl<'a> Studio<'a> {
    /// Creates a studio for pictures of a size, in pixels.
    pub fn new(gpu: &'a Gpu, size_px: [u32; 2], rounds: Rounds) -> Self {
        Self { gpu, size_px, rounds, truths: RefCell::default() }
    }

    /// Creates all resources that a setup needs.
    ///
    /// # Errors
    /// The scene is unknown, or the device fails.
    pub fn prepare(&self, setup: &Setup, size_px: [u32; 2]) -> Outcome<Ready> {
        let mut scene = Scene::open(setup.scene, &mut progress::silent)?;
        if let Some((toward, _)) = setup.sun {
            scene.lights = vec![Light::directional("sun", -toward, 60_000.0)];
        }
        let environment = Sky::default().environment(128)?;
        let lighting = Lighting::new(self.gpu, &environment, &setup.light, &light_cache(), &mut progress::silent)?;
        let moment = ViewSettings {
            camera: scene.default_camera(f64::from(size_px[0]) / f64::from(size_px[1])),
            size_px: setup.settings.drawn_px(size_px),
            ev100: setup.ev100,
            environment_intensity: if setup.sun.is_some() { 0.3 } else { 1.0 },
            shadows: setup.settings.shadows,
            lights: setup.lights,
            lod_error_px: 0.0,
            visible_layers: 1,
        };
        let view = CameraView::new(&scene, &lighting.image, &Background::Environment, &moment);
        let world = World::new(self.gpu, &scene, lighting, [view], &mut progress::silent)?;
        let (frame, plan, output) = self.declared(&setup.settings, &scene, size_px)?;
        // Textures of old frames are freed; pipelines remain, since frames share them.
        let options = ExecutorOptions { max_age: 4, timing: true, ..ExecutorOptions::default() };
        let executor = Executor::with(self.gpu, options);
        let settings = setup.settings;
        Ok(Ready { scene, moment, world, frame, plan, executor, output, size_px, settings, drawn: 0 })
    }

    fn declared(
        &self,
        settings: &Settings,
        scene: &Scene,
        size_px: [u32; 2],
    ) -> Outcome<(Frame<World>, Plan, framegraph::Texture)> {
        let mut frame = Frame::new();
        let output = frame.graph_mut().texture("output", TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb));
        let settings = settings.for_scene(scene, settings.drawn_px(size_px));
        let io = standard(&mut frame, &settings, Target::from(output))?;
        frame.graph_mut().readback(io.output)?;
        let mut plan = Plan::new();
        let options = Options::for_frame(size_px[0], size_px[1]);
        compile(frame.graph(), &self.gpu.caps(), &options, &mut Scratch::new(), &mut plan)?;
        Ok((frame, plan, io.output))
    }

    /// Changes the settings of a prepared frame, and keeps compiled resources.
    ///
    /// # Errors
    /// The device fails.
    pub fn change(&self, ready: &mut Ready, settings: &Settings) -> Outcome<()> {
        (ready.moment.shadows, ready.moment.size_px) = (settings.shadows, settings.drawn_px(ready.size_px));
        let light = &ready.world.lighting.image;
        let view = CameraView::new(&ready.scene, light, &Background::Environment, &ready.moment);
        ready.world.set_view(self.gpu, ViewId::MAIN, view)?;
        (ready.frame, ready.plan, ready.output) = self.declared(settings, &ready.scene, ready.size_px)?;
        (ready.settings, ready.drawn) = (*settings, 0);
        ready.executor.reset_histories();
        Ok(())
    }

    /// Draws the picture of a setup.
    ///
    /// # Errors
    /// The scene is unknown, or the device fails.
    pub fn picture(&self, setup: &Setup) -> Outcome<Picture> {
        self.prepare(setup, self.size_px)?.picture(self.gpu)
    }

    /// Returns the reference picture with its standard error in 8-bit steps, half of the difference between its two
    /// halves.
    ///
    /// # Errors
    /// The scene is unknown, or the device fails.
    pub fn truth(&self, truth: &Truth) -> Outcome<(Picture, f64)> {
        if let Some((_, known)) = self.truths.borrow().iter().find(|(own, _)| own == truth) {
            return Ok(known.clone());
        }
        let found = self.drawn_truth(truth)?;
        self.truths.borrow_mut().push((*truth, found.clone()));
        Ok(found)
    }

    fn drawn_truth(&self, truth: &Truth) -> Outcome<(Picture, f64)> {
        let [width, height] = self.size_px;
        match truth {
            Truth::Frame(setup) => Ok((self.picture(setup)?, 0.0)),
            Truth::Supersampled(setup, times) => {
                let large = self.prepare(setup, [width * times, height * times])?.picture(self.gpu)?;
                let mean = |own: fn(u32, u32) -> bool| {
                    let of = |i: u32| {
                        let (x0, y0) = (i % width * times, i / width * times);
                        let places = (0..times * times).map(|k| (k % times, k / times)).filter(|(x, y)| own(*x, *y));
                        mean_of(places.map(|(x, y)| large.linear[((y0 + y) * width * times + x0 + x) as usize]))
                    };
                    (0..width * height).map(of).collect::<Vec<_>>()
                };
                let halves = [mean(|x, y| (x + y) % 2 == 0), mean(|x, y| (x + y) % 2 == 1)];
                Ok(self.of_halves(halves))
            }
            Truth::Suns(setup, count) => {
                let (toward, radius) = setup.sun.ok_or("a sun to stand for many")?;
                let (right, up) = toward.any_orthonormal_pair();
                let mut halves = [const { Vec::new() }; 2];
                let mut ready = self.prepare(setup, self.size_px)?;
                for index in 0..*count {
                    let (share, turn) = ((index as f32 + 0.5) / *count as f32, index as f32 * 2.399_963_2);
                    let aside = (right * turn.cos() + up * turn.sin()) * (radius.tan() * share.sqrt());
                    let sun = -(toward + aside).normalize();
                    ready.scene.lights = vec![Light::directional("sun", sun, 60_000.0)];
                    self.change(&mut ready, &setup.settings)?;
                    halves[index as usize % 2].push(ready.picture(self.gpu)?.linear);
                }
                let mean = |pictures: Vec<Vec<[f32; 3]>>| {
                    (0..(width * height) as usize).map(|i| mean_of(pictures.iter().map(|p| p[i]))).collect::<Vec<_>>()
                };
                Ok(self.of_halves(halves.map(mean)))
            }
        }
    }

    fn of_halves(&self, [a, b]: [Vec<[f32; 3]>; 2]) -> (Picture, f64) {
        let whole = a.iter().zip(&b).map(|(a, b)| mean_of([*a, *b].into_iter())).collect();
        let [a, b, whole] = [a, b, whole].map(|linear| encoded(self.size_px, linear));
        let apart = codes(&a, &b);
        (whole, 0.5 * (apart.iter().map(|d| d * d).sum::<f64>() / apart.len() as f64).sqrt())
    }
}

/// Measures frames interleaved: each round draws all of them in another order.
///
/// # Errors
/// The device fails.
pub fn times(gpu: &Gpu, ready: &mut [Ready], rounds: Rounds) -> Outcome<Vec<Times>> {
    let mut measured = vec![Vec::new(); ready.len()];
    let mut order: Vec<usize> = (0..ready.len()).collect();
    let mut state = 0x9e37_79b9_u32;
    for round in 0..rounds.warm_up + rounds.timed {
        for at in (1..order.len()).rev() {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            order.swap(at, (state >> 8) as usize % (at + 1));
        }
        for index in &order {
            let ms = ready[*index].draw(gpu)?;
            if round >= rounds.warm_up {
                measured[*index].push(ms);
            }
        }
        program::interrupt::check()?;
    }
    Ok(measured.iter().map(|ms| Times::of(ms)).collect())
}

impl Ready {
    /// Draws the frame. Returns the time from the call until the GPU has finished, in ms.
    ///
    /// # Errors
    /// The device fails.
    pub fn draw(&mut self, gpu: &Gpu) -> Outcome<f64> {
        let Settings { taa, reflections, .. } = self.settings;
        if taa.is_some() || reflections.is_some() {
            let jitter_px = taa.map_or(DVec2::ZERO, |taa| taa.jitter_px(self.drawn));
            self.world.views.again(ViewId::MAIN, jitter_px)?;
        }
        self.world.frame_index = FrameIndex(if taa.is_some() { self.drawn } else { 0 });
        self.drawn += 1;
        let start = Instant::now();
        self.executor.execute(&self.plan, &self.frame, &self.world, &Imports::new())?;
        gpu.wait()?;
        Ok(1e3 * start.elapsed().as_secs_f64())
    }

    /// Returns the picture: the second frame if frames use the previous one, or the last of several accumulated frames.
    ///
    /// # Errors
    /// The device fails.
    pub fn picture(&mut self, gpu: &Gpu) -> Outcome<Picture> {
        let frames = match self.settings {
            Settings { taa: Some(_), .. } => SUMMED,
            Settings { reflections: Some(_), .. } => 2,
            _ => 1,
        };
        for _ in 0..frames {
            self.draw(gpu)?;
        }
        self.read(gpu)
    }

    /// Returns the temporal noise of accumulated frames: root mean square of 16 frames against their mean, in 8-bit
    /// steps. `None` if frames are not accumulated.
    ///
    /// # Errors
    /// The device fails.
    pub fn trembles(&mut self, gpu: &Gpu) -> Outcome<Option<f64>> {
        if self.settings.taa.is_none() {
            return Ok(None);
        }
        let mut frames = Vec::new();
        for _ in 0..TREMBLING {
            self.draw(gpu)?;
            frames.push(self.read(gpu)?);
        }
        let rest = (0..frames[0].linear.len()).map(|i| mean_of(frames.iter().map(|frame| frame.linear[i]))).collect();
        let rest = encoded(self.size_px, rest);
        let squares = frames.iter().flat_map(|frame| codes(frame, &rest)).map(|d| d * d);
        Ok(Some((squares.sum::<f64>() / (frames.len() * 3 * rest.linear.len()) as f64).sqrt()))
    }

    /// Moves the camera around the vertical axis through the scene's center, by an angle from its first position. The next
    /// frame has motion vectors from the previous one.
    ///
    /// # Errors
    /// The device fails.
    pub fn turn(&mut self, gpu: &Gpu, angle_rad: f64) -> Outcome<()> {
        let [width, height] = self.size_px.map(f64::from);
        let (turn, center) = (DQuat::from_rotation_y(angle_rad), self.scene.bounds_above_ground().center());
        self.moment.camera = self.scene.default_camera(width / height);
        let camera = &mut self.moment.camera;
        camera.eye = center + turn * (camera.eye - center);
        camera.world_from_view = turn * camera.world_from_view;
        let before = &self.world.views.get(ViewId::MAIN)?.view;
        let view = CameraView::new(&self.scene, &self.world.lighting.image, &Background::Environment, &self.moment);
        let mut view = view.after(before);
        if let Some(taa) = self.settings.taa {
            view.jitter(taa.jitter_px(self.drawn));
        }
        Ok(self.world.set_view(gpu, ViewId::MAIN, view)?)
    }

    /// Draws one frame of a sequence and returns its picture, after [`Ready::turn`].
    ///
    /// # Errors
    /// The device fails.
    pub fn next(&mut self, gpu: &Gpu) -> Outcome<Picture> {
        self.world.frame_index = FrameIndex(self.drawn);
        self.drawn += 1;
        self.executor.execute(&self.plan, &self.frame, &self.world, &Imports::new())?;
        gpu.wait()?;
        self.read(gpu)
    }

    /// Returns the feature culling of the scene and settings.
    pub fn facts(&self) -> Facts {
        let input = FactInput {
            scene: &self.scene,
            survey: &SceneSummary::new(&self.scene),
            around: EnvironmentSummary::from(&self.world.lighting.image),
            background: &Background::Environment,
            views: std::slice::from_ref(&self.moment),
            settings: &self.settings.for_scene(&self.scene, self.moment.size_px),
            forced: EffectSet::NONE,
            max_steps: FactInput::MAX_CODES,
            measured: Measurement::Off,
        };
        decide(&input, &mut FactMemory::default())
    }

    fn read(&self, gpu: &Gpu) -> Outcome<Picture> {
        let texture = self.executor.texture(&self.plan, self.output).ok_or("the frame left no picture")?;
        let codes = read_texture(gpu, texture)?.rgba8();
        let linear =
            |pixel: &[u8]| [0, 1, 2].map(|c: usize| linear_from_srgb_channel(f64::from(pixel[c]) / 255.0) as f32);
        Ok(encoded(self.size_px, codes.chunks_exact(4).map(linear).collect()))
    }

    /// Returns GPU times of each step without the first four frames; empty if the device has no timestamps.
    ///
    /// # Errors
    /// The device fails.
    pub fn steps(&mut self) -> Outcome<Vec<StepRecord>> {
        self.executor.catch_up()?;
        let timing = self.executor.timing();
        let of = |step| {
            let gpu = timing.step(step).gpu?;
            let names = self.plan.passes_of(step).iter().map(|member| self.plan.graph().pass_name(member.pass));
            let passes = names.collect::<Vec<_>>().join(" + ");
            Some(StepRecord { passes, min: gpu.min_ms, p25: gpu.p25_ms, median: gpu.median_ms })
        };
        Ok(self.plan.step_ids().filter_map(of).collect())
    }
}

/// Converts linear display light to a picture.
fn encoded(size_px: [u32; 2], linear: Vec<[f32; 3]>) -> Picture {
    let encode = |pixel: &[f32; 3]| pixel.map(|c| srgb_from_linear_channel(c.into()) as f32);
    Picture { size_px, encoded: linear.iter().map(encode).collect(), linear }
}

fn mean_of(pixels: impl Iterator<Item = [f32; 3]>) -> [f32; 3] {
    let (sum, count) = pixels.fold(([0.0; 3], 0.0), |(sum, n), p| ([0, 1, 2].map(|c| sum[c] + p[c]), n + 1.0));
    sum.map(|c| c / count)
}

/// Returns the differences of all channels, in 8-bit steps.
pub fn codes(ours: &Picture, truth: &Picture) -> Vec<f64> {
    let pixels = ours.encoded.iter().zip(&truth.encoded);
    pixels.flat_map(|(a, b)| [0, 1, 2].map(|c| 255.0 * (f64::from(a[c]) - f64::from(b[c])))).collect()
}

/// Returns root mean square and signed mean in 8-bit steps, and further metrics.
///
/// # Errors
/// The pictures' sizes differ.
pub fn compared(ours: &Picture, truth: &Picture) -> Outcome<(f64, f64, PictureRecord)> {
    let metrics = Metrics::of(ours, truth).ok_or("pictures of one size")?;
    let codes = codes(ours, truth);
    let count = codes.len() as f64;
    let mut sizes: Vec<f64> = codes.iter().map(|d| d.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let light = ours.linear.iter().flatten().zip(truth.linear.iter().flatten());
    let relative = light.map(|(a, b)| f64::from((a - b).powi(2) / (b * b + 0.01))).sum::<f64>() / count;
    let picture = PictureRecord {
        worst: sizes[sizes.len() - 1],
        p999: super::statistics::quantile(&sizes, 0.999),
        psnr_db: metrics.psnr_db.is_finite().then_some(metrics.psnr_db),
        flip: metrics.flip,
        relative_mse: relative,
    };
    Ok(((codes.iter().map(|d| d * d).sum::<f64>() / count).sqrt(), codes.iter().sum::<f64>() / count, picture))
}
