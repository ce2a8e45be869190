//! Whether a driver keeps the order of commands that reach one memory through different textures.

use wgpu::AdapterInfo;

/// Mesa's llvmpipe orders commands by texture and not by memory within one submission, whatever barriers say: a dispatch into
/// an alias runs before the drawing that reads the earlier one. From version 25 on it waits at barriers.
pub(crate) fn keeps_order_of_aliases(info: &AdapterInfo) -> bool {
    if info.driver != "llvmpipe" {
        return true;
    }
    let version = info.driver_info.strip_prefix("Mesa ").and_then(|rest| rest.split('.').next());
    version.and_then(|major| major.parse::<u32>().ok()).is_some_and(|major| major >= 25)
}

#[cfg(test)]
mod tests {
    use super::*;
    use wgpu::{Backend, DeviceType};

    #[test]
    fn old_software_drivers_do_not() {
        for (driver, version, keeps) in [
            ("llvmpipe", "Mesa 22.3.6 (LLVM 15.0.6)", false),
            ("llvmpipe", "Mesa 25.0.7", true),
            ("llvmpipe", "of unknown age", false),
            ("NVIDIA", "550.1", true),
        ] {
            let mut info = AdapterInfo::new(DeviceType::Cpu, Backend::Vulkan);
            (info.driver, info.driver_info) = (driver.into(), version.into());
            assert_eq!(keeps_order_of_aliases(&info), keeps, "{driver} {version}");
        }
    }
}
