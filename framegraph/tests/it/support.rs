//! Helpers for declaring small graphs.

use framegraph::*;

pub const FRAME: [u32; 2] = [64, 32];

pub fn color(format: Format) -> TextureDesc {
    TextureDesc::new(Extent::FRAME, format)
}

pub fn hdr() -> TextureDesc {
    color(Format::Rgba16Float)
}

pub fn depth() -> TextureDesc {
    color(Format::Depth32Float)
}

pub const BLACK: Intent = Intent::Clear(ClearValue::BLACK);
pub const FAR: Intent = Intent::Clear(ClearValue::FAR_REVERSED);

/// wgpu with every format, raster passes without attachments, and small alignments, so that graphs can stay small.
pub fn wgpu() -> Caps {
    Caps {
        name: "wgpu".into(),
        empty_raster: true,
        uniform_alignment_bytes: 4,
        storage_alignment_bytes: 4,
        ..Caps::wgpu_native()
    }
}

pub fn options() -> Options {
    Options { frame: FRAME, ..Options::default() }
}

pub fn plan(graph: &Graph, caps: &Caps) -> Plan {
    plan_with(graph, caps, &options())
}

pub fn plan_with(graph: &Graph, caps: &Caps, options: &Options) -> Plan {
    let mut plan = Plan::new();
    if let Err(errors) = compile(graph, caps, options, &mut Scratch::new(), &mut plan) {
        panic!("{errors}");
    }
    plan
}

pub fn errors(graph: &Graph) -> Vec<CompileError> {
    let outcome = compile(graph, &wgpu(), &options(), &mut Scratch::new(), &mut Plan::new());
    outcome.expect_err("the graph compiles").listed
}

/// Adds a full-screen pass that samples `input` and writes a new texture.
pub fn filter(graph: &mut Graph, name: &str, input: Texture, format: Format) -> Texture {
    graph
        .add_fn(name, |p| {
            p.sampled(input)?;
            let out = p.texture(&format!("{name}_out"), color(format));
            p.color(out, Intent::Overwrite)
        })
        .expect("a filter pass is valid")
}

/// Imports a texture with `Exit::Keep`, like a swapchain image.
pub fn screen(graph: &mut Graph) -> Texture {
    graph.import_texture("screen", color(Format::Rgba8UnormSrgb), Entry::Undefined, Exit::Keep)
}

pub fn ops(plan: &Plan, resource: &str) -> Vec<(LoadOp, StoreOp)> {
    let id = plan.graph().find_resource(resource).expect("the resource was declared");
    plan.attachments().iter().filter(|a| a.resource == id).map(|a| (a.load, a.store)).collect()
}

pub fn placement(plan: &Plan, resource: &str) -> Placement {
    let id = plan.graph().find_resource(resource).expect("the resource was declared");
    plan.resources()[id.index()].placement
}

pub fn steps(plan: &Plan) -> Vec<Vec<&str>> {
    let names = |s| plan.passes_of(s).iter().map(|m| plan.graph().pass_name(m.pass)).collect();
    plan.step_ids().map(names).collect()
}

pub fn split_reason(plan: &Plan, pass: &str) -> Option<Refusal> {
    let id = plan.graph().find_pass(pass).expect("the pass was declared");
    plan.reasons(Subject::Pass(id)).find_map(|r| match r {
        Reason::Split(_, why) => Some(why),
        _ => None,
    })
}

/// Returns the name of the pass or resource of an error; empty if there is none.
pub fn name<I>(named: &Option<Named<I>>) -> &str {
    named.as_ref().map_or("", |n| &n.name)
}
