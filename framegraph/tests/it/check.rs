//! The oracle and the compiler agree: the smallest graphs of each kind of fault that the oracle ever found in the compiler,
//! and what it says about plans that are fine.

use crate::support::*;
use framegraph::*;

/// A plan that the oracle has nothing to say against.
#[track_caller]
fn clean(graph: &Graph, caps: &Caps) -> Plan {
    let plan = plan(graph, caps);
    let report = check::examine(&plan);
    assert!(report.is_clean(), "{report}\n{}", dump::text(&plan));
    plan
}

fn usage(plan: &Plan, resource: &str) -> Usage {
    let id = plan.graph().find_resource(resource).expect("it exists");
    plan.resources()[id.index()].usage
}

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
    g.export(t);
    let plan = clean(&g, &Caps::wgpu());
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
    g.export(t);
    g.export(z);
    let plan = clean(&g, &Caps::wgpu());
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
    g.export(frame.1);
    g.add_fn("keep", |p| {
        p.side_effect();
        p.sampled(frame.0).map(drop)
    })
    .unwrap();
    for caps in [Caps::wgpu(), Caps::tiler()] {
        clean(&g, &caps);
    }
}

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

/// A scene that takes an epilogue, and a point-wise pass that wants to be one.
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
    g.export(graded);
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
        let plan = clean(&graph, &Caps::wgpu());
        let grade = graph.find_pass("grade").unwrap();
        let found = plan.reasons(Subject::Pass(grade)).find_map(|r| match r {
            Reason::NotInlined(_, why) => Some(why),
            _ => None,
        });
        assert_eq!(found, Some(refusal), "{}", dump::text(&plan));
    }
    let both_sample = epilogue(|p, _| draw(p, hdr()), |p, _, _| draw(p, color(Format::Rgba8Unorm)));
    assert_eq!(clean(&both_sample, &Caps::wgpu()).counts().inlined, 1);
}

#[test]
fn who_reads_an_intermediate_in_the_tile_keeps_it_from_vanishing() {
    // On a device with both: `look` would read graded colors where it wants the scene's.
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
        g.export(out);
    }
    let caps = Caps { inline: true, ..Caps::tiler() };
    assert_eq!(clean(&g, &caps).counts().inlined, 0);
}

#[test]
fn a_culled_writer_hides_what_it_writes_over() {
    let mut g = Graph::new();
    let t = g.texture("t", hdr());
    let t = g.add_fn("first", |p| p.color(t, BLACK)).unwrap();
    let t = g.add_fn("second", |p| p.color(t, BLACK)).unwrap();
    g.add_fn("reader", |p| p.sampled(t).map(drop)).unwrap();
    let plan = clean(&g, &Caps::wgpu());
    let id = |name| g.find_pass(name).unwrap();
    let t = g.find_resource("t").unwrap();
    let expected = Reason::CulledOverwritten(t, id("second"));
    assert_eq!(plan.verdict(id("first")), Some(expected));
    let expected = Reason::CulledReaderCulled(t, id("reader"));
    assert_eq!(plan.verdict(id("second")), Some(expected));
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
    let plan = clean(&g, &Caps::wgpu());
    assert_eq!(placement(&plan, "ds"), Placement::Memoryless);
    assert_eq!(plan.counts().discards, 1);
    let plan = clean(&g, &Caps::desktop());
    assert_eq!(plan.counts().discards, 1, "whichever plane is dropped");
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
    g.export(ds);
    let plan = clean(&g, &Caps::wgpu());
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
    clean(&g, &Caps::wgpu());
    let caps = Caps { sample_read_only_depth: false, ..Caps::wgpu() };
    let outcome = compile(&g, &caps, &options(), &mut Scratch::new(), &mut Plan::new());
    let errors = outcome.expect_err("the device cannot").0;
    let access = "sampled";
    assert_eq!(errors[0].reason, CompileReason::SampledDepth { access });
    assert_eq!((&*errors[0].pass, &*errors[0].resource), ("fog", "z"));
}

#[test]
fn a_same_pixel_read_has_the_size_of_the_attachments_and_one_level() {
    let mut g = Graph::new();
    let out = screen(&mut g);
    let desc = hdr().extent(Extent::fraction(2)).mips(2);
    let half = g.import_texture("half", desc, Entry::Defined, Exit::Keep);
    let refused = g.add_fn("levels", |p| p.same_pixel(half));
    let refused = refused.map(drop).expect_err("two levels are no texel");
    let access = "same_pixel";
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
fn an_empty_plan_is_not_a_plan() {
    let report = check::examine(&Plan::new());
    assert_eq!(report.violations.len(), 1, "{report}");
    assert_eq!(report.violations[0].rule, check::Rule::Structure);
    let empty = plan(&Graph::new(), &Caps::wgpu());
    assert_eq!(check(&empty), Ok(()));
}

#[test]
fn the_frames_of_the_other_tests_are_clean() {
    for caps in [Caps::wgpu(), Caps::tiler(), Caps::desktop()] {
        clean(&crate::merging::deferred(), &caps);
    }
}

#[test]
fn a_barrier_lets_every_reader_through() {
    // Written by compute, then sampled by a raster pass and by a compute pass: one layout, two stages.
    let mut g = Graph::new();
    let t = g.texture("t", hdr());
    let t = g.add_fn("write", |p| p.storage_write(t, Intent::Overwrite)).unwrap();
    let shown = filter(&mut g, "show", t, Format::R8Unorm);
    g.export(shown);
    let b = g.buffer("histogram", 64);
    let b = g
        .add_fn("count", |p| {
            p.sampled(t)?;
            p.write_buffer(b, AccessKind::StorageWrite, Intent::Overwrite)
        })
        .unwrap();
    g.export_buffer(b);
    let plan = clean(&g, &Caps::desktop());
    let t = g.find_resource("t").unwrap();
    let of_t: Vec<_> = plan.barriers().iter().filter(|b| b.resource == t).collect();
    assert_eq!(of_t.len(), 2, "one before the write, one before the reads");
    let stages = Stages::SHADER.union(Stages::COMPUTE);
    assert_eq!((of_t[1].to, of_t[1].to_stages), (State::Sampled, stages));
}

#[test]
fn a_buffer_that_takes_memory_over_waits_for_it() {
    let mut g = Graph::new();
    let end = g.buffer("end", 16);
    let mut end = g.add_fn("start", |p| p.write_buffer(end, AccessKind::StorageWrite, Intent::Overwrite)).unwrap();
    for name in ["first", "second"] {
        let b = g.buffer(name, 64);
        let b = g.add_fn(name, |p| p.write_buffer(b, AccessKind::StorageWrite, Intent::Overwrite)).unwrap();
        end = g
            .add_fn("sum", |p| {
                p.read_buffer(b, AccessKind::Uniform)?;
                p.write_buffer(end, AccessKind::StorageWrite, Intent::Modify)
            })
            .unwrap();
    }
    g.export_buffer(end);
    let plan = clean(&g, &Caps::desktop());
    let id = |name| g.find_resource(name).unwrap();
    assert_eq!(placement(&plan, "first"), placement(&plan, "second"));
    let mut of_second = plan.barriers().iter().filter(|b| b.resource == id("second"));
    let first_use = of_second.next().expect("the memory is waited for");
    assert_eq!(first_use.hand_over, id("first"));
    assert_eq!(first_use.from_stages, Stages::COMPUTE);
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

#[test]
fn the_frames_of_the_repository_are_clean_under_every_switch() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/cases");
    let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    paths.retain(|p| p.extension().is_some_and(|e| e == "ron"));
    paths.sort();
    assert!(paths.len() >= 5, "{paths:?}");
    for path in paths {
        let text = std::fs::read_to_string(&path).unwrap();
        let name = path.display().to_string();
        let file = file::GraphFile::parse(&name, &text).unwrap_or_else(|e| panic!("{e}"));
        let graph = file.graph(&[]).unwrap_or_else(|e| panic!("{e}"));
        for (preset, number) in Caps::PRESETS.iter().cycle().zip((0..generate::OPTIONS).step_by(7)) {
            let frame = file.frame().unwrap_or([1920, 1080]);
            let options = Options { frame, ..generate::options_of(number) };
            let plan = plan_with(&graph, &Caps::preset(preset).unwrap(), &options);
            let report = check::examine(&plan);
            assert!(report.is_clean(), "{name}, {preset}, {options:?}\n{report}");
        }
    }
}
