//! Vulkan driver manifests: search order, and the library each names.
//!
//! Search order and environment variables follow "Driver Discovery on Linux" of the Vulkan loader's
//! `LoaderDriverInterface.md`.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// Manifests that the loader reads, as files or folders of files.
#[derive(Debug, PartialEq, Eq)]
pub struct Search {
    /// Files and folders, in the loader's order.
    pub places: Vec<PathBuf>,
    /// Environment variable that replaces the system's places, if one is set.
    pub overridden_by: Option<&'static str>,
}

/// Returns the places where the loader looks for manifests.
///
/// `VK_DRIVER_FILES`, or else the older `VK_ICD_FILENAMES`, replaces every other place;
/// `VK_ADD_DRIVER_FILES` goes before the system's places.
pub fn search(variable: &dyn Fn(&str) -> Option<OsString>) -> Search {
    let list = |name: &str| -> Vec<PathBuf> {
        variable(name).map_or_else(Vec::new, |value| std::env::split_paths(&value).collect())
    };
    for name in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
        if variable(name).is_some() {
            return Search { places: list(name), overridden_by: Some(name) };
        }
    }
    let home = variable("HOME").map(PathBuf::from);
    let under_home = |name: &str, folder: &str| {
        variable(name).map(PathBuf::from).or_else(|| home.as_ref().map(|home| home.join(folder)))
    };
    let or_else = |name: &str, folders: &[&str]| {
        let given = list(name);
        if given.is_empty() { folders.iter().map(PathBuf::from).collect() } else { given }
    };
    let mut folders: Vec<PathBuf> = Vec::new();
    folders.extend(under_home("XDG_CONFIG_HOME", ".config"));
    folders.extend(or_else("XDG_CONFIG_DIRS", &["/etc/xdg"]));
    folders.extend(["/usr/local/etc", "/etc"].map(PathBuf::from));
    folders.extend(under_home("XDG_DATA_HOME", ".local/share"));
    folders.extend(or_else("XDG_DATA_DIRS", &["/usr/local/share", "/usr/share"]));
    // NixOS keeps its drivers here and patches the loader to look.
    folders.push(PathBuf::from("/run/opengl-driver/share"));
    let mut places = list("VK_ADD_DRIVER_FILES");
    places.extend(folders.iter().map(|folder| folder.join("vulkan/icd.d")));
    Search { places, overridden_by: None }
}

/// Returns the value of `library_path` in a manifest's JSON; `None` if there is none. The value is a file name for the
/// dynamic linker, or a path, absolute or relative to the manifest.
///
/// Reads only this string and ignores the rest of the document.
pub fn library_path(manifest: &str) -> Option<String> {
    let (_, rest) = manifest.split_once("\"library_path\"")?;
    let mut characters = rest.trim_start().strip_prefix(':')?.trim_start().strip_prefix('"')?.chars();
    let mut path = String::new();
    loop {
        match characters.next()? {
            '"' => return Some(path).filter(|path| !path.is_empty()),
            '\\' => path.push(characters.next()?),
            character => path.push(character),
        }
    }
}

/// Returns the path of a manifest's library; `None` if it is a bare file name.
pub fn explicit_path(manifest: &Path, library: &str) -> Option<PathBuf> {
    // `join` with an absolute path yields that path.
    library.contains('/').then(|| manifest.parent().unwrap_or(manifest).join(library))
}

// Lists of paths are separated by a colon below.
#[cfg(all(test, unix))]
mod tests {
    use super::*;

    fn places(variables: &[(&str, &str)]) -> Search {
        let variables: Vec<_> = variables.iter().map(|&(k, v)| (k.to_owned(), v.to_owned())).collect();
        search(&|name| variables.iter().find(|(key, _)| key == name).map(|(_, v)| v.into()))
    }

    #[test]
    fn the_system_places_are_searched_by_default() {
        let search = places(&[("HOME", "/home/u")]);
        assert_eq!(search.overridden_by, None);
        for place in [
            "/home/u/.config/vulkan/icd.d",
            "/etc/vulkan/icd.d",
            "/home/u/.local/share/vulkan/icd.d",
            "/usr/share/vulkan/icd.d",
        ] {
            assert!(search.places.contains(&PathBuf::from(place)), "{place}");
        }
    }

    #[test]
    fn the_environment_replaces_and_adds() {
        let both = places(&[("VK_ICD_FILENAMES", "/old.json"), ("VK_DRIVER_FILES", "/a.json:/b")]);
        let expected = Search { places: vec!["/a.json".into(), "/b".into()], overridden_by: Some("VK_DRIVER_FILES") };
        assert_eq!(both, expected);
        let old = places(&[("VK_ICD_FILENAMES", "/old.json"), ("VK_ADD_DRIVER_FILES", "/x")]);
        assert_eq!(old.places, [PathBuf::from("/old.json")]);
        let added = places(&[("VK_ADD_DRIVER_FILES", "/x.json"), ("XDG_DATA_DIRS", "/opt/share")]);
        assert_eq!(added.places.first(), Some(&"/x.json".into()));
        assert!(added.places.contains(&"/opt/share/vulkan/icd.d".into()));
        assert!(!added.places.contains(&"/usr/share/vulkan/icd.d".into()));
    }

    #[test]
    fn the_library_is_read_from_the_manifest() {
        let text = "{ \"ICD\": {\n \"api_version\": \"1.1\",\n \"library_path\" : \"/usr\\/lib/libvulkan_lvp.so\" } }";
        assert_eq!(library_path(text).as_deref(), Some("/usr/lib/libvulkan_lvp.so"));
        for bad in
            ["", "{}", "\"library_path\"", "\"library_path\": 3", "\"library_path\": \"cut", "\"library_path\": \"\""]
        {
            assert_eq!(library_path(bad), None, "{bad}");
        }
    }

    #[test]
    fn a_library_is_a_name_or_a_path_beside_its_manifest() {
        let manifest = Path::new("/opt/vk/icd.json");
        assert_eq!(explicit_path(manifest, "libGLX_nvidia.so.0"), None);
        assert_eq!(explicit_path(manifest, "./lib.so"), Some("/opt/vk/./lib.so".into()));
        assert_eq!(explicit_path(manifest, "/usr/lib/lib.so"), Some("/usr/lib/lib.so".into()));
    }
}
