//! Temporary file tree for tests, removed when dropped.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// A folder of its own in the system's temporary folder.
#[derive(Debug)]
pub struct Tree(PathBuf);

impl Tree {
    /// Creates a tree with `files`, pairs of path and text. A leading `/` means the tree's root.
    pub fn new(files: &[(&str, &str)]) -> Self {
        // The number separates trees of one process, and the process id separates processes.
        static NEXT: AtomicU32 = AtomicU32::new(0);
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let root = std::env::temp_dir().join(format!("xtask-{}-{number}", std::process::id()));
        std::fs::create_dir_all(&root).expect("a folder for the test");
        for (path, text) in files {
            let path = root.join(path.trim_start_matches('/'));
            std::fs::create_dir_all(path.parent().expect("a parent")).expect("a folder");
            std::fs::write(path, text).expect("a file for the test");
        }
        Self(root)
    }

    /// Returns the tree's root.
    pub fn root(&self) -> &Path {
        &self.0
    }
}

impl Drop for Tree {
    fn drop(&mut self) {
        // The system clears its temporary folder if this fails.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
