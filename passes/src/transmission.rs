//! Surfaces that let light through: a picture of everything behind them, and a second pass that draws them over it.
//!
//! ```text
//! color (opaque, sky) ─> scene/0 (copy, with distance) ─> scene/1 ─> … ─> scene/n   each level of the one above
//!                    └───────────────────────────────────────────────────┴─> transparent (transmissive, blended)
//! ```
//!
//! A frame has these passes only where the scene transmits; each level of the picture is written once and read by the next,
//! which the plan follows level by level.

use crate::color::{FrameBindings, shading_constants};
use crate::draw::{DrawOrder, Surface, draw_instances};
use crate::shading::Shading;
use crate::world::World;
use framegraph::{DeclareError, Extent, Format, Intent, Pass, PassBuilder, Texture, TextureDesc, View};
use framegraph_scene::Lobes;
use framegraph_shaders::{Features, Module, library};
use framegraph_wgpu::Record;
use framegraph_wgpu::{Binding, Cx, Depth, Epilogue, Output, Raster, RecordError, SamplerDesc};
use wgpu::BlendState;

/// Makes the picture of what is behind.
const SCENE: Module<'_> = library::pass("pass/scene.wgsl").unwrap();

/// Format of the picture: radiance, and the distance in alpha.
const SCENE_FORMAT: Format = Format::Rgba16Float;

/// How many levels a picture of a frame of this size has: until the smaller side is a few texels, of which no blur is left
/// to make, and at least one.
#[must_use]
pub fn scene_levels(frame_texels: [u32; 2]) -> u8 {
    let smaller = frame_texels[0].min(frame_texels[1]).max(1);
    (smaller.ilog2() as u8).saturating_sub(1).max(1)
}

/// Level 0 of the picture: the radiance of opaque surfaces and the sky, and how far away they are.
#[derive(Clone, Copy, Debug)]
pub struct SceneCopy {
    /// Radiance, single-sampled.
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
        let samples = pass.desc(self.depth.read_only())?.samples;
        let (hdr, depth) = (pass.sampled(self.hdr)?, pass.sampled(self.depth)?);
        let scene = pass.texture("scene", TextureDesc::new(Extent::FRAME, SCENE_FORMAT).mips(self.levels));
        Ok(SceneCopyIo { hdr, depth, samples, scene: pass.color(scene.mip(0), Intent::Overwrite)? })
    }
}

impl Record<World> for SceneCopy {
    fn record(&self, io: &SceneCopyIo, world: &World, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        // wgpu 30 makes no storage for textures of several samples that OpenGL is to read: they hold nothing.
        if io.samples > 1 && cx.gpu().info().backend == wgpu::Backend::Gl {
            return Err(RecordError::custom(
                "surfaces that transmit light need depth of several samples to be read, which wgpu cannot do through OpenGL; \
                 use one sample per texel (`--msaa 1`), or another back end",
            ));
        }
        let (hdr, depth) = (cx.view(io.hdr)?, cx.view(io.depth)?);
        let frame = cx.uniform(&world.view.frame);
        let fragment = if io.samples == 1 { "fs_copy" } else { "fs_copy_samples" };
        full_screen(fragment, world, cx, |_, name| match name {
            "frame" => Some(frame.clone()),
            "hdr" => Some(hdr.clone().into()),
            "scene_depth" | "scene_depth_samples" => Some(depth.clone().into()),
            _ => None,
        })
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

impl Record<World> for SceneLevel {
    fn record(&self, io: &SceneLevelIo, world: &World, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let above = cx.view(io.above)?;
        full_screen("fs_level", world, cx, |cx, name| match name {
            "source" => Some(above.clone().into()),
            "source_sampler" => Some(cx.sampler(SamplerDesc::LINEAR).into()),
            _ => None,
        })
    }
}

fn full_screen(
    fragment: &'static str,
    world: &World,
    cx: &mut Cx<'_>,
    mut offer: impl FnMut(&mut Cx<'_>, &str) -> Option<Binding>,
) -> Result<(), RecordError> {
    let program = world.programs.ending(&SCENE, &Features::NONE, fragment, &[])?;
    let pipeline = cx.raster_pipeline(&Raster { fragment: program.fragment, ..Raster::new(program.shader()) })?;
    let group = program.bind(cx, &pipeline, 0, |cx, name| Ok(offer(cx, name)))?;
    let pass = cx.render_pass()?;
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.draw(0..3, 0..1);
    Ok(())
}

/// Transmissive surfaces, then blended ones, over what the color pass left.
#[derive(Clone, Copy, Debug)]
pub struct Transparent {
    /// Depth of opaque surfaces.
    pub depth: Texture,
    /// The picture of what is behind, all levels written.
    pub scene: Texture,
    /// Radiance of opaque surfaces and the sky, single-sampled.
    pub hdr: Texture,
    /// The same, of each sample; `hdr` itself at one sample per texel.
    pub samples: Texture,
    /// The sun's shadow map.
    pub shadow: Option<Texture>,
    /// How surfaces are shaded.
    pub shading: Shading,
}

/// What the pass reads and wrote.
#[derive(Clone, Copy, Debug)]
pub struct TransparentIo {
    scene: View,
    shadow: Option<View>,
    /// Scene-referred radiance times exposure with everything in it, single-sampled.
    pub hdr: Texture,
}

impl Pass for Transparent {
    type Io = TransparentIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<TransparentIo, DeclareError> {
        pass.blends();
        let scene = pass.sampled(self.scene)?;
        let shadow = self.shadow.map(|map| pass.sampled(map)).transpose()?;
        pass.depth(self.depth, Intent::Modify)?;
        let samples = pass.color(self.samples, Intent::Modify)?;
        let hdr = if self.samples == self.hdr { samples } else { pass.resolve(samples, self.hdr)? };
        Ok(TransparentIo { scene, shadow, hdr })
    }
}

impl Record<World> for Transparent {
    fn record(&self, io: &TransparentIo, world: &World, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let bindings = FrameBindings::new(io.shadow, Some(io.scene), &self.shading, world, Epilogue::default(), cx)?;
        let program = |lobes: Lobes| bindings.program(world, lobes);
        let shading = shading_constants(&self.shading, world)?;
        let constants = |alpha_mode| [&[("ALPHA_MODE", alpha_mode)], shading.as_slice()].concat();
        let seen = &world.view.seen;
        // No prepass has seen these: masked ones are cut here, and the cutoff of opaque ones cuts nothing.
        let transmissive = Surface {
            program: &program,
            constants: &constants(1.0),
            depth: Depth::NEARER,
            colors: &[],
            order: DrawOrder::Kept,
        };
        draw_instances(&transmissive, &seen.transmit, world, cx, &|name| bindings.get(name))?;
        let blend = [Output { blend: Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING), ..Output::REPLACE }];
        let blended = Surface {
            constants: &constants(2.0),
            depth: Depth { write: false, ..Depth::NEARER },
            colors: &blend,
            ..transmissive
        };
        draw_instances(&blended, &seen.blend, world, cx, &|name| bindings.get(name))
    }
}
