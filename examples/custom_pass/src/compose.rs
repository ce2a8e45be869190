//! Final pass: composes scene and glow, and applies the tone curve.

use framegraph::{DeclareError, Format, Intent, Pass, PassBuilder, Texture, View};
use framegraph_wgpu::Record;
use framegraph_wgpu::{Constants, Cx, Raster, RecordError, SamplerDesc, Shader};

const SHADER: Shader<'static> = Shader::new("custom_pass/compose", include_str!("compose.wgsl"));

/// Tone maps the scene into `into`.
#[derive(Clone, Copy, Debug)]
pub struct Compose {
    /// Linear light, of the size of `into`.
    pub image: Texture,
    /// Blurred linear light, of any size.
    pub glow: Option<Texture>,
    /// Render target.
    pub into: Texture,
}

/// Resources of the pass.
#[derive(Clone, Copy, Debug)]
pub struct Io {
    image: View,
    glow: Option<View>,
    /// The composed picture.
    pub picture: Texture,
    encode: bool,
}

impl Pass for Compose {
    type Io = Io;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Io, DeclareError> {
        // Only the texel at the fragment is read. A device with same-pixel reads keeps the scene in the tile.
        let image = pass.same_pixel(self.image)?;
        let glow = self.glow.map(|glow| pass.sampled(glow)).transpose()?;
        // Without an sRGB target, the shader encodes the output.
        let format: Format = pass.desc(self.into)?.format;
        Ok(Io { image, glow, picture: pass.color(self.into, Intent::Overwrite)?, encode: !format.is_srgb() })
    }
}

impl<W: ?Sized> Record<W> for Compose {
    fn record(&self, io: &Io, _: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let constants = [("ENCODE", f64::from(io.encode))];
        let fragment = Some(if io.glow.is_some() { "fs_glow" } else { "fs_plain" });
        let raster = Raster { fragment, constants: Constants(&constants), ..Raster::new(SHADER) };
        let pipeline = cx.raster_pipeline(&raster)?;
        let mut bindings = vec![(0, cx.view(io.image)?.into())];
        if let Some(glow) = io.glow {
            bindings.push((1, cx.view(glow)?.into()));
            bindings.push((2, cx.sampler(SamplerDesc::LINEAR).into()));
        }
        let group = cx.bind_group(pipeline.group(0), &bindings);
        let pass = cx.render_pass()?;
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    }
}
