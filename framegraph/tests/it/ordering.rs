//! The optimizing order: which passes it groups, and that it is never worse.

use crate::support::*;
use framegraph::*;

const OPTIMIZED: Order = Order::Optimized;

/// Returns two targets drawn alternately: four steps in declaration order A B A B, two steps when grouped.
fn interleaved() -> Graph {
    let mut g = Graph::new();
    let mut targets = ["a", "b"].map(|n| g.texture(n, hdr()));
    for (round, intent) in [BLACK, Intent::Modify].into_iter().enumerate() {
        for (target, name) in targets.iter_mut().zip(["a", "b"]) {
            *target = g.add_fn(&format!("{name}{round}"), |p| p.color(*target, intent)).unwrap();
        }
    }
    for target in targets {
        g.export(target).unwrap();
    }
    g
}

#[test]
fn mergeable_passes_come_together() {
    let (g, caps) = (interleaved(), wgpu());
    assert_eq!(plan(&g, &caps).counts().steps, 4);
    let p = plan_with(&g, &caps, &Options { order: OPTIMIZED, ..options() });
    assert_eq!(steps(&p), [["a0", "a1"], ["b0", "b1"]]);
    let moved = g.find_pass("a1").unwrap();
    let before = g.find_pass("a0").unwrap();
    assert!(p.reasons(Subject::Pass(moved)).any(|r| r == Reason::OrderMerge(before)));
    assert_eq!((p.counts().unresolves, p.counts().resolves), (0, 2));
}

#[test]
fn fewer_bytes_are_live() {
    // Declared: all large textures are written first and used afterwards. It is better to use each before the next one
    // is written.
    let mut g = Graph::new();
    let mut small = Vec::new();
    let big: Vec<_> = (0..4)
        .map(|i| {
            let t = g.texture(&format!("big{i}"), hdr());
            g.add_fn(&format!("make{i}"), |p| p.storage_write(t, Intent::Overwrite)).unwrap()
        })
        .collect();
    for (i, t) in big.into_iter().enumerate() {
        small.push(
            g.add_fn(&format!("use{i}"), |p| {
                p.sampled(t)?;
                let out = p.texture(&format!("small{i}"), TextureDesc::new(Extent::absolute(1, 1), Format::R32Float));
                p.storage_write(out, Intent::Overwrite)
            })
            .unwrap(),
        );
    }
    let out = g.texture("out", TextureDesc::new(Extent::absolute(1, 1), Format::R32Float));
    let out = g
        .add_fn("sum", |p| {
            for t in &small {
                p.sampled(*t)?;
            }
            p.storage_write(out, Intent::Overwrite)
        })
        .unwrap();
    g.export(out).unwrap();
    let big_bytes = u64::from(FRAME[0] * FRAME[1]) * 8;
    assert_eq!(plan(&g, &wgpu()).memory().lower_bound_bytes, 4 * big_bytes + 4);
    let p = plan_with(&g, &wgpu(), &Options { order: OPTIMIZED, ..options() });
    assert_eq!(p.memory().bytes, big_bytes + 4 * 4);
}

#[test]
fn optimizing_is_idempotent_and_deterministic() {
    let g = interleaved();
    let o = Options { order: OPTIMIZED, ..options() };
    let (mut scratch, mut p) = (Scratch::new(), Plan::new());
    compile(&g, &Caps::tiler(), &o, &mut scratch, &mut p).unwrap();
    let first = dump::text(&p);
    compile(&g, &Caps::tiler(), &o, &mut scratch, &mut p).unwrap();
    assert_eq!(first, dump::text(&p));
    assert_eq!(first, dump::text(&plan_with(&g, &Caps::tiler(), &o)));
}
