//! The passes that make the specular cube: a draw of `pass/ibl.wgsl` into one face of one level, and the copy of a face
//! that was drawn apart.

use std::sync::Arc;

use framegraph::{DeclareError, Intent, Part, Pass, PassBuilder, ReadOnly, Texture, View};
use framegraph_shaders::layout::{IblKernelUniforms, IblUniforms};
use framegraph_wgpu::{Cx, Depth, Record, RecordError, SamplerDesc, ViewPart};
use wgpu::TextureViewDimension;

use crate::program::full_screen;
use crate::program::{Interface, Program};

/// What [`DrawFace`] provides to its shader, which reads the source as one of two variables.
pub(super) static INTERFACE: Interface =
    Interface { groups: &[&["ibl", "panorama", "cube", "cube_sampler", "ibl_kernel"]], constants: &["SMALL_FLOATS"] };

/// Draws one face: what the shader binds of `panorama` and `cube` is `source`.
pub(super) struct DrawFace {
    /// `pass/ibl.wgsl` with one of its fragment entry points.
    pub program: Arc<Program>,
    /// The target has ten- and eleven-bit floats: the shader's `SMALL_FLOATS`.
    pub small_floats: bool,
    /// The panorama, or six layers of a cube.
    pub source: ReadOnly,
    /// How the shader sees the source: as one image, or as a cube.
    pub seen_as: TextureViewDimension,
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
        let source = cx.view_part(io.source, ViewPart::as_dimension(self.seen_as))?;
        let provided = [
            Some(cx.uniform(&self.uniforms)),
            Some(source.clone().into()),
            Some(source.into()),
            Some(cx.sampler(SamplerDesc::LINEAR).into()),
            self.kernel.as_ref().map(|kernel| cx.uniform(&**kernel)),
        ];
        full_screen::draw(&self.program, &[self.small_floats.into()], &[&provided], Depth::NONE, cx)
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
