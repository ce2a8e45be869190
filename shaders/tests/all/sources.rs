//! The embedded table against the folder, and the rules that resolution relies on.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use framegraph_shaders::library::{SOURCES, text};
use framegraph_shaders::{Features, Module, resolve};

fn wgsl_files() -> Vec<String> {
    fn walk(folder: &Path, out: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                walk(&path, out);
            } else {
                out.push(path);
            }
        }
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("wgsl");
    let mut paths = Vec::new();
    walk(&root, &mut paths);
    let relative = paths.iter().map(|path| {
        let path = path.strip_prefix(&root).unwrap();
        path.iter().map(|part| part.to_str().unwrap()).collect::<Vec<_>>().join("/")
    });
    let mut files: Vec<String> = relative.collect();
    files.sort();
    files
}

#[test]
fn the_table_lists_every_file_once_and_in_order() {
    let listed: Vec<&str> = SOURCES.iter().map(|source| source.path).collect();
    let found = wgsl_files();
    assert!(found.len() > 20, "the folder was not found");
    assert_eq!(listed, found);
    for path in listed {
        assert!(text(path).is_some(), "{path} cannot be looked up");
    }
}

/// (keyword, name) of what is declared at module scope, where lines are not indented.
pub fn declarations(text: &str) -> Vec<(&str, &str)> {
    let named = text.lines().filter_map(|line| {
        // Attributes come first; `@group(0) @binding(0) var<uniform> frame: …`.
        let line = line.rfind(") var").map_or(line, |at| &line[at + 2..]);
        let keywords = ["fn", "struct", "const", "override", "alias", "var"];
        let keyword = keywords.into_iter().find(|k| line.starts_with(k))?;
        let rest = line[keyword.len()..].trim_start_matches(|c: char| c != ' ').strip_prefix(' ')?;
        let rest = rest.split_once("> ").filter(|_| line.contains("var<")).map_or(rest, |r| r.1);
        let name = rest.split(|c: char| c != '_' && !c.is_ascii_alphanumeric()).next()?;
        Some((keyword, name))
    });
    named.collect()
}

#[test]
fn declarations_are_found_in_every_spelling() {
    let text = "const A: u32 = 1u;\nfn f(x: f32) -> f32 {\n    let no = 1;\n}\n\
                @group(0) @binding(1) var<storage, read> lights: array<L>;\n\
                @group(0) @binding(2) var map: texture_2d<f32>;\nstruct S {\n";
    let expected = [("const", "A"), ("fn", "f"), ("var", "lights"), ("var", "map"), ("struct", "S")];
    assert_eq!(declarations(text), expected);
}

#[test]
fn shared_names_are_unique() {
    // The resolver keeps names as written, so two modules must not declare the same one.
    let mut owners: BTreeMap<&str, &str> = BTreeMap::new();
    for source in SOURCES.iter().filter(|source| !source.path.starts_with("pass/")) {
        for (_, name) in declarations(source.wgsl) {
            if let Some(other) = owners.insert(name, source.path) {
                assert_eq!(other, source.path, "`{name}` is declared in both");
            }
        }
    }
    assert!(owners.len() > 60, "only {} names were found", owners.len());
}

#[test]
fn library_functions_are_pure() {
    for source in SOURCES.iter().filter(|source| source.path.starts_with("lib/")) {
        for forbidden in ["@group", "override ", "var<private>", "texture", "package::interface"] {
            let code = source.wgsl.lines().filter(|line| !line.trim_start().starts_with("//"));
            for line in code {
                assert!(!line.contains(forbidden), "{}: {line}", source.path);
            }
        }
    }
}

#[test]
fn every_file_says_what_it_is_and_stays_small() {
    for source in SOURCES {
        let (path, lines) = (source.path, source.wgsl.lines().count());
        assert!(source.wgsl.starts_with("// "), "{path} begins with its purpose");
        assert!(lines <= 400, "{path} has {lines} lines");
        assert!(source.wgsl.lines().all(|line| line.chars().count() <= 100), "{path} is too wide");
    }
}

#[test]
fn every_library_function_is_reached_by_a_pass_or_offered_to_custom_ones() {
    // Some functions are only for shaders of applications; each still resolves.
    for source in SOURCES.iter().filter(|source| source.path.starts_with("lib/")) {
        let module = source.path.trim_start_matches("lib/").trim_end_matches(".wgsl");
        for (keyword, name) in declarations(source.wgsl) {
            if keyword == "fn" {
                let own = format!(
                    "import package::lib::{module}::{name};\n\
                     @compute @workgroup_size(1) fn main() {{}}\n"
                );
                let shader = resolve(&Module::new("own.wgsl", &own), &Features::NONE, &[]);
                assert!(shader.is_ok(), "{module}::{name}: {:?}", shader.err());
            }
        }
    }
}
