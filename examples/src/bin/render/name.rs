//! Names of output files.

use program::outputs::is_special;
use std::path::{Path, PathBuf};

/// Maximum length of a file name in bytes on common file systems.
const LONGEST: usize = 255;

/// Checks the extension of a path. Pipes and devices may have any name.
///
/// # Errors
/// One line that names the option and the valid extensions.
pub fn with_ending(path: PathBuf, option: &str, endings: &[&str]) -> Result<PathBuf, String> {
    let fits = path.extension().is_some_and(|e| endings.iter().any(|ending| e.eq_ignore_ascii_case(ending)));
    if fits || is_special(&path) {
        Ok(path)
    } else {
        Err(format!("{option} {}: the file must end in .{}", path.display(), endings.join(" or .")))
    }
}

/// Returns the path with another extension, its stem shortened if necessary; `None` for a pipe or a device.
pub fn neighbour(path: &Path, ending: &str) -> Option<PathBuf> {
    let stem = path.file_stem()?.to_string_lossy();
    (!is_special(path)).then(|| path.with_file_name(short_name(&stem, ending)))
}

/// Returns a name of at most [`LONGEST`] bytes that keeps its extension.
pub fn short_name(stem: &str, ending: &str) -> String {
    let mut most = stem.len().min(LONGEST - ending.len());
    while !stem.is_char_boundary(most) {
        most -= 1;
    }
    format!("{}{ending}", &stem[..most])
}

/// Returns the paths of the plan as text and as a graph: the specified file and its neighbor.
pub fn plan_files(asked: Option<PathBuf>, picture: &Path) -> (Option<PathBuf>, Option<PathBuf>) {
    match asked {
        Some(dot) if dot.extension().is_some_and(|e| e.eq_ignore_ascii_case("dot")) => {
            (neighbour(&dot, ".txt"), Some(dot))
        }
        Some(text) => {
            let dot = neighbour(&text, ".dot");
            (Some(text), dot)
        }
        None => (neighbour(picture, ".plan.txt"), neighbour(picture, ".plan.dot")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stay_short_enough_and_keep_their_ending() {
        let long = "ö".repeat(200);
        let name = short_name(&long, ".plan.txt");
        assert!(name.len() <= LONGEST && name.len() > LONGEST - 2 && name.ends_with("ö.plan.txt"), "{name}");
        assert_eq!(neighbour(Path::new("a/b.c.png"), ".plan.txt"), Some("a/b.c.plan.txt".into()));
        let told = with_ending("a.jpg".into(), "--out", &["png", "exr"]);
        assert_eq!(told, Err("--out a.jpg: the file must end in .png or .exr".into()));
        if cfg!(unix) {
            assert!(with_ending("/dev/null".into(), "--out", &["png"]).is_ok());
            assert_eq!(neighbour(Path::new("/dev/null"), ".dot"), None);
        }
    }
}
