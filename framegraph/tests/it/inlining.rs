//! Point-wise passes as epilogues: when they are inlined, and why not.

use crate::support::*;
use framegraph::*;
use framegraph_check::check;

struct Case {
    samples: u8,
    blends: bool,
    takes_epilogue: bool,
    other_reader: bool,
    pointwise: bool,
}

const SOUND: Case = Case { samples: 1, blends: false, takes_epilogue: true, other_reader: false, pointwise: true };

fn frame(case: &Case) -> Graph {
    let mut g = Graph::new();
    let out = screen(&mut g);
    let scene = g
        .add_fn("scene", |p| {
            if case.takes_epilogue {
                p.takes_epilogue();
            }
            if case.blends {
                p.blends();
            }
            let z = p.texture("depth", depth().samples(case.samples));
            p.depth(z, FAR)?;
            let scene = p.texture("hdr", hdr());
            if case.samples == 1 {
                return p.color(scene, BLACK);
            }
            let ms = p.texture("hdr_ms", hdr().samples(case.samples));
            let ms = p.color(ms, BLACK)?;
            p.resolve(ms, scene)
        })
        .unwrap();
    g.add_fn("grade", |p| {
        if case.pointwise {
            p.pointwise();
        }
        p.same_pixel(scene)?;
        p.color(out, Intent::Overwrite)
    })
    .unwrap();
    if case.other_reader {
        let bloom = filter(&mut g, "bloom", scene, Format::R8Unorm);
        g.export(bloom).unwrap();
    }
    g
}

#[test]
fn grading_becomes_an_epilogue() {
    let p = plan(&frame(&SOUND), &wgpu());
    let c = p.counts();
    assert_eq!((c.steps, c.unresolves, c.resolves, c.inlined, c.memoryless), (1, 0, 1, 1, 1), "{}", dump::text(&p));
    assert_eq!(placement(&p, "hdr"), Placement::Inlined);
    assert_eq!(p.attachments_of(p.step_ids().next().unwrap()).len(), 2);
    assert_eq!(ops(&p, "screen"), [(LoadOp::Clear, StoreOp::Store)]);
    assert_eq!(p.step_passes()[1].join, Join::Inlined);
}

#[test]
fn with_multisampling_each_sample_is_graded_before_the_resolve() {
    let p = plan(&frame(&Case { samples: 4, ..SOUND }), &wgpu());
    let c = p.counts();
    assert_eq!((c.steps, c.unresolves, c.resolves, c.multisample_resolves), (1, 0, 1, 1), "{}", dump::text(&p));
    assert_eq!((placement(&p, "hdr"), placement(&p, "hdr_ms")), (Placement::Inlined, Placement::Memoryless));
    let ms = p.graph().find_resource("hdr_ms").unwrap();
    assert_eq!(p.format(ms), Some(Format::Rgba8UnormSrgb), "the samples have the format of the target");
}

#[test]
fn unsound_cases_fall_back_with_a_reason() {
    let cases = [
        (Case { blends: true, ..SOUND }, Refusal::Blends),
        (Case { takes_epilogue: false, ..SOUND }, Refusal::NoEpilogue),
        (Case { other_reader: true, ..SOUND }, Refusal::NeededAsTexture),
    ];
    for (case, refusal) in cases {
        let p = plan(&frame(&case), &wgpu());
        let grade = p.graph().find_pass("grade").unwrap();
        let reason = p.reasons(Subject::Pass(grade)).find(|r| matches!(r, Reason::NotInlined(..)));
        let scene = p.graph().find_pass("scene").unwrap();
        assert_eq!(reason, Some(Reason::NotInlined(scene, refusal)));
        assert_eq!(p.counts().inlined, 0);
        assert!(matches!(placement(&p, "hdr"), Placement::Slot(_)));
    }
    let p = plan(&frame(&Case { pointwise: false, ..SOUND }), &wgpu());
    assert_eq!((p.counts().inlined, p.counts().steps), (0, 2));
    let p = plan_with(&frame(&SOUND), &wgpu(), &Options { inline: false, ..options() });
    assert_eq!((p.counts().inlined, p.counts().steps), (0, 2));
}

#[test]
fn chains_of_pointwise_passes_collapse() {
    let mut g = Graph::new();
    let out = screen(&mut g);
    let t = g.texture("hdr", hdr());
    let mut t = g
        .add_fn("scene", |p| {
            p.takes_epilogue();
            p.color(t, BLACK)
        })
        .unwrap();
    for name in ["expose", "grade"] {
        t = g
            .add_fn(name, |p| {
                p.pointwise();
                p.same_pixel(t)?;
                let next = p.texture(&format!("{name}d"), hdr());
                p.color(next, Intent::Overwrite)
            })
            .unwrap();
    }
    g.add_fn("tonemap", |p| {
        p.pointwise();
        p.same_pixel(t)?;
        p.color(out, Intent::Overwrite)
    })
    .unwrap();
    let p = plan(&g, &wgpu());
    assert_eq!(steps(&p), [["scene", "expose", "grade", "tonemap"]]);
    assert_eq!((p.counts().inlined, p.counts().resolves), (3, 1), "{}", dump::text(&p));
}

/// Two attachments of one texture, each with a layer, cannot become attachments of the target.
#[test]
fn layers_that_are_attached_one_by_one_are_not_inlined() {
    let frame = |apart: bool| {
        let mut g = Graph::new();
        let [drawn, target] = ["hdr", "target"].map(|name| g.texture(name, hdr().layers(2)));
        let drawn = g
            .add_fn("scene", |p| {
                p.takes_epilogue();
                if apart {
                    let drawn = p.color(drawn.layer(0), BLACK)?;
                    return p.color(drawn.layer(1), BLACK);
                }
                p.color(drawn, BLACK)
            })
            .unwrap();
        let target = g
            .add_fn("grade", |p| {
                p.pointwise();
                p.same_pixel(drawn)?;
                p.color(target, Intent::Overwrite)
            })
            .unwrap();
        g.export(target).unwrap();
        let plan = plan(&g, &Caps { max_attached_layers: 2, ..wgpu() });
        let report = check::examine(&plan);
        assert!(report.is_clean(), "{report}");
        plan.counts().inlined
    };
    assert_eq!((frame(false), frame(true)), (1, 0));
}
