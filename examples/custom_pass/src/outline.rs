//! Outline effect: one raster pass over the final picture.

use framegraph::{DeclareError, Intent, Pass, PassBuilder, Texture, View};
use framegraph_wgpu::Record;
use framegraph_wgpu::{Cx, Raster, RecordError, Shader};

/// Color of the lines: linear red, green, blue, and alpha.
pub const COLOR: [f32; 4] = [1.0, 1.0, 1.0, 1.0];

const SHADER: Shader<'static> = Shader::new("custom_pass/outline", include_str!("outline.wgsl"));

/// Draws lines around objects into `over`.
#[derive(Clone, Copy, Debug)]
pub struct Outline {
    /// Object numbers divided by 255 in the alpha channel.
    pub ids: Texture,
    /// Reversed depth.
    pub depth: Texture,
    /// Picture to draw into, of equal size.
    pub over: Texture,
}

impl Pass for Outline {
    type Io = (View, View, Texture);

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Self::Io, DeclareError> {
        let (ids, depth) = (pass.sampled(self.ids)?, pass.sampled(self.depth)?);
        // `Modify` keeps the other pixels. The previous pass draws into this target too, so both share a step, and the
        // picture is not loaded from memory.
        Ok((ids, depth, pass.color(self.over, Intent::Modify)?))
    }
}

impl<W: ?Sized> Record<W> for Outline {
    fn record(&self, (ids, depth, _): &Self::Io, _: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let pipeline = cx.raster_pipeline(&Raster::new(SHADER))?;
        let (ids, depth) = (cx.view(*ids)?, cx.view(*depth)?);
        let color = cx.uniform(&COLOR);
        let group = cx.bind_group(pipeline.group(0), &[(0, ids.into()), (1, depth.into()), (2, color)]);
        let pass = cx.render_pass()?;
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    }
}
