//! The probe, from files to verdict, on made-up trees.

use super::super::verdict::{Verdict, judge};
use super::*;
use crate::tree::Tree;

const LOADER: (&str, &str) = ("/usr/lib/libvulkan.so.1", "");
const LAVAPIPE: (&str, &str) = (
    "/usr/share/vulkan/icd.d/lvp_icd.x86_64.json",
    r#"{"ICD": {"api_version": "1.1.230", "library_path": "/usr/lib/libvulkan_lvp.so"}}"#,
);
const LAVAPIPE_LIBRARY: (&str, &str) = ("/usr/lib/libvulkan_lvp.so", "");
const INTEL: (&str, &str) =
    ("/usr/share/vulkan/icd.d/intel_icd.x86_64.json", r#"{"ICD": {"library_path": "libvulkan_intel.so"}}"#);
const INTEL_LIBRARY: (&str, &str) = ("/usr/lib/libvulkan_intel.so", "");

fn read(files: &[(&str, &str)], variables: &[(&str, &str)]) -> Graphics {
    let tree = Tree::new(files);
    let variable = |name: &str| variables.iter().find(|(key, _)| *key == name).map(|(_, value)| OsString::from(value));
    graphics(&Machine { root: tree.root(), variable: &variable })
}

fn usable(files: &[(&str, &str)]) -> bool {
    matches!(judge(&read(files, &[])), Verdict::Usable(_))
}

#[test]
fn each_part_of_a_software_driver_is_needed() {
    assert!(usable(&[LOADER, LAVAPIPE, LAVAPIPE_LIBRARY]));
    assert!(!usable(&[]));
    assert!(!usable(&[LAVAPIPE, LAVAPIPE_LIBRARY]), "no loader");
    assert!(!usable(&[LOADER, LAVAPIPE_LIBRARY]), "no manifest");
    assert!(!usable(&[LOADER, LAVAPIPE]), "no library");
    assert!(!usable(&[LOADER, LAVAPIPE_LIBRARY, (LAVAPIPE.0, "{ cut")]), "a damaged manifest");
}

#[test]
fn a_vendor_driver_needs_its_device() {
    let files = [LOADER, INTEL, INTEL_LIBRARY];
    assert!(!usable(&files));
    let vendor = ("/sys/class/drm/renderD128/device/vendor", "0x8086\n");
    let node = ("/dev/dri/renderD128", "");
    assert!(usable(&[files.as_slice(), &[node, vendor]].concat()));
    let other = (vendor.0, "0x1002\n");
    assert!(!usable(&[files.as_slice(), &[node, other]].concat()));
    // A display-only card has no render node.
    assert!(!usable(&[files.as_slice(), &[("/dev/dri/card0", "")]].concat()));
}

#[test]
fn the_loader_is_found_through_the_linker_cache() {
    // Header bytes, then names and paths, as glibc writes them.
    let cache = ("/etc/ld.so.cache", "glibc-ld.so.cache1.1\0\x03libvulkan.so.1\0/opt/odd/libvulkan.so.1\0");
    let loader = ("/opt/odd/libvulkan.so.1", "");
    assert_eq!(read(&[cache, loader], &[]).loader, Some("/opt/odd/libvulkan.so.1".into()));
    assert_eq!(read(&[cache], &[]).loader, None, "a stale cache");
    let given = read(&[loader], &[("LD_LIBRARY_PATH", "/opt/none:/opt/odd")]);
    assert_eq!(given.loader, Some("/opt/odd/libvulkan.so.1".into()));
}

#[test]
fn a_library_may_lie_beside_its_manifest() {
    let manifest = ("/opt/vk/swift.json", r#"{"ICD": {"library_path": "./libvk_swiftshader.so"}}"#);
    let library = ("/opt/vk/libvk_swiftshader.so", "");
    for place in ["/opt/vk/swift.json", "/opt/vk"] {
        let graphics = read(&[LOADER, manifest, library], &[("VK_DRIVER_FILES", place)]);
        let found = judge(&graphics);
        assert_eq!(found, Verdict::Usable("Vulkan, software (swift.json)".to_owned()), "{place}");
    }
}

#[test]
fn a_variable_hides_the_installed_drivers() {
    let files = [LOADER, LAVAPIPE, LAVAPIPE_LIBRARY];
    let verdict = judge(&read(&files, &[("VK_ICD_FILENAMES", "/gone.json")]));
    assert!(matches!(verdict, Verdict::Overridden { variable: "VK_ICD_FILENAMES", .. }));
}

#[test]
fn a_manifest_found_twice_counts_once() {
    let place = ("VK_ADD_DRIVER_FILES", LAVAPIPE.0);
    assert_eq!(read(&[LOADER, LAVAPIPE, LAVAPIPE_LIBRARY], &[place]).drivers.len(), 1);
}

#[test]
fn device_files_are_distinguished() {
    let devices = |files| read(files, &[]).devices;
    assert!(devices(&[("/dev/nvidia0", "")]).nvidia);
    // The control files exist without any card.
    assert!(!devices(&[("/dev/nvidiactl", ""), ("/dev/nvidia-uvm", "")]).nvidia);
    assert!(devices(&[("/dev/dxg", "")]).dxg);
}

#[test]
fn package_facts_are_read_from_the_tree() {
    let tree = Tree::new(&[
        ("/etc/os-release", "NAME=\"Ubuntu\"\nID=ubuntu\nID_LIKE=\"debian other\"\n"),
        ("/usr/bin/apt-get", ""),
        ("/usr/bin/sudo", ""),
        ("/opt/dnf", ""),
        ("/var/lib/apt/lists/deb.debian.org_main_Packages.lz4", ""),
    ]);
    let variable = |name: &str| (name == "PATH").then(|| OsString::from("/bin:/usr/bin"));
    let packages = packages(&Machine { root: tree.root(), variable: &variable });
    assert_eq!(packages.system_ids, ["ubuntu", "debian", "other"]);
    assert_eq!(packages.programs, ["apt-get", "sudo"]);
    assert!(packages.apt_lists && !packages.pacman_databases);
}

#[test]
fn layers_and_a_display_are_found_or_named() {
    let missing = |files: &[(&str, &str)], variables: &[(&str, &str)]| {
        let tree = Tree::new(files);
        let of = |name: &str| variables.iter().find(|(key, _)| *key == name).map(|(_, value)| OsString::from(value));
        missing_checks(&Machine { root: tree.root(), variable: &of })
    };
    let path = ("PATH", "/bin:/usr/bin");
    let (layers, display) =
        (("/usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json", ""), ("/usr/bin/Xvfb", ""));
    assert_eq!(missing(&[], &[path]), ["Vulkan's validation layers", "Xvfb"]);
    assert_eq!(missing(&[layers], &[path]), ["Xvfb"]);
    assert_eq!(missing(&[display], &[path]), ["Vulkan's validation layers"]);
    assert!(missing(&[layers, display], &[path]).is_empty());
    let own = ("/own/VkLayer_khronos_validation.json", "");
    assert!(missing(&[own, display], &[path, ("VK_LAYER_PATH", "/own")]).is_empty());
}
