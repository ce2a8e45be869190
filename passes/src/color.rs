//! The color pass: opaque and masked surfaces, the sky behind them, blended surfaces in front.
//!
//! Where the plan inlines point-wise passes that read the radiance, every draw of this pass ends with what they do, and
//! the radiance is never written.

use crate::draw::{DrawOrder, Surface, draw_instances};
use crate::effect;
use crate::precision::Precision;
use crate::program::Program;
use crate::shading::Shading;
use crate::upload::features_of;
use crate::view::Drawn;
use crate::world::World;
use framegraph::{ClearValue, DeclareError, Extent, Format, Intent, Pass, PassBuilder, Texture, TextureDesc, View};
use framegraph_scene::{Lobe, Lobes};
use framegraph_shaders::{Feature, Features, Module, library};
use framegraph_wgpu::Record;
use framegraph_wgpu::{Binding, Constants, Cx, Depth, Epilogue, Output, Raster, RecordError, SamplerDesc};
use std::sync::Arc;
use wgpu::{AddressMode, BlendState};

/// Shades surfaces.
pub(crate) const COLOR: Module<'_> = library::pass("pass/color.wgsl").unwrap();
/// Shades what no surface covers.
pub(crate) const SKY: Module<'_> = library::pass("pass/sky.wgsl").unwrap();

/// Format of scene-referred radiance: half floats, since eleven bits tint greys by a code (docs of the format choice).
pub const HDR_FORMAT: Format = Format::Rgba16Float;

/// Shades what the prepass found nearest.
#[derive(Clone, Copy, Debug)]
pub struct Color {
    /// Depth of the nearest surfaces.
    pub depth: Texture,
    /// The sun's shadow map; without one the sun casts none.
    pub shadow: Option<Texture>,
    /// Samples per texel; above 1 the result is averaged.
    pub samples: u8,
    /// Some surface blends.
    pub blended: bool,
    /// A later pass draws what transmits and blends ([`Transparent`](crate::transmission::Transparent)): this one leaves it
    /// out.
    pub opaque_only: bool,
    /// Format of the radiance: [`HDR_FORMAT`], or another that can be drawn into.
    pub format: Format,
    /// How surfaces are shaded.
    pub shading: Shading,
}

/// What the pass reads and wrote.
#[derive(Clone, Copy, Debug)]
pub struct ColorIo {
    shadow: Option<View>,
    /// Scene-referred radiance times exposure, linear Rec.709, single-sampled.
    pub hdr: Texture,
    /// The same, of each sample; `hdr` itself at one sample per texel.
    pub samples: Texture,
}

impl Pass for Color {
    type Io = ColorIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<ColorIo, DeclareError> {
        pass.takes_epilogue();
        pass.depth_read_only(self.depth)?;
        let shadow = self.shadow.map(|map| pass.sampled(map)).transpose()?;
        if self.blended && !self.opaque_only {
            pass.blends();
        }
        let desc = TextureDesc::new(Extent::FRAME, self.format);
        let hdr = pass.texture("hdr", desc);
        // The sky covers what no surface does, but samples at the edge of a surface are covered one by one: clearing costs
        // a tile nothing and leaves nothing to chance.
        let black = Intent::Clear(ClearValue::BLACK);
        if self.samples == 1 {
            let hdr = pass.color(hdr, black)?;
            return Ok(ColorIo { shadow, hdr, samples: hdr });
        }
        let samples = pass.texture("hdr_samples", desc.samples(self.samples));
        let samples = pass.color(samples, black)?;
        Ok(ColorIo { shadow, hdr: pass.resolve(samples, hdr)?, samples })
    }
}

impl Record<World> for Color {
    fn record(&self, io: &ColorIo, world: &World, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let ending = ending(cx)?;
        let seen = &world.view.seen;
        if !seen.transmit.is_empty() && !self.opaque_only {
            return Err(undeclared());
        }
        if !ending.effects.is_empty() && !seen.blend.is_empty() {
            return Err(RecordError::custom(
                "a surface of the scene blends, but colors are graded before they are blended; declare the frame with \
                 `Settings::blended`",
            ));
        }
        let shading = shading_constants(&self.shading, world)?;
        let bindings = FrameBindings::new(io.shadow, None, &self.shading, world, ending, cx)?;
        let program = |lobes: Lobes| bindings.program(world, lobes);
        let constants = |alpha_mode| {
            [&[("ALPHA_MODE", alpha_mode)], shading.as_slice(), bindings.ending.constants.as_slice()].concat()
        };
        // The prepass has cut the holes of masked surfaces: both kinds are drawn where depth is equal.
        let constants_opaque = constants(0.0);
        let opaque = Surface {
            program: &program,
            constants: &constants_opaque,
            depth: Depth::EQUAL,
            colors: &[],
            order: DrawOrder::ByPipeline,
        };
        for list in [&seen.opaque, &seen.mask] {
            draw_instances(&opaque, list, world, cx, &|name| bindings.get(name))?;
        }
        background(world, cx, &bindings)?;
        if self.opaque_only {
            return Ok(());
        }
        let blend = [Output { blend: Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING), ..Output::REPLACE }];
        let depth = Depth { write: false, ..Depth::NEARER };
        let blended =
            Surface { program: &program, constants: &constants(2.0), depth, colors: &blend, order: DrawOrder::Kept };
        draw_instances(&blended, &seen.blend, world, cx, &|name| bindings.get(name))
    }
}

/// The constants of shading, where the light is made for it.
pub(crate) fn shading_constants(shading: &Shading, world: &World) -> Result<Vec<(&'static str, f64)>, RecordError> {
    let (wanted, made) = (shading.table, world.lighting.dfg.settings.visibility);
    if wanted != made {
        return Err(RecordError::custom(format!(
            "`Shading::table` is {wanted:?}, but the DFG table was made for {made:?}; make the `Lighting` with \
             `Shading::light`"
        )));
    }
    Ok(shading.constants(world.lighting.image.bands))
}

/// What the passes do that the plan inlined into this one.
fn ending(cx: &mut Cx<'_>) -> Result<Epilogue, RecordError> {
    let mut all = Epilogue::default();
    for (_, epilogue) in cx.epilogues()? {
        all.append(epilogue)?;
    }
    Ok(all)
}

/// A surface transmits where the frame has no pass for it.
fn undeclared() -> RecordError {
    RecordError::custom(
        "a surface of the scene transmits light, but the frame keeps no picture of what is behind it; declare the frame with \
         `Settings::for_scene`, or set `Settings::scene_levels`",
    )
}

/// What group 0 of the color and sky shaders is offered.
pub(crate) struct FrameBindings {
    frame: Binding,
    lights: Binding,
    shadow_map: Option<Binding>,
    shadow_sampler: Binding,
    environment_map: Binding,
    environment_sampler: Binding,
    specular_map: Binding,
    dfg_table: Binding,
    light_sampler: Binding,
    scene_levels: Option<Binding>,
    scene_sampler: Binding,
    /// Features of the color shader that are the same for all surfaces.
    features: Features,
    ending: Epilogue,
}

impl FrameBindings {
    /// With the shadow map and the picture of what is behind transmissive surfaces, where the pass reads them.
    pub(crate) fn new(
        shadow: Option<View>,
        scene: Option<View>,
        shading: &Shading,
        world: &World,
        ending: Epilogue,
        cx: &mut Cx<'_>,
    ) -> Result<Self, RecordError> {
        shading.precision.check(cx.gpu()).map_err(RecordError::custom)?;
        let around = SamplerDesc {
            address: [AddressMode::Repeat, AddressMode::ClampToEdge, AddressMode::ClampToEdge],
            ..SamplerDesc::LINEAR
        };
        Ok(Self {
            frame: cx.uniform(&world.view.frame),
            lights: world.lights.clone().into(),
            shadow_map: shadow.map(|map| cx.view(map)).transpose()?.map(Binding::from),
            shadow_sampler: cx.sampler(SamplerDesc::SHADOW).into(),
            environment_map: world.lighting.panorama.view.clone().into(),
            environment_sampler: cx.sampler(around).into(),
            specular_map: world.lighting.image.specular.clone().into(),
            dfg_table: world.lighting.dfg.view.clone().into(),
            light_sampler: cx.sampler(SamplerDesc::LINEAR).into(),
            scene_levels: scene.map(|scene| cx.view(scene)).transpose()?.map(Binding::from),
            scene_sampler: cx.sampler(SamplerDesc::LINEAR).into(),
            features: Features::NONE
                .with(Feature::ENVIRONMENT_MAP)
                .with_if(Feature::SHADOWS, shadow.is_some())
                .with_if(Feature::HALF, shading.precision == Precision::Half),
            ending,
        })
    }

    /// The program of surfaces with these lobes.
    pub(crate) fn program(&self, world: &World, lobes: Lobes) -> Result<Arc<Program>, RecordError> {
        if lobes.contains(Lobe::Transmission) && self.scene_levels.is_none() {
            return Err(undeclared());
        }
        let features = features_of(lobes).iter().fold(self.features.clone(), Features::with);
        world.programs.ending(&COLOR, &features, "fs_main", &self.ending.effects)
    }

    pub(crate) fn get(&self, name: &str) -> Option<Binding> {
        match name {
            "frame" => Some(self.frame.clone()),
            "lights" => Some(self.lights.clone()),
            "shadow_map" => self.shadow_map.clone(),
            "shadow_sampler" => Some(self.shadow_sampler.clone()),
            "environment_map" => Some(self.environment_map.clone()),
            "environment_sampler" => Some(self.environment_sampler.clone()),
            "specular_map" => Some(self.specular_map.clone()),
            "dfg_table" => Some(self.dfg_table.clone()),
            "light_sampler" => Some(self.light_sampler.clone()),
            "scene_levels" => self.scene_levels.clone(),
            "scene_sampler" => Some(self.scene_sampler.clone()),
            _ => effect::binding(name).and_then(|number| self.ending.binding(number)).cloned(),
        }
    }
}

/// A full-screen triangle on the far plane: drawn where no surface is.
///
/// Black needs no triangle, being the clear value; but where colors are graded here it is drawn too: what becomes of it
/// may depend on the pixel, and only the shader gives the shader's bits.
fn background(world: &World, cx: &mut Cx<'_>, bindings: &FrameBindings) -> Result<(), RecordError> {
    let Epilogue { effects, constants, .. } = &bindings.ending;
    let (fragment, uniforms) = match &world.view.background {
        Drawn::Environment => ("fs_environment", None),
        Drawn::ClearSky(sky) => ("fs_procedural", Some(cx.uniform(sky))),
        Drawn::Constant(radiance) => ("fs_constant", Some(cx.uniform(radiance))),
        Drawn::None if effects.is_empty() => return Ok(()),
        Drawn::None => ("fs_black", None),
    };
    let program = world.programs.ending(&SKY, &Features::NONE, fragment, effects)?;
    let raster = Raster {
        fragment: program.fragment,
        constants: Constants(constants),
        depth: Depth { write: false, ..Depth::NEARER },
        ..Raster::new(program.shader())
    };
    let pipeline = cx.raster_pipeline(&raster)?;
    let mut groups = vec![program.bind(cx, &pipeline, 0, |_, name| Ok(bindings.get(name)))?];
    if let Some(sky) = uniforms {
        groups.push(program.bind(cx, &pipeline, 1, |_, name| Ok((name == "sky").then(|| sky.clone())))?);
    }
    let pass = cx.render_pass()?;
    pass.set_pipeline(&pipeline);
    for (index, group) in groups.iter().enumerate() {
        pass.set_bind_group(index as u32, group, &[]);
    }
    pass.draw(0..3, 0..1);
    Ok(())
}
