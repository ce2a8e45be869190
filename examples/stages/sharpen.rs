//! Sharpening filter for the final picture. It requires shaders and a picture, no scene.

use framegraph::{DeclareError, Format, Intent, Pass, PassBuilder, Target, Texture, TextureDesc, View};
use framegraph_passes::program::full_screen::FullScreen;
use framegraph_passes::program::{Interface, ProgramDesc, Programs};
use framegraph_shaders::Module;
use framegraph_wgpu::{Cx, Record, RecordError};

static INTERFACE: Interface = Interface { groups: &[&["picture"]], constants: &["STRENGTH", "OUTPUT_ENCODED"] };

static SHADER: Module<'static> = Module::new("sharpen.wgsl", include_str!("sharpen.wgsl"));

/// Adds the difference between each texel and the mean of its neighbors.
#[derive(Clone, Copy, Debug)]
pub struct Sharpen {
    /// Picture, sRGB-encoded in a linear format.
    pub picture: Texture,
    /// Destination; a new texture is 8-bit sRGB.
    pub into: Target,
    /// Weight of the difference; 0 changes nothing.
    pub strength: f32,
}

impl Pass for Sharpen {
    type Io = (View, Texture);

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Self::Io, DeclareError> {
        let extent = pass.desc(self.picture)?.extent;
        let picture = pass.sampled(self.picture)?;
        let into = pass.target(self.into, "sharpened", TextureDesc::new(extent, Format::Rgba8UnormSrgb));
        Ok((picture, pass.color(into, Intent::Overwrite)?))
    }
}

impl<W: AsRef<Programs> + ?Sized> Record<W> for Sharpen {
    fn record(&self, (picture, into): &Self::Io, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let constants = [self.strength.into(), f64::from(!cx.format_of(*into)?.is_srgb())];
        let provided = [Some(cx.view(*picture)?.into())];
        let draw = FullScreen::new(ProgramDesc::new(&SHADER, &INTERFACE), &[]);
        FullScreen { constants: &constants, groups: &[&provided], ..draw }.draw(world.as_ref(), cx)
    }
}
