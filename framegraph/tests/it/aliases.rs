//! Imports that may be bound to one texture: a write of one may change the other.

use framegraph::*;
use framegraph_check::check;

/// When the imports are declared as aliases.
#[derive(PartialEq)]
enum Alias {
    Never,
    First,
    Last,
}

/// Returns a graph that draws into `a` twice and reads `b` in between.
fn graph(alias: Alias) -> Graph {
    let mut g = Graph::new();
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
    let [a, b, screen] = ["a", "b", "screen"].map(|name| g.import_texture(name, desc, Entry::Defined, Exit::Keep));
    if alias == Alias::First {
        g.may_alias(a, b).unwrap();
    }
    let drawn = g.add_fn("write", |p| p.color(a, Intent::Clear(ClearValue::BLACK))).unwrap();
    let screen = g
        .add_fn("read", |p| {
            p.sampled(b)?;
            p.color(screen, Intent::Overwrite)
        })
        .unwrap();
    g.add_fn("overwrite", |p| p.color(drawn, Intent::Overwrite)).unwrap();
    g.add_fn("more", |p| p.color(screen, Intent::Modify)).unwrap();
    if alias == Alias::Last {
        g.may_alias(a, b).unwrap();
    }
    g
}

fn compiled(graph: &Graph) -> Plan {
    let (mut plan, options) = (Plan::new(), Options { order: Order::Optimized, ..Options::for_frame(8, 8) });
    compile(graph, &Caps::wgpu(), &options, &mut Scratch::new(), &mut plan).unwrap();
    let report = check::examine(&plan);
    assert!(report.is_clean(), "{report}");
    plan
}

fn order(plan: &Plan) -> Vec<&str> {
    plan.step_passes().iter().map(|m| plan.graph().pass_name(m.pass)).collect()
}

#[test]
fn a_write_of_an_alias_precedes_reads_of_the_other() {
    let plan = compiled(&graph(Alias::First));
    assert_eq!(order(&plan), ["write", "read", "overwrite", "more"]);
    assert_eq!((plan.steps().len(), plan.attachments()[0].store), (4, StoreOp::Store));
    // Without the declaration the first write has no effect, and `more` joins `read`.
    let plan = compiled(&graph(Alias::Never));
    assert_eq!(order(&plan), ["read", "more", "overwrite"]);
}

#[test]
fn a_declaration_after_the_passes_has_the_same_effect() {
    assert!(graph(Alias::Last).same_as(&graph(Alias::First)));
}

#[test]
fn forwarding_into_an_alias_orders_the_passes_too() {
    let mut g = Graph::new();
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
    let [a, b] = ["a", "b"].map(|name| g.import_texture(name, desc, Entry::Defined, Exit::Keep));
    g.may_alias(a, b).unwrap();
    let own = g.texture("own", desc);
    let own = g.add_fn("draw", |p| p.color(own, Intent::Overwrite)).unwrap();
    let flag = |g: &Graph| g.passes()[0].flags.has(PassFlags::SIDE_EFFECT);
    assert!(!flag(&g));
    g.forward(own, a).unwrap();
    assert!(flag(&g));
    compiled(&g);
}

#[test]
fn aliases_are_two_kept_imports() {
    let mut g = graph(Alias::First);
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
    let (c, own) = (g.import_texture("c", desc, Entry::Undefined, Exit::Keep), g.texture("own", desc));
    let dropped = g.import_texture("dropped", desc, Entry::Defined, Exit::Discard);
    for (a, b) in [(c, c), (c, own), (dropped, c)] {
        let refused = g.may_alias(a, b).unwrap_err().to_string();
        assert!(refused.contains("`may_alias` needs two different imports that are kept"), "{refused}");
    }
    let [a, b, c] = ["a", "b", "c"].map(|name| g.find_resource(name).unwrap());
    assert!(g.are_aliases(b, a) && !g.are_aliases(a, c) && g.has_alias(b) && !g.has_alias(c));
}

#[test]
fn a_device_with_layouts_refuses_aliases() {
    let (caps, options, mut plan) = (Caps::desktop(), Options::for_frame(8, 8), Plan::new());
    let refused =
        compile(&graph(Alias::First), &caps, &options, &mut Scratch::new(), &mut plan).unwrap_err().to_string();
    assert!(refused.contains("resource `a`: two imports may alias"), "{refused}");
    assert!(compile(&graph(Alias::Never), &caps, &options, &mut Scratch::new(), &mut plan).is_ok());
}
