//! Frames as data: every file in `cases/` must be planned as its `expect` section says.
//!
//! A case states the device, features that differ from the file's, order and size, then loads and stores, and
//! optionally other counts. `filament` has Filament's counts for the same passes. This compiler may be better but never
//! worse; the note gives the reason. The independent checker verifies every plan.

mod expect;

use expect::{Case, Field};
use framegraph::file::GraphFile;
use framegraph::{Caps, Options, Order, Plan, Scratch, compile};
use framegraph_check::check;
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("cases")
}

/// Returns paths and texts of all cases, sorted.
pub fn files() -> Vec<(String, String)> {
    let mut files: Vec<_> = std::fs::read_dir(folder())
        .expect("tests/cases is a folder")
        .map(|entry| entry.expect("the folder can be read").path())
        .filter(|path| path.extension().is_some_and(|e| e == "ron"))
        .collect();
    files.sort();
    let read = |path: PathBuf| {
        let text = std::fs::read_to_string(&path).expect("a case can be read");
        (path.file_name().unwrap_or_default().to_string_lossy().into_owned(), text)
    };
    files.into_iter().map(read).collect()
}

fn planned(file: &GraphFile<'_>, case: &Case) -> Plan {
    let graph = file.graph(&case.switches()).unwrap_or_else(|e| panic!("{e}"));
    let caps = Caps::preset(&case.caps).unwrap_or_else(|| panic!("{}: no preset", case.caps));
    let frame = case.size.map(|(w, h)| [w, h]).or(file.frame()).unwrap_or([1920, 1080]);
    let mut options = Options { frame, order: case.order, alias: case.alias, ..Options::default() };
    if case.plain {
        (options.merge, options.inline, options.memoryless) = (false, false, false);
    }
    let mut plan = Plan::new();
    compile(&graph, &caps, &options, &mut Scratch::new(), &mut plan).unwrap_or_else(|e| panic!("{}", file.explain(&e)));
    plan
}

pub fn cases_of(file: &GraphFile<'_>) -> Vec<Case> {
    let cases = file.expect::<Vec<Case>>().unwrap_or_else(|e| panic!("{e}"));
    cases.unwrap_or_default()
}

#[test]
fn every_frame_comes_to_the_counts_that_its_file_states() {
    let mut wrong = Vec::new();
    let mut stated = 0;
    for (path, text) in files() {
        let file = GraphFile::parse(&path, &text).unwrap_or_else(|e| panic!("{e}"));
        let cases = cases_of(&file);
        assert!(!cases.is_empty(), "{path} expects nothing");
        for case in cases {
            let plan = planned(&file, &case);
            let fields = case.fields(&plan);
            stated += fields.len();
            for Field { what, expected, found } in fields {
                if expected != found {
                    wrong.push(format!("{path}, {}: {what} {found}, expected {expected}", case.label()));
                }
            }
            if let Err(violations) = check(&plan) {
                let line = format!("{path}, {}: {} violations: {:?}", case.label(), violations.len(), violations[0]);
                wrong.push(line);
            }
            if let Some((loads, stores)) = case.filament {
                assert!(case.loads <= loads && case.stores <= stores, "{path}, {}: worse than Filament", case.label());
            }
            assert!(!case.note.is_empty() || case.plain, "{path}, {}: no note", case.label());
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(stated > 200, "only {stated} figures are stated");
}

#[test]
fn a_wrong_expectation_is_noticed() {
    let mut noticed = 0;
    for (path, text) in files() {
        let file = GraphFile::parse(&path, &text).unwrap_or_else(|e| panic!("{e}"));
        for case in cases_of(&file) {
            let plan = planned(&file, &case);
            for at in 0..case.fields(&plan).len() {
                let mutated = case.mutated(at);
                let differs = mutated.fields(&plan).iter().any(|f| f.expected != f.found);
                assert!(differs, "{path}, {}: field {at} is not looked at", case.label());
                noticed += 1;
            }
        }
    }
    assert!(noticed > 200, "only {noticed} figures were changed");
}

#[test]
fn combinations_of_features_plan_soundly_everywhere() {
    let mut plans = 0;
    for (path, text) in files() {
        let file = GraphFile::parse(&path, &text).unwrap_or_else(|e| panic!("{e}"));
        let features = file.features().to_vec();
        // Tests every combination of up to seven features, and a scattered eighth of the combinations of more.
        let scattered = |mask: &u32| features.len() < 8 || mask.wrapping_mul(0x9E37_79B9) >> 29 == 0;
        for mask in (0..1u32 << features.len()).filter(scattered) {
            let on = |bit: usize| mask >> bit & 1 == 1;
            let switches: Vec<_> = features.iter().enumerate().map(|(i, (name, _))| (name.clone(), on(i))).collect();
            // Some combinations leave a texture without a writer, or samples without a target: errors, never panics.
            let Ok(graph) = file.graph(&switches) else {
                continue;
            };
            for caps in Caps::PRESETS.iter().filter_map(|name| Caps::preset(name)) {
                for order in [Order::Declared, Order::Optimized] {
                    let options = Options { frame: [640, 360], order, ..Options::default() };
                    let mut plan = Plan::new();
                    if compile(&graph, &caps, &options, &mut Scratch::new(), &mut plan).is_ok() {
                        plans += 1;
                        let checked = check(&plan);
                        assert!(checked.is_ok(), "{path}, {switches:?}, {}: {checked:?}", caps.name);
                    }
                }
            }
        }
    }
    assert!(plans > 200, "only {plans} plans");
}

/// Returns a chain of `passes` passes as a file: each samples the output of the previous one.
fn chain(passes: usize) -> String {
    let mut text = String::from("(version: 1, resources: [\n");
    for i in 0..passes {
        text += &format!("Texture(name: \"t{i}\", format: Rgba8Unorm, size: Texels(256, 256)),\n");
    }
    text += "], passes: [\n";
    for i in 0..passes {
        let read = i.checked_sub(1).map(|before| format!("Sampled(of: \"t{before}\"), "));
        let read = read.unwrap_or_default();
        text += &format!("Raster(name: \"p{i}\", accesses: [{read}Color(to: \"t{i}\", intent: Overwrite)]),\n");
    }
    text + &format!("], exports: [Keep(of: \"t{}\")])", passes - 1)
}

/// The checker takes quadratic time, so its chain is shorter than the compiler's.
#[test]
fn a_chain_of_ten_thousand_passes_is_loaded_and_planned() {
    for (passes, checked) in [(10_000, false), (300, true)] {
        let text = chain(passes);
        let file = GraphFile::parse("chain.ron", &text).unwrap_or_else(|e| panic!("{e}"));
        let graph = file.graph(&[]).unwrap_or_else(|e| panic!("{e}"));
        let mut plan = Plan::new();
        compile(&graph, &Caps::wgpu(), &Options::default(), &mut Scratch::new(), &mut plan).expect("it compiles");
        let counts = plan.counts();
        let passes = passes as u32;
        assert_eq!((counts.steps, counts.resolves, counts.unresolves, counts.culled), (passes, passes, 0, 0));
        // Two textures share memory; the exported one has its own.
        assert_eq!((plan.slots().len(), plan.memory().bytes), (2, 2 * 256 * 256 * 4));
        assert!(!checked || check(&plan).is_ok());
    }
}
