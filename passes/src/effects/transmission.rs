//! Surfaces that let light through: a picture of everything behind them, and a second pass that draws them over it.
//!
//! ```text
//! color (opaque, sky) ─> scene/0 (copy, with distance) ─> scene/1 ─> … ─> scene/n   each level of the one above
//!                    └───────────────────────────────────────────────────┴─> transparent (transmissive, blended)
//! ```
//!
//! A frame has these passes only where the scene transmits; each level of the picture is written once and read by the next,
//! which the plan follows level by level.
//!
//! Glass is not seen through glass of the same [`Layer`]. With several layers, all of this is done once for each, from the back
//! to the front, and each sees those behind it. A further layer costs its copy with its levels, and color and depth are stored
//! and loaded once more.

use crate::effects::color::surface::{SurfaceBindings, SurfaceInputs, SurfaceWorld};
use crate::effects::depth::resolve::can_read_samples;
use crate::effects::fog::FogSettings;
use crate::effects::shadow::ShadowInput;
use crate::effects::transparency::{Transparency, draw_sorted};
use crate::gpu_scene::draw::SurfaceDraw;
use crate::gpu_scene::indirect::DrawList;
use crate::gpu_scene::lighting::Lighting;
use crate::gpu_scene::upload::GpuScene;
use crate::gpu_scene::view::{CameraView, ViewId, Views};
use crate::light::shading::{AlphaUse, Shading};
use crate::program::full_screen::FullScreen;
use crate::program::{Interface, ProgramDesc, Programs};
use framegraph::{DeclareError, Format, Intent, Pass, PassBuilder, Texture, TextureDesc, View};
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Depth, Epilogue, Record, RecordError, SamplerDesc};

static SHADER: Module<'static> = library::pass("pass/scene.wgsl").unwrap();

/// The copy reads the depth as one of two variables, by its samples.
static COPY: Interface =
    Interface { groups: &[&["frame", "hdr", "scene_depth", "scene_depth_samples"]], constants: &[] };

static LEVEL: Interface = Interface { groups: &[&["source", "source_sampler"]], constants: &[] };

/// Format of the picture: radiance, and the distance in alpha.
const SCENE_FORMAT: Format = Format::Rgba16Float;

/// How many levels a picture of a frame of this size has: until the smaller side is a few texels, of which no blur is left
/// to make, and at least one.
#[must_use]
pub fn scene_levels(frame_texels: [u32; 2]) -> u8 {
    let smaller = frame_texels[0].min(frame_texels[1]).max(1);
    (smaller.ilog2() as u8).saturating_sub(1).max(1)
}

/// Level 0 of the picture: the radiance of opaque surfaces and the sky, and how far away they are. Of the world it needs
/// [`Programs`] and the camera of its view.
#[derive(Clone, Copy, Debug)]
pub struct SceneCopy {
    /// The view whose camera the depth belongs to.
    pub view: ViewId,
    /// Radiance, single-sampled; the picture gets its size.
    pub hdr: Texture,
    /// Depth of what is there, of as many samples as the frame has.
    pub depth: Texture,
    /// How many levels the picture is to have.
    pub levels: u8,
}

/// What the pass reads and wrote.
#[derive(Clone, Copy, Debug)]
pub struct SceneCopyIo {
    hdr: View,
    depth: View,
    samples: u8,
    /// The picture, level 0 written.
    pub scene: Texture,
}

impl Pass for SceneCopy {
    type Io = SceneCopyIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<SceneCopyIo, DeclareError> {
        let (samples, extent) = (pass.desc(self.depth)?.samples, pass.desc(self.hdr)?.extent);
        let (hdr, depth) = (pass.sampled(self.hdr)?, pass.sampled(self.depth)?);
        let scene = pass.texture("scene", TextureDesc::new(extent, SCENE_FORMAT).mips(self.levels));
        Ok(SceneCopyIo { hdr, depth, samples, scene: pass.color(scene.mip(0), Intent::Overwrite)? })
    }
}

impl<W: AsRef<Programs> + AsRef<Views> + ?Sized> Record<W> for SceneCopy {
    fn record(&self, io: &SceneCopyIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        can_read_samples(io.samples, cx.gpu())?;
        let views: &Views = world.as_ref();
        let frame = cx.uniform(&views.get(self.view)?.view.frame);
        let (hdr, depth) = (cx.view(io.hdr)?, cx.view(io.depth)?);
        let provided = [frame, hdr.into(), depth.clone().into(), depth.into()].map(Some);
        let fragment = Some(if io.samples == 1 { "fs_copy" } else { "fs_copy_samples" });
        let program = ProgramDesc { fragment, ..ProgramDesc::new(&SHADER, &COPY) };
        FullScreen::new(program, &[&provided]).draw(world.as_ref(), cx)
    }
}

/// One further level of the picture, made of the one above.
#[derive(Clone, Copy, Debug)]
pub struct SceneLevel {
    /// The picture, its levels above `level` written.
    pub scene: Texture,
    /// Which level to make, 1 or more.
    pub level: u8,
}

/// What the pass reads and wrote.
#[derive(Clone, Copy, Debug)]
pub struct SceneLevelIo {
    above: View,
    /// The picture, this level written too.
    pub scene: Texture,
}

impl Pass for SceneLevel {
    type Io = SceneLevelIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<SceneLevelIo, DeclareError> {
        let above = pass.sampled(self.scene.mip(self.level - 1))?;
        Ok(SceneLevelIo { above, scene: pass.color(self.scene.mip(self.level), Intent::Overwrite)? })
    }
}

impl<W: AsRef<Programs> + ?Sized> Record<W> for SceneLevel {
    fn record(&self, io: &SceneLevelIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let provided = [cx.view(io.above)?.into(), cx.sampler(SamplerDesc::LINEAR).into()].map(Some);
        let program = ProgramDesc { fragment: Some("fs_level"), ..ProgramDesc::new(&SHADER, &LEVEL) };
        FullScreen::new(program, &[&provided]).draw(world.as_ref(), cx)
    }
}

/// The most layers of glass.
pub const MAX_GLASS_LAYERS: u8 = 4;

/// Which transmissive surfaces are drawn together: of those that lie over one another, all in one place of the order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layer {
    /// How many layers of glass are before it.
    pub before: u8,
    /// It has all that is farther back, too.
    pub last: bool,
}

impl Layer {
    /// All glass in one.
    pub const ONLY: Self = Self { before: 0, last: true };

    /// So many layers, from the back to the front.
    pub fn all(count: u8) -> impl Iterator<Item = Self> {
        (0..count).rev().map(move |before| Self { before, last: before + 1 == count })
    }

    /// The draws of this layer, nearest first.
    fn of(self, view: &CameraView) -> DrawList {
        let is_own = |layer: u8| if self.last { layer >= self.before } else { layer == self.before };
        let draws = view.draws.transmit.iter().zip(&view.visible.transmit_layers);
        draws.filter(|(_, layer)| is_own(**layer)).map(|(draw, _)| *draw).collect::<Vec<_>>().into()
    }
}

/// Transmissive surfaces of a layer over what is behind it, and after the first layer's the blended ones.
#[derive(Clone, Copy, Debug)]
pub struct Transparent {
    /// The view that is drawn.
    pub view: ViewId,
    /// Depth of opaque surfaces, and of glass farther back.
    pub depth: Texture,
    /// The picture of what is behind, all levels written.
    pub scene: Texture,
    /// Radiance of opaque surfaces and the sky, and of glass farther back, single-sampled.
    pub hdr: Texture,
    /// The same, of each sample; `hdr` itself at one sample per texel.
    pub samples: Texture,
    /// The shadow maps of the view.
    pub shadow: Option<Texture>,
    /// Which of the transmissive surfaces.
    pub layer: Layer,
    /// How blended surfaces are put in order: those of an unordered technique are left to later passes.
    pub transparency: Transparency,
    /// How surfaces are shaded.
    pub shading: Shading,
    /// Fog before all that is drawn.
    pub fog: Option<FogSettings>,
}

/// What the pass reads and wrote.
#[derive(Clone, Copy, Debug)]
pub struct TransparentIo {
    scene: View,
    shadow: Option<ShadowInput>,
    /// The depth has stencil.
    stencil: bool,
    /// Depth of opaque and transmissive surfaces.
    pub depth: Texture,
    /// Radiance with everything in it, of each sample; `hdr` itself at one sample per texel.
    pub samples: Texture,
    /// Scene-referred radiance times exposure with everything in it, single-sampled.
    pub hdr: Texture,
}

impl Pass for Transparent {
    type Io = TransparentIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<TransparentIo, DeclareError> {
        pass.blends();
        let scene = pass.sampled(self.scene)?;
        let shadow = ShadowInput::declare(self.shadow, pass)?;
        let stencil = pass.desc(self.depth)?.format.has_stencil();
        let depth = pass.depth(self.depth, Intent::Modify)?;
        let samples = pass.color(self.samples, Intent::Modify)?;
        let hdr = if self.samples == self.hdr { samples } else { pass.resolve(samples, self.hdr)? };
        Ok(TransparentIo { scene, shadow, stencil, depth, samples, hdr })
    }
}

impl<W> Record<W> for Transparent
where
    W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Lighting> + AsRef<Views> + ?Sized,
{
    fn record(&self, io: &TransparentIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        self.draw(io, &SurfaceWorld::of(world, self.view)?, cx)
    }
}

impl Transparent {
    fn draw(&self, io: &TransparentIo, world: &SurfaceWorld<'_>, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let inputs = SurfaceInputs {
            scene: Some(io.scene),
            fog: self.fog,
            stencil: io.stencil,
            ..SurfaceInputs::shadowed(io.shadow)
        };
        let bindings = SurfaceBindings::new(inputs, &self.shading, world, Epilogue::default(), cx)?;
        let program = |variant| bindings.program(world.programs, variant);
        // The prepass has not drawn these: masked ones are cut here, and the cutoff of opaque ones cuts nothing.
        let transmissive = SurfaceDraw {
            program: &program,
            frame: &bindings.frame,
            constants: &bindings.constants(AlphaUse::Mask),
            depth: Depth::NEARER,
            colors: &[],
        };
        let instances = world.instances().with_stencil(io.stencil);
        transmissive.draw(&self.layer.of(&world.view.view), instances, cx)?;
        match self.layer.before > 0 || self.transparency.is_unordered() {
            true => Ok(()),
            false => draw_sorted(world, &bindings, self.transparency, cx),
        }
    }
}
