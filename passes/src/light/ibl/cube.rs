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

/// Where the brightest texel of the cube lies: below 64512, the largest number of ten-bit floats, with
/// room for the rounding of sums.
const PEAK: f64 = 32768.0;

/// The samples that level `level` is filtered with.
pub(super) fn level_kernel(settings: &IblSettings, level: u32) -> Vec<KernelRow> {
    let roughness = roughness_from_specular_lod(f64::from(level), f64::from(settings.levels - 1));
    lobe_kernel(roughness, kernel_rows(settings.cube_texels >> level), settings.cube_texels)
}

/// Radiance prefiltered for a roughness a level.
pub(super) struct SpecularCube {
    /// The cube, to be sampled.
    pub texture: wgpu::Texture,
    /// The radiance in nits of a texel that holds 1.
    pub texel_nits: f32,
    /// The bytes of each level, its faces one after the other, if they were asked for; else nothing a level.
    pub levels: Vec<Vec<u8>>,
}

/// The prefiltered cube of a map; with its bytes when `read_back` is set.
pub(super) fn specular_cube(
    gpu: &Gpu,
    (name, map): (&str, &EquirectMap),
    settings: &IblSettings,
    shape: &CubeShape,
    read_back: bool,
    progress: &mut ProgressFn<'_>,
) -> Result<SpecularCube, IblError> {
    // Twice as fine as the cube, which is four faces around.
    let map = map.reduced(8 * settings.cube_texels);
    let texel_nits = scale_of(map.texels().iter());
    let source = Source::new(gpu, &map, settings.cube_texels, texel_nits)?;
    // The faces of the source, its levels, the faces of each level of the result.
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

/// The power of two that brings the brightest channel below [`PEAK`]; for black texels, one.
pub(super) fn scale_of<'a>(texels: impl Iterator<Item = &'a [f32; 4]>) -> f32 {
    let peak = texels.flat_map(|t| &t[..3]).fold(0.0_f32, |a, b| a.max(*b));
    if peak > 0.0 { (f64::from(peak) / PEAK).log2().ceil().clamp(-120.0, 120.0).exp2() as f32 } else { 1.0 }
}

/// `pass/ibl.wgsl` with this fragment entry point.
fn program(fragment: &'static str) -> Result<Arc<Program>, PassError> {
    let desc = ProgramDesc { fragment: Some(fragment), ..ProgramDesc::new(&IBL, &INTERFACE) };
    Program::new(&desc).map(Arc::new)
}

/// The panorama as a cube with all its levels, in half floats.
pub(super) struct Source {
    shape: CubeShape,
    cube: wgpu::Texture,
    panorama: wgpu::Texture,
    /// Samples along each side of a texel of level 0.
    samples: u32,
    /// Factor on the panorama.
    scale: f32,
    resample: Arc<Program>,
    halve: Arc<Program>,
}

impl Source {
    /// An empty cube of `texels`² a face, and the panorama uploaded.
    pub fn new(gpu: &Gpu, map: &EquirectMap, texels: u32, texel_nits: f32) -> Result<Self, IblError> {
        let shape = CubeShape { texels, levels: texels.ilog2() + 1, format: Format::Rgba16Float };
        let (cube, panorama) = gpu.guard("the source of the specular cube", || {
            (shape.create(gpu, "source cube", TextureUsages::RENDER_ATTACHMENT), panorama_texture(gpu, map))
        })?;
        Ok(Self {
            shape,
            cube,
            panorama,
            // Two samples a side of each texel of the map, at least two a side of each of the cube.
            samples: (map.width().div_ceil(2 * texels)).max(2),
            scale: 1.0 / texel_nits,
            resample: program("fs_cube")?,
            halve: program("fs_mip")?,
        })
    }

    /// Declares the cube as the slices before this one left it.
    fn import(&self, frame: &mut Frame, imports: &mut Imports) -> Texture {
        let cube = frame.graph_mut().import_texture("source cube", self.shape.desc(), Entry::Defined, Exit::Keep);
        imports.texture(cube, &self.cube);
        cube
    }

    /// One face of level 0, from the panorama.
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

    /// All further levels, each from the one above.
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

/// The samples of one level, as its draws take them.
pub(super) struct LevelSamples {
    count: u32,
    /// One over the sum of their weights.
    scale: f32,
    rows: Arc<IblKernelUniforms>,
}

impl LevelSamples {
    /// Of at most [`IBL_KERNEL_ROWS`] rows.
    pub fn new(rows: &[KernelRow]) -> Self {
        let mut table = IblKernelUniforms { rows: [Vec4::ZERO; IBL_KERNEL_ROWS] };
        table.rows[..rows.len()].copy_from_slice(rows);
        Self { count: rows.len() as u32, scale: (1.0 / weight_sum(rows)) as f32, rows: Arc::new(table) }
    }
}

/// The specular cube in the making.
pub(super) struct Prefilter<'a> {
    source: &'a Source,
    shape: CubeShape,
    cube: wgpu::Texture,
    program: Arc<Program>,
}

impl<'a> Prefilter<'a> {
    /// An empty cube of this shape.
    pub fn new(gpu: &Gpu, name: &str, source: &'a Source, shape: &CubeShape) -> Result<Self, IblError> {
        let cube = gpu.guard("the specular cube", || shape.create(gpu, name, TextureUsages::COPY_DST))?;
        Ok(Self { source, shape: *shape, cube, program: program("fs_prefilter")? })
    }

    /// One face of one level. It is drawn apart and copied into place, because OpenGL cannot copy the face of a cube into
    /// a buffer; the texture that it is drawn into is returned, and kept until the next slice when it is to be read back.
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
