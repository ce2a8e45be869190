//! Transmission: a picture of everything behind transmissive surfaces, and a pass that draws them over it.
//!
//! ```text
//! color (opaque, sky) ─> scene/0 (copy, with distance) ─> scene/1 ─> … ─> scene/n   each level of the one above
//!                    └───────────────────────────────────────────────────┴─> transparent (transmissive, blended)
//! ```
//!
//! A frame has these passes only if the scene has transmissive surfaces. Each level of the picture is written once and
//! read by the next; the plan tracks levels separately.
//!
//! Glass is not visible through glass of the same [`Layer`]. With several layers, the passes repeat for each, from back
//! to front, and each layer sees the layers behind it. A further layer costs its copy with all levels, and one more
//! store and load of color and depth.

use crate::effects::color::surface::{SurfaceBindings, SurfaceInputs, SurfaceWorld};
use crate::effects::depth::resolve::can_read_samples;
use crate::effects::fog::FogSettings;
use crate::effects::shadow::ShadowInput;
use crate::effects::transparency::{Transparency, draw_sorted};
use crate::gpu_scene::draw::SurfaceDraw;
use crate::gpu_scene::indirect::DrawList;
use crate::gpu_scene::lighting::Lighting;
use crate::gpu_scene::shadow_views::ShadowMaps;
use crate::gpu_scene::upload::GpuScene;
use crate::gpu_scene::view::{CameraView, ViewId, Views};
use crate::light::shading::{AlphaUse, Shading};
use crate::program::full_screen::FullScreen;
use crate::program::{Interface, ProgramDesc, Programs};
use framegraph::{DeclareError, Format, Intent, Pass, PassBuilder, Texture, TextureDesc, View};
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Depth, Epilogue, Record, RecordError, SamplerDesc};

static SHADER: Module<'static> = library::pass("pass/scene.wgsl").unwrap();

/// The shader reads depth as one of two variables, depending on its sample count.
static COPY: Interface =
    Interface { groups: &[&["frame", "hdr", "scene_depth", "scene_depth_samples"]], constants: &[] };

static LEVEL: Interface = Interface { groups: &[&["source", "source_sampler"]], constants: &[] };

/// Format of the picture: radiance, and distance in alpha.
const SCENE_FORMAT: Format = Format::Rgba16Float;

/// Returns the number of levels for a frame of this size, at least one. The last level is a few texels wide, beyond
/// which no blur remains.
#[must_use]
pub fn scene_levels(frame_texels: [u32; 2]) -> u8 {
    let smaller = frame_texels[0].min(frame_texels[1]).max(1);
    (smaller.ilog2() as u8).saturating_sub(1).max(1)
}

/// Makes level 0 of the picture: radiance of opaque surfaces and background, with their distance. Uses [`Programs`] and
/// the view's camera of the world.
#[derive(Clone, Copy, Debug)]
pub struct SceneCopy {
    /// View of the depth.
    pub view: ViewId,
    /// Radiance with one sample; the picture has its size.
    pub hdr: Texture,
    /// Depth so far, with the samples of the frame.
    pub depth: Texture,
    /// Number of levels of the picture.
    pub levels: u8,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct SceneCopyIo {
    hdr: View,
    depth: View,
    samples: u8,
    /// The picture, with level 0 written.
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

/// Makes one further level of the picture from the level above.
#[derive(Clone, Copy, Debug)]
pub struct SceneLevel {
    /// The picture, with all levels above `level` written.
    pub scene: Texture,
    /// Index of the level, at least 1.
    pub level: u8,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct SceneLevelIo {
    above: View,
    /// The picture, including this level.
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

/// Maximum number of layers of glass.
pub const MAX_GLASS_LAYERS: u8 = 4;

/// Layer of transmissive surfaces that are drawn together. Overlapping surfaces are sorted into layers by depth order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layer {
    /// Number of layers in front of it.
    pub before: u8,
    /// True if the layer also holds everything farther back.
    pub last: bool,
}

impl Layer {
    /// A single layer with all transmissive surfaces.
    pub const ONLY: Self = Self { before: 0, last: true };

    /// Returns this number of layers, from back to front.
    pub fn all(count: u8) -> impl Iterator<Item = Self> {
        (0..count).rev().map(move |before| Self { before, last: before + 1 == count })
    }

    /// Returns the draws of this layer, nearest first.
    fn of(self, view: &CameraView) -> DrawList {
        let is_own = |layer: u8| if self.last { layer >= self.before } else { layer == self.before };
        let draws = view.draws.transmit.iter().zip(&view.visible.transmit_layers);
        draws.filter(|(_, layer)| is_own(**layer)).map(|(draw, _)| *draw).collect::<Vec<_>>().into()
    }
}

/// Draws transmissive surfaces of a layer over everything behind it; after the nearest layer, draws blended surfaces.
#[derive(Clone, Copy, Debug)]
pub struct Transparent {
    /// View to draw.
    pub view: ViewId,
    /// Depth of opaque surfaces and of farther layers.
    pub depth: Texture,
    /// The picture behind the layer, with all levels written.
    pub scene: Texture,
    /// Radiance of everything behind the layer, with one sample.
    pub hdr: Texture,
    /// Radiance of each sample; the same as `hdr` at one sample per texel.
    pub samples: Texture,
    /// Shadow maps of the view; `None` for no shadows.
    pub shadow: Option<ShadowMaps>,
    /// Layer to draw.
    pub layer: Layer,
    /// Order of blended surfaces. Unordered techniques draw them in later passes.
    pub transparency: Transparency,
    /// Shading options.
    pub shading: Shading,
    /// Fog; `None` for no fog.
    pub fog: Option<FogSettings>,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct TransparentIo {
    scene: View,
    shadow: Option<ShadowInput>,
    /// True if the depth has stencil.
    stencil: bool,
    /// Depth of opaque and transmissive surfaces.
    pub depth: Texture,
    /// Radiance of each sample, including this layer; the same as `hdr` at one sample per texel.
    pub samples: Texture,
    /// Pre-exposed radiance with one sample, including this layer.
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
        // The prepass has not drawn these: masked surfaces are cut out here; opaque surfaces ignore the cutoff.
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
