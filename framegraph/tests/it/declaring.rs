//! Invalid uses of handles and builders: rejected immediately, with names, and without a trace in the graph.

use crate::support::*;
use framegraph::*;
use framegraph_check::check;

fn reason<T>(result: Result<T, DeclareError>) -> DeclareReason {
    match result {
        Ok(_) => panic!("the call was accepted"),
        Err(e) => {
            let line = e.to_string();
            assert!(line.contains("declaring.rs") && !line.contains('\n'), "{line}");
            e.reason
        }
    }
}

#[test]
fn a_stale_handle_names_both_passes() {
    let mut g = Graph::new();
    let a = g.texture("a", hdr());
    let old = g.add_fn("first", |p| p.color(a, BLACK)).unwrap();
    let _new = g.add_fn("second", |p| p.color(old, Intent::Modify)).unwrap();
    let error = g.add_fn("third", |p| p.sampled(old)).unwrap_err();
    assert_eq!((name(&error.pass), name(&error.resource)), ("third", "a"));
    assert_eq!(error.reason, DeclareReason::Stale { writer: "second".into(), user: StaleUser::OtherPass });
    assert_eq!(g.passes().len(), 2, "the rejected pass left a trace");
}

#[test]
fn a_pass_is_told_of_its_own_newer_version() {
    let mut g = Graph::new();
    let a = g.texture("a", hdr().mips(2));
    let refused = g.add_fn("twice", |p| {
        p.color(a.mip(0), BLACK)?;
        p.color(a.mip(1), BLACK)
    });
    assert_eq!(reason(refused), DeclareReason::Stale { writer: "twice".into(), user: StaleUser::SamePass });
}

#[test]
fn handles_of_other_graphs_and_of_before_a_reset_are_refused() {
    let (mut g, mut other) = (Graph::new(), Graph::new());
    let a = other.texture("a", hdr());
    assert_eq!(reason(g.add_fn("p", |p| p.color(a, BLACK))), DeclareReason::Foreign);
    other.reset();
    let _ = other.texture("a", hdr());
    assert_eq!(reason(other.add_fn("p", |p| p.color(a, BLACK))), DeclareReason::Foreign);
}

#[test]
fn a_refused_pass_gives_its_versions_back() {
    let mut g = Graph::new();
    let a = g.texture("a", hdr());
    let refused = g.add_fn("bad", |p| {
        let a = p.color(a, BLACK)?;
        let _extra = p.texture("extra", hdr());
        p.sampled(a)
    });
    assert!(matches!(reason(refused), DeclareReason::Conflict { .. }));
    assert_eq!((g.resources().len(), g.versions().len(), g.accesses().len()), (1, 1, 0));
    let _ = g.add_fn("good", |p| p.color(a, BLACK)).expect("the old handle is current again");
}

#[test]
fn after_a_pass_that_panicked_what_it_wrote_is_stale() {
    let mut g = Graph::new();
    let a = g.texture("a", hdr());
    let caught = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        let _ = g.add_fn("bad", |p| -> Result<(), DeclareError> {
            p.color(a, BLACK)?;
            std::panic::resume_unwind(Box::new("on the way"))
        });
    }));
    assert!(caught.is_err() && g.passes().is_empty());
    assert!(matches!(reason(g.export(a)), DeclareReason::Stale { .. }));
    assert!(matches!(reason(g.add_fn("good", |p| p.sampled(a))), DeclareReason::Stale { .. }));
}

#[test]
fn a_level_of_one_slice_is_attached_and_the_others_are_written_whole() {
    let mut g = Graph::new();
    let v = g.texture("v", TextureDesc { dimension: Dimension::D3, ..hdr().mips(2).layers(2) });
    let v = g.add_fn("all", |p| p.storage_write(v.mip(0), Intent::Overwrite)).unwrap();
    let v = g.add_fn("one", |p| p.color(v.mip(1), Intent::Overwrite)).unwrap();
    g.export(v).unwrap();
    let plan = plan(&g, &Caps::tiler());
    assert_eq!(check(&plan), Ok(()));
    assert_eq!(plan.counts().steps, 2);
    let mut g = Graph::new();
    let z = g.texture("z", TextureDesc { dimension: Dimension::D3, ..depth() });
    let z = g.add_fn("draw", |p| p.depth(z, FAR)).unwrap();
    g.export(z).unwrap();
    let reason = CompileReason::Shape(ShapeReason::Volume { format: Format::Depth32Float });
    assert_eq!(errors(&g)[0].reason, reason);
}

#[test]
fn conflicts_shapes_and_formats_are_refused() {
    let mut g = Graph::new();
    let a = g.texture("a", hdr().mips(3).layers(2));
    let z = g.texture("z", depth());
    let b = g.buffer("b", 16);
    type Refused = (&'static str, fn(&DeclareReason) -> bool);
    let volume = |layers| TextureDesc { dimension: Dimension::D3, ..hdr().mips(2).layers(layers) };
    let v = g.texture("v", volume(2));
    let cases: [(Refused, Result<(), DeclareError>); 13] = [
        (
            ("slices", |r| matches!(r, DeclareReason::Slices { access: AccessKind::Color })),
            g.add_fn("p", |p| p.color(v.mip(0), BLACK).map(drop)),
        ),
        (
            ("texel of slices", |r| matches!(r, DeclareReason::Slices { access: AccessKind::SamePixel })),
            g.add_fn("p", |p| p.same_pixel(v.mip(0)).map(drop)),
        ),
        (("whole", |r| matches!(r, DeclareReason::NotOneLevel { .. })), g.add_fn("p", |p| p.color(a, BLACK).map(drop))),
        (
            ("level", |r| matches!(r, DeclareReason::OutOfRange { .. })),
            g.add_fn("p", |p| p.color(a.mip(3), BLACK).map(drop)),
        ),
        (
            ("layer", |r| matches!(r, DeclareReason::OutOfRange { .. })),
            g.add_fn("p", |p| p.sampled(a.layer(2)).map(drop)),
        ),
        (("format", |r| matches!(r, DeclareReason::Format { .. })), g.add_fn("p", |p| p.color(z, BLACK).map(drop))),
        (
            ("plane", |r| matches!(r, DeclareReason::OutOfRange { .. })),
            g.add_fn("p", |p| p.sampled(z.aspect(Aspect::Stencil)).map(drop)),
        ),
        (
            ("direction", |r| matches!(r, DeclareReason::WrongDirection { access: AccessKind::StorageWrite })),
            g.add_fn("p", |p| p.read_buffer(b, AccessKind::StorageWrite).map(drop)),
        ),
        (
            ("buffer", |r| matches!(r, DeclareReason::Buffer { access: AccessKind::Sampled })),
            g.add_fn("p", |p| p.read_buffer(b, AccessKind::Sampled).map(drop)),
        ),
        (("history", |r| matches!(r, DeclareReason::NoHistory { age: 1, frames: None })), g.previous(a, 1).map(drop)),
        (
            ("feedback", |r| matches!(r, DeclareReason::Conflict { .. })),
            g.add_fn("p", |p| {
                p.sampled(a.mip(1))?;
                p.color(a.mip(1), BLACK).map(drop)
            }),
        ),
        (
            ("kind", |r| matches!(r, DeclareReason::WrongPassKind { .. })),
            g.add_fn("p", |p| {
                p.kind(PassKind::Compute)?;
                p.depth(z, FAR).map(drop)
            }),
        ),
        (("resolve", |r| matches!(r, DeclareReason::NothingToResolve)), g.add_fn("p", |p| p.resolve(a, z).map(drop))),
    ];
    for ((name, fits), result) in cases {
        let reason = reason(result);
        assert!(fits(&reason), "{name}: {reason:?}");
    }
}

#[test]
fn reading_one_level_while_writing_the_next_is_fine() {
    let mut g = Graph::new();
    let a = g.texture("a", hdr().mips(2));
    let a = g.add_fn("base", |p| p.color(a.mip(0), BLACK)).unwrap();
    let _ = g
        .add_fn("down", |p| {
            p.sampled(a.mip(0))?;
            p.color(a.mip(1), Intent::Overwrite)
        })
        .unwrap();
}

#[test]
fn scopes_nest_names() {
    let mut g = Graph::new();
    g.scope("bloom", |g| {
        let t = g.texture("t", hdr());
        g.scope("down", |g| g.add_fn("0", |p| p.color(t, BLACK)).map(drop)).unwrap();
    });
    assert!(g.find_pass("bloom/down/0").is_some() && g.find_resource("bloom/t").is_some());
}

#[test]
fn copies_are_passes_of_their_own_whether_the_kind_is_named_or_not() {
    let mut g = Graph::new();
    let (a, b) = (g.import_texture("a", hdr(), Entry::Defined, Exit::Keep), g.texture("b", hdr()));
    let buffer = g.import_buffer("buffer", 64, Entry::Defined, Exit::Keep);
    let (uniform, target) = (AccessKind::Uniform, AccessKind::CopyTarget);
    type Call = fn(&mut PassBuilder<'_>, Texture, Texture, Buffer) -> Result<(), DeclareError>;
    let calls: [(AccessKind, Call); 4] = [
        (AccessKind::Color, |p, _, b, _| p.color(b, BLACK).map(drop)),
        (AccessKind::Sampled, |p, a, _, _| p.sampled(a).map(drop)),
        (AccessKind::StorageWrite, |p, _, b, _| p.storage_write(b, Intent::Overwrite).map(drop)),
        (AccessKind::Uniform, |p, _, _, buffer| p.read_buffer(buffer, AccessKind::Uniform).map(drop)),
    ];
    for (kind, call) in calls {
        let error = g.add_fn("mixed", |p| p.copy_source(a).and(call(p, a, b, buffer))).unwrap_err();
        let reason = DeclareReason::MixedKinds { earlier: AccessKind::CopySource, of: "a".into(), later: kind };
        assert_eq!(error.reason, reason);
        assert_eq!(name(&error.pass), "mixed");
        let error = g.add_fn("mixed", |p| call(p, a, b, buffer).and(p.copy_source(a).map(drop))).unwrap_err();
        assert!(
            matches!(&error.reason, DeclareReason::MixedKinds { earlier, later: AccessKind::CopySource, .. } if *earlier == kind),
            "{error}"
        );
        assert_eq!((name(&error.pass), name(&error.resource)), ("mixed", "a"));
        assert!(error.to_string().ends_with("move the copies to a separate pass"), "{error}");
    }
    let error = g.add_fn("mixed", |p| {
        p.read_buffer(buffer, uniform)?;
        p.write_buffer(buffer, target, Intent::Overwrite)
    });
    assert!(matches!(reason(error), DeclareReason::Conflict { .. }), "the more specific error is reported");
    assert_eq!(g.passes().len(), 0);
    g.add_fn("copy", |p| p.copy_source(a).and(p.copy_target(b, Intent::Overwrite))).expect("copies can share a pass");
    assert_eq!(g.passes()[0].kind, PassKind::Copy);
}
