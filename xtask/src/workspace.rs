//! Where the workspace lies, and the `cargo` that builds it.

use std::path::PathBuf;
use std::process::Command;

use crate::Failure;

/// The workspace's root folder.
///
/// `cargo run` tells where this package lies; a program started without cargo falls back on the
/// place it was compiled in.
pub fn root() -> PathBuf {
    let package =
        std::env::var_os("CARGO_MANIFEST_DIR").map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")), PathBuf::from);
    package.parent().map_or_else(|| PathBuf::from("."), PathBuf::from)
}

/// The same `cargo` that started this program, with `arguments`, in the workspace's root.
pub fn cargo(arguments: &[&str]) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    // Mesa's device selection layer complains about a missing session on standard error.
    command.current_dir(root()).args(arguments).env("NODEVICE_SELECT", "1");
    command
}

/// The folder for what this program writes for itself, made where it is not there.
///
/// # Errors
/// Where it cannot be made.
pub fn scratch() -> Result<PathBuf, Failure> {
    let folder = root().join("target/xtask");
    std::fs::create_dir_all(&folder).map_err(|error| Failure::Failed(format!("{}: {error}", folder.display())))?;
    Ok(folder)
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_root_holds_the_workspace_manifest() {
        let manifest = std::fs::read_to_string(super::root().join("Cargo.toml"));
        assert!(manifest.is_ok_and(|text| text.contains("[workspace]")));
    }
}
