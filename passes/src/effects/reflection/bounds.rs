//! Bounds of depth, in blocks that rays skip.

use crate::effects::depth::structure::Resolution;
use crate::program::full_screen::FullScreen;
use crate::program::{Interface, ProgramDesc, Programs};
use framegraph::{DeclareError, Format, Intent, Pass, PassBuilder, Target, Texture, TextureDesc, View};
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Record, RecordError};

static SHADER: Module<'static> = library::pass("pass/depth_bounds.wgsl").unwrap();

static INTERFACE: Interface = Interface { groups: &[&["finer"]], constants: &[] };

/// Format of bounds: the largest depth, and the smallest one.
const BOUNDS: Format = Format::Rg32Float;

/// Makes one level of the bounds of a depth texture. A block of level 0 has 2×2 texels of depth.
#[derive(Clone, Copy, Debug)]
pub struct DepthBounds {
    /// Reversed depth with one sample per texel; its first level is read for level 0.
    pub depth: Texture,
    /// Bounds with all levels above `level` written; [`Target::New`] for level 0.
    pub bounds: Target,
    /// Index of the level.
    pub level: u8,
    /// Number of levels of the texture.
    pub levels: u8,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct DepthBoundsIo {
    finer: View,
    /// The bounds, including this level.
    pub bounds: Texture,
}

impl Pass for DepthBounds {
    type Io = DepthBoundsIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<DepthBoundsIo, DeclareError> {
        let extent = Resolution::Half.of(pass.desc(self.depth)?.extent);
        let bounds = pass.target(self.bounds, "depth_bounds", TextureDesc::new(extent, BOUNDS).mips(self.levels));
        let bounds = bounds.texture();
        let finer = match self.level.checked_sub(1) {
            Some(above) => pass.sampled(bounds.mip(above))?,
            None => pass.sampled(self.depth.mip(0))?,
        };
        Ok(DepthBoundsIo { finer, bounds: pass.color(bounds.mip(self.level), Intent::Overwrite)? })
    }
}

impl<W: AsRef<Programs> + ?Sized> Record<W> for DepthBounds {
    fn record(&self, io: &DepthBoundsIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let provided = [Some(cx.view(io.finer)?.into())];
        let fragment = if self.level == 0 { "fs_first" } else { "fs_level" };
        let program = ProgramDesc { fragment: Some(fragment), ..ProgramDesc::new(&SHADER, &INTERFACE) };
        FullScreen::new(program, &[&provided]).draw(world.as_ref(), cx)
    }
}
