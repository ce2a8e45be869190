//! Path of the workspace, and the `cargo` that builds it.

use std::path::PathBuf;
use std::process::Command;

use crate::Failure;

/// Returns the workspace's root folder.
///
/// `cargo run` sets the path of this package. Without cargo, the path at compile time is used.
pub fn root() -> PathBuf {
    let package =
        std::env::var_os("CARGO_MANIFEST_DIR").map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")), PathBuf::from);
    package.parent().map_or_else(|| PathBuf::from("."), PathBuf::from)
}

/// Returns the `cargo` that started this program, with `arguments`, in the workspace's root.
pub fn cargo(arguments: &[&str]) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    // Mesa's device selection layer complains about a missing session on standard error.
    command.current_dir(root()).args(arguments).env("NODEVICE_SELECT", "1");
    command
}

/// Returns the folder for temporary files of this program, and creates it if needed.
///
/// # Errors
/// The folder cannot be created.
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
