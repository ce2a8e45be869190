//! State of the window that is kept between runs: arrangement of the panes with their front tabs, theme, size, and recent
//! files.

use program::input;
#[cfg(feature = "window")]
use program::outputs::Outputs;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Maximum number of recent files.
const RECENT: usize = 10;
/// Maximum size of the file in bytes.
const MAX_BYTES: u64 = 1 << 20;

/// Kept state. Missing fields have their defaults.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Remembered {
    /// Arrangement of the panes, as `Viewer::arrangement` returns it.
    pub panes: Option<String>,
    /// Dark or light theme; `None` for that of the desktop.
    pub dark: Option<bool>,
    /// Size of the window in points.
    pub size: Option<[f32; 2]>,
    /// Recently opened files, newest first.
    pub recent: Vec<PathBuf>,
}

impl Remembered {
    /// Returns the file of the state, for a window with or without a live frame.
    ///
    /// It is in `framegraph-viewer` of the user's state folder (XDG Base Directory Specification 0.8), or of the settings
    /// folder on other systems. `None` if the system has no such folder.
    pub fn file(live: bool) -> Option<PathBuf> {
        let folder = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
        let home = || Some(folder("HOME")?.join(".local/state"));
        let base = folder("XDG_STATE_HOME").or_else(|| folder("APPDATA")).or_else(home)?;
        Some(base.join(if live { "framegraph-viewer/window-live.json" } else { "framegraph-viewer/window.json" }))
    }

    /// Reads the state. An unreadable or damaged file gives the defaults.
    pub fn read(file: &Path) -> Self {
        let text = input::text(file, MAX_BYTES).unwrap_or_default();
        let mut read: Self = serde_json::from_str(&text).unwrap_or_default();
        read.size = read.size.filter(|size| size.iter().all(|side| (100.0..=16384.0).contains(side)));
        read.recent.truncate(RECENT);
        read
    }

    /// Writes the state, completely or not at all. Failures are ignored, because no work is lost.
    #[cfg(feature = "window")]
    pub fn write(&self, file: &Path) {
        let _ = file.parent().map(std::fs::create_dir_all);
        let _ = serde_json::to_string(self).map(|text| Outputs::one(file, text.as_bytes()));
    }
}

/// Adds an opened file to recent files, newest first.
pub fn add_recent(recent: &mut Vec<PathBuf>, path: &Path) {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    recent.retain(|other| *other != path);
    recent.insert(0, path);
    recent.truncate(RECENT);
}

#[cfg(all(test, feature = "window"))]
mod tests {
    use super::*;

    #[test]
    fn the_state_is_read_again_and_damage_gives_the_defaults() {
        let folder = std::env::temp_dir().join(format!("framegraph-viewer-{}", std::process::id()));
        let file = folder.join("state/window.json");
        assert_eq!(Remembered::read(&file), Remembered::default());
        let mut kept = Remembered { dark: Some(true), size: Some([900.0, 500.0]), ..Remembered::default() };
        for name in ["/a.ron", "/b.ron", "/a.ron"] {
            add_recent(&mut kept.recent, Path::new(name));
        }
        assert_eq!(kept.recent, [PathBuf::from("/a.ron"), PathBuf::from("/b.ron")]);
        kept.write(&file);
        assert_eq!(Remembered::read(&file), kept);
        std::fs::write(&file, "{\"size\": [1.0, 1e9]}").expect("a file");
        assert_eq!(Remembered::read(&file), Remembered::default());
        std::fs::write(&file, "no state").expect("a file");
        assert_eq!(Remembered::read(&file), Remembered::default());
        // A file that is too large is not read, and writing replaces the file without leftovers.
        let padded = format!("{}{}", serde_json::to_string(&kept).expect("text"), " ".repeat(MAX_BYTES as usize));
        std::fs::write(&file, padded).expect("a file");
        assert_eq!(Remembered::read(&file), Remembered::default());
        kept.write(&file);
        assert_eq!(Remembered::read(&file), kept);
        assert_eq!(std::fs::read_dir(folder.join("state")).expect("a folder").count(), 1);
        std::fs::remove_dir_all(folder).expect("it exists");
    }
}
