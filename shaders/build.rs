//! Lists the files of `wgsl/`, so that new files are embedded automatically.

use std::error::Error;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs};

/// Collects the paths of all files in `folder`, relative to `root`, with slashes.
fn list(root: &Path, folder: &Path, paths: &mut Vec<String>) -> Result<(), Box<dyn Error>> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            list(root, &path, paths)?;
        } else if path.extension().is_some_and(|ending| ending == "wgsl") {
            let parts = path.strip_prefix(root)?.iter().map(|part| part.to_str().ok_or("a file name that is no text"));
            paths.push(parts.collect::<Result<Vec<_>, _>>()?.join("/"));
        }
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=wgsl");
    println!("cargo::rerun-if-changed=build.rs");
    let root = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?).join("wgsl");
    let mut paths = Vec::new();
    list(&root, &root, &mut paths)?;
    paths.sort();
    let mut table = String::from("&[\n");
    for path in paths {
        let file = format!("concat!(env!(\"CARGO_MANIFEST_DIR\"), {:?})", format!("/wgsl/{path}"));
        writeln!(table, "    Source {{ path: {path:?}, wgsl: include_str!({file}) }},")?;
    }
    table.push_str("]\n");
    fs::write(PathBuf::from(env::var("OUT_DIR")?).join("sources.rs"), table)?;
    Ok(())
}
