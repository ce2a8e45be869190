//! Point-wise passes that would access the wrong contents as an epilogue, and therefore stay passes.

use super::clean;
use crate::support::*;
use framegraph::*;

/// Returns a scene that accepts an epilogue, and a point-wise pass.
fn epilogue(
    scene: impl FnOnce(&mut PassBuilder<'_>, &mut Option<Buffer>) -> Result<Texture, DeclareError>,
    grade: impl FnOnce(&mut PassBuilder<'_>, Texture, Option<Buffer>) -> Result<Texture, DeclareError>,
) -> Graph {
    let mut g = Graph::new();
    let mut histogram = None;
    let drawn = g
        .add_fn("scene", |p| {
            p.takes_epilogue();
            scene(p, &mut histogram)
        })
        .unwrap();
    let graded = g
        .add_fn("grade", |p| {
            p.pointwise();
            p.same_pixel(drawn)?;
            grade(p, drawn, histogram)
        })
        .unwrap();
    g.export(graded).unwrap();
    g
}

fn draw(p: &mut PassBuilder<'_>, desc: TextureDesc) -> Result<Texture, DeclareError> {
    let t = p.texture("t", desc);
    p.color(t, BLACK)
}

#[test]
fn unsound_epilogues_are_refused() {
    let graphs = [
        (Refusal::NeverMerge, {
            epilogue(
                |p, _| draw(p, hdr()),
                |p, _, _| {
                    p.never_merge();
                    draw(p, hdr())
                },
            )
        }),
        (Refusal::SideEffect, {
            epilogue(
                |p, _| draw(p, hdr()),
                |p, _, _| {
                    p.side_effect();
                    draw(p, hdr())
                },
            )
        }),
        (Refusal::BuildsOnContents, {
            epilogue(
                |p, _| draw(p, hdr()),
                |p, _, _| {
                    p.blends();
                    draw(p, hdr())
                },
            )
        }),
        (Refusal::TargetShape, { epilogue(|p, _| draw(p, hdr().samples(4)), |p, _, _| draw(p, hdr())) }),
        (Refusal::TargetShape, { epilogue(|p, _| draw(p, hdr()), |p, _, _| draw(p, hdr().layers(2))) }),
        (Refusal::SampledElsewhere, {
            epilogue(
                |p, histogram| {
                    let buffer = p.buffer("histogram", 64);
                    let kind = AccessKind::StorageWrite;
                    *histogram = Some(p.write_buffer(buffer, kind, Intent::Overwrite)?);
                    draw(p, hdr())
                },
                |p, _, histogram| {
                    if let Some(histogram) = histogram {
                        p.read_buffer(histogram, AccessKind::Uniform)?;
                    }
                    draw(p, hdr())
                },
            )
        }),
        (Refusal::TooManyAttachments, {
            epilogue(
                |p, _| {
                    let t = draw(p, color(Format::Rgba8Unorm))?;
                    for _ in 0..3 {
                        draw(p, color(Format::Rgba8Unorm))?;
                    }
                    Ok(t)
                },
                |p, _, _| draw(p, color(Format::Rgba32Float)),
            )
        }),
    ];
    for (refusal, graph) in graphs {
        let plan = clean(&graph, &wgpu());
        let grade = graph.find_pass("grade").unwrap();
        let found = plan.reasons(Subject::Pass(grade)).find_map(|r| match r {
            Reason::NotInlined(_, why) => Some(why),
            _ => None,
        });
        assert_eq!(found, Some(refusal), "{}", dump::text(&plan));
    }
    let both_sample = epilogue(|p, _| draw(p, hdr()), |p, _, _| draw(p, color(Format::Rgba8Unorm)));
    assert_eq!(clean(&both_sample, &wgpu()).counts().inlined, 1);
}

#[test]
fn who_reads_an_intermediate_in_the_tile_keeps_it_from_vanishing() {
    // On a device with both: `look` would read graded colors instead of the scene's.
    let mut g = Graph::new();
    let scene = g.texture("scene", hdr());
    let scene = g
        .add_fn("draw", |p| {
            p.takes_epilogue();
            p.color(scene, BLACK)
        })
        .unwrap();
    for (name, pointwise) in [("look", false), ("grade", true)] {
        let out = g.texture(name, hdr());
        let out = g
            .add_fn(name, |p| {
                if pointwise {
                    p.pointwise();
                }
                p.same_pixel(scene)?;
                p.color(out, Intent::Overwrite)
            })
            .unwrap();
        g.export(out).unwrap();
    }
    let caps = Caps { inline: true, ..Caps::tiler() };
    assert_eq!(clean(&g, &caps).counts().inlined, 0);
}
