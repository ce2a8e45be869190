//! Passes of depth of field: full-screen steps that share a shader.

use super::settings::DofSettings;
use crate::effects::color::surface::HDR_FORMAT;
use crate::effects::depth::structure::Resolution;
use crate::gpu_scene::view::{ViewId, Views};
use crate::program::full_screen::FullScreen;
use crate::program::{Interface, ProgramDesc, Programs};
use framegraph::{DeclareError, Extent, Format, Intent, Pass, PassBuilder, Texture, TextureDesc, View};
use framegraph_shaders::layout::DofUniforms;
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Record, RecordError, SamplerDesc};

static SHADER: Module<'static> = library::pass("pass/dof.wgsl").unwrap();

/// Names of the shader's inputs, after the settings and the sampler.
const READ: [&str; 5] = ["hdr", "scene_depth", "field", "tiles", "gathered"];

static INTERFACE: Interface = Interface {
    groups: &[&["dof", "field_sampler", READ[0], READ[1], READ[2], READ[3], READ[4]]],
    constants: &["TEXEL_PX", "RINGS_BEFORE", "RINGS_BEHIND", "RINGS_EVEN"],
};

/// Pixels per tile. The shader dilates by two tiles, the largest radius.
const TILE_PX: u16 = 16;

/// A step with its inputs.
#[derive(Clone, Copy, Debug)]
pub enum DofStep {
    /// Writes the circle of confusion beside the radiance.
    Coc {
        /// Pre-exposed radiance with one sample.
        hdr: Texture,
        /// Reversed depth with one sample.
        depth: Texture,
    },
    /// Makes a level of both from the level above.
    Level {
        /// Radiance, with the radius in alpha.
        field: Texture,
        /// Index of the level, at least 1.
        level: u8,
    },
    /// Finds the minimum and maximum radius of each tile.
    Tiles {
        /// Radiance, with the radius in alpha; its first level is read.
        field: Texture,
    },
    /// Finds the radii that may reach into each tile.
    Dilate {
        /// Radii of tiles.
        tiles: Texture,
    },
    /// Gathers out-of-focus radiance, premultiplied by its opacity in alpha.
    Gather {
        /// Radiance, with the radius in alpha; all levels are read.
        field: Texture,
        /// Radii that may reach into tiles.
        tiles: Texture,
    },
    /// Removes noise of the taps with a median.
    Median {
        /// Gathered radiance.
        gathered: Texture,
        /// Radii that may reach into tiles.
        tiles: Texture,
    },
    /// Composites the gathered radiance over the parts in focus.
    Combine {
        /// Pre-exposed radiance with one sample.
        hdr: Texture,
        /// Gathered radiance.
        gathered: Texture,
    },
}

impl DofStep {
    /// Returns the name of the pass.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Coc { .. } => "coc",
            Self::Level { .. } => "level",
            Self::Tiles { .. } => "tiles",
            Self::Dilate { .. } => "dilate",
            Self::Gather { .. } => "gather",
            Self::Median { .. } => "median",
            Self::Combine { .. } => "combine",
        }
    }

    const fn fragment(self) -> &'static str {
        match self {
            Self::Coc { .. } => "fs_coc",
            Self::Level { .. } => "fs_level",
            Self::Tiles { .. } => "fs_tiles",
            Self::Dilate { .. } => "fs_dilate",
            Self::Gather { .. } => "fs_gather",
            Self::Median { .. } => "fs_median",
            Self::Combine { .. } => "fs_combine",
        }
    }
}

/// A step of depth of field. Uses [`Programs`] and the camera of the view of the world.
#[derive(Clone, Copy, Debug)]
pub struct DofPass {
    /// The view.
    pub view: ViewId,
    /// The step.
    pub step: DofStep,
    /// Size of the picture.
    pub extent: Extent,
    /// Number of levels to gather from, at least one.
    pub levels: u8,
    /// Settings of the lens.
    pub settings: DofSettings,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct DofIo {
    /// Inputs in the order of [`READ`].
    read: [Option<View>; 5],
    /// Result of the step.
    pub result: Texture,
}

impl Pass for DofPass {
    type Io = DofIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<DofIo, DeclareError> {
        let small = self.settings.resolution.of(self.extent);
        let field = TextureDesc::new(small, HDR_FORMAT);
        let of_tiles = TextureDesc::new(tiles_of(self.extent), Format::Rg16Float);
        let mut read = [None; 5];
        let result = match self.step {
            DofStep::Coc { hdr, depth } => {
                (read[0], read[1]) = (Some(pass.sampled(hdr)?), Some(pass.sampled(depth)?));
                pass.texture("dof_field", field.mips(self.levels)).mip(0)
            }
            DofStep::Level { field, level } => {
                read[2] = Some(pass.sampled(field.mip(level - 1))?);
                field.mip(level)
            }
            DofStep::Tiles { field } => {
                read[2] = Some(pass.sampled(field.mip(0))?);
                pass.texture("dof_tiles", of_tiles).into()
            }
            DofStep::Dilate { tiles } => {
                read[3] = Some(pass.sampled(tiles)?);
                pass.texture("dof_reach", of_tiles).into()
            }
            DofStep::Gather { field: from, tiles } => {
                (read[2], read[3]) = (Some(pass.sampled(from)?), Some(pass.sampled(tiles)?));
                pass.texture("dof_gathered", field).into()
            }
            DofStep::Median { gathered, tiles } => {
                (read[3], read[4]) = (Some(pass.sampled(tiles)?), Some(pass.sampled(gathered)?));
                pass.texture("dof_median", field).into()
            }
            DofStep::Combine { hdr, gathered } => {
                (read[0], read[4]) = (Some(pass.sampled(hdr)?), Some(pass.sampled(gathered)?));
                let TextureDesc { extent, format, .. } = pass.desc(hdr)?;
                pass.texture("hdr_focused", TextureDesc::new(extent, format)).into()
            }
        };
        Ok(DofIo { read, result: pass.color(result, Intent::Overwrite)? })
    }
}

/// Returns the size of a texture with one texel per tile.
const fn tiles_of(extent: Extent) -> Extent {
    match extent {
        Extent::Relative { num, den, align } => Extent::Relative { num, den: den * TILE_PX, align },
        Extent::Absolute { width, height } => {
            Extent::absolute(width.div_ceil(TILE_PX as u32), height.div_ceil(TILE_PX as u32))
        }
    }
}

impl<W: AsRef<Programs> + AsRef<Views> + ?Sized> Record<W> for DofPass {
    fn record(&self, io: &DofIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let views: &Views = world.as_ref();
        let projection = views.get(self.view)?.view.stand().projection();
        let [width, height] = self.extent.texels(cx.frame_texels());
        let own = &self.settings;
        let (focus_m, scale_px) = own.lens(&projection, height);
        let texel_px = own.resolution.texel_px();
        let rings = |rings: u8| f64::from(rings.clamp(3, 17));
        let constants = [texel_px.into(), rings(own.rings_before), rings(own.rings_behind), rings(own.rings_even)];
        let most_px = [own.most_before_px, own.most_behind_px].map(|most| most.clamp(0.0, 2.0 * f32::from(TILE_PX)));
        let uniforms = DofUniforms {
            depth_row: projection.depth,
            most_px,
            // Only the gather reads it, as the distance between taps.
            per_px: [0, 1].map(|axis| own.axes()[axis] / [width, height][axis].max(1) as f32),
            focus_m,
            scale_px,
            tile_texels: f32::from(TILE_PX) / texel_px as f32,
            last_level: f32::from(self.levels.max(1) - 1),
        };
        let sampler = SamplerDesc { mipmap: wgpu::MipmapFilterMode::Nearest, ..SamplerDesc::LINEAR };
        let mut provided = vec![Some(cx.uniform(&uniforms)), Some(cx.sampler(sampler).into())];
        for view in io.read {
            provided.push(view.map(|view| cx.view(view)).transpose()?.map(Into::into));
        }
        let program = ProgramDesc { fragment: Some(self.step.fragment()), ..ProgramDesc::new(&SHADER, &INTERFACE) };
        FullScreen { constants: &constants, ..FullScreen::new(program, &[&provided]) }.draw(world.as_ref(), cx)
    }
}

impl Resolution {
    /// Pixels per texel.
    pub(super) const fn texel_px(self) -> u32 {
        match self {
            Self::Full => 1,
            Self::Half => 2,
        }
    }
}
