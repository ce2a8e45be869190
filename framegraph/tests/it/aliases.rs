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
    assert!(refused.contains("resource `a`: two imported textures may alias"), "{refused}");
    assert!(compile(&graph(Alias::Never), &caps, &options, &mut Scratch::new(), &mut plan).is_ok());
}

/// Returns a graph that writes the buffer `a` in compute, and reads `b` in two steps.
/// Aliases of a graph have no effect on the next one that is compiled with the same [`Scratch`].
#[test]
fn aliases_are_forgotten_with_their_graph() {
    let caps = Caps { explicit_barriers: true, ..Caps::desktop() };
    let compiled = |scratch: &mut Scratch, alias: bool| {
        let mut plan = Plan::new();
        compile(&buffers(alias), &caps, &Options::for_frame(8, 8), scratch, &mut plan).unwrap();
        plan.barriers().to_vec()
    };
    let mut used = Scratch::new();
    assert_ne!(compiled(&mut used, true), compiled(&mut Scratch::new(), false), "aliases add barriers");
    assert_eq!(compiled(&mut used, false), compiled(&mut Scratch::new(), false));
}

fn buffers(alias: bool) -> Graph {
    let mut g = Graph::new();
    let [a, b, c] = ["a", "b", "c"].map(|name| g.import_buffer(name, 64, Entry::Defined, Exit::Keep));
    if alias {
        g.may_alias_buffer(a, b).unwrap();
    }
    let a = g.add_fn("write", |p| p.storage_write_buffer(a, Intent::Overwrite)).unwrap();
    let c = g
        .add_fn("read", |p| {
            p.uniform(b)?;
            p.storage_write_buffer(c, Intent::Overwrite)
        })
        .unwrap();
    let a = g
        .add_fn("copy", |p| {
            p.copy_source_buffer(c)?;
            p.copy_target_buffer(a, Intent::Overwrite)
        })
        .unwrap();
    g.add_fn("again", |p| {
        p.uniform(b)?;
        p.storage_write_buffer(a, Intent::Modify)
    })
    .unwrap();
    g
}

/// A barrier of a buffer waits for uses of the buffers that may alias it.
#[test]
fn barriers_wait_for_aliases() {
    let (mut plan, options) = (Plan::new(), Options::for_frame(8, 8));
    for (alias, expected) in [(false, [None, None]), (true, [Some(0), Some(2)])] {
        compile(&buffers(alias), &Caps::desktop(), &options, &mut Scratch::new(), &mut plan).unwrap();
        let report = check::examine(&plan);
        assert!(report.is_clean(), "{report}");
        let b = plan.graph().find_resource("b").unwrap();
        let of = |step| plan.barriers().iter().find(|x| x.resource == b && x.before.index() == step);
        let after = |step| of(step).and_then(|x| x.after.some()).map(|s| s.index());
        // The first write of `a` is overwritten: without aliases no pass needs it.
        assert_eq!((plan.counts().culled, order(&plan)[0]), if alias { (0, "write") } else { (1, "read") });
        assert_eq!(if alias { [after(1), after(3)] } else { [after(0), after(2)] }, expected);
        assert!(!alias || of(3).unwrap().from_stages.contains(Stages::COPY), "{:?}", plan.barriers());
    }
    // The barrier of `a` waits for the read of `b`, which the write of `a` must not overtake.
    let a = plan.graph().find_resource("a").unwrap();
    let copy = plan.barriers().iter().find(|x| x.resource == a && x.before.index() == 2).unwrap();
    assert_eq!((copy.after.index(), copy.from_stages), (1, Stages::COMPUTE));
}

/// The checker finds barriers that do not wait for an alias.
#[test]
fn a_barrier_that_forgets_an_alias_is_reported() {
    let (mut plan, options) = (Plan::new(), Options::for_frame(8, 8));
    compile(&buffers(true), &Caps::desktop(), &options, &mut Scratch::new(), &mut plan).unwrap();
    let b = plan.graph().find_resource("b").unwrap();
    let row = plan.barriers().iter().position(|x| x.resource == b && x.before.index() == 3).unwrap();
    let mut broken = plan.clone();
    internals::arrays(&mut broken).barriers[row].from_stages = Stages::NONE;
    assert!(!check::examine(&broken).is_clean());
    internals::arrays(&mut plan).barriers.remove(row);
    assert!(!check::examine(&plan).is_clean());
}

/// Files hold the pairs, and only the flags that passes declare.
#[cfg(feature = "files")]
#[test]
fn aliases_survive_a_file() {
    use framegraph::file::{GraphFile, Registry, to_ron};
    for g in [graph(Alias::First), buffers(true)] {
        let text = to_ron(&g, "aliases", [8, 8]);
        assert!(text.contains("MayAlias(of: \"a\", with: \"b\")") && !text.contains("flags"), "{text}");
        let mut read = Graph::new();
        GraphFile::parse("a.ron", &text).unwrap().declare(&[], &Registry::new(), &mut read).unwrap();
        assert!(read.same_as(&g), "{}", to_ron(&read, "aliases", [8, 8]));
    }
    let mut g = graph(Alias::First);
    let a = g.find_resource("a").unwrap();
    g.add_fn("effect", |p| {
        p.side_effect();
        let b = p.texture("own", TextureDesc::new(Extent::FRAME, Format::R8Unorm));
        p.color(b, Intent::Overwrite)
    })
    .unwrap();
    assert_eq!(g.aliases_of(a).count(), 1);
    assert_eq!(to_ron(&g, "", [0, 0]).matches("flags: [SideEffect]").count(), 1);
    let text = "(version: 1, resources: [MayAlias(of: \"a\", with: \"b\"),
        Buffer(name: \"a\", bytes: 4, kind: Import(entry: Defined, exit: Keep)),
        Texture(name: \"b\", format: R8Unorm, kind: Import(entry: Defined, exit: Keep))])";
    let refused = |text: &str| {
        let parsed = GraphFile::parse("a.ron", text).unwrap();
        parsed.declare(&[], &Registry::new(), &mut Graph::new()).unwrap_err().to_string()
    };
    assert!(refused(text).contains("an import is listed later; list `MayAlias` after both imports"));
    let below =
        text.replacen("MayAlias(of: \"a\", with: \"b\"),", "", 1).replace("])", ", MayAlias(of: \"a\", with: \"b\")])");
    assert!(refused(&below).contains("both textures or both buffers"), "{}", refused(&below));
}

#[test]
fn dumps_name_aliases() {
    let plan = compiled(&graph(Alias::First));
    assert!(dump::text(&plan).contains("imported, may alias b\n"), "{}", dump::text(&plan));
    assert!(dump::json(&plan, "").contains("\"may_alias\": [\n"), "{}", dump::json(&plan, ""));
}
