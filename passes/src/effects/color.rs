//! The color pass: opaque and masked surfaces, the background, and sorted blended surfaces.
//!
//! After a depth prepass, only the nearest surfaces are shaded, each pixel once. Otherwise the pass tests depth itself
//! and may shade a pixel several times. Both give bit-identical pictures, since the last of equally near surfaces wins
//! either way.
//!
//! If the plan inlines point-wise passes that read the radiance, the shaders of this pass apply them, and the radiance
//! is never written.

mod background;
pub mod surface;

use crate::effects::color::background::draw_background;
use crate::effects::color::surface::{HDR_FORMAT, OcclusionInput, SurfaceBindings, SurfaceInputs, SurfaceWorld};
use crate::effects::depth::prepass::new_depth;
use crate::effects::fog::FogSettings;
use crate::effects::shadow::ShadowInput;
use crate::effects::transparency::{Transparency, draw_sorted};
use crate::error::PassError;
use crate::gpu_scene::draw::SurfaceDraw;
use crate::gpu_scene::lighting::Lighting;
use crate::gpu_scene::shadow_views::ShadowMaps;
use crate::gpu_scene::upload::GpuScene;
use crate::gpu_scene::view::{ViewId, Views};
use crate::light::shading::{AlphaUse, Shading};
use crate::program::Programs;
use framegraph::{
    ClearValue, DeclareError, Extent, Format, Intent, Pass, PassBuilder, Target, Texture, TextureDesc, View,
};
use framegraph_wgpu::{Cx, Depth, Epilogue, Record, RecordError};

/// Shades the visible surfaces and the background.
#[derive(Clone, Copy, Debug)]
pub struct Color {
    /// View to draw; must be the view of the depth.
    pub view: ViewId,
    /// Source of the depth; the radiance has its size.
    pub depth: ColorDepth,
    /// Shadow maps of the view, depth or moments; `None` for no shadows.
    pub shadow: Option<ShadowMaps>,
    /// Ambient occlusion of opaque and masked surfaces: visibility in red; in format Rgba16Float, the bent normal in
    /// the other channels. Has the size of the depth, or is smaller.
    pub occlusion: Option<Texture>,
    /// Depth pyramid that the ambient occlusion was computed from. Required if that is smaller than the depth.
    pub structure: Option<Texture>,
    /// Depth of the scene with one sample per texel, at the size of the picture, for contact shadows of the sun. Used
    /// with shadow maps.
    pub contact_depth: Option<Texture>,
    /// Screen-space reflections with all levels written, and their hit distances. Replace reflections of the
    /// environment on opaque and masked surfaces.
    pub reflections: Option<[Texture; 2]>,
    /// Samples per texel, as in the depth; above 1, the result is resolved.
    pub samples: u8,
    /// Gives the pass's own depth a stencil aspect, for materials that use stencil. A prepass's depth brings its own.
    pub stencil: bool,
    /// True if any surface blends.
    pub blended: bool,
    /// Order of blended surfaces. Unordered techniques draw them in later passes.
    pub transparency: Transparency,
    /// True if a blended surface writes depth
    /// ([`TransparencyMode::TwoPassesOneSide`](framegraph_scene::TransparencyMode)).
    pub blended_depth: bool,
    /// Skips transmissive and blended surfaces, which a later pass draws
    /// ([`Transparent`](crate::effects::transmission::Transparent)).
    pub opaque_only: bool,
    /// Draws the background; not needed if surfaces cover the picture.
    pub sky: bool,
    /// Format of the radiance: [`HDR_FORMAT`], or another renderable format.
    pub format: Format,
    /// Target of the radiance; a new texture has the size of the depth and this format.
    pub into: Target,
    /// Shading options.
    pub shading: Shading,
    /// Fog; `None` for no fog.
    pub fog: Option<FogSettings>,
}

/// Source of the depth that the color pass tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColorDepth {
    /// Depth of a [`Prepass`](crate::effects::depth::prepass::Prepass). Surfaces are shaded where their depth is equal.
    /// The radiance has its layers.
    Prepass(Texture),
    /// Depth of the color pass itself, of this size.
    Own(Extent),
}

impl Color {
    /// Creates a pass for the main view over the depth of a prepass: one sample per texel, half floats, and no shadows,
    /// ambient occlusion, blending or fog. Override other fields with `..Color::new(depth)`.
    pub fn new(depth: Texture) -> Self {
        Self {
            view: ViewId::MAIN,
            depth: ColorDepth::Prepass(depth),
            shadow: None,
            occlusion: None,
            structure: None,
            contact_depth: None,
            reflections: None,
            samples: 1,
            stencil: false,
            blended: false,
            transparency: Transparency::Sorted,
            blended_depth: false,
            opaque_only: false,
            sky: true,
            format: HDR_FORMAT,
            into: Target::New,
            shading: Shading::default(),
            fog: None,
        }
    }
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct ColorIo {
    shadow: Option<ShadowInput>,
    contact: Option<View>,
    occlusion: Option<OcclusionInput>,
    reflections: Option<[View; 2]>,
    /// True if the depth has stencil.
    stencil: bool,
    /// Reversed depth of the nearest surfaces.
    pub depth: Texture,
    /// Pre-exposed radiance, linear Rec.709, with one sample.
    pub hdr: Texture,
    /// Radiance of each sample; the same as `hdr` at one sample per texel.
    pub samples: Texture,
}

impl Pass for Color {
    type Io = ColorIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<ColorIo, DeclareError> {
        pass.takes_epilogue();
        let (extent, layers, depth) = match self.depth {
            ColorDepth::Prepass(depth) if self.blended_depth && self.draws_blended() => {
                let TextureDesc { extent, layers, .. } = pass.desc(depth)?;
                (extent, layers, pass.depth(depth, Intent::Modify)?)
            }
            ColorDepth::Prepass(depth) => {
                let TextureDesc { extent, format, layers, .. } = pass.desc(depth)?;
                // Blended surfaces may write stencil.
                let depth = match format.has_stencil() {
                    true => pass.depth(depth, Intent::Modify)?,
                    false => pass.depth_read_only(depth).map(|_| depth)?,
                };
                (extent, layers, depth)
            }
            ColorDepth::Own(extent) => (extent, 1, new_depth(pass, extent, self.samples, (self.stencil, 1))?),
        };
        let stencil = pass.desc(depth)?.format.has_stencil();
        let shadow = ShadowInput::declare(self.shadow, pass)?;
        let contact = self.contact_depth.map(|depth| pass.sampled(depth.mip(0))).transpose()?;
        let occlusion = self.occlusion.map(|picture| self.occlusion_input(picture, extent, pass)).transpose()?;
        let reflections = match self.reflections {
            Some([picture, ways]) => Some([pass.sampled(picture)?, pass.sampled(ways)?]),
            None => None,
        };
        if self.blended && self.draws_blended() {
            pass.blends();
        }
        let desc = TextureDesc::new(extent, self.format).layers(layers);
        let hdr = pass.target(self.into, "hdr", desc);
        // The background covers texels without surfaces. Samples at surface edges are covered one by one, so clear
        // them; this is free on tilers.
        let black = Intent::Clear(ClearValue::BLACK);
        if self.samples == 1 {
            let hdr = pass.color(hdr, black)?;
            return Ok(ColorIo { shadow, contact, occlusion, reflections, stencil, depth, hdr, samples: hdr });
        }
        let samples = pass.texture("hdr_samples", desc.samples(self.samples));
        let samples = pass.color(samples, black)?;
        let hdr = pass.resolve(samples, hdr.texture())?;
        Ok(ColorIo { shadow, contact, occlusion, reflections, stencil, depth, hdr, samples })
    }
}

impl<W> Record<W> for Color
where
    W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Lighting> + AsRef<Views> + ?Sized,
{
    fn record(&self, io: &ColorIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        self.draw(io, &SurfaceWorld::of(world, self.view)?, cx)
    }
}

impl Color {
    /// Returns true if no later pass draws blended surfaces.
    fn draws_blended(&self) -> bool {
        !self.opaque_only && !self.transparency.is_unordered()
    }

    fn occlusion_input(
        &self,
        picture: Texture,
        extent: Extent,
        pass: &mut PassBuilder<'_>,
    ) -> Result<OcclusionInput, DeclareError> {
        let desc = pass.desc(picture)?;
        let structure = match self.structure {
            _ if desc.extent == extent => None,
            Some(structure) => Some(pass.sampled(structure.mip(0))?),
            None => {
                let hint = "pass the structure that it was computed from";
                return Err(pass.error("ambient occlusion has another size than the depth", hint));
            }
        };
        let bent_normals = desc.format == Format::Rgba16Float;
        Ok(OcclusionInput { picture: pass.sampled(picture)?, structure, bent_normals })
    }

    fn draw(&self, io: &ColorIo, world: &SurfaceWorld<'_>, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let visible = &world.view.view.visible;
        if !visible.transmit.is_empty() && !self.opaque_only {
            return Err(PassError::TransmissionUndeclared.into());
        }
        let epilogue = epilogue(cx)?;
        if !epilogue.effects.is_empty() && !visible.blend.is_empty() && self.draws_blended() {
            return Err(PassError::BlendingUndeclared.into());
        }
        let ColorIo { shadow, contact, occlusion, reflections, stencil, .. } = *io;
        let inputs = SurfaceInputs {
            contact,
            occlusion,
            reflections,
            fog: self.fog,
            stencil,
            ..SurfaceInputs::shadowed(shadow)
        };
        let bindings = SurfaceBindings::new(inputs, &self.shading, world, epilogue, cx)?;
        // A prepass has already tested and written stencil.
        let own_stencil = stencil && matches!(self.depth, ColorDepth::Own(_));
        let program = |variant| bindings.program(world.programs, variant);
        // A prepass has cut out masked surfaces, but another surface may have equal depth there.
        let depth = match self.depth {
            ColorDepth::Prepass(_) => Depth::EQUAL,
            ColorDepth::Own(_) => Depth::NEARER,
        };
        for (batches, alpha) in world.view.view.draws.surfaces.iter().zip([AlphaUse::None, AlphaUse::Mask]) {
            let surfaces = SurfaceDraw {
                program: &program,
                frame: &bindings.frame,
                constants: &bindings.constants(alpha),
                depth: depth.clone(),
                colors: &[],
            };
            surfaces.draw(batches, world.instances().with_stencil(own_stencil), cx)?;
        }
        if self.sky {
            draw_background(world, &bindings, cx)?;
        }
        if self.draws_blended() { draw_sorted(world, &bindings, self.transparency, cx) } else { Ok(()) }
    }
}

/// Returns the effects that the plan inlined into this pass.
fn epilogue(cx: &mut Cx<'_>) -> Result<Epilogue, RecordError> {
    let mut all = Epilogue::default();
    for (_, epilogue) in cx.epilogues()? {
        all.append(epilogue)?;
    }
    Ok(all)
}
