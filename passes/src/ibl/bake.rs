//! From a panorama to the specular cube, on the GPU.

use std::path::Path;

use framegraph_shaders::layout::{IBL_KERNEL_ROWS, IblKernelUniforms, IblUniforms};
use framegraph_shaders::reference::image_light::roughness_from_specular_lod;
use framegraph_shaders::{Module, library};
use glam::Vec4;
use wgpu::util::{DeviceExt, TextureDataOrder};
use wgpu::{
    BindingResource, Extent3d, RenderPipeline, Sampler, SamplerDescriptor, Texture, TextureDescriptor,
    TextureDimension, TextureFormat, TextureUsages, TextureView,
};

use super::draw::{Program, draw, uniform};
use super::kernel::{KernelRow, kernel_rows, lobe_kernel, weight_sum};
use super::texture::{CubeShape, cube_view, face_view, level_view, place_face};
use super::{IblError, IblSettings};
use framegraph_scene::environment::EquirectMap;
use framegraph_scene::progress::{Progress, ProgressFn, Stage, report};
use framegraph_wgpu::{Gpu, read_texture};

const IBL: Module<'_> = library::pass("pass/ibl.wgsl").unwrap();

/// Where the brightest texel of the cube lies: below 64512, the largest number of ten-bit floats, with
/// room for the rounding of sums.
const PEAK: f64 = 32768.0;

/// Steps that are reported: the faces of the source, its levels, the faces of each level.
struct Steps<'a, 'p> {
    name: &'a str,
    done: usize,
    total: usize,
    progress: &'a mut ProgressFn<'p>,
}

impl Steps<'_, '_> {
    /// Waits for what was submitted, and reports it.
    fn step(&mut self, gpu: &Gpu, item: &str) -> Result<(), IblError> {
        gpu.wait()?;
        self.done += 1;
        let progress = Progress { stage: Stage::Lighting, done: self.done, total: self.total, item };
        Ok(report(self.progress, Path::new(self.name), progress)?)
    }
}

/// The samples that level `level` is filtered with.
pub(super) fn level_kernel(settings: &IblSettings, level: u32) -> Vec<KernelRow> {
    let roughness = roughness_from_specular_lod(f64::from(level), f64::from(settings.levels - 1));
    lobe_kernel(roughness, kernel_rows(settings.cube_texels >> level), settings.cube_texels)
}

/// A cube that was made.
pub(super) struct Baked {
    pub cube: Texture,
    /// The radiance in nits of a texel that holds 1.
    pub texel_nits: f32,
    /// The bytes of each level, its faces one after the other, if they were asked for.
    pub levels: Vec<Vec<u8>>,
}

/// The prefiltered cube; with its bytes when these are to be kept.
///
/// Faces are drawn apart and copied into place, because OpenGL cannot copy the face of a cube into a
/// buffer.
pub(super) fn specular_cube(
    gpu: &Gpu,
    (name, map): (&str, &EquirectMap),
    settings: &IblSettings,
    shape: &CubeShape,
    keep: bool,
    progress: &mut ProgressFn<'_>,
) -> Result<Baked, IblError> {
    let program = Program::new(gpu, &IBL)?;
    // Twice as fine as the cube, which is four faces around.
    let map = map.reduced(8 * settings.cube_texels);
    let texel_nits = scale_of(&map);
    let total = 6 + 1 + 6 * shape.levels as usize;
    let mut steps = Steps { name, done: 0, total, progress };
    let source = source_cube(gpu, &program, &map, settings.cube_texels, texel_nits, &mut steps)?;

    let small = shape.format == TextureFormat::Rg11b10Ufloat;
    let constants = [("SMALL_FLOATS", f64::from(u8::from(small)))];
    let pipeline = program.pipeline(gpu, "fs_prefilter", shape.format, &constants)?;
    let (cube, sampler) =
        gpu.guard("the specular cube", || (shape.create(gpu, name, TextureUsages::COPY_DST), trilinear(gpu)))?;
    let source = cube_view(&source);
    let mut levels = Vec::new();
    for level in 0..shape.levels {
        let rows = level_kernel(settings, level);
        let apart = gpu.guard("a face of the specular cube", || shape.create_face(gpu, level))?;
        let target = apart.create_view(&Default::default());
        let mut bytes = Vec::new();
        for face in 0..6 {
            gpu.guard("filtering the environment", || {
                prefilter(gpu, &pipeline, &target, [face, shape.level_texels(level)], &rows, (&source, &sampler));
                place_face(gpu, &apart, &cube, level, face);
            })?;
            steps.step(gpu, &format!("face {} of level {}", face + 1, level + 1))?;
            if keep {
                bytes.extend(read_texture(gpu, &apart)?.bytes);
            }
        }
        levels.push(bytes);
    }
    Ok(Baked { cube, texel_nits, levels })
}

/// The power of two that brings the brightest channel below [`PEAK`]; for a black map, one.
fn scale_of(map: &EquirectMap) -> f32 {
    let peak = map.texels().iter().flat_map(|t| &t[..3]).fold(0.0_f32, |a, b| a.max(*b));
    if peak > 0.0 { (f64::from(peak) / PEAK).log2().ceil().clamp(-120.0, 120.0).exp2() as f32 } else { 1.0 }
}

fn trilinear(gpu: &Gpu) -> Sampler {
    gpu.device.create_sampler(&SamplerDescriptor {
        label: Some("trilinear"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        ..Default::default()
    })
}

/// The panorama as a cube with all its levels, in half floats.
fn source_cube(
    gpu: &Gpu,
    program: &Program,
    map: &EquirectMap,
    texels: u32,
    texel_nits: f32,
    steps: &mut Steps<'_, '_>,
) -> Result<Texture, IblError> {
    let format = TextureFormat::Rgba16Float;
    let shape = CubeShape { texels, levels: texels.ilog2() + 1, format };
    let resample = program.pipeline(gpu, "fs_cube", format, &[])?;
    let halve = program.pipeline(gpu, "fs_mip", format, &[])?;
    let (cube, panorama) = gpu.guard("the source of the specular cube", || {
        (shape.create(gpu, "source cube", TextureUsages::RENDER_ATTACHMENT), upload(gpu, map))
    })?;
    // Two samples a side of each texel of the map, at least two a side of each of the cube.
    let samples = (map.width().div_ceil(2 * texels)).max(2);
    for face in 0..6 {
        gpu.guard("resampling the environment", || {
            let settings = IblUniforms { face, size_texels: texels, samples, scale: 1.0 / texel_nits };
            let settings = uniform(gpu, "ibl", bytemuck::bytes_of(&settings));
            let target = face_view(&cube, 0, face);
            let bindings = [(0, settings.as_entire_binding()), (1, BindingResource::TextureView(&panorama))];
            draw(gpu, &resample, &target, texels, 0..texels, &bindings);
        })?;
        steps.step(gpu, &format!("face {} of the map", face + 1))?;
    }
    gpu.guard("the levels of the environment", || {
        let sampler = trilinear(gpu);
        for level in 1..shape.levels {
            let above = level_view(&cube, level - 1);
            let size_texels = shape.level_texels(level);
            for face in 0..6 {
                let settings = IblUniforms { face, size_texels, samples: 0, scale: 1.0 };
                let settings = uniform(gpu, "ibl", bytemuck::bytes_of(&settings));
                let bindings = [
                    (0, settings.as_entire_binding()),
                    (2, BindingResource::TextureView(&above)),
                    (3, BindingResource::Sampler(&sampler)),
                ];
                draw(gpu, &halve, &face_view(&cube, level, face), size_texels, 0..size_texels, &bindings);
            }
        }
    })?;
    steps.step(gpu, "levels of the map")?;
    Ok(cube)
}

fn upload(gpu: &Gpu, map: &EquirectMap) -> TextureView {
    let desc = TextureDescriptor {
        label: Some("panorama"),
        size: Extent3d { width: map.width(), height: map.height(), depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format: TextureFormat::Rgba32Float,
        usage: TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    let bytes = bytemuck::cast_slice(map.texels());
    gpu.device
        .create_texture_with_data(&gpu.queue, &desc, TextureDataOrder::LayerMajor, bytes)
        .create_view(&Default::default())
}

fn prefilter(
    gpu: &Gpu,
    pipeline: &RenderPipeline,
    target: &TextureView,
    [face, size_texels]: [u32; 2],
    rows: &[KernelRow],
    (source, sampler): (&TextureView, &Sampler),
) {
    let scale = (1.0 / weight_sum(rows)) as f32;
    let settings = IblUniforms { face, size_texels, samples: rows.len() as u32, scale };
    let settings = uniform(gpu, "ibl", bytemuck::bytes_of(&settings));
    let mut table = IblKernelUniforms { rows: [Vec4::ZERO; IBL_KERNEL_ROWS] };
    table.rows[..rows.len()].copy_from_slice(rows);
    let table = uniform(gpu, "kernel", bytemuck::bytes_of(&table));
    let bindings = [
        (0, settings.as_entire_binding()),
        (2, BindingResource::TextureView(source)),
        (3, BindingResource::Sampler(sampler)),
        (4, table.as_entire_binding()),
    ];
    draw(gpu, pipeline, target, size_texels, 0..size_texels, &bindings);
}
