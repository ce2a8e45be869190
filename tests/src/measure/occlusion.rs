//! Ambient occlusion of analytic scenes on a device: the passes run on a depth given by a formula.

pub mod mirror;

use crate::executors;
use framegraph::{Entry, Exit, Extent, Format, Intent, Options, Plan, Scratch, Texture, TextureDesc, compile};
use framegraph_passes::effects::depth::structure::{Resolution, StructureLevel, structure_levels};
use framegraph_passes::effects::occlusion::{AmbientOcclusion, Axis, OcclusionBlur, OcclusionSettings};
use framegraph_passes::gpu_scene::view::Views;
use framegraph_passes::program::Programs;
use framegraph_passes::{CameraView, Precision, ViewId, ViewSettings};
use framegraph_scene::{Camera, Projection};
use framegraph_wgpu::{Depth, Frame, Gpu, Imports, Raster, Shader, read_texture, texture_2d};
use glam::{DVec2, DVec3, Vec3};
use std::error::Error;
use std::time::Instant;
use truth::occlusion as truth;
use wgpu::util::{DeviceExt, TextureDataOrder};
use wgpu::{CompareFunction, TextureFormat, TextureUsages};

/// Copies an uploaded picture into a depth attachment.
const GIVEN: Shader<'static> = Shader::new(
    "given_depth",
    "@group(0) @binding(0) var given: texture_2d<f32>;
     @vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
         return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.0, 1.0);
     }
     @fragment fn fs_main(@builtin(position) at: vec4f) -> @builtin(frag_depth) f32 {
         return textureLoad(given, vec2<i32>(at.xy), 0).r;
     }",
);

/// A camera at the origin that looks along -z, with a given depth.
#[derive(Clone, Debug)]
pub struct Stage {
    /// The camera.
    pub camera: Camera,
    /// Width and height of the picture, in pixels.
    pub size_px: [u32; 2],
    /// Reversed depth of each pixel, rows from the top; 0 without a surface.
    pub depth: Vec<f32>,
    /// Direction toward the sun in view space; `None` without a sun.
    pub toward_sun: Option<DVec3>,
}

/// Data that the passes read: shaders and a camera.
struct Parts {
    programs: Programs,
    views: Views,
}

impl AsRef<Programs> for Parts {
    fn as_ref(&self) -> &Programs {
        &self.programs
    }
}

impl AsRef<Views> for Parts {
    fn as_ref(&self) -> &Views {
        &self.views
    }
}

impl Stage {
    /// Creates a stage from `scene`, which intersects a ray, given by start and direction, and returns the hit
    /// distance. All are in view space, and the distance is in units of the direction.
    ///
    /// # Errors
    /// The camera has no direction.
    pub fn new(
        projection: Projection,
        size_px: [u32; 2],
        scene: impl Fn(DVec3, DVec3) -> Option<f64>,
    ) -> Result<Self, Box<dyn Error>> {
        let camera = Camera::look_at(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, projection)?;
        let mut stage = Self { camera, size_px, depth: Vec::new(), toward_sun: None };
        let texels = size_px[0] * size_px[1];
        stage.depth = (0..texels)
            .map(|texel| {
                let (start, direction) = stage.ray(texel);
                let Some(way) = scene(start, direction) else { return 0.0 };
                let clip = stage.clip_from_view() * (start + way * direction).extend(1.0);
                (clip.z / clip.w) as f32
            })
            .collect();
        Ok(stage)
    }

    fn clip_from_view(&self) -> glam::DMat4 {
        self.camera.clip_from_view(f64::from(self.size_px[0]) / f64::from(self.size_px[1]))
    }

    /// Returns start and direction of the ray through the center of a texel, in view space. The direction has z = -1.
    pub fn ray(&self, texel: u32) -> (DVec3, DVec3) {
        let [width, height] = self.size_px.map(f64::from);
        let at = DVec2::new(f64::from(texel % self.size_px[0]) + 0.5, f64::from(texel / self.size_px[0]) + 0.5);
        let ndc = DVec2::new(2.0 * at.x / width - 1.0, 1.0 - 2.0 * at.y / height);
        let m = self.clip_from_view();
        let across = DVec2::new(ndc.x / m.x_axis.x, ndc.y / m.y_axis.y);
        match self.camera.projection {
            Projection::Perspective { .. } => (DVec3::ZERO, across.extend(-1.0)),
            Projection::Orthographic { .. } => (across.extend(0.0), DVec3::NEG_Z),
        }
    }

    /// Returns the position that a texel shows, in view space.
    pub fn position(&self, texel: u32, scene: impl Fn(DVec3, DVec3) -> Option<f64>) -> Option<DVec3> {
        let (start, direction) = self.ray(texel);
        scene(start, direction).map(|way| start + way * direction)
    }

    /// Returns the visibility of each texel from the ambient occlusion passes.
    ///
    /// # Errors
    /// The device fails.
    pub fn visibility(
        &self,
        gpu: &Gpu,
        settings: &OcclusionSettings,
        precision: Precision,
    ) -> Result<Vec<f32>, Box<dyn Error>> {
        let (texels, _) = self.occlusion(gpu, settings, precision, 1)?;
        Ok(texels.into_iter().map(|[visibility, ..]| visibility).collect())
    }

    /// Returns the visibility of each texel, with the mean open direction if enabled, and the minimum time of several
    /// frames in ms. The time runs from submission until the GPU has finished. The resolution is that of the picture;
    /// the setting is ignored.
    ///
    /// # Errors
    /// The device fails.
    pub fn occlusion(
        &self,
        gpu: &Gpu,
        settings: &OcclusionSettings,
        precision: Precision,
        frames: u32,
    ) -> Result<(Vec<[f32; 4]>, f64), Box<dyn Error>> {
        let seen = ViewSettings {
            camera: self.camera.clone(),
            size_px: self.size_px,
            ev100: 0.0,
            shadows: None,
            ..ViewSettings::default()
        };
        let mut view = CameraView::empty(&seen);
        if let Some(toward) = self.toward_sun {
            view.frame.sun_direction = toward.normalize().as_vec3();
            view.frame.sun_illuminance = Vec3::ONE;
        }
        let parts = Parts { programs: Programs::new(), views: Views::new(gpu, [view])? };
        let mut frame = Frame::<Parts>::new();
        let given = TextureDesc::new(Extent::FRAME, Format::R32Float);
        let given = frame.graph_mut().import_texture("given", given, Entry::Defined, Exit::Discard);
        let occlusion =
            declare(&mut frame, given, settings, precision, structure_levels(self.size_px, Resolution::Full))?;
        frame.graph_mut().readback(occlusion)?;
        let mut plan = Plan::new();
        let [width, height] = self.size_px;
        compile(frame.graph(), &gpu.caps(), &Options::for_frame(width, height), &mut Scratch::new(), &mut plan)?;
        let texture = self.uploaded(gpu);
        let mut imports = Imports::new();
        imports.texture(given, &texture);
        let mut executor = executors::lend(gpu);
        let mut least_ms = f64::INFINITY;
        for _ in 0..frames.max(1) {
            let start = Instant::now();
            executor.execute(&plan, &frame, &parts, &imports)?;
            gpu.wait()?;
            least_ms = least_ms.min(1e3 * start.elapsed().as_secs_f64());
        }
        let texture = executor.texture(&plan, occlusion).ok_or("there is no result")?;
        Ok((read_texture(gpu, texture)?.rgba(), least_ms))
    }

    fn uploaded(&self, gpu: &Gpu) -> wgpu::Texture {
        let [width, height] = self.size_px;
        let desc = texture_2d("given", [width, height], TextureFormat::R32Float, TextureUsages::TEXTURE_BINDING);
        let depth = bytemuck::cast_slice(&self.depth);
        gpu.device.create_texture_with_data(&gpu.queue, &desc, TextureDataOrder::LayerMajor, depth)
    }
}

/// Declares the passes of ambient occlusion over a given depth.
fn declare(
    frame: &mut Frame<Parts>,
    given: Texture,
    settings: &OcclusionSettings,
    precision: Precision,
    levels: u8,
) -> Result<Texture, Box<dyn Error>> {
    let mut structure = structure(frame, given, levels)?;
    for level in 1..levels {
        structure = frame.add("structure_level", StructureLevel { structure, level })?.structure;
    }
    let view = ViewId::MAIN;
    let pass = AmbientOcclusion { view, structure, settings: *settings, precision };
    let mut occlusion = frame.add("occlusion", pass)?.occlusion;
    if let Some(blur) = settings.blur {
        for axis in [Axis::Across, Axis::Down] {
            let bent_normals = settings.has_bent_normals();
            let pass = OcclusionBlur { view, structure, occlusion, blur, axis, bent_normals };
            occlusion = frame.add("occlusion_blur", pass)?.blurred;
        }
    }
    Ok(occlusion)
}

/// Declares level 0 of a given structure.
fn structure(frame: &mut Frame<Parts>, given: Texture, levels: u8) -> Result<Texture, Box<dyn Error>> {
    let desc = TextureDesc::new(Extent::FRAME, Format::Depth32Float).mips(levels);
    let structure = frame.graph_mut().texture("structure", desc);
    let (_, structure) = frame.add_fn(
        "structure",
        move |pass| {
            let given = pass.sampled(given)?;
            Ok((given, pass.depth(structure.mip(0), Intent::Overwrite)?))
        },
        |(given, _), _, cx| {
            let depth = Depth { compare: CompareFunction::Always, write: true, ..Depth::NONE };
            let pipeline = cx.raster_pipeline(&Raster { depth, ..Raster::new(GIVEN) })?;
            let given = cx.view(*given)?;
            let group = cx.bind_group(pipeline.group(0), &[(0, given.into())]);
            let pass = cx.render_pass()?;
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.draw(0..3, 0..1);
            Ok(())
        },
    )?;
    Ok(structure)
}

/// Returns a ground plane through (0, 0, -distance), rotated about x by `tilt_deg` degrees from facing the eye.
pub fn ground(distance_m: f64, tilt_deg: f64) -> impl Fn(DVec3, DVec3) -> Option<f64> + Clone {
    let (sin, cos) = tilt_deg.to_radians().sin_cos();
    let normal = DVec3::new(0.0, sin, cos);
    move |start, direction| {
        let way = normal.dot(DVec3::new(0.0, 0.0, -distance_m) - start) / normal.dot(direction);
        (way > 0.0 && way.is_finite()).then_some(way)
    }
}

/// Returns a corner of two perpendicular planes that both face the eye at 45°. Its vertical edge is at x = 0,
/// `distance_m` away.
pub fn corner(distance_m: f64) -> impl Fn(DVec3, DVec3) -> Option<f64> + Clone {
    // Returns the nearer intersection with z = -distance + |x|.
    move |start, direction| {
        let to = |side: f64| {
            let normal = DVec3::new(-side, 0.0, 1.0);
            normal.dot(DVec3::new(0.0, 0.0, -distance_m) - start) / normal.dot(direction)
        };
        Some(to(1.0).min(to(-1.0)))
    }
}

/// Creates a stage with the corner: 256 pixels wide, with a radius of 0.3 m of about 55 pixels. The projection is
/// parallel, so all pixels of a column have the same distance from the edge.
///
/// # Errors
/// Never: the camera has a direction.
pub fn corner_stage(side_px: u32) -> Result<Stage, Box<dyn Error>> {
    let projection = Projection::Orthographic { half_width_m: None, half_height_m: 0.7, near_m: 0.1, far_m: 10.0 };
    Stage::new(projection, [side_px, side_px], corner(3.0))
}

/// Returns the columns of [`corner_stage`] within `radius_m` of the edge, with their distance along the plane in m.
pub fn corner_columns(stage: &Stage, radius_m: f64) -> Vec<(u32, f64)> {
    let scene = corner(3.0);
    let distance = |x| stage.position(x, &scene).map_or(f64::INFINITY, |p| p.x.abs() * std::f64::consts::SQRT_2);
    (0..stage.size_px[0]).map(|x| (x, distance(x))).filter(|(_, d)| *d <= radius_m).collect()
}

/// Returns the texels of a column, without an eighth at either end.
pub fn column(stage: &Stage, texels: &[f32], x: u32) -> Vec<f64> {
    let [width, height] = stage.size_px;
    let rows = height / 8..height - height / 8;
    rows.map(|y| f64::from(texels[(y * width + x) as usize])).collect()
}

/// Returns mean and standard deviation.
pub fn mean_and_deviation(values: &[f64]) -> [f64; 2] {
    let count = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / count;
    [mean, (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / count).sqrt()]
}

/// Returns the root mean square error of visibility within `radius_m` of the corner.
pub fn corner_error(stage: &Stage, visibility: &[f32], radius_m: f64) -> f64 {
    let columns = corner_columns(stage, radius_m).into_iter();
    let errors = columns.flat_map(|(x, distance_m)| {
        let truth = truth::corner(distance_m, radius_m);
        column(stage, visibility, x).into_iter().map(move |v| (v - truth).powi(2))
    });
    let errors: Vec<f64> = errors.collect();
    (errors.iter().sum::<f64>() / errors.len().max(1) as f64).sqrt()
}
