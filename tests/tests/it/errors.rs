//! `Debug` of an error is its message, so that `unwrap()` and `main() -> Result` print it as `Display` does.

use framegraph::{Extent, Format, Graph, Intent, TextureDesc};
use std::error::Error;
use std::path::{Path, PathBuf};

/// Returns all sources of the packages, without dependencies.
fn sources() -> Result<Vec<PathBuf>, std::io::Error> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let rooms = [
        "framegraph",
        "renderer",
        "scene",
        "shaders",
        "passes",
        "tests",
        "examples",
        "egui",
        "viewer",
        "vulkan",
        "xtask",
    ];
    let mut folders: Vec<_> = rooms.map(|room| root.join(room)).into();
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in folder.read_dir()? {
            let path = entry?.path();
            match path.extension().and_then(|e| e.to_str()) {
                Some("rs") => files.push(path),
                _ if path.is_dir() && !path.ends_with("target") => folders.push(path),
                _ => {}
            }
        }
    }
    files.sort();
    Ok(files)
}

#[test]
fn no_error_derives_debug() -> Result<(), Box<dyn Error>> {
    // Reasons of decisions, which are not errors, and measured errors.
    let other = ["pub enum Reason", "pub enum DropReason", "pub struct TableError", "pub struct LobeError"];
    let mut errors = 0;
    for file in sources()? {
        let text = std::fs::read_to_string(&file)?;
        let lines: Vec<_> = text.lines().map(str::trim_start).collect();
        for (number, line) in lines.iter().enumerate().filter(|(_, line)| line.starts_with("#[derive(")) {
            // The item after the attributes and documentation.
            let item = lines[number..].iter().find(|line| !line.starts_with('#') && !line.starts_with("//"));
            let words: Vec<_> = item.unwrap_or(&"").split([' ', '{', '<', '(', ';']).collect();
            let kind = words.iter().position(|word| ["enum", "struct"].contains(word));
            let name = kind.and_then(|at| words.get(at + 1)).unwrap_or(&"");
            let named = ["Error", "Fault", "Reason", "Mismatch"].iter().any(|end| name.ends_with(end));
            let known = other.iter().any(|other| item.is_some_and(|item| item.starts_with(other)));
            if line.contains("thiserror::Error") || named && !known {
                errors += 1;
                let place = format!("{}:{}", file.display(), number + 1);
                assert!(!line.contains("Debug"), "{place}: implement `Debug` of {name} as the sentence");
            }
        }
        for name in text.lines().filter_map(|line| line.strip_prefix("impl std::error::Error for ")) {
            let name = name.trim_end_matches(" {}");
            errors += 1;
            assert!(text.contains(&format!("fmt::Debug for {name}")), "{}: {name}", file.display());
        }
    }
    assert!(errors > 40, "the sources were read: {errors}");
    Ok(())
}

#[test]
fn debug_is_the_sentence() {
    let mut graph = Graph::new();
    let image = graph.texture("image", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
    let read = graph.add_fn("early", |p| {
        p.color(image, Intent::Overwrite)?;
        p.color(image, Intent::Overwrite)
    });
    let errors: [Box<dyn Error>; 4] = [
        Box::new(read.expect_err("the second handle is stale")),
        Box::new("no such mode".parse::<framegraph_wgpu::inspect::DisplayMode>().expect_err("it is none")),
        Box::new(
            framegraph_scene::Scene::open("nowhere.glb", &mut framegraph_scene::progress::silent).expect_err("none"),
        ),
        Box::new(framegraph_wgpu::ExecuteError::OtherPlan),
    ];
    for error in errors {
        assert_eq!(format!("{error:?}"), error.to_string());
        assert!(error.to_string().contains(' '), "{error}");
    }
}
