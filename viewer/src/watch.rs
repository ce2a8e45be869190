//! Watches files by polling their times and sizes twice a second on a separate thread.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, SystemTime};

/// Polling interval.
const PERIOD: Duration = Duration::from_millis(500);

/// Watch over files, ended on drop.
#[derive(Debug)]
pub struct Watch {
    changed: Arc<AtomicBool>,
    ended: Arc<AtomicBool>,
}

/// Returns modification time and size of a file; `None` if it does not exist.
fn state(path: &PathBuf) -> Option<(SystemTime, u64)> {
    let metadata = std::fs::metadata(path).ok()?;
    Some((metadata.modified().ok()?, metadata.len()))
}

impl Watch {
    /// Starts watching. `wake` is called after each change.
    pub fn start(files: Vec<PathBuf>, wake: impl Fn() + Send + 'static) -> Self {
        let (changed, ended) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicBool::new(false)));
        let watch = Self { changed: changed.clone(), ended: ended.clone() };
        let mut seen: Vec<_> = files.iter().map(state).collect();
        std::thread::spawn(move || {
            while !ended.load(Ordering::Relaxed) {
                std::thread::sleep(PERIOD);
                let now: Vec<_> = files.iter().map(state).collect();
                // A file that an editor replaces may be missing for a moment.
                if now != seen && now.iter().all(Option::is_some) {
                    seen = now;
                    changed.store(true, Ordering::Relaxed);
                    wake();
                }
            }
        });
        watch
    }

    /// Returns whether a file changed since the last call.
    pub fn changed(&self) -> bool {
        self.changed.swap(false, Ordering::Relaxed)
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::Relaxed);
    }
}
