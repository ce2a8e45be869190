//! Reads at the same pixel: in the tile where they find it, sampled where they miss it.

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

#[test]
fn a_read_in_the_tile_loads_the_plane_that_nobody_drew() {
    let mut g = Graph::new();
    let format = Format::Depth32FloatStencil8;
    let ds = g.import_texture("ds", color(format), Entry::Defined, Exit::Keep);
    let ds = g.add_fn("draw", |p| p.depth(ds.aspect(Aspect::Depth), FAR)).unwrap();
    let out = screen(&mut g);
    g.add_fn("show", |p| {
        p.same_pixel(ds)?;
        p.color(out, Intent::Overwrite)
    })
    .unwrap();
    let plan = clean(&g, &Caps::tiler());
    let a = plan.attachments()[1];
    assert_eq!((a.load, a.store), (LoadOp::Clear, StoreOp::Store));
    let stencil = (a.stencil_load, a.stencil_store);
    assert_eq!(stencil, (LoadOp::Load, StoreOp::None));
    assert_eq!(plan.counts().steps, 1);
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
    let refused = refused.map(drop).expect_err("two levels are no texel");
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
