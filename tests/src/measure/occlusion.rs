//! Ambient occlusion of analytic scenes on a device: a depth given by a formula, and what the passes make of it.

use framegraph::{Entry, Exit, Extent, Format, Intent, Options, Plan, Scratch, Texture, TextureDesc, compile};
use framegraph_passes::occlusion::{AmbientOcclusion, Axis, OcclusionBlur, OcclusionSettings};
use framegraph_passes::program::Programs;
use framegraph_passes::structure::{StructureLevel, structure_levels};
use framegraph_passes::view::Views;
use framegraph_passes::{CameraView, Precision, ViewId, ViewSettings};
use framegraph_scene::{Camera, Projection};
use framegraph_wgpu::{Depth, Executor, Frame, Gpu, Imports, Raster, Shader, read_texture};
use glam::{DVec2, DVec3};
use std::error::Error;
use wgpu::util::{DeviceExt, TextureDataOrder};
use wgpu::{CompareFunction, Extent3d, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages};

/// Writes an uploaded picture into a depth attachment.
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

/// A camera at the origin that looks along -z, and what it sees.
#[derive(Clone, Debug)]
pub struct Stage {
    /// The camera.
    pub camera: Camera,
    /// Width and height of the picture.
    pub size_px: [u32; 2],
    /// Reversed depth of each pixel, rows from the top; 0 where there is nothing.
    pub depth: Vec<f32>,
}

/// The passes' world: shaders and a camera.
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
    /// What a camera sees where `scene` gives the way along a ray, from a start, to what is there, if anything; both in view
    /// space, the way in units of the direction.
    ///
    /// # Errors
    /// When the camera has no direction.
    pub fn new(
        projection: Projection,
        size_px: [u32; 2],
        scene: impl Fn(DVec3, DVec3) -> Option<f64>,
    ) -> Result<Self, Box<dyn Error>> {
        let camera = Camera::look_at(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, projection)?;
        let mut stage = Self { camera, size_px, depth: Vec::new() };
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

    /// Start and direction of the ray through the middle of a texel, in view space; z of the direction is -1.
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

    /// Position that a texel shows, in view space.
    pub fn position(&self, texel: u32, scene: impl Fn(DVec3, DVec3) -> Option<f64>) -> Option<DVec3> {
        let (start, direction) = self.ray(texel);
        scene(start, direction).map(|way| start + way * direction)
    }

    /// Ambient occlusion that the passes make of it: visibility of each texel of the structure. The settings' resolution is
    /// that of the picture.
    ///
    /// # Errors
    /// What the device refuses.
    pub fn visibility(
        &self,
        gpu: &Gpu,
        settings: &OcclusionSettings,
        precision: Precision,
    ) -> Result<Vec<f32>, Box<dyn Error>> {
        let seen = ViewSettings {
            camera: self.camera.clone(),
            size_px: self.size_px,
            ev100: 0.0,
            environment_intensity: 1.0,
            shadows: None,
        };
        let parts = Parts { programs: Programs::new(), views: Views::new(gpu, [CameraView::empty(&seen)])? };
        let mut frame = Frame::<Parts>::new();
        let given = TextureDesc::new(Extent::FRAME, Format::R32Float);
        let given = frame.graph_mut().import_texture("given", given, Entry::Defined, Exit::Discard);
        let levels = structure_levels(self.size_px, settings.resolution);
        let mut structure = structure(&mut frame, given, levels)?;
        for level in 1..levels {
            structure = frame.add("structure_level", StructureLevel { structure, level })?.structure;
        }
        let view = ViewId::MAIN;
        let pass = AmbientOcclusion { view, structure, settings: *settings, precision };
        let mut occlusion = frame.add("occlusion", pass)?.occlusion;
        if let Some(blur) = settings.blur {
            for axis in [Axis::Across, Axis::Down] {
                occlusion =
                    frame.add("occlusion_blur", OcclusionBlur { view, structure, occlusion, blur, axis })?.blurred;
            }
        }
        frame.graph_mut().readback(occlusion)?;
        let mut plan = Plan::new();
        let [width, height] = self.size_px;
        compile(frame.graph(), &gpu.caps(), &Options::for_frame(width, height), &mut Scratch::new(), &mut plan)?;
        let texture = gpu.device.create_texture_with_data(
            &gpu.queue,
            &TextureDescriptor {
                label: Some("given"),
                size: Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: TextureDimension::D2,
                format: TextureFormat::R32Float,
                usage: TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            },
            TextureDataOrder::LayerMajor,
            bytemuck::cast_slice(&self.depth),
        );
        let mut imports = Imports::new();
        imports.texture(given, &texture);
        let mut executor = Executor::new(gpu);
        executor.execute(&plan, &frame, &parts, &imports)?;
        let texture = executor.texture(&plan, occlusion).ok_or("there is no result")?;
        Ok(read_texture(gpu, texture)?.rgba().into_iter().map(|[visibility, ..]| visibility).collect())
    }
}

/// Declares level 0 of a structure that is given.
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

/// Ground that tilts away from the eye: through (0, 0, -distance), turned by so many degrees about x from facing the eye.
pub fn ground(distance_m: f64, tilt_deg: f64) -> impl Fn(DVec3, DVec3) -> Option<f64> + Clone {
    let (sin, cos) = tilt_deg.to_radians().sin_cos();
    let normal = DVec3::new(0.0, sin, cos);
    move |start, direction| {
        let way = normal.dot(DVec3::new(0.0, 0.0, -distance_m) - start) / normal.dot(direction);
        (way > 0.0 && way.is_finite()).then_some(way)
    }
}

/// A corner of two planes at right angles that both face the eye at 45°, its edge upright at x = 0, `distance_m` away.
pub fn corner(distance_m: f64) -> impl Fn(DVec3, DVec3) -> Option<f64> + Clone {
    // The nearer of z = -distance + |x|.
    move |start, direction| {
        let to = |side: f64| {
            let normal = DVec3::new(-side, 0.0, 1.0);
            normal.dot(DVec3::new(0.0, 0.0, -distance_m) - start) / normal.dot(direction)
        };
        Some(to(1.0).min(to(-1.0)))
    }
}
