//! Same-pixel reads: in the tile if the attachment is there, otherwise sampled.

use super::{clean, usage};
use crate::support::*;
use framegraph::*;

#[test]
fn a_same_pixel_read_that_misses_the_tile_is_sampled() {
    let mut g = Graph::new();
    let out = screen(&mut g);
    let far = g.import_texture("far", hdr(), Entry::Defined, Exit::Keep);
    let near = g.texture("near", hdr());
    let near = g.add_fn("draw", |p| p.color(near, BLACK)).unwrap();
    g.add_fn("mix", |p| {
        p.same_pixel(near)?;
        p.same_pixel(far)?;
        p.color(out, Intent::Overwrite)
    })
    .unwrap();
    let plan = clean(&g, &Caps::tiler());
    assert_eq!(steps(&plan), [["draw", "mix"]]);
    assert_eq!(usage(&plan, "far"), Usage::SAMPLED);
    let inside = Usage::ATTACHMENT.union(Usage::INPUT_ATTACHMENT);
    assert_eq!(usage(&plan, "near"), inside);
}

/// Returns a graph that draws depth and reads `plane` at the same pixel while drawing the screen.
fn reads_plane(plane: Aspect) -> Graph {
    let mut g = Graph::new();
    let format = Format::Depth32FloatStencil8;
    let ds = g.import_texture("ds", color(format), Entry::Defined, Exit::Keep);
    let out = screen(&mut g);
    let (ds, out) = g.add_fn("draw", |p| Ok((p.depth(ds.aspect(Aspect::Depth), FAR)?, p.color(out, BLACK)?))).unwrap();
    g.add_fn("show", |p| {
        p.same_pixel(ds.aspect(plane))?;
        p.color(out, Intent::Modify)
    })
    .unwrap();
    g
}

#[test]
fn a_plane_that_nobody_drew_is_not_in_the_tile() {
    // Depth is in the tile; stencil is sampled if planes can be used separately; both together are not possible.
    let joined = |plane, caps: &Caps| clean(&reads_plane(plane), caps).counts().steps == 1;
    let apart = Caps { separate_planes: false, ..Caps::tiler() };
    for (caps, stencil) in [(Caps::tiler(), true), (apart, false)] {
        let found = [Aspect::Depth, Aspect::Stencil, Aspect::All].map(|plane| joined(plane, &caps));
        assert_eq!(found, [true, stencil, false], "{}", caps.separate_planes);
    }
    let plan = clean(&reads_plane(Aspect::Stencil), &Caps::tiler());
    let a = plan.attachments()[1];
    assert_eq!((a.load, a.store, a.stencil_load, a.stencil_store), {
        (LoadOp::Clear, StoreOp::Store, LoadOp::DontCare, StoreOp::None)
    });
    assert_eq!(usage(&plan, "ds"), Usage::ATTACHMENT.union(Usage::SAMPLED));
}

#[test]
fn a_device_without_reads_in_the_tile_samples_what_it_can() {
    // Read-only depth can be sampled in the same step, also by a same-pixel read.
    let mut g = Graph::new();
    let z = g.import_texture("z", depth(), Entry::Defined, Exit::Keep);
    let mut out = screen(&mut g);
    for (name, intent) in [("test", BLACK), ("fog", Intent::Modify)] {
        out = g
            .add_fn(name, |p| {
                if name == "fog" { p.same_pixel(z) } else { p.depth_read_only(z) }?;
                p.color(out, intent)
            })
            .unwrap();
    }
    assert_eq!(steps(&clean(&g, &wgpu())), [["test", "fog"]]);
}

#[test]
fn a_read_in_the_tile_leaves_room_for_a_later_pass() {
    // `grade` fits next to the three attachments of `scene`; `ui` adds another one and fits only next to `grade`.
    let mut g = Graph::new();
    let wide = color(Format::Rgba16Float);
    let [a, b, c] = ["a", "b", "c"].map(|name| g.texture(name, wide));
    let [a, b, c] = g.add_fn("scene", |p| Ok([p.color(a, BLACK)?, p.color(b, BLACK)?, p.color(c, BLACK)?])).unwrap();
    let (out, marks) = (screen(&mut g), g.texture("marks", wide));
    let out = g
        .add_fn("grade", |p| {
            for input in [a, b, c] {
                p.same_pixel(input)?;
            }
            p.color(out, Intent::Overwrite)
        })
        .unwrap();
    let marks = g
        .add_fn("ui", |p| {
            p.color(out, Intent::Modify)?;
            p.color_at(5, marks, BLACK)
        })
        .unwrap();
    g.export(marks).unwrap();
    let roomy = clean(&g, &Caps::tiler());
    assert_eq!(steps(&roomy), [["scene", "grade", "ui"]]);
    let plan = clean(&g, &Caps { tile_bytes_per_pixel: 32, ..Caps::tiler() });
    assert_eq!(steps(&plan), [vec!["scene"], vec!["grade", "ui"]]);
    assert_eq!(split_reason(&plan, "grade"), Some(Refusal::RoomForLater));
    assert_eq!(plan.counts().unresolves, 0);
}

/// `draw` shares an attachment with a step that is longer because of a read in the tile, and `late` shares a step with
/// `draw` only. `extra` then never leaves the tile. If `late` draws something else, `draw` stays with the earlier
/// passes.
#[test]
fn a_pass_that_only_draws_is_cut_off_for_a_later_one() {
    let graph = |shares: bool| {
        let mut g = Graph::new();
        let [old, read, kept, extra, other] =
            ["old", "read", "kept", "extra", "other"].map(|name| g.texture(name, color(Format::Rgba8Unorm)));
        let [old, read] = g.add_fn("scene", |p| Ok([p.color(old, BLACK)?, p.color(read, BLACK)?])).unwrap();
        let kept = g
            .add_fn("grade", |p| {
                p.same_pixel(read)?;
                p.color_at(2, kept, Intent::Overwrite)
            })
            .unwrap();
        let [kept, extra] = g
            .add_fn("draw", |p| {
                p.color_at(1, read, Intent::Modify)?;
                Ok([p.color_at(2, kept, Intent::Modify)?, p.color_at(3, extra, BLACK)?])
            })
            .unwrap();
        let late = g
            .add_fn("late", |p| {
                p.sampled(old)?;
                if shares { p.color_at(3, extra, Intent::Modify) } else { p.color(other, Intent::Overwrite) }
            })
            .unwrap();
        g.export(kept).unwrap();
        g.add_fn("out", |p| {
            p.same_pixel(late)?;
            let out = p.texture("out", color(Format::Rgba8Unorm));
            p.color(out, Intent::Overwrite)
        })
        .and_then(|out| g.export(out))
        .unwrap();
        clean(&g, &Caps::tiler())
    };
    let plan = graph(true);
    assert_eq!(steps(&plan), [vec!["scene", "grade"], vec!["draw", "late", "out"]]);
    assert_eq!(split_reason(&plan, "draw"), Some(Refusal::RoomForLater));
    assert_eq!(placement(&plan, "extra"), Placement::Memoryless);
    let plan = graph(false);
    assert_eq!(steps(&plan), [vec!["scene", "grade", "draw"], vec!["late", "out"]]);
    assert_eq!(split_reason(&plan, "late"), Some(Refusal::SampledElsewhere));
}

#[test]
fn what_a_step_reads_in_memory_it_does_not_draw_over() {
    let mut g = Graph::new();
    let old = g.import_texture("old", hdr(), Entry::Defined, Exit::Keep);
    let t = g.texture("t", hdr());
    let t = g.add_fn("draw", |p| p.color(t, BLACK)).unwrap();
    let u = g.texture("u", hdr());
    let u = g
        .add_fn("mix", |p| {
            p.same_pixel(t)?;
            p.same_pixel(old)?;
            p.color(u, Intent::Overwrite)
        })
        .unwrap();
    g.add_fn("over", |p| {
        p.same_pixel(u)?;
        p.color(old, Intent::Overwrite)
    })
    .unwrap();
    let plan = clean(&g, &Caps::tiler());
    assert_eq!(split_reason(&plan, "over"), Some(Refusal::SampledElsewhere));
}

#[test]
fn a_same_pixel_read_has_the_size_of_the_attachments_and_one_level() {
    let mut g = Graph::new();
    let out = screen(&mut g);
    let desc = hdr().extent(Extent::fraction(2)).mips(2);
    let half = g.import_texture("half", desc, Entry::Defined, Exit::Keep);
    let refused = g.add_fn("levels", |p| p.same_pixel(half));
    let refused = refused.map(drop).expect_err("a same-pixel read needs one level");
    let access = AccessKind::SamePixel;
    assert_eq!(refused.reason, DeclareReason::NotOneLevel { access });
    g.add_fn("size", |p| {
        p.same_pixel(half.mip(0))?;
        p.color(out, Intent::Overwrite)
    })
    .unwrap();
    let [width, height] = FRAME;
    let reason = CompileReason::Extent { expected: [width, height, 1], found: [width / 2, height / 2, 1] };
    assert_eq!(errors(&g)[0].reason, reason);
}

#[test]
fn what_only_a_raster_pass_can_do_makes_one() {
    let mut g = Graph::new();
    let t = g.import_texture("t", hdr(), Entry::Defined, Exit::Keep);
    g.add_fn("look", |p| {
        p.side_effect();
        p.same_pixel(t).map(drop)
    })
    .unwrap();
    assert_eq!(clean(&g, &Caps::tiler()).steps()[0].kind, PassKind::Raster);
}
