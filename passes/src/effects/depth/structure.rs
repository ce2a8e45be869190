//! Structure: the depth of opaque and masked surfaces as a pyramid, for screen-space effects.
//!
//! Copies the depth of a prepass with one sample per texel, at its size or at half of it. Without such a prepass, the
//! geometry is drawn. Nothing runs unless a pass reads it.
//!
//! ```text
//! prepass ─> structure ─> structure_level 1 ─> structure_level 2 ─> …   each keeps one texel of four, in a rotated grid
//! ```

use crate::effects::depth::prepass::{DEPTH_FORMAT, draw_depth};
use crate::gpu_scene::upload::GpuScene;
use crate::gpu_scene::view::{ViewId, Views};
use crate::program::full_screen::FullScreen;
use crate::program::{Interface, ProgramDesc, Programs};
use crate::settings::place::Words;
use crate::stages::{Handles, Slot, StageError};
use framegraph::{Aspect, ClearValue, DeclareError, Extent, Intent, Pass, PassBuilder, Texture, TextureDesc, View};
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Depth, Frame, Record, RecordError};
use wgpu::CompareFunction;

static SHADER: Module<'static> = library::pass("pass/structure.wgsl").unwrap();

static INTERFACE: Interface = Interface { groups: &[&["finer"]], constants: &[] };

/// Resolution of the structure, relative to the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Resolution {
    /// Size of the picture.
    #[default]
    Full,
    /// Half the width and height: a quarter of the texels.
    Half,
}

impl Words for Resolution {
    const WORDS: &'static [(&'static str, Self)] = &[("full", Self::Full), ("half", Self::Half)];
}

impl Resolution {
    /// Returns the size at this resolution, for a view whose pictures have the size `extent`.
    #[must_use]
    pub const fn of(self, extent: Extent) -> Extent {
        match (self, extent) {
            (Self::Full, _) => extent,
            (Self::Half, Extent::Relative { num, den, align }) => Extent::Relative { num, den: 2 * den, align },
            (Self::Half, Extent::Absolute { width, height }) => Extent::absolute(width.div_ceil(2), height.div_ceil(2)),
        }
    }
}

/// Returns the number of levels of the structure for a picture of this size, as in Filament. Five fewer than a full mip
/// chain, so the last level is about 32 texels wide; 1 to 8.
#[must_use]
pub fn structure_levels(picture_texels: [u32; 2], resolution: Resolution) -> u8 {
    let texels = Resolution::of(resolution, Extent::absolute(picture_texels[0], picture_texels[1])).texels([1, 1]);
    let larger = texels[0].max(texels[1]).max(1);
    (larger.ilog2() as u8 + 1).saturating_sub(5).clamp(1, 8)
}

/// Draws level 0: reversed depth of opaque and masked surfaces.
#[derive(Clone, Copy, Debug)]
pub struct Structure {
    /// View to draw.
    pub view: ViewId,
    /// Size of level 0.
    pub extent: Extent,
    /// Number of levels of the texture.
    pub levels: u8,
}

impl Pass for Structure {
    type Io = Texture;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Texture, DeclareError> {
        let desc = TextureDesc::new(self.extent, DEPTH_FORMAT).mips(self.levels.max(1));
        let structure = pass.texture("structure", desc);
        pass.depth(structure.mip(0), Intent::Clear(ClearValue::FAR_REVERSED))
    }
}

impl<W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Views> + ?Sized> Record<W> for Structure {
    fn record(&self, _: &Texture, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        draw_depth(self.view, false, world, cx)
    }
}

/// Copies level 0 from the depth of a prepass.
#[derive(Clone, Copy, Debug)]
pub struct StructureOf {
    /// Reversed depth with one sample per texel; its first level is read.
    pub depth: Texture,
    /// Resolution of level 0, relative to the depth.
    pub resolution: Resolution,
    /// Number of levels of the texture.
    pub levels: u8,
}

impl Pass for StructureOf {
    type Io = StructureLevelIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<StructureLevelIo, DeclareError> {
        let TextureDesc { extent, format, .. } = pass.desc(self.depth)?;
        let finer = match format.has_stencil() {
            true => pass.sampled(self.depth.mip(0).aspect(Aspect::Depth))?,
            false => pass.sampled(self.depth.mip(0))?,
        };
        let desc = TextureDesc::new(self.resolution.of(extent), DEPTH_FORMAT).mips(self.levels.max(1));
        let structure = pass.texture("structure", desc);
        Ok(StructureLevelIo { finer, structure: pass.depth(structure.mip(0), Intent::Overwrite)? })
    }
}

impl<W: AsRef<Programs> + ?Sized> Record<W> for StructureOf {
    fn record(&self, io: &StructureLevelIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let fragment = if self.resolution == Resolution::Full { "fs_copy" } else { "fs_half" };
        draw_level(fragment, io, world.as_ref(), cx)
    }
}

/// Makes one further level from the level above.
#[derive(Clone, Copy, Debug)]
pub struct StructureLevel {
    /// The structure, with all levels above `level` written.
    pub structure: Texture,
    /// Index of the level, at least 1.
    pub level: u8,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct StructureLevelIo {
    finer: View,
    /// The structure, including this level.
    pub structure: Texture,
}

impl Pass for StructureLevel {
    type Io = StructureLevelIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<StructureLevelIo, DeclareError> {
        if self.level == 0 {
            return Err(pass.error("level 0 is drawn, not made of another", "declare `Structure` for it"));
        }
        let finer = pass.sampled(self.structure.mip(self.level - 1))?;
        Ok(StructureLevelIo { finer, structure: pass.depth(self.structure.mip(self.level), Intent::Overwrite)? })
    }
}

impl<W: AsRef<Programs> + ?Sized> Record<W> for StructureLevel {
    fn record(&self, io: &StructureLevelIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        draw_level("fs_level", io, world.as_ref(), cx)
    }
}

fn draw_level(
    fragment: &'static str,
    io: &StructureLevelIo,
    programs: &Programs,
    cx: &mut Cx<'_>,
) -> Result<(), RecordError> {
    let provided = [Some(cx.view(io.finer)?.into())];
    let program = ProgramDesc { fragment: Some(fragment), ..ProgramDesc::new(&SHADER, &INTERFACE) };
    let depth = Depth { compare: CompareFunction::Always, write: true, ..Depth::NONE };
    FullScreen { depth, ..FullScreen::new(program, &[&provided]) }.draw(programs, cx)
}

/// Returns depth of the view's opaque and masked surfaces with one sample per texel, if a pass has drawn it
/// ([`Slot::DEPTH`]).
pub fn drawn_depth<W: ?Sized>(frame: &Frame<W>, handles: &Handles) -> Option<Texture> {
    let (depth, graph) = (handles.find(Slot::DEPTH)?, frame.graph());
    let desc = graph.resources()[graph.resource_of(depth)?.index()].desc.texture()?;
    (desc.samples == 1).then_some(depth)
}

/// Returns the structure of the frame at a resolution ([`Slot::STRUCTURE`], [`Slot::HALF_STRUCTURE`]). The first
/// request declares it with its levels; later requests share it. It is a copy of the depth of the prepass if that has
/// one sample per texel, and is drawn otherwise.
///
/// # Errors
/// Returns the error of a refused pass.
pub fn structure<W>(
    frame: &mut Frame<W>,
    handles: &mut Handles,
    resolution: Resolution,
    levels: u8,
) -> Result<Texture, StageError>
where
    W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Views> + ?Sized,
{
    let slot = match resolution {
        Resolution::Full => Slot::STRUCTURE,
        Resolution::Half => Slot::HALF_STRUCTURE,
    };
    if let Some(structure) = handles.find(slot) {
        return Ok(structure);
    }
    let drawn = drawn_depth(frame, handles).or_else(|| handles.find(Slot::STRUCTURE));
    let mut structure = match drawn {
        Some(depth) => frame.add("structure", StructureOf { depth, resolution, levels })?.structure,
        None => {
            let extent = resolution.of(handles.extent());
            frame.add("structure", Structure { view: handles.view(), extent, levels })?
        }
    };
    for level in 1..levels {
        structure = frame.add("structure_level", StructureLevel { structure, level })?.structure;
    }
    handles.set(slot, structure);
    Ok(structure)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_filaments() {
        for (size, resolution, levels) in [
            ([1920, 1088], Resolution::Half, 5),
            ([1920, 1088], Resolution::Full, 6),
            ([640, 360], Resolution::Full, 5),
            ([64, 64], Resolution::Full, 2),
            ([1, 1], Resolution::Half, 1),
            ([16384, 16384], Resolution::Full, 8),
        ] {
            assert_eq!(structure_levels(size, resolution), levels, "{size:?} {resolution:?}");
        }
    }

    #[test]
    fn half_a_size_is_rounded_up() {
        assert_eq!(Resolution::Half.of(Extent::FRAME).texels([1281, 721]), [641, 361]);
        assert_eq!(Resolution::Half.of(Extent::absolute(5, 1)).texels([9, 9]), [3, 1]);
        assert_eq!(Resolution::Full.of(Extent::FRAME), Extent::FRAME);
    }
}
