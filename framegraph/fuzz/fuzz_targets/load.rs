//! Parses random text as a graph file and as a device. Parsing must report errors or succeed; a parsed graph must be
//! rejected by the compiler or planned correctly. Writing, parsing and writing again must give equal text.
//!
//! `tests/cases` contains good seeds.
#![no_main]

use framegraph::file::{self, GraphFile};
use framegraph::{Caps, Options, Order, Plan, Scratch, compile, dump};
use framegraph_check::check;
use framegraph_check::generate::{self, Entropy, Profile};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let device = file::caps("fuzz.ron", text);
    let Ok(file) = GraphFile::parse("fuzz.ron", text) else {
        if let Ok(caps) = device {
            plan_something(&caps);
        }
        return;
    };
    let all = |on: bool| -> Vec<_> { file.features().iter().map(|(name, _)| (name.clone(), on)).collect() };
    for switches in [Vec::new(), all(true), all(false)] {
        let Ok(graph) = file.graph(&switches) else { continue };
        let written = file::to_ron(&graph, file.name(), file.frame().unwrap_or([0, 0]));
        let again = GraphFile::parse("again.ron", &written).unwrap_or_else(|e| panic!("{e}\n{written}"));
        let graph_again = again.graph(&[]).unwrap_or_else(|e| panic!("{e}\n{written}"));
        assert_eq!(file::to_ron(&graph_again, file.name(), file.frame().unwrap_or([0, 0])), written);
        let frame = file.frame().unwrap_or([64, 32]);
        let options = Options { frame, budget_steps: 2000, ..Options::default() };
        for caps in Caps::PRESETS.iter().filter_map(|name| Caps::preset(name)) {
            for order in [Order::Declared, Order::Optimized] {
                let mut plan = Plan::new();
                match compile(&graph, &caps, &Options { order, ..options }, &mut Scratch::new(), &mut plan) {
                    Ok(()) => {
                        let report = check::examine(&plan);
                        assert!(report.is_clean(), "{report}\n{}", dump::text(&plan));
                    }
                    Err(errors) => assert!(!file.explain(&errors).listed.is_empty()),
                }
            }
        }
    }
});

/// Compiles a random graph for a device that was read from a file. It must be rejected or planned correctly.
fn plan_something(caps: &Caps) {
    let graph = generate::graph(&mut Entropy::seeded(5), &Profile::default());
    let mut plan = Plan::new();
    if compile(&graph, caps, &generate::options_of(32), &mut Scratch::new(), &mut plan).is_ok() {
        let report = check::examine(&plan);
        assert!(report.is_clean(), "{report}\n{caps:?}\n{}", dump::text(&plan));
    }
}
