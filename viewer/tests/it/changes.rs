//! Comparison of plans equals the comparison of the library.

use crate::case;
use framegraph::file::GraphFile;
use framegraph::{Alias, Caps, Options, Plan, Scratch};
use viewer::plan_data::PlanData;
use viewer::view::diff::{changes, drawing};

fn plan(name: &str, caps: &Caps, switches: &[(&str, bool)], frame: [u32; 2]) -> Plan {
    let text = std::fs::read_to_string(case(name)).expect("the case");
    let file = GraphFile::parse(name, &text).expect("the case is sound");
    let switches: Vec<_> = switches.iter().map(|(name, on)| ((*name).to_owned(), *on)).collect();
    let graph = file.graph(&switches).expect("the case is sound");
    let options = Options { frame, alias: Alias::Heap, ..Options::default() };
    let mut plan = Plan::new();
    framegraph::compile(&graph, caps, &options, &mut Scratch::new(), &mut plan).expect("a plan");
    plan
}

#[test]
fn plans_differ_as_the_library_says() {
    let small = [640, 360];
    let plans = [
        plan("filament", &Caps::tiler(), &[], small),
        plan("filament", &Caps::tiler(), &[("sao", true), ("msaa", true)], small),
        plan("filament", &Caps::wgpu(), &[("taa", true), ("fxaa", false)], small),
        plan("filament", &Caps::desktop(), &[("shadows", true)], [1280, 720]),
        plan("diamond", &Caps::tiler(), &[], small),
    ];
    let data = plans.each_ref().map(|plan| PlanData::of(plan, "frame").expect("the text is read back"));
    for (before, b) in plans.iter().zip(&data) {
        for (after, a) in plans.iter().zip(&data) {
            let (library, ours) = (framegraph::diff(before, after), changes(b, a));
            assert_eq!(ours.passes_added, library.passes_added);
            assert_eq!(ours.passes_removed, library.passes_removed);
            assert_eq!(ours.resources_added, library.resources_added);
            assert_eq!(ours.resources_removed, library.resources_removed);
            let culls: Vec<_> = library.culls.iter().map(|c| (c.pass.clone(), c.culled, c.reason.clone())).collect();
            assert_eq!(ours.culls, culls);
            let merges = library.merges.iter().map(|m| (m.what.clone(), m.before.clone(), m.after.clone()));
            assert_eq!(ours.merges, merges.collect::<Vec<_>>());
            let totals: Vec<_> = ours.totals.iter().map(|(name, was, is, _)| ((*name).to_owned(), *was, *is)).collect();
            let theirs = library.totals.iter().map(|t| (t.what.clone(), t.before, t.after));
            assert_eq!(totals, theirs.collect::<Vec<_>>());
            let names: Vec<_> = ours.resources.iter().map(|(name, ..)| name.clone()).collect();
            assert_eq!(names, library.resources.iter().map(|r| r.what.clone()).collect::<Vec<_>>());
        }
    }
    let words = drawing(Some(&data[0]), &data[1]).words();
    for part in ["added passes", "+ structure/4", "changed resources", "multisample resolves"] {
        assert!(words.contains(part), "{part}: {words}");
    }
    assert!(drawing(Some(&data[0]), &data[0]).words().contains("no differences"));
}
