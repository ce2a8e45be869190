//! Screen-space reflections of a room on a device, compared with exact reflections.

use crate::executors;
use framegraph::{Extent, Format, Intent, Options, Plan, Scratch, Texture, compile};
use framegraph_passes::effects::depth::structure::Resolution;
use framegraph_passes::effects::reflection::{ReflectionSettings, reflections};
use framegraph_passes::gpu_scene::upload::GpuScene;
use framegraph_passes::gpu_scene::view::Views;
use framegraph_passes::program::Programs;
use framegraph_passes::stages::Slot;
use framegraph_passes::{CameraView, Handles, PreparedScene, ViewId, ViewSettings};
use framegraph_scene::geometry::{plane, sphere};
use framegraph_scene::{Camera, Material, Projection, Scene, progress};
use framegraph_wgpu::{Frame, Gpu, Imports, Raster, Shader, read_texture};
use glam::{DMat4, DVec2, DVec3, Vec2, Vec3};
use std::error::Error;
use truth::reflection::{Lens, Mirrored, Room};

/// Replaces the previous frame's radiance with texture coordinates, so that a reflection shows where it was found. The
/// left half can contain invalid values instead.
const PAINT: &str = "
    override BROKEN: f32 = 0.0;
    @vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
        return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.0, 1.0);
    }
    @fragment fn fs_main(@builtin(position) at: vec4f) -> @location(0) vec4f {
        let uv = at.xy / vec2f(WIDTH, HEIGHT);
        if uv.x < 0.5 && BROKEN != 0.0 {
            // Computed at run time, since constant NaN is rejected.
            return vec4f(bitcast<f32>(u32(BROKEN) << 16u));
        }
        return vec4f(uv, 1.0, 1.0);
    }";

/// First 16 bits of an f32 that is NaN, infinity and negative infinity.
pub const BROKEN: [u32; 3] = [0x7fc0, 0x7f80, 0xff80];

/// A room of mirrors with a camera, as a scene and as formulas.
#[derive(Debug)]
pub struct Stage {
    /// Room as formulas.
    pub room: Room,
    /// Camera as formulas.
    pub lens: Lens,
    /// Width and height of the picture, in pixels.
    pub size_px: [u32; 2],
    /// Camera of the previous frame.
    pub earlier: Lens,
    /// The room as a scene.
    pub scene: Scene,
    /// Projection of the camera.
    pub projection: Projection,
}

/// Data that the passes read: shaders, meshes and a camera.
struct Parts {
    programs: Programs,
    scene: GpuScene,
    views: Views,
}

impl AsRef<Programs> for Parts {
    fn as_ref(&self) -> &Programs {
        &self.programs
    }
}

impl AsRef<GpuScene> for Parts {
    fn as_ref(&self) -> &GpuScene {
        &self.scene
    }
}

impl AsRef<Views> for Parts {
    fn as_ref(&self) -> &Views {
        &self.views
    }
}

/// Statistics of rays from the pixels of one kind of mirror.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Found {
    /// Number of pixels that reflect a visible point, away from the picture's border.
    pub seen: usize,
    /// Share of these pixels with a hit.
    pub hit: f64,
    /// Distance from the exact hit in pixels: median and 95th percentile.
    pub off_px: [f64; 2],
    /// Share of hits that are off by more than 4 pixels, and thus on another object.
    pub elsewhere: f64,
    /// Number of pixels whose rays hit nothing within the range.
    pub empty: usize,
    /// Share of these pixels with a hit, which is wrong.
    pub made_up: f64,
    /// Number of pixels that reflect a point outside of the picture or hidden in it.
    pub unseen: usize,
    /// Share of these pixels with a hit, which is wrong.
    pub mistaken: f64,
}

impl Stage {
    /// Creates three mirror balls over a mirror floor.
    pub fn balls(size_px: [u32; 2]) -> Self {
        let balls = [(-0.9, 0.5, 0.0, 0.4), (0.1, 0.62, -0.5, 0.45), (0.95, 0.45, 0.3, 0.35)];
        let balls = balls.map(|(x, y, z, radius)| (DVec3::new(x, y, z), radius)).to_vec();
        let lens = Lens {
            eye: DVec3::new(0.2, 1.3, 3.4),
            target: DVec3::new(0.0, 0.3, 0.0),
            fov_y_rad: 0.7,
            aspect: f64::from(size_px[0]) / f64::from(size_px[1]),
        };
        Self::new(Room { floor_m: 0.0, balls }, lens, size_px)
    }

    /// Creates a stage from a room and a camera.
    pub fn new(room: Room, lens: Lens, size_px: [u32; 2]) -> Self {
        let mut scene = Scene { name: "room".into(), ..Scene::default() };
        let mirror = scene.add_material(Material { metallic: 1.0, ..Material::dielectric("mirror", Vec3::ONE, 0.0) });
        let floor = scene.add_mesh(plane(Vec2::splat(40.0), 8, Vec2::ONE));
        scene.add_instance("floor", floor, mirror, DMat4::from_translation(DVec3::Y * room.floor_m));
        let ball = scene.add_mesh(sphere(1.0, 256, 128));
        for (middle, radius) in &room.balls {
            let at = DMat4::from_translation(*middle) * DMat4::from_scale(DVec3::splat(*radius));
            scene.add_instance("ball", ball, mirror, at);
        }
        let projection = Projection::perspective(lens.fov_y_rad, 0.05);
        Self { room, lens, size_px, earlier: lens, scene, projection }
    }

    fn view(&self, lens: &Lens) -> Result<CameraView, Box<dyn Error>> {
        let camera = Camera::look_at(lens.eye, lens.target, DVec3::Y, self.projection)?;
        let size_px = self.size_px;
        let seen = ViewSettings { camera, size_px, ev100: 0.0, shadows: None, ..ViewSettings::default() };
        Ok(CameraView::unlit(&PreparedScene::new(&self.scene), &seen))
    }

    /// Returns the reflections in the second frame, where the first one was filled with texture coordinates. `broken`
    /// is an element of [`BROKEN`], or 0. Each texel has the coordinates of the hit and 1, multiplied by the weight,
    /// and the weight.
    ///
    /// # Errors
    /// The device fails.
    pub fn reflected(
        &self,
        gpu: &Gpu,
        settings: &ReflectionSettings,
        resolution: Resolution,
        broken: u32,
    ) -> Result<Vec<[f32; 4]>, Box<dyn Error>> {
        let view = self.view(&self.lens)?.after(&self.view(&self.earlier)?);
        let scene = GpuScene::upload(gpu, &self.scene, &mut progress::silent)?;
        let parts = Parts { programs: Programs::new(), scene, views: Views::new(gpu, [view])? };
        let [width, height] = self.size_px;
        let mut frame = Frame::<Parts>::new();
        let mut handles = Handles::for_view(ViewId::MAIN, Extent::FRAME);
        reflections(&mut frame, &mut handles, settings, (resolution, 1), 1, Format::Rgba16Float)?;
        let (found, history) = (handles.get(Slot::REFLECTIONS)?, handles.get(Slot::HDR_HISTORY)?);
        paint(&mut frame, history, self.size_px, broken)?;
        frame.graph_mut().readback(found)?;
        let mut plan = Plan::new();
        compile(frame.graph(), &gpu.caps(), &Options::for_frame(width, height), &mut Scratch::new(), &mut plan)?;
        let mut executor = executors::lend(gpu);
        let mut read = || -> Result<_, Box<dyn Error>> {
            executor.execute(&plan, &frame, &parts, &Imports::new())?;
            Ok(read_texture(gpu, executor.texture(&plan, found).ok_or("there is no result")?)?.rgba())
        };
        let first = read()?;
        assert!(first.iter().all(|texel| *texel == [0.0; 4]), "the first frame has none before it");
        read()
    }

    /// Returns statistics of rays on the floor and on the balls.
    ///
    /// # Errors
    /// The device fails.
    pub fn found(
        &self,
        gpu: &Gpu,
        settings: &ReflectionSettings,
        resolution: Resolution,
    ) -> Result<[Found; 2], Box<dyn Error>> {
        let texels = self.reflected(gpu, settings, resolution, 0)?;
        Ok([true, false].map(|floor| self.judge(&texels, settings, floor)))
    }

    fn judge(&self, texels: &[[f32; 4]], settings: &ReflectionSettings, floor: bool) -> Found {
        let size = DVec2::new(f64::from(self.size_px[0]), f64::from(self.size_px[1]));
        let (mut off, mut found) = (Vec::new(), Found::default());
        let (mut empty, mut unseen) = (0, 0);
        for (index, texel) in texels.iter().enumerate() {
            let at = DVec2::new((index % self.size_px[0] as usize) as f64, (index / self.size_px[0] as usize) as f64);
            let reach_m = f64::from(settings.reach_m);
            let truth = self.room.mirrored(&self.lens, (at + 0.5) / size, reach_m, &self.earlier);
            let Some((_, shown)) = truth.filter(|(place, _)| place.on_floor == floor) else { continue };
            let [u, v, _, counts] = texel.map(f64::from);
            // Hits with a weight below 0.1 are ignored, since they have few significant bits.
            let met = counts > 0.1;
            match shown {
                // Reflections fade near the border of the picture and near the end of the range.
                Mirrored::Seen(uv) if (uv - 0.5).abs().max_element() < 0.4 => {
                    found.seen += 1;
                    if met {
                        off.push(((DVec2::new(u, v) / counts - uv) * size).length());
                    }
                }
                Mirrored::Seen(_) => {}
                Mirrored::Nothing => (found.empty, empty) = (found.empty + 1, empty + usize::from(met)),
                Mirrored::Unseen => (found.unseen, unseen) = (found.unseen + 1, unseen + usize::from(met)),
            }
        }
        off.sort_by(f64::total_cmp);
        let share = |part: usize, of: usize| part as f64 / of.max(1) as f64;
        let below = |share: f64| off.get((off.len() as f64 * share) as usize).copied().unwrap_or(0.0);
        Found {
            hit: share(off.len(), found.seen),
            off_px: [below(0.5), below(0.95)],
            elsewhere: share(off.iter().filter(|px| **px > 4.0).count(), off.len()),
            made_up: share(empty, found.empty),
            mistaken: share(unseen, found.unseen),
            ..found
        }
    }
}

/// Declares the pass that fills the history.
fn paint(
    frame: &mut Frame<Parts>,
    history: Texture,
    [width, height]: [u32; 2],
    broken: u32,
) -> Result<(), Box<dyn Error>> {
    let text = PAINT.replace("WIDTH", &format!("{width}.0")).replace("HEIGHT", &format!("{height}.0"));
    frame.add_fn(
        "paint",
        move |pass| pass.color(history, Intent::Overwrite),
        move |_, _, cx| {
            let constants = [("BROKEN", f64::from(broken))];
            let pipeline = cx.raster_pipeline(&Raster {
                constants: framegraph_wgpu::Constants(&constants),
                ..Raster::new(Shader::new("paint", &text))
            })?;
            let pass = cx.render_pass()?;
            pass.set_pipeline(&pipeline);
            pass.draw(0..3, 0..1);
            Ok(())
        },
    )?;
    Ok(())
}
