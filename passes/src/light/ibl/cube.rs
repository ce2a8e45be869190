//! From a panorama to the specular cube, on the GPU.
//!
//! ```text
//! panorama ─> source level 0, a face a slice ─> source levels 1…, one slice ─> a face of a level of the result a slice
//! ```
//!
//! The source and the result are textures that the slices import; each slice declares which level and layer it writes.

use std::sync::Arc;

use framegraph::{DeclareError, Entry, Exit, Extent, Format, Texture, TextureDesc};
use framegraph_shaders::layout::{IBL_KERNEL_ROWS, IblKernelUniforms, IblUniforms};
use framegraph_shaders::reference::image_light::roughness_from_specular_lod;
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Frame, Gpu, Imports, read_texture};
use glam::Vec4;
use wgpu::{TextureUsages, TextureViewDimension};

use super::error::IblError;
use super::faces::{CopyFace, DrawFace, INTERFACE};
use super::kernel::{KernelRow, kernel_rows, lobe_kernel, weight_sum};
use super::settings::IblSettings;
use super::slices::Slices;
use super::texture::{CubeShape, panorama_texture};
use crate::error::PassError;
use crate::program::{Program, ProgramDesc};
use framegraph_scene::environment::EquirectMap;
use framegraph_scene::progress::ProgressFn;

static IBL: Module<'static> = library::pass("pass/ibl.wgsl").unwrap();

/// Maximum value of the cube's texels: below 64512, the maximum of 10-bit floats, with room for rounding of sums.
const PEAK: f64 = 32768.0;

/// Returns the samples that filter a level.
pub(super) fn level_kernel(settings: &IblSettings, level: u32) -> Vec<KernelRow> {
    let roughness = roughness_from_specular_lod(f64::from(level), f64::from(settings.levels - 1));
    lobe_kernel(roughness, kernel_rows(settings.cube_texels >> level), settings.cube_texels)
}

/// Radiance, prefiltered for one roughness per level.
pub(super) struct SpecularCube {
    /// Cube texture for sampling.
    pub texture: wgpu::Texture,
    /// Radiance in nits of a texel with value 1.
    pub texel_nits: f32,
    /// Bytes of each level with consecutive faces if requested, otherwise empty.
    pub levels: Vec<Vec<u8>>,
}

/// Returns the prefiltered cube of a map, with its bytes if `read_back` is true.
pub(super) fn specular_cube(
    gpu: &Gpu,
    (name, map): (&str, &EquirectMap),
    settings: &IblSettings,
    shape: &CubeShape,
    read_back: bool,
    progress: &mut ProgressFn<'_>,
) -> Result<SpecularCube, IblError> {
    // Twice the resolution of the cube, whose four side faces span the width.
    let map = map.reduced(8 * settings.cube_texels);
    let texel_nits = scale_of(map.texels().iter());
    let source = Source::new(gpu, &map, settings.cube_texels, texel_nits)?;
    // Faces of the source, its levels, and the faces of each level of the result.
    let total = 6 + 1 + 6 * shape.levels as usize;
    let mut slices = Slices::new(gpu, name, total, progress);
    for face in 0..6 {
        slices.run(&format!("face {} of the map", face + 1), |frame, imports| source.resample(face, frame, imports))?;
    }
    slices.run("levels of the map", |frame, imports| source.halve(frame, imports))?;

    let prefilter = Prefilter::new(gpu, name, &source, shape)?;
    let mut levels = Vec::new();
    for level in 0..shape.levels {
        let samples = LevelSamples::new(&level_kernel(settings, level));
        let mut bytes = Vec::new();
        for face in 0..6 {
            let item = format!("face {} of level {}", face + 1, level + 1);
            let drawn =
                slices.run(&item, |frame, imports| prefilter.face(level, face, &samples, read_back, frame, imports))?;
            if let Some(texture) = slices.texture(drawn).filter(|_| read_back) {
                bytes.extend(read_texture(gpu, texture)?.bytes);
            }
        }
        levels.push(bytes);
    }
    Ok(SpecularCube { texture: prefilter.cube, texel_nits, levels })
}

/// Returns the power of two that brings the brightest channel below [`PEAK`]; 1 for black texels.
pub(super) fn scale_of<'a>(texels: impl Iterator<Item = &'a [f32; 4]>) -> f32 {
    let peak = texels.flat_map(|t| &t[..3]).fold(0.0_f32, |a, b| a.max(*b));
    if peak > 0.0 { (f64::from(peak) / PEAK).log2().ceil().clamp(-120.0, 120.0).exp2() as f32 } else { 1.0 }
}

/// Returns `pass/ibl.wgsl` with this fragment entry point.
fn program(fragment: &'static str) -> Result<Arc<Program>, PassError> {
    let desc = ProgramDesc { fragment: Some(fragment), ..ProgramDesc::new(&IBL, &INTERFACE) };
    Program::new(&desc).map(Arc::new)
}

/// Panorama as a cube with all levels, in half floats.
pub(super) struct Source {
    shape: CubeShape,
    cube: wgpu::Texture,
    panorama: wgpu::Texture,
    /// Number of samples along each side of a texel of level 0.
    samples: u32,
    /// Factor on the panorama.
    scale: f32,
    resample: Arc<Program>,
    halve: Arc<Program>,
}

impl Source {
    /// Creates an empty cube of `texels`² per face, and uploads the panorama.
    pub fn new(gpu: &Gpu, map: &EquirectMap, texels: u32, texel_nits: f32) -> Result<Self, IblError> {
        let shape = CubeShape { texels, levels: texels.ilog2() + 1, format: Format::Rgba16Float };
        let (cube, panorama) = gpu.guard("the source of the specular cube", || {
            (shape.create(gpu, "source cube", TextureUsages::RENDER_ATTACHMENT), panorama_texture(gpu, map))
        })?;
        Ok(Self {
            shape,
            cube,
            panorama,
            // Two samples along each side of a map texel, and at least two along each side of a cube texel.
            samples: (map.width().div_ceil(2 * texels)).max(2),
            scale: 1.0 / texel_nits,
            resample: program("fs_cube")?,
            halve: program("fs_mip")?,
        })
    }

    /// Imports the cube as previous slices left it.
    fn import(&self, frame: &mut Frame, imports: &mut Imports) -> Texture {
        let cube = frame.graph_mut().import_texture("source cube", self.shape.desc(), Entry::Defined, Exit::Keep);
        imports.texture(cube, &self.cube);
        cube
    }

    /// Draws one face of level 0 from the panorama.
    pub fn resample(&self, face: u32, frame: &mut Frame, imports: &mut Imports) -> Result<(), DeclareError> {
        let size = self.panorama.size();
        let desc = TextureDesc::new(Extent::absolute(size.width, size.height), Format::Rgba32Float);
        let panorama = frame.graph_mut().import_texture("panorama", desc, Entry::Defined, Exit::Keep);
        imports.texture(panorama, &self.panorama);
        let cube = self.import(frame, imports);
        let resample = DrawFace {
            program: self.resample.clone(),
            small_floats: false,
            source: panorama.into(),
            seen_as: TextureViewDimension::D2,
            target: cube.mip(0).layer(face as u16),
            uniforms: IblUniforms { face, size_texels: self.shape.texels, samples: self.samples, scale: self.scale },
            kernel: None,
        };
        frame.add("resample", resample)?;
        Ok(())
    }

    /// Draws the remaining levels, each from the previous one.
    pub fn halve(&self, frame: &mut Frame, imports: &mut Imports) -> Result<(), DeclareError> {
        let mut cube = self.import(frame, imports);
        for level in 1..self.shape.levels {
            for face in 0..6 {
                let size_texels = self.shape.level_texels(level);
                let halve = DrawFace {
                    program: self.halve.clone(),
                    small_floats: false,
                    source: cube.mip(level as u8 - 1).into(),
                    seen_as: TextureViewDimension::Cube,
                    target: cube.mip(level as u8).layer(face as u16),
                    uniforms: IblUniforms { face, size_texels, samples: 0, scale: 1.0 },
                    kernel: None,
                };
                cube = frame.add("halve", halve)?.target;
            }
        }
        Ok(())
    }
}

/// Filter samples of one level, as its draws read them.
pub(super) struct LevelSamples {
    count: u32,
    /// Reciprocal of the sum of the weights.
    scale: f32,
    rows: Arc<IblKernelUniforms>,
}

impl LevelSamples {
    /// Packs at most [`IBL_KERNEL_ROWS`] rows.
    pub fn new(rows: &[KernelRow]) -> Self {
        let mut table = IblKernelUniforms { rows: [Vec4::ZERO; IBL_KERNEL_ROWS] };
        table.rows[..rows.len()].copy_from_slice(rows);
        Self { count: rows.len() as u32, scale: (1.0 / weight_sum(rows)) as f32, rows: Arc::new(table) }
    }
}

/// Prefiltering in progress.
pub(super) struct Prefilter<'a> {
    source: &'a Source,
    shape: CubeShape,
    cube: wgpu::Texture,
    program: Arc<Program>,
}

impl<'a> Prefilter<'a> {
    /// Creates an empty cube of this shape.
    pub fn new(gpu: &Gpu, name: &str, source: &'a Source, shape: &CubeShape) -> Result<Self, IblError> {
        let cube = gpu.guard("the specular cube", || shape.create(gpu, name, TextureUsages::COPY_DST))?;
        Ok(Self { source, shape: *shape, cube, program: program("fs_prefilter")? })
    }

    /// Draws one face of one level into a separate texture, and copies it to the cube, since OpenGL cannot copy a cube
    /// face into a buffer. Returns the separate texture, kept until the next slice if it is read back.
    pub fn face(
        &self,
        level: u32,
        face: u32,
        samples: &LevelSamples,
        read_back: bool,
        frame: &mut Frame,
        imports: &mut Imports,
    ) -> Result<Texture, DeclareError> {
        let size_texels = self.shape.level_texels(level);
        let source = self.source.import(frame, imports);
        let graph = frame.graph_mut();
        let cube = graph.import_texture("specular cube", self.shape.desc(), Entry::Defined, Exit::Keep);
        imports.texture(cube, &self.cube);
        let desc = TextureDesc::new(Extent::absolute(size_texels, size_texels), self.shape.format);
        let apart = graph.texture("face", desc);
        let prefilter = DrawFace {
            program: self.program.clone(),
            small_floats: self.shape.format == Format::Rg11b10Ufloat,
            source: source.into(),
            seen_as: TextureViewDimension::Cube,
            target: apart.into(),
            uniforms: IblUniforms { face, size_texels, samples: samples.count, scale: samples.scale },
            kernel: Some(samples.rows.clone()),
        };
        let drawn = frame.add("prefilter", prefilter)?.target;
        frame.add("copy", CopyFace { face: drawn, cube, level: level as u8, layer: face as u16 })?;
        if read_back {
            frame.graph_mut().readback(drawn)?;
        }
        Ok(drawn)
    }
}
