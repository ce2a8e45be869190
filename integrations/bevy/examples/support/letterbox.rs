//! A pass of the user: black bars over the picture.

use framegraph::{DeclareError, Intent, Pass, PassBuilder, Texture};
use framegraph_wgpu::{Cx, Raster, Record, RecordError, Shader};

const SHADER: Shader<'static> = Shader::new("bevy/letterbox", include_str!("letterbox.wgsl"));

/// Draws black bars at the top and bottom, an eighth of the height each.
#[derive(Clone, Copy, Debug)]
pub struct Letterbox {
    /// The finished picture.
    pub over: Texture,
}

impl Pass for Letterbox {
    type Io = Texture;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Texture, DeclareError> {
        // `Modify` keeps the rest of the picture, so the pass joins the render pass that wrote it.
        pass.color(self.over, Intent::Modify)
    }
}

impl<W: ?Sized> Record<W> for Letterbox {
    fn record(&self, _: &Texture, _: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let pipeline = cx.raster_pipeline(&Raster::new(SHADER))?;
        let pass = cx.render_pass()?;
        pass.set_pipeline(&pipeline);
        pass.draw(0..6, 0..2);
        Ok(())
    }
}
