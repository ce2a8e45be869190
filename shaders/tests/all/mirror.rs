//! Every function of `wgsl/lib/` has a case, and with it a mirror of the same name.

use std::collections::BTreeSet;
use std::path::Path;

use framegraph_shader_mirrors::cases;
use framegraph_shaders::library::SOURCES;

use crate::sources::declarations;

fn library_functions() -> BTreeSet<(String, String)> {
    let mut functions = BTreeSet::new();
    for source in SOURCES.iter().filter(|source| source.path.starts_with("lib/")) {
        let file = source.path.trim_start_matches("lib/").trim_end_matches(".wgsl");
        for (keyword, name) in declarations(source.wgsl) {
            if keyword == "fn" {
                functions.insert((file.to_owned(), name.to_owned()));
            }
        }
    }
    functions
}

#[test]
fn every_function_has_a_case_and_every_case_a_function() {
    let functions = library_functions();
    let listed: BTreeSet<(String, String)> =
        cases::all().map(|case| (case.file.to_owned(), case.function.to_owned())).collect();
    assert!(functions.len() > 50, "only {} functions were found", functions.len());
    assert_eq!(listed.len(), cases::all().count(), "a function is listed twice");
    let missing: Vec<_> = functions.difference(&listed).collect();
    let stale: Vec<_> = listed.difference(&functions).collect();
    assert!(missing.is_empty() && stale.is_empty(), "missing {missing:?}, stale {stale:?}");
}

#[test]
fn mirrors_have_the_file_and_function_names_of_the_library() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (file, function) in library_functions() {
        let [own, tested] = ["src/reference", "mirrors/src"].map(|folder| root.join(folder).join(format!("{file}.rs")));
        let path = if own.exists() { own } else { tested };
        let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        assert!(text.contains(&format!("pub fn {function}(")), "{file}.rs has no {function}");
    }
}
