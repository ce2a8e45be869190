//! The passes that make the specular cube: a draw of `pass/ibl.wgsl` into one face of one level, and the copy of a face
//! that was drawn apart.

use std::sync::Arc;

use framegraph::{DeclareError, Intent, Part, Pass, PassBuilder, ReadOnly, Texture, View};
use framegraph_shaders::layout::{IblKernelUniforms, IblUniforms};
use framegraph_wgpu::{Constants, Cx, Raster, Record, RecordError, SamplerDesc, ViewPart};
use wgpu::TextureViewDimension;

use crate::program::Program;

/// Draws one face: what the shader binds of `panorama` and `cube` is `source`.
pub(super) struct DrawFace {
    /// `pass/ibl.wgsl` with one of its fragment entry points.
    pub program: Arc<Program>,
    /// Values of the shader's `override` constants.
    pub constants: &'static [(&'static str, f64)],
    /// The panorama, or six layers of a cube.
    pub source: ReadOnly,
    /// The face: one layer of one level. All its texels are written.
    pub target: Part,
    /// Face, size and scale.
    pub uniforms: IblUniforms,
    /// Samples of the lobe, where the entry point filters.
    pub kernel: Option<Arc<IblKernelUniforms>>,
}

/// What [`DrawFace`] reads and wrote.
#[derive(Clone, Copy)]
pub(super) struct DrawFaceIo {
    source: View,
    /// The texture of the face, after the draw.
    pub target: Texture,
}

impl Pass for DrawFace {
    type Io = DrawFaceIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<DrawFaceIo, DeclareError> {
        Ok(DrawFaceIo { source: pass.sampled(self.source)?, target: pass.color(self.target, Intent::Overwrite)? })
    }
}

impl Record for DrawFace {
    fn record(&self, io: &DrawFaceIo, (): &(), cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let Self { program, constants, uniforms, kernel, .. } = self;
        let raster =
            Raster { fragment: program.fragment, constants: Constants(constants), ..Raster::new(program.shader()) };
        let pipeline = cx.raster_pipeline(&raster)?;
        let group = program.bind(cx, &pipeline, 0, |cx, name| {
            Ok(match name {
                "ibl" => Some(cx.uniform(uniforms)),
                "panorama" => Some(cx.view(io.source)?.into()),
                "cube" => Some(cx.view_part(io.source, ViewPart::seen_as(TextureViewDimension::Cube))?.into()),
                "cube_sampler" => Some(cx.sampler(SamplerDesc::LINEAR).into()),
                "ibl_kernel" => kernel.as_ref().map(|kernel| cx.uniform(&**kernel)),
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

/// Copies a texture of one face into its place in a cube.
pub(super) struct CopyFace {
    /// One level, one layer.
    pub face: Texture,
    /// The cube; only the face at `level` and `layer` is written.
    pub cube: Texture,
    /// Level of the cube.
    pub level: u8,
    /// Layer of the cube: the number of the face, 0…5.
    pub layer: u16,
}

/// What [`CopyFace`] reads and wrote.
#[derive(Clone, Copy)]
pub(super) struct CopyFaceIo {
    face: View,
    cube: Texture,
}

impl Pass for CopyFace {
    type Io = CopyFaceIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<CopyFaceIo, DeclareError> {
        let place = self.cube.mip(self.level).layer(self.layer);
        Ok(CopyFaceIo { face: pass.copy_source(self.face)?, cube: pass.copy_target(place, Intent::Overwrite)? })
    }
}

impl Record for CopyFace {
    fn record(&self, io: &CopyFaceIo, (): &(), cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let (face, cube) = (cx.texture(io.face)?, cx.texture_of(io.cube)?);
        let place = wgpu::TexelCopyTextureInfo {
            texture: &cube,
            mip_level: self.level.into(),
            origin: wgpu::Origin3d { x: 0, y: 0, z: self.layer.into() },
            aspect: wgpu::TextureAspect::All,
        };
        cx.encoder()?.copy_texture_to_texture(face.as_image_copy(), place, face.size());
        Ok(())
    }
}
