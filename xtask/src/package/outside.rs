//! Projects outside of the workspace: one whose programs are the first examples of the READMEs, and a copy of the template.

use super::published::Published;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// Writes the project into `folder`, with dependencies on the packages in `unpacked`.
///
/// Returns the names of its programs.
///
/// # Errors
/// A README cannot be read, or a file cannot be written.
pub fn write(root: &Path, all: &[Published], unpacked: &Path, folder: &Path) -> Result<Vec<String>, String> {
    let say = |path: &Path, error: std::io::Error| format!("{}: {error}", path.display());
    // Programs of an earlier run are removed; a README may have lost its example.
    let programs = folder.join("src/bin");
    if programs.exists() {
        fs::remove_dir_all(&programs).map_err(|error| say(&programs, error))?;
    }
    fs::create_dir_all(&programs).map_err(|error| say(&programs, error))?;
    let mut names = Vec::new();
    let own = all.iter().map(|package| (package.name.as_str(), root.join(&package.folder)));
    for (name, place) in [("readme", root.to_owned())].into_iter().chain(own) {
        let path = place.join("README.md");
        let text = fs::read_to_string(&path).map_err(|error| say(&path, error))?;
        if let Some(text) = program(&text) {
            // A program with the name of a package would have the library's file name.
            let name = format!("outside-{name}");
            let path = programs.join(&name).with_extension("rs");
            fs::write(&path, text).map_err(|error| say(&path, error))?;
            names.push(name);
        }
    }
    let path = folder.join("Cargo.toml");
    let workspace = root.join("Cargo.toml");
    let workspace = fs::read_to_string(&workspace).map_err(|error| say(&workspace, error))?;
    fs::write(&path, manifest(all, unpacked, &workspace)).map_err(|error| say(&path, error))?;
    // The versions of the workspace, which are downloaded already.
    let (from, to) = (root.join("Cargo.lock"), folder.join("Cargo.lock"));
    fs::copy(&from, to).map_err(|error| say(&from, error))?;
    Ok(names)
}

/// Copies the template into `folder` as `cargo generate` does, with dependencies on the packages in `unpacked`.
///
/// # Errors
/// A file cannot be read or written.
pub fn copy_template(root: &Path, all: &[Published], unpacked: &Path, folder: &Path) -> Result<(), String> {
    let say = |path: &Path, error: std::io::Error| format!("{}: {error}", path.display());
    let source = folder.join("src");
    fs::create_dir_all(&source).map_err(|error| say(&source, error))?;
    let template = root.join("examples/template");
    for file in ["main.rs", "scene.wgsl", "effect.wgsl"] {
        let from = template.join("src").join(file);
        fs::copy(&from, source.join(file)).map_err(|error| say(&from, error))?;
    }
    let [from, workspace, to] = [template.join("Cargo.toml"), root.join("Cargo.toml"), folder.join("Cargo.toml")];
    let read = |path: &Path| fs::read_to_string(path).map_err(|error| say(path, error));
    let manifest = read(&from)?.replace("{{project-name}}", "outside-template");
    let text = manifest + "\n[workspace]\n" + &patches(all, unpacked, &read(&workspace)?);
    fs::write(&to, text).map_err(|error| say(&to, error))?;
    let (from, to) = (root.join("Cargo.lock"), folder.join("Cargo.lock"));
    fs::copy(&from, to).map_err(|error| say(&from, error)).map(drop)
}

/// Returns the first Rust example of a document as a program.
fn program(document: &str) -> Option<String> {
    let (_, after) = document.split_once("```rust\n")?;
    let (code, _) = after.split_once("\n```")?;
    Some(if code.contains("fn main()") {
        code.to_owned()
    } else {
        format!("fn main() -> Result<(), Box<dyn std::error::Error>> {{\n{code}\nOk(())\n}}\n")
    })
}

/// Returns a manifest that names all packages by version, and takes them from the folder `unpacked`.
fn manifest(all: &[Published], unpacked: &Path, workspace: &str) -> String {
    let mut text = String::from("[package]\nname = \"outside\"\nedition = \"2024\"\n\n[workspace]\n\n[dependencies]\n");
    for Published { name, .. } in all {
        let _ = writeln!(text, "{name} = \"{}\"", env!("CARGO_PKG_VERSION"));
    }
    text + &patches(all, unpacked, workspace)
}

/// Returns the part of a manifest that takes all packages from the folder `unpacked`.
///
/// Profiles are those of the workspace, so that dependencies need not be built again.
fn patches(all: &[Published], unpacked: &Path, workspace: &str) -> String {
    let mut text = String::from("\n[patch.crates-io]\n");
    for Published { name, .. } in all {
        let _ = writeln!(text, "{name} = {{ path = {:?} }}", unpacked.join(name_of_folder(name)));
    }
    let profiles = workspace.find("\n[profile.").map_or("", |start| &workspace[start..]);
    text + profiles
}

/// Returns the folder of a package in its archive.
pub fn name_of_folder(name: &str) -> String {
    format!("{name}-{}", env!("CARGO_PKG_VERSION"))
}

#[cfg(test)]
mod tests {
    use super::program;

    #[test]
    fn the_first_example_becomes_a_program() {
        let document = "# A\n\n```toml\na\n```\n\n```rust\nuse a::b;\nb()?;\n```\n\n```rust\nsecond()\n```\n";
        let text = program(document).expect("it has an example");
        assert!(text.starts_with("fn main()") && text.contains("b()?;\nOk(())") && !text.contains("second"));
        let whole = "```rust\nfn main() {}\n```";
        assert_eq!(program(whole).as_deref(), Some("fn main() {}"));
        assert_eq!(program("no code"), None);
    }
}
