//! Truncated graphs: what they keep, and that their plans are valid.

use framegraph::{
    Caps, ClearValue, DeclareError, Entry, Exit, Extent, Format, Graph, Intent, Options, Placement, Plan, Scratch,
    TextureDesc, compile, dump,
};
use framegraph_check::check;

const CLEAR: Intent = Intent::Clear(ClearValue::BLACK);

/// A frame with memoryless depth, an `hdr` texture that is inlined, and an overlay drawn over the result.
fn frame() -> Result<Graph, DeclareError> {
    let mut graph = Graph::new();
    let desc = |format| TextureDesc::new(Extent::FRAME, format);
    let screen = graph.import_texture("screen", desc(Format::Rgba8UnormSrgb), Entry::Undefined, Exit::Keep);
    let hdr = graph.add_fn("scene", |p| {
        let depth = p.texture("depth", desc(Format::Depth32Float));
        p.depth(depth, Intent::Clear(ClearValue::FAR_REVERSED))?;
        p.takes_epilogue();
        let hdr = p.texture("hdr", desc(Format::Rgba16Float));
        p.color(hdr, CLEAR)
    })?;
    let screen = graph.add_fn("grade", |p| {
        p.pointwise();
        p.same_pixel(hdr)?;
        p.color(screen, Intent::Overwrite)
    })?;
    let late = graph.texture("late", desc(Format::R8Unorm));
    graph.add_fn("late", |p| p.color(late, CLEAR))?;
    graph.add_fn("overlay", |p| {
        p.side_effect();
        p.color(screen, Intent::Modify)
    })?;
    Ok(graph)
}

fn planned(graph: &Graph) -> Plan {
    let mut plan = Plan::new();
    let compiled = compile(graph, &Caps::wgpu(), &Options::for_frame(64, 32), &mut Scratch::new(), &mut plan);
    assert_eq!(compiled, Ok(()));
    plan
}

/// Cuts the graph at the `nth` version of a resource, reads that version, and returns its placement.
fn looked_at(graph: &Graph, name: &str, nth: usize) -> Result<(Plan, Placement), Box<dyn std::error::Error>> {
    let resource = graph.find_resource(name).ok_or("no resource")?;
    let version = graph.versions_of(resource).nth(nth).ok_or("no version")?;
    let (mut cut, shown) = graph.ending_with(version).ok_or("undefined contents")?;
    let out = cut.texture("out", TextureDesc::new(Extent::FRAME, Format::Rgba32Uint));
    let out = cut.add_fn("look", |p| {
        p.sampled(shown)?;
        p.color(out, Intent::Overwrite)
    })?;
    cut.readback(out)?;
    let plan = planned(&cut);
    assert_eq!(check(&plan), Ok(()));
    let placement = plan.resources()[resource.index()].placement;
    Ok((plan, placement))
}

#[test]
fn what_the_frame_does_without_is_there_to_look_at() -> Result<(), Box<dyn std::error::Error>> {
    let graph = frame()?;
    let under_study = planned(&graph);
    let text = dump::text(&under_study);
    let placed = |name| graph.find_resource(name).map(|r| under_study.resources()[r.index()].placement);
    assert_eq!(
        (placed("depth"), placed("hdr")),
        (Some(Placement::Memoryless), Some(Placement::Inlined)),
        "the original plan must not allocate them"
    );
    for (name, nth, passes) in [("depth", 1, 2), ("hdr", 1, 2), ("screen", 1, 3), ("late", 1, 2), ("screen", 2, 4)] {
        let (plan, placement) = looked_at(&graph, name, nth)?;
        assert!(matches!(placement, Placement::Slot(_)), "{name} {nth}: {placement:?}");
        assert_eq!(plan.counts().passes, passes, "{name} {nth}: only the required passes run");
    }
    assert_eq!(dump::text(&planned(&graph)), text);
    Ok(())
}

#[test]
fn handles_of_passes_that_stay_work_on() -> Result<(), Box<dyn std::error::Error>> {
    let mut graph = Graph::new();
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
    let first = graph.texture("a", desc);
    let first = graph.add_fn("first", |p| p.color(first, CLEAR))?;
    let b = graph.texture("b", desc);
    let (view, second) = graph.add_fn("second", |p| Ok((p.sampled(first)?, p.color(b, CLEAR)?)))?;
    let third = graph.add_fn("third", |p| p.color(second, Intent::Modify))?;
    let b = graph.resource_of(b).ok_or("no resource")?;
    let versions: Vec<_> = graph.versions_of(b).collect();
    assert_eq!(versions.len(), 3);
    assert!(graph.ending_with(versions[0]).is_none(), "the contents are undefined");
    let (cut, _) = graph.ending_with(versions[1]).ok_or("defined contents")?;
    assert_eq!(cut.passes().len(), 2);
    assert_eq!(cut.access_of(view), graph.access_of(view));
    assert_eq!(cut.writer_of(second), graph.writer_of(second));
    assert_eq!((cut.writer_of(third), cut.resources()[b.index()].current), (None, versions[1]));
    Ok(())
}

/// A write to an import that is not kept is valid if a later pass reads it. Truncation removes that reader.
#[test]
fn a_read_that_is_gone_leaves_no_write_without_a_reader() -> Result<(), Box<dyn std::error::Error>> {
    let mut graph = Graph::new();
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
    let lent = graph.import_texture("lent", desc, Entry::Defined, Exit::Discard);
    let drawn = graph.texture("drawn", desc);
    let (lent, _) = graph.add_fn("both", |p| Ok((p.color(lent, CLEAR)?, p.color(drawn, CLEAR)?)))?;
    let out = graph.texture("result", desc);
    let out = graph.add_fn("read", |p| {
        p.sampled(lent)?;
        p.color(out, CLEAR)
    })?;
    graph.export(out)?;
    planned(&graph);
    looked_at(&graph, "drawn", 1)?;
    Ok(())
}

#[test]
fn contents_on_entry_are_seen_without_any_pass() -> Result<(), Box<dyn std::error::Error>> {
    let mut graph = Graph::new();
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
    let mine = graph.import_texture("mine", desc, Entry::Defined, Exit::Keep);
    graph.add_fn("over", |p| p.color(mine, Intent::Modify))?;
    let history = graph.history("taa", desc, 1);
    let earlier = graph.previous(history, 1)?;
    graph.add_fn("taa", |p| {
        p.sampled(earlier)?;
        p.color(history, Intent::Overwrite)
    })?;
    for name in ["mine", "taa@-1"] {
        let (plan, _) = looked_at(&graph, name, 0)?;
        let passes = if name == "mine" { 1 } else { 2 };
        assert_eq!(plan.counts().passes, passes, "{name}: the write of the import is kept");
    }
    Ok(())
}
