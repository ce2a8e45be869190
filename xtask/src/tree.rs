//! A made-up file tree for tests, removed when dropped.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// A folder of its own under the system's temporary folder.
#[derive(Debug)]
pub struct Tree(PathBuf);

impl Tree {
    /// A tree with `files`: (path, text). A leading `/` means the tree's root.
    pub fn new(files: &[(&str, &str)]) -> Self {
        // A number per tree keeps tests of one process apart, the process id those of several.
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

    /// The tree's root.
    pub fn root(&self) -> &Path {
        &self.0
    }
}

impl Drop for Tree {
    fn drop(&mut self) {
        // Nothing can be done about a file that will not go; the system clears the folder.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
