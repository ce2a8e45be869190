//! Temporary file in the folder of its final path.
//!
//! Its name is independent of the final name, which may already have the maximum length. The file is locked while in
//! use. An unlocked one was left by a killed run, and the next run that writes into the folder removes it.

use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, MutexGuard};

const BEGIN: &str = ".framegraph-";
const END: &str = ".part";
/// Attempts to create a temporary file that another run removes before it is locked.
const TRIES: u32 = 10;

/// Temporary files of this process, for exits without running destructors.
static LIVE: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn live() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    LIVE.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

/// Held while files are renamed, so that the process exits before or after all renames.
static PLACING: Mutex<()> = Mutex::new(());

/// Blocks [`remove_all`] while the guard lives.
pub(crate) fn hold() -> MutexGuard<'static, ()> {
    PLACING.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

/// Returns a file name in `folder` that is unique in this process.
pub(crate) fn fresh_name(folder: &Path) -> PathBuf {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    folder.join(format!("{BEGIN}{}-{number}{END}", std::process::id()))
}

/// Removes all temporary files of this process before it exits.
pub(crate) fn remove_all() {
    std::mem::forget(hold());
    for path in live().iter() {
        // The next run removes leftovers.
        let _ = fs::remove_file(path);
    }
}

/// Temporary file, removed on drop.
#[derive(Debug)]
pub(crate) struct Part {
    pub file: File,
    path: PathBuf,
}

impl Part {
    /// Creates a temporary file in `folder` and removes leftovers of killed runs.
    pub fn create(folder: &Path) -> io::Result<Self> {
        sweep(folder);
        for _ in 0..TRIES {
            let path = fresh_name(folder);
            let file = match OpenOptions::new().read(true).write(true).create_new(true).open(&path) {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => continue,
                opened => opened?,
            };
            live().insert(path.clone());
            let part = Self { file, path };
            // Without file locks, nothing is swept either.
            let _ = part.file.lock();
            if part.is_there() {
                return Ok(part);
            }
        }
        Err(io::Error::other("a temporary file in its folder was removed each time it was created"))
    }

    /// Returns whether the file still exists under its name.
    pub fn is_there(&self) -> bool {
        fs::symlink_metadata(&self.path).is_ok()
    }

    /// Renames the file to `place` with the mode and owner of the file it replaces.
    pub fn place(self, place: &Path) -> io::Result<()> {
        if let Ok(old) = fs::metadata(place) {
            self.file.set_permissions(old.permissions())?;
            #[cfg(unix)]
            {
                use std::os::unix::fs::{MetadataExt, fchown};
                // Changing the owner requires administrator rights.
                let _ = fchown(&self.file, Some(old.uid()), Some(old.gid()));
            }
        }
        fs::rename(&self.path, place)
    }
}

impl Drop for Part {
    fn drop(&mut self) {
        // Fails for a file that was renamed.
        let _ = fs::remove_file(&self.path);
        live().remove(&self.path);
    }
}

/// Removes unlocked temporary files and ignores failures.
fn sweep(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let is_part = name.to_str().is_some_and(|name| name.starts_with(BEGIN) && name.ends_with(END));
        if !is_part || !entry.file_type().is_ok_and(|kind| kind.is_file()) {
            continue;
        }
        if File::open(entry.path()).is_ok_and(|file| file.try_lock().is_ok()) {
            let _ = fs::remove_file(entry.path());
        }
    }
}
