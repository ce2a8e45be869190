//! Post: exposure, tone curve, sRGB encoding and dither in one full-screen pass.

use crate::world::World;
use framegraph::{DeclareError, Extent, Format, Intent, Pass, PassBuilder, Target, Texture, TextureDesc, View};
use renderer::Record;
use renderer::wgpu::{Constants, Cx, Raster, RecordError};
use shaders::layout::{PostUniforms, ToneMap};

/// From pre-exposed linear Rec.709 to the display.
#[derive(Clone, Copy, Debug)]
pub struct Post {
    /// Scene-referred radiance times exposure, single-sampled, of the frame's size.
    pub hdr: Texture,
    /// Where the picture goes; new ones are eight bits a channel.
    pub into: Target,
    /// The curve.
    pub tone_map: ToneMap,
    /// Exposure compensation in EV.
    pub compensation_ev: f32,
    /// Amplitude of the dither: 1 is half a code either way, 0 is none.
    pub dither: f32,
    /// An edge filter follows: write encoded values with their luma in alpha.
    pub for_fxaa: bool,
}

/// What the post pass reads and wrote.
#[derive(Clone, Copy, Debug)]
pub struct PostIo {
    hdr: View,
    /// The picture: sRGB encoded, by the target's format or (for an edge filter) by the shader.
    pub ldr: Texture,
}

impl Pass for Post {
    type Io = PostIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<PostIo, DeclareError> {
        pass.pointwise();
        let hdr = pass.same_pixel(self.hdr)?;
        let format = if self.for_fxaa { Format::Rgba8Unorm } else { Format::Rgba8UnormSrgb };
        let into = pass.target(self.into, "ldr", TextureDesc::new(Extent::FRAME, format));
        Ok(PostIo { hdr, ldr: pass.color(into, Intent::Overwrite)? })
    }
}

impl Record<World> for Post {
    fn record(&self, io: &PostIo, world: &World, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let program = &world.programs.post;
        let flag = |on: bool| f64::from(u8::from(on));
        let srgb = cx.targets().colors[0].is_some_and(Format::is_srgb);
        let constants = [
            ("TONE_MAP", self.tone_map.constant()),
            ("OUTPUT_ENCODED", flag(!srgb)),
            ("LUMA_IN_ALPHA", flag(self.for_fxaa)),
        ];
        let pipeline =
            cx.raster_pipeline(&Raster { constants: Constants(&constants), ..Raster::new(program.shader()) })?;
        let uniforms = cx.uniform(&PostUniforms {
            exposure_scale: self.compensation_ev.exp2(),
            dither: self.dither,
            dither_levels: 255.0,
            frame_index: world.view.frame.frame_index,
        });
        let hdr = cx.view(io.hdr)?;
        let group = program.bind(cx, &pipeline, 0, |_, name| {
            Ok(match name {
                "post" => Some(uniforms.clone()),
                "hdr" => Some(hdr.clone().into()),
                _ => None,
            })
        })?;
        let pass = cx.render_pass()?;
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    }
}
