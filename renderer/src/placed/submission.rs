//! Detection of drivers that do not order accesses to shared memory within a submission.

use wgpu::AdapterInfo;

/// Returns whether the driver orders accesses to memory that several textures share.
///
/// Mesa's llvmpipe before version 25 orders commands by texture within a submission, regardless of barriers. A dispatch
/// into one alias may then run before the draw that reads another. Newer versions wait at barriers.
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
    fn old_llvmpipe_does_not_order_aliases() {
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
