//! Any text as a graph file: it is refused with errors, or read; what is read is refused by the compiler, or planned right.
//!
//! Good seeds: `tests/cases` of the repository.
#![no_main]

use framegraph::file::GraphFile;
use framegraph::{Caps, Options, Plan, Scratch, check, compile, dump};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let Ok(file) = GraphFile::parse("fuzz.ron", text) else { return };
    let Ok(graph) = file.graph(&[]) else { return };
    let options = Options { frame: file.frame().unwrap_or([64, 32]), budget_steps: 2000, ..Options::default() };
    for preset in Caps::PRESETS {
        let caps = Caps::preset(preset).unwrap_or_default();
        let mut plan = Plan::new();
        match compile(&graph, &caps, &options, &mut Scratch::new(), &mut plan) {
            Ok(()) => {
                let report = check::examine(&plan);
                assert!(report.is_clean(), "{report}\n{}", dump::text(&plan));
            }
            Err(errors) => assert!(!file.explain(&errors).0.is_empty()),
        }
    }
});
