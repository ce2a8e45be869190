//! Oracle and compiler agree on the smallest graph of each kind of error that the oracle found in the compiler, and on
//! correct plans.

mod attachments;
mod epilogues;
mod resolves;
mod same_pixel;

use crate::support::*;
use framegraph::*;
use framegraph_check::check;
use framegraph_check::generate;

/// Returns a plan without findings of the oracle.
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

#[test]
fn a_culled_writer_hides_what_it_writes_over() {
    let mut g = Graph::new();
    let t = g.texture("t", hdr());
    let t = g.add_fn("first", |p| p.color(t, BLACK)).unwrap();
    let t = g.add_fn("second", |p| p.color(t, BLACK)).unwrap();
    g.add_fn("reader", |p| p.sampled(t).map(drop)).unwrap();
    let plan = clean(&g, &wgpu());
    let id = |name| g.find_pass(name).unwrap();
    let t = g.find_resource("t").unwrap();
    let expected = Reason::CulledOverwritten(t, id("second"));
    assert_eq!(plan.verdict(id("first")), Some(expected));
    let expected = Reason::CulledReaderCulled(t, id("reader"));
    assert_eq!(plan.verdict(id("second")), Some(expected));
}

#[test]
fn an_empty_plan_is_not_a_plan() {
    let report = check::examine(&Plan::new());
    assert_eq!(report.violations.len(), 1, "{report}");
    assert_eq!(report.violations[0].rule, check::Rule::Structure);
    let empty = plan(&Graph::new(), &wgpu());
    assert_eq!(check(&empty), Ok(()));
}

#[test]
fn the_frames_of_the_other_tests_are_clean() {
    for caps in [wgpu(), Caps::tiler(), Caps::desktop()] {
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
    g.export(shown).unwrap();
    let b = g.buffer("histogram", 64);
    let b = g
        .add_fn("count", |p| {
            p.sampled(t)?;
            p.write_buffer(b, AccessKind::StorageWrite, Intent::Overwrite)
        })
        .unwrap();
    g.export_buffer(b).unwrap();
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
    g.export_buffer(end).unwrap();
    let plan = clean(&g, &Caps::desktop());
    let id = |name| g.find_resource(name).unwrap();
    assert_eq!(placement(&plan, "first"), placement(&plan, "second"));
    let mut of_second = plan.barriers().iter().filter(|b| b.resource == id("second"));
    let first_use = of_second.next().expect("the first use has a barrier");
    assert_eq!(first_use.aliases, id("first"));
    assert_eq!(first_use.from_stages, Stages::COMPUTE);
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
        for (preset, number) in
            Caps::PRESETS.iter().filter(|name| **name != "wgpu").cycle().zip((0..generate::OPTIONS).step_by(7))
        {
            let frame = file.frame().unwrap_or([1920, 1080]);
            let options = Options { frame, ..generate::options_of(number) };
            let plan = plan_with(&graph, &Caps::preset(preset).unwrap(), &options);
            let report = check::examine(&plan);
            assert!(report.is_clean(), "{name}, {preset}, {options:?}\n{report}");
        }
    }
}

#[test]
fn a_volume_has_more_levels_than_its_depth_has_bits() {
    let mut g = Graph::new();
    let desc = TextureDesc::new(Extent::absolute(2048, 1), Format::R8Unorm).layers(64).mips(TextureDesc::ALL_MIPS);
    let volume =
        g.import_texture("volume", TextureDesc { dimension: Dimension::D3, ..desc }, Entry::Defined, Exit::Keep);
    g.add_fn("look", |p| {
        p.side_effect();
        p.sampled(volume).map(drop)
    })
    .unwrap();
    clean(&g, &wgpu());
}
