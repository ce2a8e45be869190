//! Passes that prefilter the specular cube: a draw of `pass/ibl.wgsl` into a face of a level, and a copy of that face
//! into the cube.

use std::sync::Arc;

use framegraph::{DeclareError, Intent, Part, Pass, PassBuilder, ReadOnly, Texture, View};
use framegraph_shaders::layout::{IblKernelUniforms, IblUniforms};
use framegraph_wgpu::{Cx, Depth, Record, RecordError, SamplerDesc, ViewPart};
use wgpu::TextureViewDimension;

use crate::program::full_screen;
use crate::program::{Interface, Program};

/// Interface of [`DrawFace`]; its shader reads the source as one of two variables.
pub(super) static INTERFACE: Interface =
    Interface { groups: &[&["ibl", "panorama", "cube", "cube_sampler", "ibl_kernel"]], constants: &["SMALL_FLOATS"] };

/// Draws one face. The shader's `panorama` or `cube` is bound to `source`.
pub(super) struct DrawFace {
    /// `pass/ibl.wgsl` with one of its fragment entry points.
    pub program: Arc<Program>,
    /// True if the target has 10- and 11-bit floats: the shader's `SMALL_FLOATS`.
    pub small_floats: bool,
    /// The panorama, or six layers of a cube.
    pub source: ReadOnly,
    /// View dimension of the source: an image, or a cube.
    pub seen_as: TextureViewDimension,
    /// Face: one layer of one level. All its texels are written.
    pub target: Part,
    /// Face, size and scale.
    pub uniforms: IblUniforms,
    /// Samples of the lobe, if the entry point filters.
    pub kernel: Option<Arc<IblKernelUniforms>>,
}

/// Resources of [`DrawFace`].
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

/// Copies the texture of a face into a cube.
pub(super) struct CopyFace {
    /// One level, one layer.
    pub face: Texture,
    /// Cube; only the face at `level` and `layer` is written.
    pub cube: Texture,
    /// Level of the cube.
    pub level: u8,
    /// Layer of the cube: the index of the face, 0…5.
    pub layer: u16,
}

/// Resources of [`CopyFace`].
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
