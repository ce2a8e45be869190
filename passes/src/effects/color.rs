//! The color pass: opaque and masked surfaces, the sky behind them, blended surfaces in front.
//!
//! Over a depth prepass it shades what that found nearest, each pixel once. Without one it finds the nearest itself and may shade a
//! pixel several times; the picture is the same to the bit, since the last of equally near surfaces is seen either way.
//!
//! Where the plan inlines point-wise passes that read the radiance, every draw of this pass ends with what they do, and
//! the radiance is never written.

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
use crate::gpu_scene::upload::GpuScene;
use crate::gpu_scene::view::{ViewId, Views};
use crate::light::shading::{AlphaUse, Shading};
use crate::program::Programs;
use framegraph::{
    ClearValue, DeclareError, Extent, Format, Intent, Pass, PassBuilder, Target, Texture, TextureDesc, View,
};
use framegraph_wgpu::{Cx, Depth, Epilogue, Record, RecordError};

/// Shades what is nearest.
#[derive(Clone, Copy, Debug)]
pub struct Color {
    /// The view that is drawn: that of the depth.
    pub view: ViewId,
    /// Where depth comes from; the radiance gets its size.
    pub depth: ColorDepth,
    /// The shadow maps of the view, depth or moments; without them nothing casts.
    pub shadow: Option<Texture>,
    /// Ambient occlusion of what does not blend: visibility in red, and where it is of the format Rgba16Float the mean open
    /// direction in the other channels. Of the depth's size, or smaller.
    pub occlusion: Option<Texture>,
    /// The structure of the scene: what ambient occlusion was made of, needed where that is smaller than the depth; and what
    /// contact shadows look around in.
    pub structure: Option<Texture>,
    /// What rays found in the picture, all levels written, and how long their ways were: it takes the place of the environment in
    /// the reflections of what does not blend.
    pub reflections: Option<[Texture; 2]>,
    /// The sun's shadow maps are completed by contact shadows, where there are maps and a structure.
    pub contact_shadows: bool,
    /// Samples per texel, those of the depth; above 1 the result is averaged.
    pub samples: u8,
    /// Materials test and write stencil: depth of this pass's own then has it. That of a prepass says itself whether it has.
    pub stencil: bool,
    /// Some surface blends.
    pub blended: bool,
    /// How blended surfaces are put in order: those of an unordered technique are left to later passes.
    pub transparency: Transparency,
    /// A blended surface writes depth ([`TransparencyMode::TwoPassesOneSide`](framegraph_scene::TransparencyMode)).
    pub blended_depth: bool,
    /// A later pass draws what transmits and blends ([`Transparent`](crate::effects::transmission::Transparent)): this one leaves it
    /// out.
    pub opaque_only: bool,
    /// What stands behind everything is drawn; not needed where surfaces cover the picture.
    pub sky: bool,
    /// Format of the radiance: [`HDR_FORMAT`], or another that can be drawn into.
    pub format: Format,
    /// Where the radiance goes; a new texture has the size of the depth, and the format.
    pub into: Target,
    /// How surfaces are shaded.
    pub shading: Shading,
    /// Fog before all that is drawn.
    pub fog: Option<FogSettings>,
}

/// Where the depth comes from that the color pass tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColorDepth {
    /// From a [`Prepass`](crate::effects::depth::prepass::Prepass): the nearest surfaces, which are shaded where depth is equal.
    Prepass(Texture),
    /// From the color pass itself, of this size.
    Own(Extent),
}

impl Color {
    /// The main view over the depth of a prepass: one sample per texel, no shadow map, no ambient occlusion, nothing that blends, no fog, half floats. Other fields
    /// are set in a struct expression that ends with `..Color::new(depth)`.
    pub fn new(depth: Texture) -> Self {
        Self {
            view: ViewId::MAIN,
            depth: ColorDepth::Prepass(depth),
            shadow: None,
            occlusion: None,
            structure: None,
            reflections: None,
            contact_shadows: false,
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

/// What the pass reads and wrote.
#[derive(Clone, Copy, Debug)]
pub struct ColorIo {
    shadow: Option<ShadowInput>,
    contact: Option<View>,
    occlusion: Option<OcclusionInput>,
    reflections: Option<[View; 2]>,
    /// The depth has stencil.
    stencil: bool,
    /// Depth of the nearest surfaces, reversed.
    pub depth: Texture,
    /// Scene-referred radiance times exposure, linear Rec.709, single-sampled.
    pub hdr: Texture,
    /// The same, of each sample; `hdr` itself at one sample per texel.
    pub samples: Texture,
}

impl Pass for Color {
    type Io = ColorIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<ColorIo, DeclareError> {
        pass.takes_epilogue();
        let (extent, depth) = match self.depth {
            ColorDepth::Prepass(depth) if self.blended_depth && self.draws_blended() => {
                (pass.desc(depth)?.extent, pass.depth(depth, Intent::Modify)?)
            }
            ColorDepth::Prepass(depth) => {
                let TextureDesc { extent, format, .. } = pass.desc(depth)?;
                // Blended surfaces may write stencil.
                let depth = match format.has_stencil() {
                    true => pass.depth(depth, Intent::Modify)?,
                    false => pass.depth_read_only(depth).map(|_| depth)?,
                };
                (extent, depth)
            }
            ColorDepth::Own(extent) => (extent, new_depth(pass, extent, self.samples, self.stencil)?),
        };
        let stencil = pass.desc(depth)?.format.has_stencil();
        let shadow = ShadowInput::declare(self.shadow, pass)?;
        let shown = self.structure.filter(|_| self.contact_shadows);
        let contact = shown.map(|structure| pass.sampled(structure.mip(0))).transpose()?;
        let occlusion = self.occlusion.map(|picture| self.occlusion_input(picture, extent, pass)).transpose()?;
        let reflections = match self.reflections {
            Some([picture, ways]) => Some([pass.sampled(picture)?, pass.sampled(ways)?]),
            None => None,
        };
        if self.blended && self.draws_blended() {
            pass.blends();
        }
        let desc = TextureDesc::new(extent, self.format);
        let hdr = pass.target(self.into, "hdr", desc);
        // The sky covers what no surface does, but samples at the edge of a surface are covered one by one: clearing costs
        // a tile nothing and leaves nothing to chance.
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
    /// Whether no later pass draws blended surfaces.
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
                let hint = "give the color pass the structure that it was made of";
                return Err(pass.error("ambient occlusion is of another size than the depth", hint));
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
        // A prepass has tested and written the stencil of what it drew.
        let own_stencil = stencil && matches!(self.depth, ColorDepth::Own(_));
        let program = |variant| bindings.program(world.programs, variant);
        // A prepass has cut the holes of masked surfaces, but something else may be as near there.
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

/// What the passes do that the plan inlined into this one.
fn epilogue(cx: &mut Cx<'_>) -> Result<Epilogue, RecordError> {
    let mut all = Epilogue::default();
    for (_, epilogue) in cx.epilogues()? {
        all.append(epilogue)?;
    }
    Ok(all)
}
