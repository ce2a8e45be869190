//! Temporal anti-aliasing of analytic pictures: a moving disc before a background, sampled with the jitter.

use framegraph::{
    ClearValue, DeclareError, Extent, Format, Intent, Options, Plan, Scratch, Target, Texture, TextureDesc, compile,
};
use framegraph_passes::SettingsTable;
use framegraph_passes::effects::taa::Taa;
use framegraph_passes::gpu_scene::view::Views;
use framegraph_passes::program::Programs;
use framegraph_passes::{CameraView, LightSearch, TaaSettings, ViewId, ViewSettings};
use framegraph_scene::{Camera, Projection};
use framegraph_shader_mirrors::srgb::srgb_from_linear_channel;
use framegraph_wgpu::{Executor, Frame, Gpu, Imports, Raster, Shader, read_texture};
use glam::{DVec2, DVec3};
use std::error::Error;

/// Draws a disc before stripes; `disc` has its center and radius in pixels, and its radiance.
const PAINT: Shader<'static> = Shader::new(
    "paint",
    "struct Painted { disc: vec4f, jitter: vec2f, stripes: vec2f }
     @group(0) @binding(0) var<uniform> painted: Painted;
     @vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
         return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.0, 1.0);
     }
     @fragment fn fs_main(@builtin(position) at: vec4f) -> @location(0) vec4f {
         let place = at.xy - vec2f(painted.jitter.x, -painted.jitter.y);
         let stripe = step(0.5, fract((place.x + 0.4 * place.y) / 8.0));
         let ground = painted.stripes.x + painted.stripes.y * stripe;
         let light = select(ground, painted.disc.w, distance(place, painted.disc.xy) < painted.disc.z);
         return vec4f(light, light, 0.5 * light, 1.0);
     }",
);

/// Parameters of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Painted {
    /// Center and radius in pixels from the top left, and radiance.
    pub disc: [f32; 4],
    /// Radiance of the background, and the addition of every other stripe.
    pub ground: [f32; 2],
}

impl Painted {
    /// Returns the radiance at a point, in pixels from the top left.
    pub fn light(&self, place: DVec2) -> f64 {
        let [x, y, radius, light] = self.disc.map(f64::from);
        let stripe = ((place.x + 0.4 * place.y) / 8.0).rem_euclid(1.0) >= 0.5;
        let ground = f64::from(self.ground[0]) + if stripe { f64::from(self.ground[1]) } else { 0.0 };
        if place.distance(DVec2::new(x, y)) < radius { light } else { ground }
    }
}

/// Data that passes read.
struct World {
    programs: Programs,
    views: Views,
    painted: Painted,
}

impl AsRef<Programs> for World {
    fn as_ref(&self) -> &Programs {
        &self.programs
    }
}

impl AsRef<Views> for World {
    fn as_ref(&self) -> &Views {
        &self.views
    }
}

/// The temporal pass alone, frame after frame.
pub struct Stage<'g> {
    gpu: &'g Gpu,
    executor: Executor,
    frame: Frame<World>,
    world: World,
    index: u32,
    /// Exposure of the following frames. Changing it or the picture changes the view.
    pub exposure: f32,
}

impl<'g> Stage<'g> {
    /// Creates a stage without frames.
    ///
    /// # Errors
    /// The device fails.
    pub fn new(gpu: &'g Gpu) -> Result<Self, Box<dyn Error>> {
        let camera = Camera::look_at(DVec3::Z, DVec3::ZERO, DVec3::Y, Projection::perspective(1.0, 0.1))?;
        let (size_px, lights) = ([64, 64], LightSearch::default());
        let seen = ViewSettings { camera, size_px, ev100: 0.0, shadows: None, lights, ..ViewSettings::default() };
        let views = Views::new(gpu, [CameraView::empty(&seen)])?;
        let painted = Painted { disc: [0.0; 4], ground: [0.0; 2] };
        let exposure = views.get(ViewId::MAIN)?.view.frame.exposure;
        Ok(Self {
            gpu,
            executor: Executor::new(gpu),
            frame: Frame::new(),
            world: World { programs: Programs::new(), views, painted },
            index: 0,
            exposure,
        })
    }

    /// Draws a frame. Returns the current picture and the accumulated one.
    ///
    /// # Errors
    /// The device fails.
    pub fn frame(
        &mut self,
        settings: &TaaSettings,
        painted: Painted,
        size_px: [u32; 2],
    ) -> Result<[Vec<[f32; 4]>; 2], Box<dyn Error>> {
        let jitter_px = settings.jitter_px(self.index);
        let before = &self.world.views.get(ViewId::MAIN)?.view;
        if painted == self.world.painted && self.exposure == before.frame.exposure {
            self.world.views.again(ViewId::MAIN, jitter_px)?;
        } else {
            let before = before.clone();
            let mut view = before.clone().after(&before);
            view.frame.exposure = self.exposure;
            view.jitter(jitter_px);
            self.world.views.set(self.gpu, ViewId::MAIN, view)?;
        }
        (self.world.painted, self.index) = (painted, self.index + 1);
        let frame = &mut self.frame;
        frame.reset();
        let hdr = paint(frame, Target::New, jitter_px)?;
        let depth = frame.add_fn(
            "depth",
            |pass| {
                let depth = pass.texture("depth", TextureDesc::new(Extent::FRAME, Format::Depth32Float));
                // A wall at a distance of 2 m.
                pass.depth(depth, Intent::Clear(ClearValue::DepthStencil(0.05, 0)))
            },
            |_, _, _| Ok(()),
        )?;
        let into = frame.graph_mut().history("taa", TextureDesc::new(Extent::FRAME, Format::Rgba16Float), 1);
        let earlier = frame.graph_mut().previous(into, 1)?;
        let sum = frame
            .add("taa", Taa { view: ViewId::MAIN, hdr, depth, velocity: None, earlier, into, settings: *settings })?
            .sum;
        frame.graph_mut().readback(hdr)?;
        self.run([hdr, sum], size_px)
    }

    /// Draws a frame in which another pass fills the accumulated picture with a number.
    ///
    /// # Errors
    /// The device fails.
    pub fn spoil(&mut self, number: f32, size_px: [u32; 2]) -> Result<(), Box<dyn Error>> {
        let frame = &mut self.frame;
        frame.reset();
        let into = frame.graph_mut().history("taa", TextureDesc::new(Extent::FRAME, Format::Rgba16Float), 1);
        self.world.painted = Painted { disc: [0.0; 4], ground: [number, 0.0] };
        let sum = paint(frame, Target::from(into), DVec2::ZERO)?;
        self.run([sum, sum], size_px).map(|_| ())
    }

    /// Marks a camera cut.
    pub fn cut(&mut self) {
        self.executor.reset_history("taa");
    }

    fn run(&mut self, wanted: [Texture; 2], [width, height]: [u32; 2]) -> Result<[Vec<[f32; 4]>; 2], Box<dyn Error>> {
        let (mut plan, frame) = (Plan::new(), &mut self.frame);
        frame.graph_mut().readback(wanted[1])?;
        compile(frame.graph(), &self.gpu.caps(), &Options::for_frame(width, height), &mut Scratch::new(), &mut plan)?;
        self.executor.execute(&plan, frame, &self.world, &Imports::new())?;
        let read = |texture| -> Result<_, Box<dyn Error>> {
            Ok(read_texture(self.gpu, self.executor.texture(&plan, texture).ok_or("there is no result")?)?.rgba())
        };
        Ok([read(wanted[0])?, read(wanted[1])?])
    }
}

/// Declares the pass that draws the picture.
fn paint(frame: &mut Frame<World>, into: Target, jitter_px: DVec2) -> Result<Texture, DeclareError> {
    let jitter = jitter_px.as_vec2().to_array();
    frame.add_fn(
        "paint",
        |pass| {
            let hdr = pass.target(into, "hdr", TextureDesc::new(Extent::FRAME, Format::Rgba16Float));
            pass.color(hdr, Intent::Overwrite)
        },
        move |_, world: &World, cx| {
            let Painted { disc: [x, y, radius, light], ground: [dark, more] } = world.painted;
            let pipeline = cx.raster_pipeline(&Raster::new(PAINT))?;
            let painted = cx.uniform(&[x, y, radius, light, jitter[0], jitter[1], dark, more]);
            let group = cx.bind_group(pipeline.group(0), &[(0, painted)]);
            let pass = cx.render_pass()?;
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.draw(0..3, 0..1);
            Ok(())
        },
    )
}

/// Returns two PSNRs in dB of encoded values, for still stripes and a disc after `frames` frames. The first compares
/// with 16×16 samples per pixel. The second compares each of the last sixteen frames with their mean, and measures
/// temporal noise.
///
/// # Errors
/// The device fails.
pub fn still(gpu: &Gpu, settings: &TaaSettings, frames: u32) -> Result<[f64; 2], Box<dyn Error>> {
    let size_px = [48_u32, 48];
    let painted = Painted { disc: [24.3, 22.8, 14.0, 0.9], ground: [0.05, 0.4] };
    let mut stage = Stage::new(gpu)?;
    let mut last = Vec::new();
    for frame in 0..frames {
        let [_, sum] = stage.frame(settings, painted, size_px)?;
        if frame + 16 >= frames {
            last.push(sum.iter().map(|texel| f64::from(texel[0])).collect::<Vec<f64>>());
        }
    }
    let texel = |index: usize| {
        let corner = DVec2::new((index % 48) as f64, (index / 48) as f64);
        let place = |i: u32| corner + (DVec2::new(f64::from(i % 16), f64::from(i / 16)) + 0.5) / 16.0;
        (0..256).map(|i| painted.light(place(i))).sum::<f64>() / 256.0
    };
    let truth: Vec<f64> = (0..48 * 48).map(texel).collect();
    let mean = |index: usize| last.iter().map(|sum| sum[index]).sum::<f64>() / last.len() as f64;
    let rest: Vec<f64> = (0..truth.len()).map(mean).collect();
    let error = |a: &[f64], b: &[f64]| {
        let squares =
            a.iter().zip(b).map(|(a, b)| (srgb_from_linear_channel(*a) - srgb_from_linear_channel(*b)).powi(2));
        squares.sum::<f64>() / a.len() as f64
    };
    let end = last.last().ok_or("there is no frame")?;
    let trembles = last.iter().map(|sum| error(sum, &rest)).sum::<f64>() / last.len() as f64;
    Ok([error(end, &truth), trembles].map(|squares| -10.0 * squares.log10()))
}

/// Measures ghosting of a disc that moves right by `speed_px` pixels per frame. At pixels that the disc left at least
/// two frames ago, the accumulated value is compared with the range of the pixel's neighborhood. Returns the largest
/// error and the root mean square.
///
/// # Errors
/// The device fails.
pub fn ghost(gpu: &Gpu, settings: &TaaSettings, ground: [f32; 2], speed_px: f64) -> Result<[f64; 2], Box<dyn Error>> {
    let (size_px, frames, radius) = ([96_u32, 32_u32], 16, 7.0);
    let mut stage = Stage::new(gpu)?;
    let middle = |frame: i32| DVec2::new(10.0 + speed_px * f64::from(frame), 16.0);
    let mut last = Vec::new();
    let at = |frame: i32| {
        let DVec2 { x, y } = middle(frame);
        Painted { disc: [x as f32, y as f32, radius, 4.0], ground }
    };
    for frame in 0..frames {
        [_, last] = stage.frame(settings, at(frame), size_px)?;
    }
    let (mut most, mut squares, mut count) = (0.0_f64, 0.0, 0);
    for (index, texel) in last.iter().enumerate() {
        let place = DVec2::new((index % 96) as f64 + 0.5, (index / 96) as f64 + 0.5);
        let reach = f64::from(radius) + 3.0;
        let covered = |frame: i32| place.distance(middle(frame)) < reach;
        if (0..frames - 2).any(covered) && !(frames - 2..frames).any(covered) {
            let near = (0..81).map(|i| {
                let aside = DVec2::new(f64::from(i % 9) - 4.0, f64::from(i / 9) - 4.0) * 0.5;
                at(frames - 1).light(place + aside)
            });
            let (low, high) = near.fold((f64::MAX, f64::MIN), |(low, high), light| (low.min(light), high.max(light)));
            let light = f64::from(texel[0]);
            let off = (light - high).max(low - light).max(0.0);
            (most, squares, count) = (most.max(off), squares + off * off, count + 1);
        }
    }
    Ok([most, (squares / f64::from(count.max(1))).sqrt()])
}

/// Settings whose figures are printed.
const CHOICES: [&str; 12] = [
    "on:feedback=1,filter-input=off",
    "on",
    "on:filter-input=off",
    "on:width=0.6",
    "on:clip=clamp",
    "on:clip=none",
    "on:box=variance",
    "on:box=both",
    "on:box=both,ycocg=on",
    "on:steady=on",
    "on:feedback=0.05",
    "on:converge=on,filter-input=off,jitter=halton32",
];

/// Returns the rows of the table in `docs/design/taa.md`, starting with its head.
///
/// # Errors
/// The device fails.
pub fn table(gpu: &Gpu) -> Result<Vec<String>, Box<dyn Error>> {
    let mut rows = vec![
        "| `--taa` | still, dB | trembles, dB | ghost on even ground | on stripes, most | RMS |".to_owned(),
        "| --- | --- | --- | --- | --- | --- |".to_owned(),
    ];
    for choice in CHOICES {
        let settings = TaaSettings::from_text(choice)?.ok_or("it is on")?;
        let [near, steady] = still(gpu, &settings, 32)?;
        let [even, _] = ghost(gpu, &settings, [0.05, 0.0], 3.0)?;
        let [most, rms] = ghost(gpu, &settings, [0.05, 0.4], 3.0)?;
        rows.push(format!("| `{choice}` | {near:.1} | {steady:.1} | {even:.4} | {most:.3} | {rms:.4} |"));
    }
    Ok(rows)
}
