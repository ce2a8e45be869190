//! A file in the making beside the place that it will take.
//!
//! Its name has nothing of the final one, which may be as long as names can be. It is locked while it is made, so that one
//! without a lock was left behind by a run that was killed: the next run that writes into the folder sweeps it away.

use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, MutexGuard};

const BEGIN: &str = ".framegraph-";
const END: &str = ".part";
/// How often a part that was swept away between making and locking it is made anew.
const TRIES: u32 = 10;

/// The parts that there are, for a program that ends without dropping them.
static LIVE: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn live() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    LIVE.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

/// Held while files get their names: the program ends before or after that, not between.
static PLACING: Mutex<()> = Mutex::new(());

/// Keeps [`remove_all`] waiting.
pub(crate) fn hold() -> MutexGuard<'static, ()> {
    PLACING.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

/// A name in `folder` that nothing else in this program has.
pub(crate) fn fresh_name(folder: &Path) -> PathBuf {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    folder.join(format!("{BEGIN}{}-{number}{END}", std::process::id()))
}

/// Removes every part of this program, which is about to end.
pub(crate) fn remove_all() {
    std::mem::forget(hold());
    for path in live().iter() {
        // What cannot be removed is swept away by the next run.
        let _ = fs::remove_file(path);
    }
}

/// A file in the making. Dropping it removes it.
#[derive(Debug)]
pub(crate) struct Part {
    pub file: File,
    path: PathBuf,
}

impl Part {
    /// A new part in `folder`. Removes what killed runs left there.
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
            // Where files cannot be locked nothing is swept either.
            let _ = part.file.lock();
            if part.is_there() {
                return Ok(part);
            }
        }
        Err(io::Error::other("a file beside it was removed each time it was made"))
    }

    /// Whether the file still has its name.
    pub fn is_there(&self) -> bool {
        fs::symlink_metadata(&self.path).is_ok()
    }

    /// Gives the file the name `place`, with mode and owner of the file that it replaces.
    pub fn place(self, place: &Path) -> io::Result<()> {
        if let Ok(old) = fs::metadata(place) {
            self.file.set_permissions(old.permissions())?;
            #[cfg(unix)]
            {
                use std::os::unix::fs::{MetadataExt, fchown};
                // Only the system's administrator can give files away.
                let _ = fchown(&self.file, Some(old.uid()), Some(old.gid()));
            }
        }
        fs::rename(&self.path, place)
    }
}

impl Drop for Part {
    fn drop(&mut self) {
        // One that was placed is not there any more.
        let _ = fs::remove_file(&self.path);
        live().remove(&self.path);
    }
}

/// Removes parts that nobody holds a lock on. What cannot be removed stays.
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
