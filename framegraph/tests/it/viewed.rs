//! Textures viewed in the sRGB twin of their format.

use crate::support::*;
use framegraph::*;
use framegraph_check::check;

fn frame(first: Option<Format>, second: Option<Format>) -> Graph {
    let mut g = Graph::new();
    let out = screen(&mut g);
    let seen = |t: Texture, view: Option<Format>| view.map_or(t.range(Range::ALL), |v| t.viewed_as(v));
    let out = g.add_fn("first", |p| p.color(seen(out, first), BLACK)).unwrap();
    g.add_fn("second", |p| p.color(seen(out, second), Intent::Modify)).unwrap();
    g
}

#[test]
fn attachments_share_a_step_when_they_are_seen_alike() {
    let linear = Some(Format::Rgba8Unorm);
    for (first, second, steps) in [(None, None, 1), (linear, linear, 1), (None, linear, 2), (linear, None, 2)] {
        for caps in [wgpu(), Caps::tiler(), Caps::desktop()] {
            let g = frame(first, second);
            let plan = plan(&g, &caps);
            assert_eq!(check(&plan), Ok(()), "{first:?} {second:?}");
            assert_eq!(plan.counts().steps, steps, "{first:?} {second:?}");
            let views: Vec<_> = plan.attachments().iter().map(|a| a.view).collect();
            assert_eq!(views, if steps == 1 { vec![first] } else { vec![first, second] });
            assert_eq!(plan.resources()[0].srgb_views, first.or(second).is_some());
        }
    }
    let text = dump::text(&plan(&frame(None, linear), &wgpu()));
    assert!(text.contains("color 0: screen as Rgba8Unorm load -> store"), "{text}");
}

#[test]
fn its_own_format_is_no_view_and_strangers_are_refused() {
    assert_eq!(frame(Some(Format::Rgba8UnormSrgb), None).accesses()[0].range, Range::ALL);
    let mut g = Graph::new();
    let (a, z) = (g.texture("a", hdr()), g.texture("z", color(Format::Rgba8UnormSrgb)));
    let refused = g.add_fn("p", |p| p.color(a.viewed_as(Format::Rgba8Unorm), BLACK)).unwrap_err();
    assert_eq!(refused.reason, DeclareReason::NoTwin { format: Format::Rgba16Float, view: Format::Rgba8Unorm });
    // A view does not allow accesses that the texture does not support.
    let refused = g.add_fn("p", |p| p.storage_write(z.viewed_as(Format::Rgba8Unorm), Intent::Overwrite)).unwrap_err();
    assert!(refused.to_string().contains("use the format without sRGB"), "{refused}");
}

#[test]
fn samples_are_resolved_between_equal_views() {
    let resolved = |view: Format| {
        let mut g = Graph::new();
        let out = screen(&mut g);
        g.add_fn("draw", |p| {
            let samples = p.texture("samples", color(Format::Rgba8Unorm).samples(4));
            let drawn = p.color(samples.viewed_as(Format::Rgba8UnormSrgb), BLACK)?;
            p.resolve(drawn, out.viewed_as(view))
        })
        .unwrap();
        g
    };
    assert_eq!(check(&plan(&resolved(Format::Rgba8UnormSrgb), &wgpu())), Ok(()));
    let reason = &errors(&resolved(Format::Rgba8Unorm))[0].reason;
    assert_eq!(*reason, CompileReason::Format { expected: Format::Rgba8UnormSrgb, found: Format::Rgba8Unorm });
}

#[test]
fn a_slot_has_both_formats_when_a_tenant_is_seen_through_the_other() {
    let mut g = Graph::new();
    let a = g.texture("a", color(Format::Rgba8Unorm));
    let a = g.add_fn("draw", |p| p.color(a, BLACK)).unwrap();
    g.add_fn("look", |p| {
        p.side_effect();
        p.sampled(a.viewed_as(Format::Rgba8UnormSrgb))
    })
    .unwrap();
    let plan = plan(&g, &wgpu());
    assert_eq!(check(&plan), Ok(()));
    assert!(plan.slots()[0].srgb_views);
}
