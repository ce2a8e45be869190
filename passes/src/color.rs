//! The color pass: opaque and masked surfaces, the sky behind them, blended surfaces in front.

use crate::draw::{Surface, draw_instances};
use crate::view::Drawn;
use crate::world::World;
use framegraph::{ClearValue, DeclareError, Extent, Format, Intent, Pass, PassBuilder, Texture, TextureDesc, View};
use renderer::Record;
use renderer::wgpu::{Binding, Cx, Depth, Output, Raster, RecordError, SamplerShape};
use wgpu::{AddressMode, BlendState};

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
}

/// What the pass reads and wrote.
#[derive(Clone, Copy, Debug)]
pub struct ColorIo {
    shadow: Option<View>,
    /// Scene-referred radiance times exposure, linear Rec.709, single-sampled.
    pub hdr: Texture,
}

impl Pass for Color {
    type Io = ColorIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<ColorIo, DeclareError> {
        pass.depth_read_only(self.depth)?;
        let shadow = self.shadow.map(|map| pass.sampled(map)).transpose()?;
        if self.blended {
            pass.blends();
        }
        let desc = TextureDesc::new(Extent::FRAME, HDR_FORMAT);
        let hdr = pass.texture("hdr", desc);
        // The sky covers what no surface does, but samples at the edge of a surface are covered one by one: clearing costs
        // a tile nothing and leaves nothing to chance.
        let black = Intent::Clear(ClearValue::BLACK);
        if self.samples == 1 {
            return Ok(ColorIo { shadow, hdr: pass.color(hdr, black)? });
        }
        let samples = pass.texture("hdr_samples", desc.samples(self.samples));
        let samples = pass.color(samples, black)?;
        Ok(ColorIo { shadow, hdr: pass.resolve(samples, hdr)? })
    }
}

impl Record<World> for Color {
    fn record(&self, io: &ColorIo, world: &World, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let bindings = FrameBindings::new(io, world, cx)?;
        let program = &world.programs.color[usize::from(io.shadow.is_some())];
        let surface = |alpha_mode, depth, colors| Surface { program, alpha_mode, depth, colors };
        let seen = &world.view.seen;
        // The prepass has cut the holes of masked surfaces: both kinds are drawn where depth is equal.
        for list in [&seen.opaque, &seen.mask] {
            let opaque = surface(Some(0.0), Depth::EQUAL, &[]);
            draw_instances(&opaque, list, world, cx, &|name| bindings.get(name))?;
        }
        sky(world, cx, &bindings)?;
        let blend = [Output { blend: Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING), ..Output::REPLACE }];
        let blended = surface(Some(2.0), Depth { write: false, ..Depth::NEARER }, &blend);
        draw_instances(&blended, &seen.blend, world, cx, &|name| bindings.get(name))
    }
}

/// What group 0 of the color and sky shaders is offered.
struct FrameBindings {
    frame: Binding,
    lights: Binding,
    shadow_map: Option<Binding>,
    shadow_sampler: Binding,
    environment_map: Binding,
    environment_sampler: Binding,
    dfg_table: Binding,
    dfg_sampler: Binding,
}

impl FrameBindings {
    fn new(io: &ColorIo, world: &World, cx: &mut Cx<'_>) -> Result<Self, RecordError> {
        let around = SamplerShape {
            address: [AddressMode::Repeat, AddressMode::ClampToEdge, AddressMode::ClampToEdge],
            ..SamplerShape::LINEAR
        };
        Ok(Self {
            frame: cx.uniform(&world.view.frame),
            lights: world.lights.clone().into(),
            shadow_map: io.shadow.map(|map| cx.view(map)).transpose()?.map(Binding::from),
            shadow_sampler: cx.sampler(SamplerShape::SHADOW).into(),
            environment_map: world.environment.view.clone().into(),
            environment_sampler: cx.sampler(around).into(),
            dfg_table: world.dfg.clone().into(),
            dfg_sampler: cx.sampler(SamplerShape::LINEAR).into(),
        })
    }

    fn get(&self, name: &str) -> Option<Binding> {
        match name {
            "frame" => Some(self.frame.clone()),
            "lights" => Some(self.lights.clone()),
            "shadow_map" => self.shadow_map.clone(),
            "shadow_sampler" => Some(self.shadow_sampler.clone()),
            "environment_map" => Some(self.environment_map.clone()),
            "environment_sampler" => Some(self.environment_sampler.clone()),
            "dfg_table" => Some(self.dfg_table.clone()),
            "dfg_sampler" => Some(self.dfg_sampler.clone()),
            _ => None,
        }
    }
}

/// A full-screen triangle on the far plane: drawn where no surface is.
fn sky(world: &World, cx: &mut Cx<'_>, bindings: &FrameBindings) -> Result<(), RecordError> {
    let (program, uniforms) = match &world.view.background {
        Drawn::Environment => (&world.programs.sky_map, None),
        Drawn::ClearSky(sky) => (&world.programs.sky_clear, Some(cx.uniform(sky))),
        Drawn::None => return Ok(()),
    };
    let behind = Depth { write: false, ..Depth::NEARER };
    let raster = Raster { fragment: program.fragment, depth: behind, ..Raster::new(program.shader()) };
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
