//! Decides which installed driver can run on this machine.
//!
//! A manifest alone proves little. Distributions install the drivers of all vendors together, so manifests of absent
//! GPUs are common. The loader or a library may be missing. A driver counts only together with its library and the
//! device it drives.

use super::facts::{Devices, Driver, Graphics};

/// Verdict on whether rendering is possible.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// A driver can run: description of the usable drivers, hardware first.
    Usable(String),
    /// No driver can run, and installing a software driver would help: the reason.
    Missing(String),
    /// No driver can run, and installing one would not help, because an environment variable replaces the search path.
    Overridden {
        /// Name of the environment variable.
        variable: &'static str,
        /// Reason the drivers it names are not usable.
        reason: String,
    },
}

/// Device that a driver needs besides its library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Needs {
    /// No device: the driver renders on the CPU.
    Cpu,
    /// A render node of this PCI vendor.
    Vendor(u32),
    /// NVIDIA's own device file.
    Nvidia,
    /// The paravirtual device of the Windows Subsystem for Linux.
    Dxg,
    /// Any render node: GPUs on a system-on-chip and virtual GPUs have no vendor id.
    RenderNode,
}

/// Judges the drivers of a machine.
pub fn judge(graphics: &Graphics) -> Verdict {
    let Graphics { loader, drivers, devices, overridden_by } = graphics;
    let missing = |reason: String| match overridden_by {
        // Without a loader, a driver package still helps: it brings the loader along.
        Some(variable) if loader.is_some() => Verdict::Overridden { variable, reason },
        _ => Verdict::Missing(reason),
    };
    if loader.is_none() {
        return missing("the Vulkan loader libvulkan.so.1 is not installed".to_owned());
    }
    if drivers.is_empty() {
        return missing("no Vulkan driver is installed".to_owned());
    }
    let mut hardware = Vec::new();
    let mut software = Vec::new();
    let mut unusable = Vec::new();
    for driver in drivers {
        match lack(driver, devices) {
            Some(lack) => unusable.push(format!("{} {lack}", driver.name())),
            None if needs(driver) == Needs::Cpu => software.push(driver.name()),
            None => hardware.push(driver.name()),
        }
    }
    let kinds = [("hardware", hardware), ("software", software)];
    let found: Vec<String> = kinds
        .iter()
        .filter(|(_, names)| !names.is_empty())
        .map(|(kind, names)| format!("{kind} ({})", names.join(", ")))
        .collect();
    if found.is_empty() {
        return missing(format!("no installed Vulkan driver can run: {}", unusable.join(", ")));
    }
    Verdict::Usable(format!("Vulkan, {}", found.join(", then ")))
}

/// Returns the reason `driver` cannot run here; `None` if it can.
fn lack(driver: &Driver, devices: &Devices) -> Option<&'static str> {
    let Some(_) = driver.library else {
        return Some("is not readable as a manifest");
    };
    if !driver.library_found {
        return Some("has lost its library");
    }
    let nodes = &devices.render_nodes;
    let fits = |vendor: Option<u32>, wanted: u32| vendor.is_none_or(|vendor| vendor == wanted);
    let (present, open) = match needs(driver) {
        Needs::Cpu => (true, true),
        Needs::Nvidia => (devices.nvidia, true),
        Needs::Dxg => (devices.dxg, true),
        Needs::RenderNode => (!nodes.is_empty(), nodes.iter().any(|node| node.accessible)),
        Needs::Vendor(wanted) => {
            let mut mine = nodes.iter().filter(|node| fits(node.vendor, wanted)).peekable();
            (mine.peek().is_some(), mine.any(|node| node.accessible))
        }
    };
    match (present, open) {
        (false, _) => Some("has no device"),
        (true, false) => Some("may not open its device"),
        (true, true) => None,
    }
}

/// Returns the device that `driver` needs, judged by the names of its library and manifest.
fn needs(driver: &Driver) -> Needs {
    const NAMES: &[(&str, Needs)] = &[
        ("lvp", Needs::Cpu),
        ("swiftshader", Needs::Cpu),
        ("nvidia", Needs::Nvidia),
        ("intel", Needs::Vendor(0x8086)),
        ("radeon", Needs::Vendor(0x1002)),
        ("amdvlk", Needs::Vendor(0x1002)),
        ("nouveau", Needs::Vendor(0x10de)),
        ("dzn", Needs::Dxg),
    ];
    let library = driver.library.as_deref().unwrap_or_default();
    let library = library.rsplit('/').next().unwrap_or_default();
    let names = [library.to_lowercase(), driver.name().to_lowercase()];
    let named = |part: &str| names.iter().any(|name| name.contains(part));
    NAMES.iter().find(|(part, _)| named(part)).map_or(Needs::RenderNode, |&(_, needs)| needs)
}

#[cfg(test)]
mod tests {
    use super::super::facts::RenderNode;
    use super::*;

    fn driver(manifest: &str, library: &str) -> Driver {
        Driver {
            manifest: format!("/usr/share/vulkan/icd.d/{manifest}").into(),
            library: Some(library.to_owned()),
            library_found: true,
        }
    }

    fn mesa() -> Vec<Driver> {
        vec![
            driver("intel_icd.x86_64.json", "/usr/lib/libvulkan_intel.so"),
            driver("radeon_icd.x86_64.json", "/usr/lib/libvulkan_radeon.so"),
        ]
    }

    fn machine(drivers: Vec<Driver>, devices: Devices) -> Graphics {
        Graphics { loader: Some("/lib/libvulkan.so.1".into()), drivers, devices, overridden_by: None }
    }

    fn node(vendor: Option<u32>, accessible: bool) -> Devices {
        Devices { render_nodes: vec![RenderNode { vendor, accessible }], ..Devices::default() }
    }

    fn refusal(graphics: &Graphics) -> String {
        match judge(graphics) {
            Verdict::Missing(reason) => reason,
            other => panic!("{other:?}"),
        }
    }

    fn found(graphics: &Graphics) -> String {
        match judge(graphics) {
            Verdict::Usable(found) => found,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn vendor_manifests_without_a_device_are_not_usable() {
        let reason = refusal(&machine(mesa(), Devices::default()));
        assert!(reason.contains("intel_icd.x86_64.json has no device"), "{reason}");
        assert!(reason.contains("radeon_icd.x86_64.json has no device"), "{reason}");
    }

    #[test]
    fn a_vendor_driver_needs_a_node_of_its_vendor_that_opens() {
        let amd = machine(mesa(), node(Some(0x1002), true));
        assert_eq!(found(&amd), "Vulkan, hardware (radeon_icd.x86_64.json)");
        assert!(refusal(&machine(mesa(), node(Some(0x10de), true))).contains("has no device"));
        let closed = refusal(&machine(mesa(), node(Some(0x8086), false)));
        assert!(closed.contains("intel_icd.x86_64.json may not open its device"), "{closed}");
        // If the kernel does not report the vendor, the driver counts as usable.
        assert!(found(&machine(mesa(), node(None, true))).contains("intel_icd.x86_64.json"));
    }

    #[test]
    fn hardware_is_named_before_software() {
        let mut drivers = vec![driver("lvp_icd.x86_64.json", "libvulkan_lvp.so")];
        drivers.extend(mesa());
        let text = found(&machine(drivers, node(Some(0x8086), true)));
        assert_eq!(text, "Vulkan, hardware (intel_icd.x86_64.json), then software (lvp_icd.x86_64.json)");
    }

    #[test]
    fn software_drivers_need_a_loader_and_their_library() {
        let lavapipe = || vec![driver("lvp_icd.json", "libvulkan_lvp.so")];
        assert!(matches!(judge(&machine(lavapipe(), Devices::default())), Verdict::Usable(_)));
        let no_loader = Graphics { loader: None, ..machine(lavapipe(), Devices::default()) };
        assert!(refusal(&no_loader).contains("libvulkan.so.1"));
        let mut lost = lavapipe();
        lost[0].library_found = false;
        assert!(refusal(&machine(lost, Devices::default())).contains("has lost its library"));
        let mut unreadable = lavapipe();
        unreadable[0].library = None;
        assert!(refusal(&machine(unreadable, Devices::default())).contains("not readable"));
        assert!(refusal(&machine(Vec::new(), Devices::default())).contains("no Vulkan driver"));
    }

    #[test]
    fn other_kinds_of_device_are_recognised() {
        let nvidia = || vec![driver("nvidia_icd.json", "libGLX_nvidia.so.0")];
        let card = Devices { nvidia: true, ..Devices::default() };
        assert!(found(&machine(nvidia(), card)).contains("hardware (nvidia_icd.json)"));
        // An open render node of another driver does not make NVIDIA's own driver run.
        assert!(refusal(&machine(nvidia(), node(Some(0x10de), true))).contains("no device"));
        let dzn = vec![driver("dzn_icd.json", "libvulkan_dzn.so")];
        let wsl = Devices { dxg: true, ..Devices::default() };
        assert!(matches!(judge(&machine(dzn, wsl)), Verdict::Usable(_)));
        let board = || vec![driver("broadcom_icd.json", "libvulkan_broadcom.so")];
        assert!(matches!(judge(&machine(board(), node(None, true))), Verdict::Usable(_)));
        assert!(refusal(&machine(board(), Devices::default())).contains("no device"));
    }

    #[test]
    fn a_variable_that_shuts_out_every_driver_is_blamed() {
        let empty = machine(Vec::new(), Devices::default());
        let shut = Graphics { overridden_by: Some("VK_DRIVER_FILES"), ..empty };
        let Verdict::Overridden { variable, .. } = judge(&shut) else { panic!("{:?}", judge(&shut)) };
        assert_eq!(variable, "VK_DRIVER_FILES");
        assert!(matches!(judge(&Graphics { loader: None, ..shut }), Verdict::Missing(_)));
    }
}
