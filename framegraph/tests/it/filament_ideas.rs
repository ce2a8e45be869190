//! The sixteen tests of Filament's frame graph, written for this library. `docs/design/filament-frame-graph.md` describes
//! each; names are those of `filament_framegraph_test.cpp`.

use crate::support::*;
use framegraph::*;
use framegraph_check::check;

fn sized(width: u32, height: u32) -> TextureDesc {
    TextureDesc::new(Extent::absolute(width, height), Format::Rgba8Unorm)
}

fn checked(graph: &Graph) -> Plan {
    let plan = plan(graph, &wgpu());
    assert_eq!(check(&plan), Ok(()));
    plan
}

fn culled(plan: &Plan) -> Vec<&str> {
    let graph = plan.graph();
    graph.pass_ids().filter(|p| plan.is_culled(*p)).map(|p| graph.pass_name(p)).collect()
}

fn usage(plan: &Plan, name: &str) -> Usage {
    plan.resources()[plan.graph().find_resource(name).unwrap().index()].usage
}

fn draw(g: &mut Graph, name: &str, desc: TextureDesc) -> Texture {
    g.add_fn(name, |p| {
        let out = p.texture(&format!("{name} out"), desc);
        p.color(out, Intent::Overwrite)
    })
    .unwrap()
}

fn look(g: &mut Graph, name: &str, input: impl Into<ReadOnly>, desc: TextureDesc) -> Texture {
    let input = input.into();
    g.add_fn(name, |p| {
        p.sampled(input)?;
        let out = p.texture(&format!("{name} out"), desc);
        p.color(out, Intent::Overwrite)
    })
    .unwrap()
}

/// `Simple`: a chain with an exported end is kept.
#[test]
fn graph_simple() {
    let mut g = Graph::new();
    let a = draw(&mut g, "a", sized(8, 8));
    let b = look(&mut g, "b", a, sized(8, 8));
    g.export(b).unwrap();
    assert!(culled(&checked(&g)).is_empty());
}

/// `Culling1`: an unused branch is culled, including everything that only it needs.
#[test]
fn graph_culling_1() {
    let mut g = Graph::new();
    let a = draw(&mut g, "a", sized(8, 8));
    let b = look(&mut g, "b", a, sized(8, 8));
    let c = look(&mut g, "c", a, sized(8, 8));
    let _ = look(&mut g, "d", c, sized(8, 8));
    g.export(b).unwrap();
    assert_eq!(culled(&checked(&g)), ["c", "d"]);
}

/// `Culling2`: nothing is exported, so nothing runs, and the plan contains a warning.
#[test]
fn graph_culling_2() {
    let mut g = Graph::new();
    let a = draw(&mut g, "a", sized(8, 8));
    let _ = look(&mut g, "b", a, sized(8, 8));
    let plan = checked(&g);
    assert_eq!(culled(&plan), ["a", "b"]);
    assert_eq!(plan.warnings().next(), Some(Warning::NothingRuns));
}

/// `ReadRead`: one pass reads a texture in two ways, and the texture gets both usages.
#[test]
fn read_read() {
    let mut g = Graph::new();
    let a = draw(&mut g, "a", sized(16, 32));
    g.add_fn("b", |p| {
        p.side_effect();
        p.sampled(a)?;
        p.storage_read(a)
    })
    .unwrap();
    assert_eq!(usage(&checked(&g), "a out"), Usage::ATTACHMENT.union(Usage::SAMPLED).union(Usage::STORAGE));
}

/// `WriteWrite`: in Filament one pass may upload and draw. Here these are two passes, and the texture gets both usages.
#[test]
fn write_write() {
    let mut g = Graph::new();
    let a = g.texture("a", sized(16, 32));
    let both = g.add_fn("both", |p| {
        p.copy_target(a, Intent::Overwrite)?;
        p.color(a, Intent::Modify)
    });
    assert!(matches!(both.unwrap_err().reason, DeclareReason::Conflict { .. } | DeclareReason::Stale { .. }));
    let a = g.add_fn("upload", |p| p.copy_target(a, Intent::Overwrite)).unwrap();
    let a = g.add_fn("draw", |p| p.color(a, Intent::Modify)).unwrap();
    g.export(a).unwrap();
    let plan = checked(&g);
    assert!(culled(&plan).is_empty());
    assert_eq!(usage(&plan, "a"), Usage::ATTACHMENT.union(Usage::COPY_TARGET));
}

/// `WriteRead`: a pass cannot read its own output.
#[test]
fn write_read() {
    let mut g = Graph::new();
    let a = g.texture("a", sized(16, 32));
    let refused = g.add_fn("p", |p| {
        let a = p.color(a, Intent::Overwrite)?;
        p.sampled(a)
    });
    assert!(matches!(refused.unwrap_err().reason, DeclareReason::Conflict { .. }));
    assert!(g.passes().is_empty(), "a rejected pass leaves no trace");
}

/// `ReadWrite`: in Filament a read before a write means that previous contents are used. Here the intent says so, and
/// reading unwritten contents is an error.
#[test]
fn read_write() {
    let mut g = Graph::new();
    let imported = g.import_texture("imported", sized(640, 400), Entry::Defined, Exit::Keep);
    g.add_fn("p", |p| p.color(imported, Intent::Modify)).unwrap();
    let plan = checked(&g);
    assert_eq!(ops(&plan, "imported"), [(LoadOp::Load, StoreOp::Store)]);
    let fresh = g.texture("fresh", sized(16, 32));
    let fresh = g.add_fn("q", |p| p.color(fresh, Intent::Modify)).unwrap();
    g.export(fresh).unwrap();
    assert!(matches!(errors(&g)[0].reason, CompileReason::ReadUnwritten { .. }));
}

/// `Culling1` of the frame graph: an unused output exists as long as its pass runs.
#[test]
fn an_unread_output_of_a_kept_pass_exists() {
    let mut g = Graph::new();
    let (out, _) = g
        .add_fn("p", |p| {
            let (a, b) = (p.texture("out0", sized(16, 32)), p.texture("out1", sized(16, 32)));
            Ok((p.color(a, Intent::Overwrite)?, p.color(b, Intent::Overwrite)?))
        })
        .unwrap();
    g.export(out).unwrap();
    let plan = checked(&g);
    assert_eq!(ops(&plan, "out1"), [(LoadOp::DontCare, StoreOp::Discard)]);
    assert_eq!(usage(&plan, "out1"), Usage::ATTACHMENT);
}

/// `Basic`: depth, G-buffer, lighting, a debug pass that is culled, post-processing.
#[test]
fn basic() {
    let mut g = Graph::new();
    let depth = TextureDesc::new(Extent::absolute(16, 32), Format::Depth32Float);
    let depth = g.add_fn("depth", |p| {
        let depth = p.texture("depth", depth);
        p.depth(depth, FAR)
    });
    let depth = depth.unwrap();
    let (depth, gbuffer) = g
        .add_fn("gbuffer", |p| {
            let depth = p.depth(depth, Intent::Modify)?;
            let mut made = Vec::new();
            for name in ["gbuf1", "gbuf2", "gbuf3"] {
                let texture = p.texture(name, sized(16, 32));
                made.push(p.color(texture, Intent::Overwrite)?);
            }
            Ok((depth, made))
        })
        .unwrap();
    let lighting = g.add_fn("lighting", |p| {
        p.sampled(depth)?;
        p.sampled(gbuffer[1])?;
        p.sampled(gbuffer[2])?;
        let out = p.texture("lighting", sized(16, 32));
        p.color(out, Intent::Overwrite)
    });
    let lighting = lighting.unwrap();
    let _ = look(&mut g, "debug", gbuffer[0], sized(16, 32));
    let back = look(&mut g, "post", lighting, sized(16, 32));
    g.export(back).unwrap();
    let plan = checked(&g);
    assert_eq!(culled(&plan), ["debug"]);
    // Filament's flags: depth starts discarded and is kept; the first G-buffer texture is discarded at the end.
    assert_eq!(ops(&plan, "gbuf1"), [(LoadOp::DontCare, StoreOp::Discard)]);
    assert_eq!(ops(&plan, "gbuf2"), [(LoadOp::DontCare, StoreOp::Store)]);
    // Depth and G-buffer share one step here, so depth is cleared, not loaded, and stored once.
    assert_eq!(ops(&plan, "depth"), [(LoadOp::Clear, StoreOp::Store)]);
}

/// `ImportResource`: imports have the declared size and keep the pass that writes them.
#[test]
fn import_resource() {
    let mut g = Graph::new();
    let output = g.import_texture("output", sized(320, 200), Entry::Undefined, Exit::Keep);
    let input = g.import_texture("input", sized(640, 400), Entry::Defined, Exit::Discard);
    assert_eq!(g.desc(output), Some(sized(320, 200)));
    g.add_fn("p", |p| {
        p.sampled(input)?;
        p.color(output, Intent::Overwrite)
    })
    .unwrap();
    let plan = checked(&g);
    assert!(culled(&plan).is_empty() && plan.resources().iter().all(|r| r.placement == Placement::External));
}

/// `ForwardResource`: the output of one pass becomes the texture that another pass reads, with the size of that
/// texture.
#[test]
fn forward_resource() {
    let mut g = Graph::new();
    let input = g.texture("debug input", sized(32, 64));
    let lighting = draw(&mut g, "lighting", sized(640, 400));
    let output = look(&mut g, "debug", input, sized(640, 400));
    g.export(output).unwrap();
    let input = g.forward(lighting, input).unwrap();
    let plan = checked(&g);
    assert!(culled(&plan).is_empty());
    assert_eq!(usage(&plan, "debug input"), Usage::ATTACHMENT.union(Usage::SAMPLED));
    assert_eq!(plan.steps()[0].extent, [32, 64]);
    assert_eq!(plan.resources()[g.find_resource("lighting out").unwrap().index()].placement, Placement::Unused);
    assert!(dump::text(&plan).contains("resource `lighting out`: forwarded to `debug input`"));
    // The handle refers to the target afterwards.
    assert_eq!(g.resource_of(lighting), g.find_resource("debug input"));
    g.add_fn("again", |p| p.color(input, Intent::Modify)).unwrap();
}

/// `ForwardImportedResource`: the last pass draws into the swapchain image.
#[test]
fn forward_imported_resource() {
    let mut g = Graph::new();
    let screen = g.import_texture("screen", sized(320, 200), Entry::Undefined, Exit::Keep);
    let lighting = draw(&mut g, "lighting", sized(32, 32));
    g.forward(lighting, screen).unwrap();
    let plan = checked(&g);
    assert!(culled(&plan).is_empty());
    assert_eq!((plan.steps()[0].extent, usage(&plan, "screen")), ([320, 200], Usage::ATTACHMENT));
    assert_eq!(ops(&plan, "screen"), [(LoadOp::DontCare, StoreOp::Store)]);
}

/// `SubResourcesWrite`: one pass per level, because a pass of this library has one set of attachments.
#[test]
fn sub_resources_write() {
    let mut g = Graph::new();
    let mut chain = g.texture("chain", sized(16, 32).mips(4));
    for mip in 0..4 {
        let level = chain.mip(mip);
        chain = g.add_fn(&format!("level {mip}"), |p| p.color(level, Intent::Overwrite)).unwrap();
    }
    let debug = look(&mut g, "debug", chain.mip(0), sized(16, 32));
    g.export(debug).unwrap();
    g.export(chain).unwrap();
    let plan = checked(&g);
    assert_eq!(plan.steps().len(), 5);
    let extents: Vec<_> = plan.steps()[..4].iter().map(|s| s.extent).collect();
    assert_eq!(extents, [[16, 32], [8, 16], [4, 8], [2, 4]]);
    assert_eq!(ops(&plan, "chain"), [(LoadOp::DontCare, StoreOp::Store); 4]);
}

/// `SubResourcesRead`: one pass fills all levels, another reads them one by one.
#[test]
fn sub_resources_read() {
    let mut g = Graph::new();
    let chain = g.texture("chain", sized(16, 32).mips(4));
    let chain = g.add_fn("upload", |p| p.copy_target(chain, Intent::Overwrite)).unwrap();
    let out = g.add_fn("blit", |p| {
        for mip in 0..4 {
            p.sampled(chain.mip(mip))?;
        }
        let out = p.texture("out", sized(16, 32));
        p.color(out, Intent::Overwrite)
    });
    g.export(out.unwrap()).unwrap();
    assert!(culled(&checked(&g)).is_empty());
}

/// `SubResourcesWriteRead`: each level is computed from the previous one, as in bloom.
#[test]
fn sub_resources_write_read() {
    let mut g = Graph::new();
    let chain = g.texture("chain", sized(16, 32).mips(4));
    let top = draw(&mut g, "top", sized(16, 32));
    // The scene's texture becomes level 0: `forwardResource` to a subresource.
    let mut chain = g.forward(top, chain.mip(0)).unwrap();
    for mip in 1..4 {
        let (source, level) = (chain.mip(mip - 1), chain.mip(mip));
        chain = g
            .add_fn(&format!("down {mip}"), |p| {
                p.sampled(source)?;
                p.color(level, Intent::Overwrite)
            })
            .unwrap();
    }
    let out = look(&mut g, "composite", chain, sized(16, 32));
    g.export(out).unwrap();
    let plan = checked(&g);
    assert!(culled(&plan).is_empty());
    assert_eq!(ops(&plan, "chain"), [(LoadOp::DontCare, StoreOp::Store); 4]);
}

/// `BadGraph`: two writers of one version are not possible, because the first makes the handle stale.
#[test]
fn bad_graph() {
    let mut g = Graph::new();
    let r0 = draw(&mut g, "R0", sized(8, 8));
    let r1 = g.add_fn("R1", |p| p.color(r0, Intent::Modify)).unwrap();
    let refused = g.add_fn("R2", |p| p.color(r0, Intent::Modify)).unwrap_err();
    assert_eq!(refused.reason, DeclareReason::Stale { writer: "R1".into(), user: StaleUser::OtherPass });
    g.export(r1).unwrap();
    assert!(culled(&checked(&g)).is_empty());
}

#[test]
fn what_cannot_be_forwarded_is_refused_and_stays() {
    let mut g = Graph::new();
    let (screen, other) = (screen(&mut g), g.texture("other", color(Format::Rgba8UnormSrgb)));
    let fault = |g: &mut Graph, from, into: Part| match g.forward(from, into).unwrap_err().reason {
        DeclareReason::Forward(fault) => fault,
        reason => panic!("{reason:?}"),
    };
    assert_eq!(fault(&mut g, screen, other.into()), ForwardReason::NotTransient);
    assert_eq!(fault(&mut g, other, screen.into()), ForwardReason::Unwritten);
    let drawn = draw(&mut g, "draw", color(Format::Rgba8UnormSrgb));
    assert_eq!(fault(&mut g, drawn, drawn.into()), ForwardReason::NotTransient);
    let later = g.texture("later", color(Format::Rgba8UnormSrgb));
    assert_eq!(fault(&mut g, drawn, later.into()), ForwardReason::TargetLater);
    assert_eq!(fault(&mut g, drawn, screen.mip(1)), ForwardReason::Parts);
    let chain = g.texture("chain", color(Format::Rgba8UnormSrgb).mips(2));
    let into_chain = draw(&mut g, "second", color(Format::Rgba8UnormSrgb));
    assert_eq!(fault(&mut g, into_chain, chain.into()), ForwardReason::Parts);
    // Only one of several slices would be drawn, but all would count as cleared.
    let volume = |layers| TextureDesc { dimension: Dimension::D3, ..sized(8, 8) }.layers(layers);
    let (deep, flat) = (g.texture("deep", volume(4).mips(3)), g.texture("flat", volume(1)));
    let slice = draw(&mut g, "slice", volume(1));
    assert_eq!(fault(&mut g, slice, deep.mip(0)), ForwardReason::Slices);
    assert_eq!(fault(&mut g, slice, deep.mip(1)), ForwardReason::Slices);
    let slice = g.forward(slice, deep.mip(2)).unwrap();
    let last = g.accesses().last().unwrap();
    assert_eq!((last.resource, last.range.mip), (g.find_resource("deep").unwrap(), 2));
    let _ = (slice, flat);
    let stored = g.texture("stored", hdr());
    let stored = g.add_fn("store", |p| p.storage_write(stored, Intent::Overwrite)).unwrap();
    let srgb = ForwardReason::Format { format: Format::Rgba8UnormSrgb, access: AccessKind::StorageWrite };
    assert_eq!(fault(&mut g, stored, screen.into()), srgb);
    // A use in between: a pass that draws on the screen while the image is computed would be overwritten.
    let screen = g.add_fn("between", |p| p.color(screen, BLACK)).unwrap();
    let drawn = g.add_fn("on", |p| p.color(drawn, Intent::Modify)).unwrap();
    assert!(matches!(fault(&mut g, drawn, screen.into()), ForwardReason::TargetLater | ForwardReason::Interleaved));
    assert!(g.forward_of(g.find_resource("draw out").unwrap()).is_none());
    // The forwarded texture has no valid handle.
    let mut g = Graph::new();
    let screen = self::screen(&mut g);
    let entry = g.texture("a", color(Format::Rgba8UnormSrgb));
    let drawn = g.add_fn("draw", |p| p.color(entry, BLACK)).unwrap();
    g.forward(drawn, screen).unwrap();
    assert!(matches!(g.add_fn("p", |p| p.sampled(entry)).unwrap_err().reason, DeclareReason::Stale { .. }));
    assert!(matches!(g.export(entry).unwrap_err().reason, DeclareReason::Stale { .. }));
}
