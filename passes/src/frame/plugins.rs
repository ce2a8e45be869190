//! Standard passes by name, for graph files. Plugins declare the passes, without recorders.
//!
//! In a file: `Plugin(kind: "fxaa", name: "fxaa", slots: {"input": "ldr", "output": "screen"})`. The program `plan`
//! reads graph files.

use crate::effects::bloom::{BloomDown, BloomFirst, BloomSettings, BloomUp};
use crate::effects::color::Color;
use crate::effects::depth::prepass::Prepass;
use crate::effects::depth::resolve::{DepthOf, DepthResolve};
use crate::effects::depth::structure::{Resolution, Structure};
use crate::effects::fxaa::Fxaa;
use crate::effects::occlusion::{AmbientOcclusion, Axis, Blur, OcclusionBlur, OcclusionSettings, SaoQuality};
use crate::effects::post::Post;
use crate::effects::post::tone_resolve::ToneResolve;
use crate::effects::shadow::{Shadow, ShadowLayer, maps_desc};
use crate::effects::taa::velocity::Velocity;
use crate::effects::taa::{SUM_FORMAT, Taa, TaaSettings};
use crate::effects::transmission::SceneCopy;
use crate::effects::upscale::sharpen::Sharpen;
use crate::effects::upscale::{Enlarge, UpscaleFilter};
use crate::gpu_scene::shadow_views::{ShadowMaps, ShadowSettings};
use crate::gpu_scene::view::ViewId;
use crate::settings::precision::Precision;
use framegraph::file::{Call, Host, Plugin, PluginError, PluginSlot, Registry, SlotType};
use framegraph::{Extent, Pass, Texture, TextureDesc};

/// Declares the pass of a kind.
type Declare<H> = fn(&mut H, &mut Call<'_>) -> Result<(), PluginError>;

/// Kind of pass: its slots and its declaration.
struct Standard<H: ?Sized> {
    slots: &'static [PluginSlot],
    declare: Declare<H>,
}

impl<H: Host + ?Sized> Plugin<H> for Standard<H> {
    fn slots(&self) -> &[PluginSlot] {
        self.slots
    }

    fn declare(&self, host: &mut H, call: &mut Call<'_>) -> Result<(), PluginError> {
        (self.declare)(host, call)
    }
}

const DEPTH: PluginSlot = PluginSlot::required("depth", SlotType::Texture);
const STRUCTURE: PluginSlot = PluginSlot::required("structure", SlotType::Texture);
const VELOCITY: PluginSlot = PluginSlot::optional("velocity", SlotType::Texture);
const SUM: PluginSlot = PluginSlot::optional("sum", SlotType::Texture);
const SHADOW: PluginSlot = PluginSlot::optional("shadow", SlotType::Texture);
const INPUT: PluginSlot = PluginSlot::required("input", SlotType::Texture);
const OUTPUT: PluginSlot = PluginSlot::required("output", SlotType::Target);

/// Standard passes that read and write textures which a file names.
///
/// | kind | parameters, with defaults |
/// | --- | --- |
/// | `shadow` | texels of the map: 2048 |
/// | `prepass`, `color` | samples: 1 |
/// | `depth_resolve`, `tone_resolve`, `occlusion`, `velocity`, `taa`, `fxaa`, `upscale` | none |
/// | `structure` | size of the frame instead of half of it: false |
/// | `occlusion_blur` | vertical: false |
/// | `scene_copy` | mip levels: 1 |
/// | `bloom_first` | size and mip levels: ((640, 360), 1) |
/// | `bloom_down` | level: 1 |
/// | `bloom_up` | size, level, number of levels: ((640, 360), 0, 1) |
/// | `post` | encoded for FXAA: false |
/// | `sharpen` | strength: 0.5 |
///
/// Passes that depend on the scene's materials or on a series of textures have no kind: transparency, reflections, depth
/// of field, lens flare, exposure, picking, and moments of shadow maps.
///
/// ```
/// use framegraph::Graph;
/// use framegraph::file::GraphFile;
///
/// let text = r#"(
///     version: 1,
///     resources: [Texture(name: "screen", format: Rgba8UnormSrgb, kind: Import(entry: Undefined, exit: Keep))],
///     passes: [
///         Plugin(kind: "prepass", name: "prepass", slots: {"output": "depth"}, params: 4),
///         Plugin(kind: "color", name: "color", slots: {"depth": "depth", "output": "hdr"}, params: 4),
///         Plugin(kind: "post", name: "post", slots: {"input": "hdr", "output": "screen"}),
///     ],
/// )"#;
/// let mut graph = Graph::new();
/// GraphFile::parse("frame.ron", text)?.declare(&[], &framegraph_passes::frame::plugins::registry(), &mut graph)?;
/// assert_eq!(graph.passes().len(), 3);
/// # Ok::<(), framegraph::file::FileErrors>(())
/// ```
pub fn registry<'p, H: Host + ?Sized + 'p>() -> Registry<'p, H> {
    let mut registry = Registry::new();
    let mut add = |kind: &str, slots, declare: Declare<H>| _ = registry.insert(kind, Standard { slots, declare });
    add("shadow", &[OUTPUT], |host, call| {
        let map_texels = params(call, 2048)?;
        let settings = ShadowSettings { map_texels, cascades: 1, local_maps: 0, ..ShadowSettings::default() };
        let (desc, name) = maps_desc(&settings);
        let maps = host.graph().texture(name, desc);
        made(host, call, &Shadow { settings, view: ViewId::MAIN, layer: ShadowLayer::anew(0), maps }, |map| map)
    });
    add("prepass", &[OUTPUT], |host, call| {
        let samples = params(call, 1)?;
        made(host, call, &Prepass { samples, ..Prepass::default() }, |depth| depth)
    });
    add("color", &[DEPTH, SHADOW, OUTPUT], |host, call| {
        let (depth, samples) = (input(call, DEPTH)?, params(call, 1)?);
        let shadow = call.current("shadow").map(|texture| ShadowMaps { texture, view: ViewId::MAIN });
        made(host, call, &Color { shadow, samples, ..Color::new(depth) }, |io| io.hdr)
    });
    add("depth_resolve", &[DEPTH, OUTPUT], |host, call| {
        let depth = input(call, DEPTH)?;
        made(host, call, &DepthResolve { depth, which: DepthOf::FirstSample }, |io| io.depth)
    });
    add("post", &[INPUT, OUTPUT], |host, call| {
        let (hdr, for_fxaa) = (input(call, INPUT)?, params(call, false)?);
        let (into, settings) = (call.target("output").0, crate::PostSettings::DEFAULT);
        made(host, call, &Post { hdr, bloom: None, into, settings, only: None, for_fxaa, stored: None }, |io| io.ldr)
    });
    add("fxaa", &[INPUT, OUTPUT], |host, call| {
        let (ldr, into) = (input(call, INPUT)?, call.target("output").0);
        made(host, call, &Fxaa { ldr, into, settings: framegraph_shaders::layout::FxaaUniforms::default() }, |io| {
            io.output
        })
    });
    add("structure", &[OUTPUT], |host, call| {
        let resolution = if params(call, false)? { Resolution::Full } else { Resolution::Half };
        let extent = resolution.of(Extent::FRAME);
        made(host, call, &Structure { view: ViewId::MAIN, extent, levels: 1 }, |structure| structure)
    });
    add("occlusion", &[STRUCTURE, OUTPUT], |host, call| {
        let structure = input(call, STRUCTURE)?;
        let (settings, precision) = (OcclusionSettings::default(), Precision::default());
        let pass = AmbientOcclusion { view: ViewId::MAIN, structure, settings, precision };
        made(host, call, &pass, |io| io.occlusion)
    });
    add("occlusion_blur", &[STRUCTURE, INPUT, OUTPUT], |host, call| {
        let (structure, occlusion) = (input(call, STRUCTURE)?, input(call, INPUT)?);
        let axis = if params(call, false)? { Axis::Down } else { Axis::Across };
        let blur = Blur::high(SaoQuality::Ultra.sigma());
        made(
            host,
            call,
            &OcclusionBlur { view: ViewId::MAIN, structure, occlusion, blur, axis, bent_normals: false },
            |io| io.blurred,
        )
    });
    add("velocity", &[DEPTH, OUTPUT], |host, call| {
        let depth = input(call, DEPTH)?;
        made(host, call, &Velocity { view: ViewId::MAIN, depth }, |io| io)
    });
    add("taa", &[INPUT, DEPTH, VELOCITY, OUTPUT], |host, call| {
        let (hdr, depth) = (input(call, INPUT)?, input(call, DEPTH)?);
        let (velocity, name) = (call.current(VELOCITY.name), call.name().to_owned());
        let into = host.graph().history(&name, TextureDesc::new(Extent::FRAME, SUM_FORMAT), 1);
        let earlier = host.graph().previous(into, 1)?;
        let pass = Taa { view: ViewId::MAIN, hdr, depth, velocity, earlier, into, settings: TaaSettings::default() };
        made(host, call, &pass, |io| io.sum)
    });
    add("scene_copy", &[INPUT, DEPTH, OUTPUT], |host, call| {
        let (hdr, depth) = (input(call, INPUT)?, input(call, DEPTH)?);
        made(host, call, &SceneCopy { view: ViewId::MAIN, hdr, depth, levels: params(call, 1)? }, |io| io.scene)
    });
    add("tone_resolve", &[INPUT, OUTPUT], |host, call| {
        let samples = input(call, INPUT)?;
        made(host, call, &ToneResolve { samples }, |io| io.hdr)
    });
    add("bloom_first", &[INPUT, OUTPUT], |host, call| {
        let (source, (size, levels)) = (input(call, INPUT)?, params(call, ([640, 360], 1))?);
        let pass = BloomFirst { source, size, levels, settings: BloomSettings::DEFAULT, sifts: true };
        made(host, call, &pass, |io| io.glow)
    });
    add("bloom_down", &[INPUT, OUTPUT], |host, call| {
        let (glow, level) = (input(call, INPUT)?, params(call, 1)?);
        made(host, call, &BloomDown { glow, level, odd: false }, |io| io.glow)
    });
    add("bloom_up", &[INPUT, SUM, OUTPUT], |host, call| {
        let (glow, (size, level, levels)) = (input(call, INPUT)?, params(call, ([640, 360], 0, 1))?);
        let (sum, narrow) = (call.current(SUM.name), BloomSettings::DEFAULT.narrow);
        made(host, call, &BloomUp { glow, sum, level, levels, size, narrow }, |io| io.sum)
    });
    add("upscale", &[INPUT, OUTPUT], |host, call| {
        let (picture, into) = (input(call, INPUT)?, call.target("output").0);
        let pass = Enlarge { picture, filter: UpscaleFilter::default(), extent: Extent::FRAME, into };
        made(host, call, &pass, |io| io.output)
    });
    add("sharpen", &[INPUT, OUTPUT], |host, call| {
        let (picture, into) = (input(call, INPUT)?, call.target("output").0);
        made(host, call, &Sharpen { picture, into, sharpness: params(call, 0.5)? }, |io| io.sharp)
    });
    registry
}

/// Returns the only parameter of a kind, or `otherwise` if the file omits it.
fn params<T: serde::de::DeserializeOwned>(call: &Call<'_>, otherwise: T) -> Result<T, PluginError> {
    if call.has_params() { Ok(call.params()?) } else { Ok(otherwise) }
}

/// Returns the texture bound to a required slot. These passes do not read earlier images of a history.
fn input(call: &Call<'_>, slot: PluginSlot) -> Result<Texture, PluginError> {
    call.current(slot.name).ok_or_else(|| PluginError::Custom {
        message: format!("its slot `{}` takes no image of an earlier frame", slot.name),
        hint: "copy the image, and bind the copy".into(),
    })
}

/// Declares the pass and provides its output.
fn made<H: Host + ?Sized, P: Pass>(
    host: &mut H,
    call: &mut Call<'_>,
    pass: &P,
    output: impl Fn(P::Io) -> Texture,
) -> Result<(), PluginError> {
    let io = host.graph().add(call.name(), pass)?;
    call.give(OUTPUT.name, output(io));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph::file::GraphFile;
    use framegraph::{Caps, Graph, Options, Plan, Scratch, compile};

    const FRAME: &str = r#"(
        version: 1,
        resources: [Texture(name: "screen", format: Rgba8UnormSrgb, kind: Import(entry: Undefined, exit: Keep))],
        passes: [
            Plugin(kind: "shadow", name: "shadow", slots: {"output": "map"}),
            Plugin(kind: "prepass", name: "prepass", slots: {"output": "depth"}),
            Plugin(kind: "structure", name: "structure", slots: {"output": "structure"}),
            Plugin(kind: "occlusion", name: "occlusion", slots: {"structure": "structure", "output": "ao"}),
            Plugin(kind: "occlusion_blur", name: "across",
                slots: {"structure": "structure", "input": "ao", "output": "ao_across"}),
            Plugin(kind: "velocity", name: "velocity", slots: {"depth": "depth", "output": "motion"}),
            Plugin(kind: "color", name: "color", slots: {"depth": "depth", "shadow": "map", "output": "hdr"}),
            Plugin(kind: "scene_copy", name: "copy", slots: {"input": "hdr", "depth": "depth", "output": "scene"}),
            Plugin(kind: "taa", name: "taa",
                slots: {"input": "hdr", "depth": "depth", "velocity": "motion", "output": "still"}),
            Plugin(kind: "bloom_first", name: "first", slots: {"input": "still", "output": "glow"}, params: ((320, 180), 2)),
            Plugin(kind: "bloom_down", name: "down", slots: {"input": "glow", "output": "glow_down"}, params: 1),
            Plugin(kind: "bloom_up", name: "up", slots: {"input": "glow_down", "output": "bloom"},
                params: ((320, 180), 0, 1)),
            Plugin(kind: "post", name: "post", slots: {"input": "still", "output": "ldr"}),
            Plugin(kind: "upscale", name: "upscale", slots: {"input": "ldr", "output": "large"}),
            Plugin(kind: "sharpen", name: "sharpen", slots: {"input": "large", "output": "screen"}, params: 0.25),
        ],
    )"#;

    #[test]
    fn every_kind_can_be_declared_by_a_file() -> Result<(), Box<dyn std::error::Error>> {
        let (mut graph, registry) = (Graph::new(), registry::<Graph>());
        GraphFile::parse("frame.ron", FRAME)?.declare(&[], &registry, &mut graph)?;
        // Both resolves and FXAA have tests of their own.
        let others = ["depth_resolve", "fxaa", "tone_resolve"];
        let unused: Vec<_> = registry.kinds().filter(|kind| !FRAME.contains(&format!("kind: \"{kind}\""))).collect();
        assert_eq!(unused, others);
        let (mut plan, options) = (Plan::new(), Options::for_frame(640, 360));
        compile(&graph, &Caps::wgpu(), &options, &mut Scratch::new(), &mut plan)?;
        let running: Vec<_> = plan.running().map(|member| graph.pass_name(member.pass)).collect();
        assert_eq!(running, ["shadow", "prepass", "velocity", "color", "taa", "post", "upscale", "sharpen"]);
        Ok(())
    }
}
