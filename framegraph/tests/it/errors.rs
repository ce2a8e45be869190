//! Errors of whole graphs: each error of the validation phase, and all of them at once.

use crate::support::*;
use framegraph::*;

#[test]
fn reading_what_nobody_wrote_names_the_later_writer() {
    let mut g = Graph::new();
    let a = g.texture("a", hdr());
    let out = filter(&mut g, "early", a, Format::R8Unorm);
    g.export(out).unwrap();
    let _ = g.add_fn("late", |p| p.color(a, BLACK)).unwrap();
    let e = errors(&g);
    assert_eq!(e.len(), 1);
    assert_eq!((name(&e[0].pass), name(&e[0].resource)), ("early", "a"));
    assert_eq!(
        e[0].reason,
        CompileReason::ReadUnwritten { access: Some(AccessKind::Sampled), later_writer: Some("late".into()) }
    );
}

#[test]
fn a_part_that_nobody_wrote_is_found() {
    let mut g = Graph::new();
    let a = g.texture("a", hdr().layers(2));
    let a = g.add_fn("one", |p| p.color(a.layer(0), BLACK)).unwrap();
    let out = filter(&mut g, "both", a, Format::R8Unorm);
    g.export(out).unwrap();
    assert!(matches!(errors(&g)[0].reason, CompileReason::ReadUnwritten { .. }));
}

#[test]
fn exporting_what_nobody_wrote_is_an_error() {
    let mut g = Graph::new();
    let a = g.texture("a", hdr());
    g.export(a).unwrap();
    assert!(matches!(errors(&g)[0].reason, CompileReason::ReadUnwritten { access: None, .. }));
}

#[test]
fn attachments_must_fit_each_other() {
    let mut g = Graph::new();
    let half = TextureDesc::new(Extent::fraction(2), Format::Depth32Float);
    let (c, z) = (g.texture("c", hdr()), g.texture("z", half));
    let c = g
        .add_fn("sizes", |p| {
            p.depth(z, FAR)?;
            p.color(c, BLACK)
        })
        .unwrap();
    g.export(c).unwrap();
    let (ms, one) = (g.texture("ms", hdr().samples(4)), g.texture("one", depth()));
    let ms = g
        .add_fn("samples", |p| {
            p.depth(one, FAR)?;
            p.color(ms, BLACK)
        })
        .unwrap();
    let into = g.texture("into", color(Format::Rgba8Unorm));
    let single = g.texture("single", hdr());
    let _ = g
        .add_fn("resolve", |p| {
            let ms = p.color(ms, Intent::Modify)?;
            p.resolve(ms, into)?;
            let single = p.color(single, BLACK)?;
            p.resolve(single, c)
        })
        .unwrap();
    let reasons: Vec<_> = errors(&g).into_iter().map(|e| (name(&e.pass).to_owned(), e.reason)).collect();
    let has = |pass: &str, fits: fn(&CompileReason) -> bool| reasons.iter().any(|(p, r)| p == pass && fits(r));
    assert!(has("sizes", |r| matches!(r, CompileReason::Extent { .. })), "{reasons:?}");
    assert!(has("samples", |r| matches!(r, CompileReason::Samples { .. })), "{reasons:?}");
    assert!(has("resolve", |r| matches!(r, CompileReason::Format { .. })), "{reasons:?}");
    assert!(has("resolve", |r| matches!(r, CompileReason::Samples { expected: 0, found: 1 })), "{reasons:?}");
}

#[test]
fn shapes_that_cannot_be_made_are_all_reported() {
    let mut g = Graph::new();
    let _ = g.texture("empty", TextureDesc::new(Extent::absolute(0, 4), Format::R8Unorm));
    let _ = g.texture("wide", TextureDesc::new(Extent::absolute(1 << 20, 4), Format::R8Unorm));
    let _ = g.texture("levels", TextureDesc::new(Extent::absolute(4, 4), Format::R8Unorm).mips(4));
    let _ = g.texture("samples", hdr().samples(3));
    let _ = g.texture("both", hdr().samples(4).mips(2));
    let _ = g.buffer("nothing", 0);
    let _ = g.buffer("huge", 1 << 40);
    let found: Vec<_> = errors(&g).into_iter().map(|e| name(&e.resource).to_owned()).collect();
    assert_eq!(found, ["empty", "wide", "levels", "samples", "both", "nothing", "huge"]);
}

#[test]
fn more_parts_than_can_be_followed_are_refused() {
    // 65535 layers of 15 levels each. 18 of them exceed 2^24 parts.
    let desc = TextureDesc::new(Extent::absolute(1 << 14, 1 << 14), Format::R8Unorm).layers(u16::MAX).mips(0);
    let mut g = Graph::new();
    for index in 0..17 {
        let _ = g.import_texture(&format!("array{index}"), desc, Entry::Defined, Exit::Keep);
    }
    let caps = Caps { max_texture_layers: u32::from(u16::MAX), ..wgpu() };
    compile(&g, &caps, &options(), &mut Scratch::new(), &mut Plan::new()).expect("17 are within the limit");
    for index in 17..40 {
        let _ = g.import_texture(&format!("array{index}"), desc, Entry::Defined, Exit::Keep);
    }
    let refused = compile(&g, &caps, &options(), &mut Scratch::new(), &mut Plan::new());
    let found = refused.expect_err("40 exceed the limit").listed;
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(name(&found[0].resource), "array17");
    assert!(
        found[0].to_string().contains("17694450 subresources (level, layer and plane), the maximum is 16777216"),
        "{}",
        found[0]
    );
}

#[test]
fn clear_values_must_fit() {
    let mut g = Graph::new();
    let (c, z) = (g.texture("c", hdr()), g.texture("z", depth()));
    let c = g
        .add_fn("swapped", |p| {
            p.depth(z, BLACK)?;
            p.color(c, FAR)
        })
        .unwrap();
    g.export(c).unwrap();
    let z = g.texture("nan", depth());
    let z = g.add_fn("nan", |p| p.depth(z, Intent::Clear(ClearValue::DepthStencil(f32::NAN, 0)))).unwrap();
    g.export(z).unwrap();
    let found: Vec<_> = errors(&g)
        .into_iter()
        .map(|e| (name(&e.resource).to_owned(), matches!(e.reason, CompileReason::ClearValue { .. })))
        .collect();
    assert_eq!(found, [("z".into(), true), ("c".into(), true), ("nan".into(), true)]);
    let message = errors(&g)[2].to_string();
    assert!(message.contains("cleared to depth NaN and stencil 0, which Depth32Float cannot represent"), "{message}");
}

#[test]
fn errors_of_calls_without_a_result_are_reported_by_compiling() {
    let mut g = Graph::new();
    g.history("taa", hdr(), 0);
    let never_written = g.texture("a", hdr());
    let out = filter(&mut g, "early", never_written, Format::R8Unorm);
    g.export(out).unwrap();
    // Listed together with errors of compiling.
    let e = errors(&g);
    assert!(matches!(&e[0].reason, CompileReason::Declare(d) if d.reason == DeclareReason::EmptyHistory), "{e:?}");
    assert!(matches!(&e[1].reason, CompileReason::ReadUnwritten { .. }), "{e:?}");
}

#[test]
fn a_stale_export_is_refused_on_the_spot() {
    let mut g = Graph::new();
    let a = g.texture("a", hdr());
    let _ = g.add_fn("write", |p| p.color(a, BLACK)).unwrap();
    let refused = g.export(a).unwrap_err();
    assert_eq!(refused.reason, DeclareReason::Stale { writer: "write".into(), user: StaleUser::Graph });
    assert!(g.exports().is_empty() && refused.to_string().contains("errors.rs"), "{refused}");
}

#[test]
fn every_error_is_one_line_with_a_hint() {
    let mut g = Graph::new();
    let a = g.texture("a", hdr());
    let out = filter(&mut g, "early", a, Format::R8Unorm);
    g.export(out).unwrap();
    let line = errors(&g)[0].to_string();
    assert!(line.contains("`early`") && line.contains("`a`") && line.contains("; ") && !line.contains('\n'), "{line}");
}
