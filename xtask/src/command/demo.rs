//! `cargo xtask demo`: renders the built-in scenes and lists the written files.

use std::fs;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use super::Command;
use crate::options::Options;
use crate::{Failure, adapter, stage, workspace};

/// The command.
pub const COMMAND: Command = Command {
    name: "demo",
    summary: "build in release and render the built-in scenes into target/demo/",
    details: "\
Renders `spheres`, `columns` and `materials` at 1280x720 with the `render`
program. Each writes SCENE.png and its plan (text and DOT) into target/demo/.
",
    run,
};

/// Built-in scenes, which need no file. The first is the main example.
const SCENES: [&str; 3] = ["spheres", "columns", "materials"];
/// Picture size in pixels, width by height, as an option and as numbers.
const SIZE: (&str, (u32, u32)) = ("1280x720", (1280, 720));
/// Output folder, relative to the workspace's root.
const FOLDER: &str = "target/demo";

fn run(options: &Options) -> Result<(), Failure> {
    adapter::ready(options)?;
    let folder = workspace::root().join(FOLDER);
    fs::create_dir_all(&folder).map_err(|error| Failure::Failed(format!("{}: {error}", folder.display())))?;
    let failed = |stage: &str, reason: String| Failure::Failed(format!("{stage}: {reason}"));
    let build = ["build", "--release", "--package", "examples", "--bin", "render"];
    stage::run("build", &mut workspace::cargo(&build)).result.map_err(|reason| failed("build", reason))?;
    let mut made = Vec::new();
    for scene in SCENES {
        // Files of an earlier run must not be mistaken for results of this one.
        for old in files_of(&folder, scene) {
            fs::remove_file(&old).map_err(|error| failed(&old.display().to_string(), error.to_string()))?;
        }
        let words = arguments(scene);
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        stage::run(scene, &mut workspace::cargo(&words)).result.map_err(|reason| failed(scene, reason))?;
        let picture = folder.join(format!("{scene}.png"));
        let size = png_size(&picture).map_err(|reason| failed(&picture.display().to_string(), reason))?;
        if size != SIZE.1 {
            let reason = format!("is {}x{} pixels, not {}", size.0, size.1, SIZE.0);
            return Err(failed(&picture.display().to_string(), reason));
        }
        made.extend(files_of(&folder, scene));
    }
    program::line(format_args!("== written to {FOLDER}:"));
    for file in made {
        let length_bytes = fs::metadata(&file).map_or(0, |metadata| metadata.len());
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        program::line(format_args!("  {name:<16} {:>8.1} KB", length_bytes as f64 / 1000.0));
    }
    Ok(())
}

/// Returns the arguments of `cargo` that render `scene`.
fn arguments(scene: &str) -> Vec<String> {
    let fixed = ["run", "--quiet", "--release", "--package", "examples", "--bin", "render", "--"].map(str::to_owned);
    let out = format!("{FOLDER}/{scene}.png");
    let plan = format!("{FOLDER}/{scene}.txt");
    let own = [scene, "--size", SIZE.0, "--out", &out, "--plan", &plan].map(str::to_owned);
    [fixed.as_slice(), &own].concat()
}

/// Returns the files of `scene` in `folder`, with any extension, sorted.
fn files_of(folder: &Path, scene: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let files = entries.map(|entry| entry.path()).filter(|path| path.is_file());
    let mut files: Vec<_> = files.filter(|path| path.file_stem().is_some_and(|stem| stem == scene)).collect();
    files.sort();
    files
}

/// Reads the size of a PNG in pixels from its header (PNG third edition, section 11.2.1).
fn png_size(path: &Path) -> Result<(u32, u32), String> {
    let mut header = [0; 24];
    fs::File::open(path).and_then(|mut file| file.read_exact(&mut header)).map_err(|error| error.to_string())?;
    if !header.starts_with(b"\x89PNG\r\n\x1a\n") || &header[12..16] != b"IHDR" {
        return Err("is not a PNG".to_owned());
    }
    let number = |at: usize| header[at..at + 4].iter().fold(0, |number, &byte| number << 8 | u32::from(byte));
    Ok((number(16), number(20)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::Tree;

    #[test]
    fn the_main_job_is_the_documented_command() {
        assert_eq!(
            arguments("spheres").join(" "),
            "run --quiet --release --package examples --bin render -- spheres --size 1280x720 \
             --out target/demo/spheres.png --plan target/demo/spheres.txt"
        );
        let (width, height) = SIZE.1;
        assert_eq!(SIZE.0, format!("{width}x{height}"));
    }

    #[test]
    fn files_belong_to_a_scene_by_their_stem() {
        let tree = Tree::new(&[
            ("spheres.png", ""),
            ("spheres.dot", ""),
            ("spheres", ""),
            ("spheres2.png", ""),
            ("columns.png", ""),
        ]);
        let names: Vec<_> =
            files_of(tree.root(), "spheres").iter().map(|file| file.file_name().map(|n| n.to_owned())).collect();
        assert_eq!(names, ["spheres", "spheres.dot", "spheres.png"].map(|name| Some(name.into())));
    }

    #[test]
    fn a_picture_is_judged_by_its_header() {
        let tree = Tree::new(&[("no.png", "no picture, but long enough for a header"), ("cut.png", "")]);
        let good = tree.root().join("good.png");
        fs::write(&good, b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\x05\0\0\0\x02\xd0\x08").expect("a file");
        assert_eq!(png_size(&good), Ok((1280, 720)));
        assert_eq!(png_size(&tree.root().join("no.png")), Err("is not a PNG".to_owned()));
        assert!(png_size(&tree.root().join("cut.png")).is_err());
        assert!(png_size(&tree.root().join("none.png")).is_err());
    }
}
