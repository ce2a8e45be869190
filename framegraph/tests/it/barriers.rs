//! Barriers of small frames, derived by hand.

use crate::support::*;
use framegraph::*;
use framegraph_check::check;

fn explicit() -> Caps {
    Caps::desktop()
}

fn of<'p>(plan: &'p Plan, name: &str) -> Vec<&'p Barrier> {
    let id = plan.graph().find_resource(name).expect("the resource was declared");
    plan.barriers().iter().filter(|b| b.resource == id).collect()
}

#[test]
fn a_chain_transitions_each_texture_twice() {
    let mut g = Graph::new();
    let a = g.texture("a", hdr());
    let a = g.add_fn("draw", |p| p.color(a, BLACK)).unwrap();
    let b = filter(&mut g, "one", a, Format::Rgba16Float);
    let c = filter(&mut g, "two", b, Format::Rgba16Float);
    g.export(c).unwrap();
    let p = plan(&g, &explicit());
    let a = of(&p, "a");
    assert_eq!((a[0].from, a[0].to), (State::Undefined, State::ColorAttachment));
    assert_eq!((a[1].from, a[1].to), (State::ColorAttachment, State::Sampled));
    assert_eq!((a[1].from_stages, a[1].to_stages), (Stages::COLOR, Stages::SHADER));
    assert_eq!(a.len(), 2);
    // `two_out` is exported and not aliased; `a` is unused when it is written, but not aliased either.
    assert!(of(&p, "two_out").iter().all(|b| b.aliases.is_none()));
}

#[test]
fn memory_is_handed_over_after_its_last_use() {
    let mut g = Graph::new();
    let mut t = g.texture("t0", hdr());
    t = g.add_fn("draw", |p| p.color(t, BLACK)).unwrap();
    for i in 1..4 {
        t = filter(&mut g, &format!("f{i}"), t, Format::Rgba16Float);
    }
    let out = screen(&mut g);
    g.add_fn("show", |p| {
        p.sampled(t)?;
        p.color(out, Intent::Overwrite)
    })
    .unwrap();
    let p = plan(&g, &explicit());
    // `t0` and `f1` share two slots: `f2` reuses the memory of `t0`, which `f1` sampled in step 1.
    let f2 = of(&p, "f2_out")[0];
    assert_eq!(f2.aliases, g.find_resource("t0").unwrap());
    assert_eq!((f2.after.index(), f2.before.index(), f2.from), (1, 2, State::Undefined));
    assert_eq!(f2.from_stages, Stages::SHADER);
}

#[test]
fn two_reads_of_one_kind_need_one_barrier_and_the_next_write_waits_for_both() {
    let mut g = Graph::new();
    let b = g.buffer("b", 64);
    let b = g.add_fn("fill", |p| p.write_buffer(b, AccessKind::StorageWrite, Intent::Overwrite)).unwrap();
    for name in ["read0", "read1"] {
        g.add_fn(name, |p| {
            p.side_effect();
            p.read_buffer(b, AccessKind::StorageRead)
        })
        .unwrap();
    }
    let b = g.add_fn("again", |p| p.write_buffer(b, AccessKind::StorageWrite, Intent::Overwrite)).unwrap();
    g.export_buffer(b).unwrap();
    let p = plan(&g, &explicit());
    let found: Vec<_> = of(&p, "b").iter().map(|b| (b.before.index(), b.after.index())).collect();
    assert_eq!(found, [(1, 0), (3, 2)]);
}

/// A texture that is sampled and read as storage in one step has the storage layout, which supports both.
#[test]
fn what_is_sampled_and_storage_at_once_is_in_the_layout_of_storage() {
    let mut g = Graph::new();
    let [read, out] = ["read", "out"].map(|name| g.texture(name, hdr()));
    let read = g.add_fn("draw", |p| p.color(read, BLACK)).unwrap();
    let both = g.add_fn("both", |p| {
        p.sampled(read)?;
        p.storage_read(read)?;
        p.color(out, Intent::Overwrite)
    });
    g.export(both.unwrap()).unwrap();
    let p = plan(&g, &explicit());
    let states: Vec<_> = of(&p, "read").iter().map(|b| (b.from, b.to)).collect();
    assert_eq!(states, [(State::Undefined, State::ColorAttachment), (State::ColorAttachment, State::Storage)]);
}

#[test]
fn levels_change_apart() {
    let mut g = Graph::new();
    let t = g.texture("t", hdr().mips(3));
    let mut t = g.add_fn("base", |p| p.color(t.mip(0), BLACK)).unwrap();
    for mip in 1..3 {
        t = g
            .add_fn("down", |p| {
                p.sampled(t.mip(mip - 1))?;
                p.color(t.mip(mip), Intent::Overwrite)
            })
            .unwrap();
    }
    g.export(t).unwrap();
    let p = plan(&g, &explicit());
    let found: Vec<_> = of(&p, "t").iter().map(|b| (b.before.index(), b.first_part, b.parts, b.to)).collect();
    use State::{ColorAttachment as C, Sampled as S};
    assert_eq!(found, [(0, 0, 1, C), (1, 0, 1, S), (1, 1, 1, C), (2, 1, 1, S), (2, 2, 1, C)]);
}

#[test]
fn what_is_attached_is_in_the_layout_with_both_planes() {
    // Both planes are written; then depth is sampled, and only stencil is tested.
    let mut g = Graph::new();
    let ds = g.texture("ds", color(Format::Depth32FloatStencil8));
    let ds = g.add_fn("both", |p| p.depth(ds, FAR)).unwrap();
    let a = g.texture("a", hdr());
    let a = g
        .add_fn("fog", |p| {
            p.sampled(ds.aspect(Aspect::Depth))?;
            p.color(a, BLACK)
        })
        .unwrap();
    let (b, half) = (g.texture("b", hdr()), g.texture("half", hdr()));
    let half = g.add_fn("other", |p| p.storage_write(half, Intent::Overwrite)).unwrap();
    let b = g
        .add_fn("mask", |p| {
            p.sampled(half)?;
            p.depth_read_only(ds.aspect(Aspect::Stencil))?;
            p.color(b, BLACK)
        })
        .unwrap();
    g.export(a).unwrap();
    g.export(b).unwrap();
    let p = plan(&g, &explicit());
    assert_eq!(check(&p), Ok(()));
    let found: Vec<_> = of(&p, "ds").iter().map(|b| (b.before.index(), b.first_part, b.parts, b.from, b.to)).collect();
    use State::{DepthAttachment as D, DepthReadOnly as R, Sampled as S, Undefined as U};
    // In step 3 the depth plane takes part, although no pass of the step accesses it.
    assert_eq!(found, [(0, 0, 2, U, D), (1, 0, 1, D, S), (3, 0, 1, S, R), (3, 1, 1, D, R)]);
    let waits: Vec<_> = of(&p, "ds").iter().map(|b| (b.from_stages, b.to_stages)).collect();
    let (d, s) = (Stages::DEPTH, Stages::SHADER);
    assert_eq!(waits, [(Stages::NONE, d), (d, s), (s, d), (d, d)], "loads of a plane wait too");
}

#[test]
fn an_import_comes_in_the_state_that_its_owner_says() {
    let left = |state, stages| Entry::Left { state, stages };
    let rows = [
        (Entry::Defined, State::Entry, Stages::NONE),
        (Entry::Undefined, State::Undefined, Stages::NONE),
        (left(State::Sampled, Stages::SHADER), State::Sampled, Stages::SHADER),
        // The contents are undefined, but their last readers must be waited for.
        (left(State::Undefined, Stages::COPY), State::Undefined, Stages::COPY),
    ];
    for (entry, from, stages) in rows {
        let mut g = Graph::new();
        let t = g.import_texture("t", hdr(), entry, Exit::Keep);
        let intent = if entry.is_defined() { Intent::Modify } else { BLACK };
        g.add_fn("draw", |p| p.color(t, intent)).unwrap();
        let p = plan(&g, &explicit());
        assert_eq!(check(&p), Ok(()));
        let [first] = of(&p, "t")[..] else { panic!("one barrier") };
        assert_eq!((first.from, first.from_stages, first.to), (from, stages, State::ColorAttachment));
        assert!(first.after.is_none());
    }
    let mut g = Graph::new();
    let t = g.import_texture("t", hdr(), left(State::Undefined, Stages::NONE), Exit::Keep);
    g.add_fn("draw", |p| p.color(t, Intent::Modify)).unwrap();
    assert!(matches!(errors(&g)[0].reason, CompileReason::ReadUnwritten { .. }), "the contents are undefined");
}

#[test]
fn devices_with_automatic_barriers_get_none() {
    let mut g = Graph::new();
    let out = screen(&mut g);
    g.add_fn("draw", |p| p.color(out, BLACK)).unwrap();
    assert!(plan(&g, &wgpu()).barriers().is_empty());
    assert_eq!(plan(&g, &explicit()).barriers().len(), 1);
}
