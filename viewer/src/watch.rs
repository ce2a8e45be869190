//! Notices that files change, by looking twice a second at their times and lengths, on a thread of its own.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, SystemTime};

/// Between two looks.
const PERIOD: Duration = Duration::from_millis(500);

/// A watch over files. Dropping it ends it.
#[derive(Debug)]
pub struct Watch {
    changed: Arc<AtomicBool>,
    ended: Arc<AtomicBool>,
}

/// When a file was written, and how long it is; none of one that is not there.
fn state(path: &PathBuf) -> Option<(SystemTime, u64)> {
    let metadata = std::fs::metadata(path).ok()?;
    Some((metadata.modified().ok()?, metadata.len()))
}

impl Watch {
    /// Watches from now on; `wake` is called after a change.
    pub fn start(files: Vec<PathBuf>, wake: impl Fn() + Send + 'static) -> Self {
        let (changed, ended) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicBool::new(false)));
        let watch = Self { changed: changed.clone(), ended: ended.clone() };
        let mut seen: Vec<_> = files.iter().map(state).collect();
        std::thread::spawn(move || {
            while !ended.load(Ordering::Relaxed) {
                std::thread::sleep(PERIOD);
                let now: Vec<_> = files.iter().map(state).collect();
                // A file that an editor replaces is not there for a moment.
                if now != seen && now.iter().all(Option::is_some) {
                    seen = now;
                    changed.store(true, Ordering::Relaxed);
                    wake();
                }
            }
        });
        watch
    }

    /// Whether a file has changed since this was asked last.
    pub fn changed(&self) -> bool {
        self.changed.swap(false, Ordering::Relaxed)
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::Relaxed);
    }
}
