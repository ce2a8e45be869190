//! Renames several files into place together: if one rename fails, the others are undone.

use crate::part::{self, Part};
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

/// Backup of a replaced file, kept until all files are in place.
#[derive(Debug)]
struct Kept {
    path: PathBuf,
    /// Lock that keeps other runs from removing the backup.
    _locked: Option<File>,
}

impl Kept {
    /// Backs up the file at `place`; `None` if it does not exist.
    fn of(place: &Path) -> io::Result<Option<Self>> {
        if !place.is_file() {
            return Ok(None);
        }
        let path = part::fresh_name(place.parent().unwrap_or(Path::new(".")));
        // Some file systems have no hard links.
        fs::hard_link(place, &path).or_else(|_| fs::rename(place, &path))?;
        let locked = File::open(&path).ok();
        let _ = locked.as_ref().map(File::lock);
        Ok(Some(Self { path, _locked: locked }))
    }
}

impl Drop for Kept {
    fn drop(&mut self) {
        // Fails if the backup was restored.
        let _ = fs::remove_file(&self.path);
    }
}

/// Renames each file into place.
///
/// # Errors
/// Index of the rejected file and the reason. No path has changed.
pub(crate) fn all(parts: Vec<(PathBuf, Part)>) -> Result<(), (usize, io::Error)> {
    let _until_all_are_placed = part::hold();
    let mut placed: Vec<(PathBuf, Option<Kept>)> = Vec::new();
    for (index, (place, part)) in parts.into_iter().enumerate() {
        let kept = match Kept::of(&place) {
            Ok(kept) => kept,
            Err(error) => {
                undo(placed);
                return Err((index, error));
            }
        };
        if let Err(error) = part.place(&place) {
            if let Some(kept) = kept {
                let _ = fs::rename(&kept.path, &place);
            }
            undo(placed);
            return Err((index, error));
        }
        placed.push((place, kept));
    }
    Ok(())
}

/// Restores the backups and removes new files. Failures are ignored, since nothing more can be done.
fn undo(placed: Vec<(PathBuf, Option<Kept>)>) {
    for (place, kept) in placed.into_iter().rev() {
        let _ = match kept {
            Some(kept) => fs::rename(&kept.path, &place),
            None => fs::remove_file(&place),
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    #[test]
    fn a_failed_rename_undoes_the_others() {
        let folder = std::env::temp_dir().join(format!("program-place-{}", std::process::id()));
        let [old, new, refused] = ["old", "new", "refused"].map(|name| folder.join(name));
        fs::create_dir_all(refused.join("not empty")).expect("a folder for temporary files");
        fs::write(&old, "old").expect("the folder is ours");
        let parts = |places: &[&PathBuf]| {
            let part = |place: &&PathBuf| {
                let mut part = Part::create(&folder).expect("the folder is ours");
                part.file.write_all(b"of the run").expect("there is room");
                (place.to_path_buf(), part)
            };
            places.iter().map(part).collect::<Vec<_>>()
        };
        // A file cannot replace a folder.
        let failed = all(parts(&[&old, &new, &refused]));
        assert!(failed.is_err_and(|(index, _)| index == 2));
        assert_eq!(fs::read_to_string(&old).ok().as_deref(), Some("old"));
        assert_eq!(
            fs::read_dir(&folder).expect("it is there").count(),
            2,
            "nothing is left but the file and the folder"
        );
        all(parts(&[&old, &new])).expect("both can be placed");
        for place in [&old, &new] {
            assert_eq!(fs::read_to_string(place).ok().as_deref(), Some("of the run"));
        }
        assert_eq!(fs::read_dir(&folder).expect("it is there").count(), 3);
        fs::remove_dir_all(&folder).expect("the folder is ours");
    }
}
