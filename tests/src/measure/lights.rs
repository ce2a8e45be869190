//! Many lights: a scene at night, rendered with froxels and with a loop over all lights.

use crate::executors;
use crate::stage::light_cache;
use framegraph::{Extent, Options, Plan, Scratch, Target, Texture, compile};
use framegraph_passes::effects::shadow::{KeptShadows, maps_slot};
use framegraph_passes::gpu_scene::punctual::LightLists;
use framegraph_passes::gpu_scene::view::{Background, ViewSettings, Views};
use framegraph_passes::light::ibl::{DfgSettings, IblSettings};
use framegraph_passes::light::shading::LightSettings;
use framegraph_passes::{CameraView, Handles, LightSearch, Lighting, Settings, Slot, ViewId, World, stages};
use framegraph_scene::{Camera, Environment, Light, LightKind, Scene, progress};
use framegraph_wgpu::{Frame, Gpu, Imports, read_texture};
use glam::DVec3;
use std::collections::BTreeSet;
use std::error::Error;
use std::time::Instant;

/// A scene without environment light, on the GPU.
#[derive(Debug)]
pub struct Night {
    /// The scene.
    pub scene: Scene,
    /// View of the scene; its shadows are taken from the settings.
    pub seen: ViewSettings,
    /// Settings of the frame.
    pub settings: Settings,
    world: World,
}

/// A picture with its time.
#[derive(Clone, Debug)]
pub struct Shot {
    /// Radiance times exposure of each pixel, rows from the top.
    pub linear: Vec<[f32; 4]>,
    /// Minimum time of the frames in ms, from submission until the GPU has finished.
    pub ms: f64,
    /// Number of rendered shadow map layers.
    pub layers: usize,
}

impl Night {
    /// Creates a night scene with a camera and a picture size.
    ///
    /// # Errors
    /// The device fails.
    pub fn new(
        gpu: &Gpu,
        scene: Scene,
        camera: Camera,
        size_px: [u32; 2],
        settings: Settings,
    ) -> Result<Self, Box<dyn Error>> {
        let settings = Settings { fxaa: false, ..settings }.for_scene(&scene, size_px);
        let image = IblSettings { cube_texels: 64, bands: settings.shading.bands, ..IblSettings::default() };
        let light = LightSettings { image, dfg: DfgSettings { texels: 32, visibility: settings.shading.table } };
        let dark = Environment::uniform(DVec3::ZERO)?;
        let lighting = Lighting::new(gpu, &dark, &light, &light_cache(), &mut progress::silent)?;
        let seen = ViewSettings { camera, size_px, ev100: 3.0, shadows: settings.shadows, ..ViewSettings::default() };
        let view = CameraView::new(&scene, &lighting.image, &Background::None, &seen);
        let world = World::new(gpu, &scene, lighting, [view], &mut progress::silent)?;
        Ok(Self { scene, seen, settings, world })
    }

    /// Returns the view with a method of finding lights.
    pub fn view(&self, lights: LightSearch) -> CameraView {
        let seen = ViewSettings { lights, ..self.seen.clone() };
        CameraView::new(&self.scene, &self.world.lighting.image, &Background::None, &seen)
    }

    /// Draws a view `frames` times.
    ///
    /// # Errors
    /// The device fails.
    pub fn shoot(&mut self, gpu: &Gpu, view: CameraView, frames: u32) -> Result<Shot, Box<dyn Error>> {
        self.world.set_view(gpu, ViewId::MAIN, view)?;
        self.execute(gpu, Frame::new(), Handles::default(), &Imports::new(), frames)
    }

    /// Draws a view once with cached shadow maps.
    ///
    /// # Errors
    /// The device fails.
    pub fn shoot_keeping(
        &mut self,
        gpu: &Gpu,
        view: CameraView,
        kept: &mut KeptShadows,
    ) -> Result<Shot, Box<dyn Error>> {
        let shadows = view.shadows.clone().ok_or("a view with shadows")?;
        self.world.set_view(gpu, ViewId::MAIN, view)?;
        let (mut frame, mut imports) = (Frame::new(), Imports::new());
        let maps = kept.declare(gpu, &mut frame, ViewId::MAIN, &shadows)?.ok_or("something casts")?;
        kept.import(maps, &mut imports);
        let handles = Handles::default().with_shadow_maps(maps_slot(&shadows.settings), maps);
        let shot = self.execute(gpu, frame, handles, &imports, 1)?;
        kept.drawn(&shadows);
        Ok(shot)
    }

    fn execute(
        &self,
        gpu: &Gpu,
        mut frame: Frame<World>,
        handles: Handles,
        imports: &Imports,
        frames: u32,
    ) -> Result<Shot, Box<dyn Error>> {
        let hdr = stages(&self.settings).declare(&mut frame, handles, Target::New)?.get(Slot::HDR)?;
        let (pictures, ms) = self.run(gpu, &mut frame, &[hdr], imports, frames)?;
        let graph = frame.graph();
        let draws = |name: &str| ["shadow", "shadow/cascade", "shadow/local"].contains(&name);
        let layers = graph.pass_ids().filter(|pass| draws(graph.pass_name(*pass))).count();
        Ok(Shot { linear: pictures.concat(), ms, layers })
    }

    /// Draws several views in one graph, each in its size.
    ///
    /// # Errors
    /// The device fails.
    pub fn shoot_together(&mut self, gpu: &Gpu, views: Vec<CameraView>) -> Result<Vec<Vec<[f32; 4]>>, Box<dyn Error>> {
        let sizes: Vec<_> = views.iter().map(|view| view.frame.viewport_size_px).collect();
        self.world.views = Views::new(gpu, views)?;
        let (mut frame, stages) = (Frame::new(), stages(&self.settings));
        let mut pictures = Vec::new();
        for (number, size) in (0..).zip(sizes) {
            let handles = Handles::for_view(ViewId(number), Extent::absolute(size.x as u32, size.y as u32));
            let declare = |frame: &mut Frame<World>| stages.declare(frame, handles, Target::New);
            pictures.push(frame.scope(&format!("view {number}"), declare)?.get(Slot::HDR)?);
        }
        Ok(self.run(gpu, &mut frame, &pictures, &Imports::new(), 1)?.0)
    }

    /// Executes a frame several times. Returns its textures, and the minimum time in ms.
    fn run(
        &self,
        gpu: &Gpu,
        frame: &mut Frame<World>,
        wanted: &[Texture],
        imports: &Imports,
        frames: u32,
    ) -> Result<(Vec<Vec<[f32; 4]>>, f64), Box<dyn Error>> {
        wanted.iter().try_for_each(|texture| frame.graph_mut().readback(*texture))?;
        let mut plan = Plan::new();
        let [width, height] = self.seen.size_px;
        compile(frame.graph(), &gpu.caps(), &Options::for_frame(width, height), &mut Scratch::new(), &mut plan)?;
        let mut executor = executors::lend(gpu);
        let mut ms = f64::INFINITY;
        for _ in 0..frames.max(1) {
            let start = Instant::now();
            executor.execute(&plan, frame, &self.world, imports)?;
            gpu.wait()?;
            ms = ms.min(1e3 * start.elapsed().as_secs_f64());
        }
        let read = |texture: &Texture| -> Result<_, Box<dyn Error>> {
            let texture = executor.texture(&plan, *texture).ok_or("there is no picture")?;
            Ok(read_texture(gpu, texture)?.rgba())
        };
        Ok((wanted.iter().map(read).collect::<Result<_, _>>()?, ms))
    }

    /// Returns the minimum time of creating the view, in ms.
    pub fn view_ms(&self, lights: LightSearch, repeats: u32) -> f64 {
        let time = |_| {
            let start = Instant::now();
            std::hint::black_box(self.view(lights));
            1e3 * start.elapsed().as_secs_f64()
        };
        (0..repeats).map(time).fold(f64::INFINITY, f64::min)
    }

    /// Counts pairs of a light and a froxel such that one of `samples` points lit by the light is visible in the
    /// froxel. All lights must have a range. The froxel of a point is computed from the documented rule: tiles of the
    /// picture, and depths in geometric steps between `ends_m`.
    pub fn touched(&self, lists: &LightLists, ends_m: [f64; 2], samples: u32) -> usize {
        let [width, height] = self.seen.size_px.map(f64::from);
        let camera = &self.seen.camera;
        let clip_from_world = camera.clip_from_view(width / height) * camera.view_from_world();
        let [across, down, slices] = lists.uniforms.counts;
        let side = f64::from(1.0 / lists.uniforms.tiles_per_px);
        let slice_of = |ahead: f64| {
            let ratio = (ends_m[1] / ends_m[0]).powf(1.0 / f64::from(slices.max(2) - 1));
            (1..slices).take_while(|slice| ahead >= ends_m[0] * ratio.powi(*slice as i32 - 1)).count() as u32
        };
        let mut pairs = BTreeSet::new();
        let mut random = Random(1);
        for (number, light) in self.scene.lights.iter().enumerate() {
            for _ in 0..samples {
                let place = light.position + reached(light, &mut random);
                let clip = clip_from_world * place.extend(1.0);
                let ndc = clip.truncate() / clip.w;
                if clip.w > 0.0 && ndc.x.abs() <= 1.0 && ndc.y.abs() <= 1.0 && (0.0..=1.0).contains(&ndc.z) {
                    let tile =
                        |at: f64, size: f64, count: u32| (((at + 1.0) * 0.5 * size / side) as u32).min(count - 1);
                    let (x, y) = (tile(ndc.x, width, across), tile(-ndc.y, height, down));
                    pairs.insert((number, x, y, slice_of((place - camera.eye).dot(camera.forward()))));
                }
            }
        }
        pairs.len()
    }
}

/// Returns a point within the range of a light, relative to the light.
fn reached(light: &Light, random: &mut Random) -> DVec3 {
    let (LightKind::Point { range_m, .. } | LightKind::Spot { range_m, .. }) = light.kind else { return DVec3::ZERO };
    let range = f64::from(range_m.unwrap_or(0.0));
    let axis = light.direction.as_dvec3();
    let least_cosine = match light.kind {
        LightKind::Spot { outer_cone_rad, .. } => f64::from(outer_cone_rad).cos(),
        _ => -1.0,
    };
    let cosine = least_cosine + (1.0 - least_cosine) * random.next();
    let (right, up) = axis.any_orthonormal_pair();
    let (sin, cos) = (random.next() * std::f64::consts::TAU).sin_cos();
    let aside = (1.0 - cosine * cosine).max(0.0).sqrt();
    (axis * cosine + (right * cos + up * sin) * aside) * (range * random.next().cbrt())
}

/// SplitMix64 generator (Steele et al. 2014) of numbers in 0…1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}
