//! `cargo xtask package`: packs the published crates, as `cargo publish` does, and uses them.

use super::Command;
use crate::options::Options;
use crate::package::outside;
use crate::package::published::{Published, published, without_version};
use crate::{Failure, stage, workspace};
use std::fs;
use std::path::Path;

/// The command.
pub const COMMAND: Command = Command {
    name: "package",
    summary: "pack the published crates, and check what the packages contain",
    details: "\
Checks the manifests of all published crates, packs them in order of dependency,
and unpacks them into target/xtask/packages. Nothing is uploaded. Without
`--build` the network is not used. A test of this program checks manifests and lists of files.

  --build       also write a project outside of the workspace that depends on
                the unpacked crates. Its programs are the first examples of the
                READMEs, and each is built and run. A copy of examples/template
                is built too, for which cargo may download crates

Exit code 1 if a package is incomplete, or if an example fails.
",
    run,
};

fn run(options: &Options) -> Result<(), Failure> {
    let root = workspace::root();
    let all = published(&root).map_err(Failure::Failed)?;
    let mut faults = without_version(&root, &all).map_err(Failure::Failed)?;
    faults.extend(all.iter().flat_map(|package| package.faults(&root)));
    let mut pack = workspace::cargo(&["package", "--offline", "--no-verify", "--allow-dirty"]);
    pack.args(all.iter().flat_map(|package| ["--package", &package.name]));
    staged("pack", &mut pack)?;
    let folder = workspace::scratch()?.join("packages");
    let say = |error| Failure::Failed(format!("{}: {error}", folder.display()));
    if folder.exists() {
        fs::remove_dir_all(&folder).map_err(say)?;
    }
    fs::create_dir_all(&folder).map_err(say)?;
    for package in &all {
        unpack(&root, package, &folder)?;
        let own = folder.join(outside::name_of_folder(&package.name));
        let list = list(&own).map_err(say)?;
        program::line(format_args!("{}: {} files", package.name, list.len()));
        faults.extend(package.faults_of_files(&list.join("\n")));
    }
    if !faults.is_empty() {
        return Err(Failure::Failed(faults.join("\n")));
    }
    if options.has("--build") { build(&root, &all, &folder) } else { Ok(()) }
}

/// Runs a command, and fails if it fails.
fn staged(name: &'static str, command: &mut std::process::Command) -> Result<(), Failure> {
    stage::run(name, command).result.map_err(|error| Failure::Failed(format!("{name}: {error}")))
}

/// Unpacks the archive of a package into `folder`.
fn unpack(root: &Path, package: &Published, folder: &Path) -> Result<(), Failure> {
    let archive =
        root.join("target/package").join(outside::name_of_folder(&package.name)).with_added_extension("crate");
    let mut tar = std::process::Command::new("tar");
    tar.arg("-xzf").arg(&archive).arg("-C").arg(folder);
    match tar.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(Failure::Failed(format!("{}: tar: {status}", archive.display()))),
        Err(error) => Err(Failure::Failed(format!("tar: {error}; install it"))),
    }
}

/// Returns the paths of all files in `root`, relative to it.
fn list(root: &Path) -> std::io::Result<Vec<String>> {
    let mut files = Vec::new();
    let mut folders = vec![root.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder)? {
            let path = entry?.path();
            if path.is_dir() {
                folders.push(path);
            } else {
                files.push(path.strip_prefix(root).unwrap_or(&path).to_string_lossy().into_owned());
            }
        }
    }
    Ok(files)
}

/// Builds and runs the examples of the READMEs outside of the workspace.
fn build(root: &Path, all: &[Published], unpacked: &Path) -> Result<(), Failure> {
    let folder = workspace::scratch()?.join("outside");
    let programs = outside::write(root, all, unpacked, &folder).map_err(Failure::Failed)?;
    for program in &programs {
        let mut cargo = workspace::cargo(&["run", "--offline", "--bin", program]);
        // The workspace's folder has most dependencies already.
        cargo.current_dir(&folder).env("CARGO_TARGET_DIR", root.join("target"));
        staged("outside", &mut cargo)?;
    }
    let folder = workspace::scratch()?.join("outside-template");
    outside::copy_template(root, all, unpacked, &folder).map_err(Failure::Failed)?;
    // Its window toolkit has more features than the workspace uses, so cargo may download crates.
    let mut cargo = workspace::cargo(&["build"]);
    staged("template", cargo.current_dir(&folder).env("CARGO_TARGET_DIR", root.join("target")))?;
    program::line(format_args!("{} programs outside of the workspace ran, and the template was built", programs.len()));
    Ok(())
}
