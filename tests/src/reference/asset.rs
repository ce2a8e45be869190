//! Paths of the models and environments of a reference.

use super::document::{Asset, Hashes, Kept, Scene};
use sha2::{Digest, Sha256};
use std::path::{Component, Path, PathBuf};

/// A file cannot be used.
#[derive(thiserror::Error)]
pub enum AssetError {
    /// The folder of assets is not given.
    #[error("{entry}: not in the repository; use `--assets DIR`")]
    NoFolder {
        /// Path of the asset.
        entry: PathBuf,
    },
    /// A path leads out of its folder.
    #[error("{entry}: the path leads out of the folder of assets")]
    Outside {
        /// Path of the asset.
        entry: PathBuf,
    },
    /// The file system reported an error.
    #[error("{file}: {error}")]
    File {
        /// Path of the file.
        file: PathBuf,
        /// Error of the file system.
        error: std::io::Error,
    },
    /// The file has another hash.
    #[error("{file}: its SHA-256 is {found}, not {expected}")]
    Hash {
        /// Path of the file.
        file: PathBuf,
        /// Actual hash.
        found: String,
        /// Expected hash.
        expected: String,
    },
}

impl std::fmt::Debug for AssetError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// Files of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sources {
    /// Model.
    pub model: PathBuf,
    /// Environment, if it is a file.
    pub light: Option<PathBuf>,
}

impl Sources {
    /// Resolves the files of a scene. `folder` has the statement; `assets` has files that are named with hashes.
    /// Returns `None` if the scene has no model.
    ///
    /// # Errors
    /// [`AssetError`].
    pub fn of(scene: &Scene, folder: &Path, assets: Option<&Path>) -> Result<Option<Self>, AssetError> {
        let Some(model) = scene.assets.first() else { return Ok(None) };
        let light = scene.ibl.as_ref().and_then(|ibl| ibl.ktx1.as_ref());
        let light = light.map(|light| resolve(light, folder, assets)).transpose()?;
        Ok(Some(Self { model: resolve(model, folder, assets)?, light }))
    }
}

/// Resolves an asset: beside the statement in `folder`, or by its hash in `assets` or a folder within.
///
/// # Errors
/// [`AssetError`].
pub fn resolve(asset: &Asset, folder: &Path, assets: Option<&Path>) -> Result<PathBuf, AssetError> {
    let Kept { entry, sha256, .. } = match asset {
        Asset::Beside(path) => return Ok(folder.join(path)),
        Asset::Elsewhere(kept) => kept,
    };
    let assets = assets.ok_or_else(|| AssetError::NoFolder { entry: entry.clone() })?;
    let root = root_of(inside(entry)?, assets);
    let file = root.join(entry);
    match sha256 {
        Hashes::One(hash) => check(&file, hash)?,
        Hashes::Each(hashes) => {
            for (path, hash) in hashes {
                let beside = file.with_file_name(inside(path)?);
                check(&if beside.exists() { beside } else { root.join(path) }, hash)?;
            }
        }
    }
    Ok(file)
}

/// Returns a path that stays in its folder.
fn inside(path: &Path) -> Result<&Path, AssetError> {
    let stays = path.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    if stays { Ok(path) } else { Err(AssetError::Outside { entry: path.into() }) }
}

/// Returns `assets` if it has the entry, otherwise the first folder in it that has the entry.
fn root_of(entry: &Path, assets: &Path) -> PathBuf {
    let mut folders: Vec<PathBuf> =
        std::fs::read_dir(assets).into_iter().flatten().flatten().map(|f| f.path()).collect();
    folders.sort();
    folders.insert(0, assets.into());
    folders.into_iter().find(|folder| folder.join(entry).exists()).unwrap_or_else(|| assets.into())
}

fn check(file: &Path, expected: &str) -> Result<(), AssetError> {
    let bytes = std::fs::read(file).map_err(|error| AssetError::File { file: file.into(), error })?;
    let found: String = Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect();
    let expected = expected.trim();
    if found.eq_ignore_ascii_case(expected) {
        Ok(())
    } else {
        Err(AssetError::Hash { file: file.into(), found, expected: expected.into() })
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
            Asset::Elsewhere(Kept {
                entry: entry.into(),
                source: serde_json::Value::Null,
                sha256: Hashes::One(sha256.into()),
            })
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
        // Files in a subfolder, with a hash for each file. Paths are relative to the entry or to the folder.
        std::fs::create_dir_all(folder.join("kind/model"))?;
        std::fs::write(folder.join("kind/model/abc"), "abc")?;
        std::fs::write(folder.join("kind/model/abc.bin"), "abc")?;
        let each = |hash: &str| {
            let sha256 = Hashes::Each([("abc".into(), right.into()), ("model/abc.bin".into(), hash.into())].into());
            Asset::Elsewhere(Kept { entry: "model/abc".into(), source: serde_json::Value::Null, sha256 })
        };
        assert_eq!(resolve(&each(right), &folder, Some(&folder))?, folder.join("kind/model/abc"));
        assert!(told(each(&wrong), Some(&folder)).is_err_and(|e| e.contains("abc.bin") && e.contains(right)));
        assert_eq!(resolve(&Asset::Beside("a/b.glb".into()), Path::new("r"), None)?, Path::new("r/a/b.glb"));
        std::fs::remove_dir_all(&folder)?;
        Ok(())
    }
}
