//! Differences between plans.

use crate::dump::{frame, random_plans};
use crate::support::*;
use framegraph::*;

#[test]
fn a_plan_does_not_differ_from_itself() {
    for plan in random_plans(30) {
        let diff = diff(&plan, &plan);
        assert!(diff.is_empty(), "{diff}");
        assert_eq!(diff.to_string(), "no change\n");
    }
}

/// The frame of the dump tests with tone mapping at the same pixel, and another unused pass.
fn changed() -> Graph {
    let mut g = Graph::new();
    let out = screen(&mut g);
    let z = g.texture("depth", depth());
    let z = g.add_fn("prepass", |p| p.depth(z, FAR)).unwrap();
    let scene = g.texture("hdr", hdr());
    let scene = g
        .add_fn("scene", |p| {
            p.takes_epilogue();
            p.depth_read_only(z)?;
            p.color(scene, BLACK)
        })
        .unwrap();
    g.add_fn("tonemap", |p| {
        p.pointwise();
        p.same_pixel(scene)?;
        p.color(out, Intent::Overwrite)
    })
    .unwrap();
    let t = g.texture("t", hdr());
    let _ = g.add_fn("stray", |p| p.color(t, BLACK)).unwrap();
    g
}

#[test]
fn changes_are_named_with_their_reasons() {
    let (a, b) = (plan(&frame(), &wgpu()), plan(&changed(), &wgpu()));
    let d = diff(&a, &b);
    assert_eq!(
        (d.passes_added.as_slice(), d.passes_removed.as_slice()),
        (["stray".to_owned()].as_slice(), ["idle".to_owned()].as_slice())
    );
    assert_eq!(
        (d.resources_added.as_slice(), d.resources_removed.as_slice()),
        (["t".to_owned()].as_slice(), ["idle_out".to_owned()].as_slice())
    );
    assert!(d.culls.is_empty());
    let total = |what| d.totals.iter().find(|t| t.what == what).map(|t| (t.before, t.after));
    assert_eq!(total("resolves"), Some((2, 1)));
    assert_eq!(total("resolve_bytes"), Some((24576, 8192)));
    assert_eq!(total("inlined"), Some((0, 1)));
    assert_eq!((total("unresolves"), total("culled")), (None, None));
    let mates = d.merges.iter().find(|m| m.what == "tonemap").expect("it shares a step");
    assert_eq!(
        (mates.before.len(), mates.after.as_slice()),
        (0, ["prepass".to_owned(), "scene".to_owned()].as_slice())
    );
    let text = d.to_string();
    for line in [
        "passes:\n  - idle\n  + stray\n",
        "  tonemap: was alone, is with prepass, scene\n",
        "  stores: 2 -> 1 (-1)\n",
        "  stored_bytes: 24.0 KiB -> 8.0 KiB (-16.0 KiB)\n",
        "  hdr: 64x32 Rgba16Float, 16384 B, slot -> 64x32 Rgba16Float, inlined\n",
        "  pass `tonemap`\n    - not merged with `scene`: the later one samples a texture that the step writes\n    \
         + inlined into the shader of `scene`\n",
    ] {
        assert!(text.contains(line), "{text}\nlacks {line}");
    }
    let back = diff(&b, &a);
    assert_eq!((back.passes_added, back.passes_removed), (d.passes_removed, d.passes_added));
}

#[test]
fn culls_in_both_directions_are_told_apart() {
    let make = |read: bool| {
        let mut g = Graph::new();
        let t = g.texture("t", hdr());
        let t = g.add_fn("draw", |p| p.color(t, BLACK)).unwrap();
        let out = screen(&mut g);
        g.add_fn("show", |p| {
            if read {
                p.sampled(t)?;
            }
            p.color(out, Intent::Overwrite)
        })
        .unwrap();
        plan(&g, &wgpu())
    };
    let d = diff(&make(true), &make(false));
    assert_eq!(d.culls.len(), 1);
    assert_eq!((d.culls[0].pass.as_str(), d.culls[0].culled), ("draw", true));
    assert_eq!(d.culls[0].reason, "culled because no pass reads `t`");
    assert!(d.to_string().contains("  draw: now culled: culled because no pass reads `t`\n"));
    assert!(
        diff(&make(false), &make(true)).to_string().contains("  draw: runs again: kept because `show` reads `t`\n")
    );
}

#[test]
fn passes_of_one_name_are_matched_in_order() {
    let make = |count: usize| {
        let mut g = Graph::new();
        for _ in 0..count {
            let t = g.texture("t", hdr());
            let t = g.add_fn("down", |p| p.color(t, BLACK)).unwrap();
            g.export(t).unwrap();
        }
        plan(&g, &wgpu())
    };
    let d = diff(&make(2), &make(4));
    assert_eq!((d.passes_added.len(), d.passes_removed.len(), d.resources_added.len()), (2, 0, 2));
}

#[test]
fn a_device_can_be_compared_with_another() {
    let graph = frame();
    let d = diff(&plan(&graph, &wgpu()), &plan(&graph, &Caps::desktop()));
    assert!(d.passes_added.is_empty() && d.merges.is_empty());
    let depth = d.resources.iter().find(|r| r.what == "depth").expect("it needs memory there");
    assert!(depth.before.ends_with("memoryless") && depth.after.ends_with("slot"), "{depth:?}");
    let value: serde_json::Value = serde_json::from_str(&d.json()).expect("the form is JSON");
    assert_eq!((&value["schema"], &value["version"]), (&"framegraph-diff".into(), &1.into()));
    assert!(value["totals"].as_array().is_some_and(|t| t.iter().any(|t| t["what"] == "memoryless")));
}
