//! Attachments of one step: equal ranges compare equal, ranges do not overlap partly, and planes are tracked
//! separately.

use super::clean;
use crate::support::*;
use framegraph::*;

fn layers(layer: u16, layers: u16) -> Range {
    Range { layer, layers, ..Range::ALL }
}

#[test]
fn one_spot_spelled_in_two_ways_is_one_attachment() {
    let mut g = Graph::new();
    let t = g.texture("t", hdr().layers(2));
    let t = g.add_fn("first", |p| p.color(t, BLACK)).unwrap();
    let all = t.range(layers(0, 2));
    let t = g.add_fn("second", |p| p.color(all, Intent::Modify)).unwrap();
    g.export(t).unwrap();
    let plan = clean(&g, &wgpu());
    assert_eq!(steps(&plan), [["first", "second"]]);
}

#[test]
fn overlapping_layers_are_not_attached_at_once() {
    let mut g = Graph::new();
    let (t, z) = (g.texture("t", hdr().layers(3)), g.texture("z", depth().layers(2)));
    let (t, z) = g.add_fn("first", |p| Ok((p.color(t.range(layers(0, 2)), BLACK)?, p.depth(z, FAR)?))).unwrap();
    let (t, z) = g
        .add_fn("second", |p| {
            let t = p.color_at(1, t.range(layers(1, 2)), BLACK)?;
            Ok((t, p.depth(z, Intent::Modify)?))
        })
        .unwrap();
    g.export(t).unwrap();
    g.export(z).unwrap();
    let plan = clean(&g, &wgpu());
    assert_eq!(split_reason(&plan, "second"), Some(Refusal::ColorsDiffer));
}

#[test]
fn one_target_is_not_resolved_into_twice_in_a_step() {
    let mut g = Graph::new();
    let (z, into) = (g.texture("z", depth().samples(4)), g.texture("into", hdr()));
    let mut frame = (z, into);
    for name in ["first", "second"] {
        let (z, into) = frame;
        let ms = g.texture("ms", hdr().samples(4));
        frame = g
            .add_fn(name, |p| {
                let ms = p.color(ms, BLACK)?;
                let intent = if name == "first" { FAR } else { Intent::Modify };
                Ok((p.depth(z, intent)?, p.resolve(ms, into)?))
            })
            .unwrap();
    }
    g.export(frame.1).unwrap();
    g.add_fn("keep", |p| {
        p.side_effect();
        p.sampled(frame.0).map(drop)
    })
    .unwrap();
    for caps in [wgpu(), Caps::tiler()] {
        clean(&g, &caps);
    }
}

#[test]
fn a_plane_that_nobody_touches_costs_no_memory_and_is_no_reason() {
    let mut g = Graph::new();
    let out = screen(&mut g);
    let ds = g.texture("ds", color(Format::Depth32FloatStencil8));
    g.add_fn("draw", |p| {
        p.depth(ds.aspect(Aspect::Stencil), FAR)?;
        p.color(out, BLACK)
    })
    .unwrap();
    let plan = clean(&g, &wgpu());
    assert_eq!(placement(&plan, "ds"), Placement::Memoryless);
    assert_eq!(plan.counts().discards, 1);
    let plan = clean(&g, &Caps::desktop());
    assert_eq!(plan.counts().discards, 1, "one plane is discarded");
}

#[test]
fn a_load_names_the_writer_of_the_plane_that_is_loaded() {
    let mut g = Graph::new();
    let ds = g.texture("ds", color(Format::Depth32FloatStencil8));
    let mut ds = ds;
    for (name, aspect) in [("depth", Aspect::Depth), ("stencil", Aspect::Stencil)] {
        ds = g
            .add_fn(name, |p| {
                p.never_merge();
                p.depth(ds.aspect(aspect), FAR)
            })
            .unwrap();
    }
    let out = screen(&mut g);
    g.add_fn("use", |p| {
        p.depth_read_only(ds.aspect(Aspect::Stencil))?;
        p.color(out, Intent::Overwrite)
    })
    .unwrap();
    g.export(ds).unwrap();
    let plan = clean(&g, &wgpu());
    let id = |name| g.find_pass(name).unwrap();
    let step = plan.pass_steps()[id("use").index()];
    let ds = g.find_resource("ds").unwrap();
    let reason = plan.reasons(Subject::Load(step, ds)).next();
    assert_eq!(reason, Some(Reason::LoadWritten(id("stencil"))));
}

#[test]
fn a_device_that_cannot_sample_tested_depth_refuses_it() {
    let mut g = Graph::new();
    let z = g.import_texture("z", depth(), Entry::Defined, Exit::Keep);
    let out = screen(&mut g);
    g.add_fn("fog", |p| {
        p.depth_read_only(z)?;
        p.sampled(z)?;
        p.color(out, Intent::Overwrite)
    })
    .unwrap();
    clean(&g, &wgpu());
    let caps = Caps { sample_read_only_depth: false, ..wgpu() };
    let outcome = compile(&g, &caps, &options(), &mut Scratch::new(), &mut Plan::new());
    let errors = outcome.expect_err("the device does not support it").listed;
    let access = AccessKind::Sampled;
    assert_eq!(errors[0].reason, CompileReason::SampledDepth { access });
    assert_eq!((name(&errors[0].pass), name(&errors[0].resource)), ("fog", "z"));
}

#[test]
fn planes_start_apart_with_one_clear_value_at_most() {
    // The second pass clears stencil, which no earlier pass of the step uses, so that depth starts the same way.
    let starts = |first: Intent| {
        let mut g = Graph::new();
        let ds = g.import_texture("ds", color(Format::Depth32FloatStencil8), Entry::Defined, Exit::Keep);
        let out = screen(&mut g);
        let (ds, out) =
            g.add_fn("depth", |p| Ok((p.depth(ds.aspect(Aspect::Depth), first)?, p.color(out, BLACK)?))).unwrap();
        g.add_fn("stencil", |p| {
            p.depth(ds.aspect(Aspect::Stencil), FAR)?;
            p.color(out, Intent::Modify)
        })
        .unwrap();
        clean(&g, &wgpu())
    };
    let plan = starts(Intent::Modify);
    let a = plan.attachments()[1];
    assert_eq!((plan.counts().steps, a.load, a.stencil_load), (1, LoadOp::Load, LoadOp::Clear));
    let other = Intent::Clear(ClearValue::DepthStencil(0.25, 7));
    assert_eq!(split_reason(&starts(other), "stencil"), Some(Refusal::ClearBetween));
}
