//! Where the models of a reference are.

use super::document::{Asset, Kept};
use sha2::{Digest, Sha256};
use std::path::{Component, Path, PathBuf};

/// A model is not to be had.
#[derive(thiserror::Error)]
pub enum AssetError {
    /// Nobody said where such files are.
    #[error("{entry}: kept elsewhere; `--assets DIR` says where")]
    NoFolder {
        /// What was asked for.
        entry: PathBuf,
    },
    /// A path leads out of its folder.
    #[error("{entry}: the path leads out of the folder of assets")]
    Outside {
        /// What was asked for.
        entry: PathBuf,
    },
    /// The file system said no.
    #[error("{file}: {error}")]
    File {
        /// The file.
        file: PathBuf,
        /// Why.
        error: std::io::Error,
    },
    /// It is another file.
    #[error("{file}: its SHA-256 is {found}, not {expected}")]
    Hash {
        /// The file.
        file: PathBuf,
        /// What it is.
        found: String,
        /// What it should be.
        expected: String,
    },
}

impl std::fmt::Debug for AssetError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// The file of a model: beside the statement in `folder`, or in `assets` with the hash that is stated.
///
/// # Errors
/// [`AssetError`].
pub fn resolve(asset: &Asset, folder: &Path, assets: Option<&Path>) -> Result<PathBuf, AssetError> {
    let Kept { entry, sha256, .. } = match asset {
        Asset::Beside(path) => return Ok(folder.join(path)),
        Asset::Elsewhere(kept) => kept,
    };
    let assets = assets.ok_or_else(|| AssetError::NoFolder { entry: entry.clone() })?;
    if !entry.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir)) {
        return Err(AssetError::Outside { entry: entry.clone() });
    }
    let file = assets.join(entry);
    let bytes = std::fs::read(&file).map_err(|error| AssetError::File { file: file.clone(), error })?;
    let found: String = Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect();
    if found.eq_ignore_ascii_case(sha256.trim()) {
        Ok(file)
    } else {
        Err(AssetError::Hash { file, found, expected: sha256.clone() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_kept_elsewhere_must_be_the_right_ones() -> Result<(), Box<dyn std::error::Error>> {
        let folder = std::env::temp_dir().join(format!("reference-asset-{}", std::process::id()));
        std::fs::create_dir_all(&folder)?;
        std::fs::write(folder.join("abc"), "abc")?;
        let kept = |entry: &str, sha256: &str| {
            Asset::Elsewhere(Kept { entry: entry.into(), source: serde_json::Value::Null, sha256: sha256.into() })
        };
        // FIPS 180-2, appendix B.1.
        let right = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        let found = resolve(&kept("abc", right), &folder, Some(&folder))?;
        assert_eq!(found, folder.join("abc"));
        let told = |asset: Asset, assets: Option<&Path>| resolve(&asset, &folder, assets).map_err(|e| e.to_string());
        let wrong = right.replace("ba78", "ba79");
        assert!(told(kept("abc", &wrong), Some(&folder)).is_err_and(|e| e.contains("abc") && e.contains(right)));
        assert!(told(kept("abc", right), None).is_err_and(|e| e.contains("--assets")));
        assert!(told(kept("../abc", right), Some(&folder)).is_err_and(|e| e.contains("out of the folder")));
        assert!(told(kept("abd", right), Some(&folder)).is_err_and(|e| e.contains("abd")));
        assert_eq!(resolve(&Asset::Beside("a/b.glb".into()), Path::new("r"), None)?, Path::new("r/a/b.glb"));
        std::fs::remove_dir_all(&folder)?;
        Ok(())
    }
}
