//! Facts about this machine, read once. Tests replace the root folder and the environment.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use super::manifest;

/// Source of the facts: `/` and the process's environment, or a made-up tree.
pub struct Machine<'a> {
    /// The folder that stands for `/`.
    pub root: &'a Path,
    /// Looks an environment variable up; an empty one counts as unset.
    pub variable: &'a dyn Fn(&str) -> Option<OsString>,
}

/// Facts that decide whether rendering is possible.
#[derive(Debug)]
pub struct Graphics {
    /// Path of the Vulkan loader.
    pub loader: Option<PathBuf>,
    /// Drivers that the loader would read, in its order.
    pub drivers: Vec<Driver>,
    /// Devices present on this machine.
    pub devices: Devices,
    /// Environment variable that replaces the system's drivers, if one is set.
    pub overridden_by: Option<&'static str>,
}

/// One driver manifest.
#[derive(Debug, PartialEq, Eq)]
pub struct Driver {
    /// Path of the manifest.
    pub manifest: PathBuf,
    /// Library that the manifest names; `None` if the file cannot be read or names none.
    pub library: Option<String>,
    /// True if the dynamic linker would find the library.
    pub library_found: bool,
}

impl Driver {
    /// Returns the manifest's file name.
    pub fn name(&self) -> String {
        let name = self.manifest.file_name().unwrap_or(self.manifest.as_os_str());
        name.to_string_lossy().into_owned()
    }
}

/// The graphics devices in `/dev`.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Devices {
    /// `/dev/dri/renderD*`, by name.
    pub render_nodes: Vec<RenderNode>,
    /// True if a numbered device such as `/dev/nvidia0` exists.
    pub nvidia: bool,
    /// True if `/dev/dxg` exists.
    pub dxg: bool,
}

/// A render node of the kernel's direct rendering manager.
#[derive(Debug, PartialEq, Eq)]
pub struct RenderNode {
    /// PCI vendor, if the kernel reports one.
    pub vendor: Option<u32>,
    /// True if this user may open the node for reading and writing.
    pub accessible: bool,
}

/// Facts that decide how a package is installed.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Packages {
    /// `ID` and then `ID_LIKE` of `/etc/os-release`.
    pub system_ids: Vec<String>,
    /// Programs found on `PATH`, among the package managers and `sudo`.
    pub programs: Vec<&'static str>,
    /// True if this user is root.
    pub root: bool,
    /// True if apt has package lists.
    pub apt_lists: bool,
    /// True if pacman has package databases.
    pub pacman_databases: bool,
    /// True if a terminal is attached, so that a password can be typed.
    pub terminal: bool,
}

/// Reads the facts that decide whether rendering is possible.
pub fn graphics(machine: &Machine<'_>) -> Graphics {
    let search = manifest::search(machine.variable);
    let linker = linker_cache(machine);
    let mut drivers: Vec<Driver> = Vec::new();
    for file in search.places.iter().flat_map(|place| manifests(machine, place)) {
        if drivers.iter().any(|driver| driver.manifest == file) {
            continue;
        }
        let text = fs::read_to_string(machine.at(&file)).unwrap_or_default();
        let library = manifest::library_path(&text);
        let library_found = library.as_ref().is_some_and(|library| match manifest::explicit_path(&file, library) {
            Some(path) => machine.at(&path).is_file(),
            None => find_library(machine, &linker, library).is_some(),
        });
        drivers.push(Driver { manifest: file, library, library_found });
    }
    Graphics {
        loader: find_library(machine, &linker, "libvulkan.so.1"),
        drivers,
        devices: devices(machine),
        overridden_by: search.overridden_by,
    }
}

/// Returns the names of missing tools that tests of Vulkan streams and of windows need.
pub fn missing_checks(machine: &Machine<'_>) -> Vec<&'static str> {
    let given = (machine.variable)("VK_LAYER_PATH").unwrap_or_default();
    let usual = ["/usr/share", "/usr/local/share", "/etc"].map(|at| Path::new(at).join("vulkan/explicit_layer.d"));
    let mut folders = std::env::split_paths(&given).chain(usual);
    let layers =
        folders.any(|folder| machine.names(&folder).iter().any(|name| name == "VkLayer_khronos_validation.json"));
    let path = (machine.variable)("PATH").unwrap_or_default();
    let display = std::env::split_paths(&path).any(|folder| machine.at(&folder.join("Xvfb")).is_file());
    let wanted = [(layers, "Vulkan's validation layers"), (display, "Xvfb")];
    wanted.into_iter().filter(|(there, _)| !there).map(|(_, what)| what).collect()
}

/// Reads the facts that decide how a package is installed.
pub fn packages(machine: &Machine<'_>) -> Packages {
    let release = fs::read_to_string(machine.at(Path::new("/etc/os-release"))).unwrap_or_default();
    let ids = |key: &str| -> Vec<String> {
        let value = release.lines().find_map(|line| line.strip_prefix(key)).unwrap_or_default();
        value.trim_matches('"').split_whitespace().map(str::to_owned).collect()
    };
    let path = (machine.variable)("PATH").unwrap_or_default();
    let on_path =
        |program: &&str| std::env::split_paths(&path).any(|folder| machine.at(&folder.join(program)).is_file());
    let programs = ["apt-get", "dnf", "pacman", "zypper", "apk", "sudo"];
    let any = |folder: &str, part: &str| machine.names(Path::new(folder)).iter().any(|name| name.contains(part));
    Packages {
        system_ids: [ids("ID="), ids("ID_LIKE=")].concat(),
        programs: programs.into_iter().filter(on_path).collect(),
        root: is_root(),
        apt_lists: any("/var/lib/apt/lists", "_Packages"),
        pacman_databases: any("/var/lib/pacman/sync", ".db"),
        terminal: std::io::IsTerminal::is_terminal(&std::io::stdin()),
    }
}

impl Machine<'_> {
    /// Maps a path into this machine's root folder; relative paths are unchanged.
    fn at(&self, path: &Path) -> PathBuf {
        path.strip_prefix("/").map_or_else(|_| path.to_owned(), |path| self.root.join(path))
    }

    /// Returns the names in `folder`, sorted; empty if it cannot be read.
    fn names(&self, folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(self.at(folder)).into_iter().flatten().flatten();
        let mut names: Vec<_> = entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

/// Returns the manifests at `place`: the file itself, or the manifests in the folder.
fn manifests(machine: &Machine<'_>, place: &Path) -> Vec<PathBuf> {
    let json = |path: &Path| path.extension().is_some_and(|extension| extension == "json");
    if machine.at(place).is_dir() {
        let files = machine.names(place).into_iter().map(|name| place.join(name));
        files.filter(|file| json(file)).collect()
    } else if json(place) && machine.at(place).exists() {
        vec![place.to_owned()]
    } else {
        Vec::new()
    }
}

/// Finds a library by its file name, as the dynamic linker does: `LD_LIBRARY_PATH`, the linker's cache, then the usual
/// folders (musl has no cache).
fn find_library(machine: &Machine<'_>, cache: &[PathBuf], library: &str) -> Option<PathBuf> {
    let given = (machine.variable)("LD_LIBRARY_PATH").unwrap_or_default();
    let triplet = format!("{}-linux-gnu", std::env::consts::ARCH);
    let usual = ["/lib", "/usr/lib", "/lib64", "/usr/lib64", "/usr/local/lib"];
    let usual = usual.map(PathBuf::from).into_iter();
    let multiarch = ["/lib", "/usr/lib"].map(|folder| Path::new(folder).join(&triplet)).into_iter();
    let nix = std::iter::once(PathBuf::from("/run/opengl-driver/lib"));
    let given = std::env::split_paths(&given).filter(|folder| !folder.as_os_str().is_empty());
    let folders = given.chain(usual).chain(multiarch).chain(nix);
    let cached = cache.iter().filter(|path| path.ends_with(library)).cloned();
    let mut candidates = folders.map(|folder| folder.join(library)).chain(cached);
    candidates.find(|path| machine.at(path).is_file())
}

/// Reads the library paths in glibc's `/etc/ld.so.cache`. The file is a table of offsets and zero-terminated strings;
/// strings that start with `/` are paths.
fn linker_cache(machine: &Machine<'_>) -> Vec<PathBuf> {
    let bytes = fs::read(machine.at(Path::new("/etc/ld.so.cache"))).unwrap_or_default();
    let strings = bytes.split(|&byte| byte == 0).filter(|string| string.starts_with(b"/"));
    strings.map(|string| PathBuf::from(String::from_utf8_lossy(string).into_owned())).collect()
}

fn devices(machine: &Machine<'_>) -> Devices {
    let nodes = machine.names(Path::new("/dev/dri")).into_iter();
    let render_nodes = nodes.filter(|name| name.starts_with("renderD")).map(|name| {
        let vendor = Path::new("/sys/class/drm").join(&name).join("device/vendor");
        let vendor = fs::read_to_string(machine.at(&vendor)).ok();
        let node = machine.at(&Path::new("/dev/dri").join(&name));
        RenderNode {
            vendor: vendor.and_then(|text| u32::from_str_radix(text.trim().trim_start_matches("0x"), 16).ok()),
            accessible: fs::OpenOptions::new().read(true).write(true).open(node).is_ok(),
        }
    });
    let numbered = |name: &String| {
        let number = name.strip_prefix("nvidia");
        number.is_some_and(|n| !n.is_empty() && n.bytes().all(|byte| byte.is_ascii_digit()))
    };
    let names = machine.names(Path::new("/dev"));
    Devices {
        render_nodes: render_nodes.collect(),
        nvidia: names.iter().any(numbered),
        dxg: names.iter().any(|name| name == "dxg"),
    }
}

/// Returns true if this process may install packages without `sudo`.
#[cfg(unix)]
fn is_root() -> bool {
    // The owner of a process's folder is its effective user; the standard library has no `geteuid`.
    fs::metadata("/proc/self").is_ok_and(|own| std::os::unix::fs::MetadataExt::uid(&own) == 0)
}

/// Returns true: package managers on this system need no `sudo`.
#[cfg(not(unix))]
fn is_root() -> bool {
    false
}

#[cfg(all(test, unix))]
mod tests;
