//! Standard passes by name, for graph files. Plugins declare the passes, without recorders.
//!
//! In a file: `Plugin(kind: "fxaa", name: "fxaa", slots: {"input": "ldr", "output": "screen"})`. The program `plan`
//! reads graph files.

use crate::effects::color::Color;
use crate::effects::depth::prepass::Prepass;
use crate::effects::depth::resolve::{DepthOf, DepthResolve};
use crate::effects::fxaa::Fxaa;
use crate::effects::post::Post;
use crate::effects::shadow::{Shadow, ShadowLayer, maps_desc};
use crate::gpu_scene::shadow_views::{ShadowMaps, ShadowSettings};
use crate::gpu_scene::view::ViewId;
use framegraph::file::{Call, Host, Plugin, PluginError, PluginSlot, Registry, SlotType};
use framegraph::{Pass, Texture};

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
const SHADOW: PluginSlot = PluginSlot::optional("shadow", SlotType::Texture);
const INPUT: PluginSlot = PluginSlot::required("input", SlotType::Texture);
const OUTPUT: PluginSlot = PluginSlot::required("output", SlotType::Target);

/// The standard passes: `shadow`, `prepass`, `color`, `depth_resolve`, `post` and `fxaa`.
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
