//! Which adapter to render on: hardware before software, and what the environment asks for.

use wgpu::{Adapter, AdapterInfo, Backend, Backends, DeviceType, Instance, Limits};

/// What is asked of the adapter. [`AdapterRequest::from_env`] is what programs use.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterRequest {
    /// The graphics interfaces that may be used. The one that does nothing (`Backends::NOOP`) is used only when it is the
    /// only one asked for.
    pub backends: Backends,
    /// A part of the adapter's name, in any case; `None` for any adapter.
    pub name: Option<String>,
    /// Words of `WGPU_BACKEND` that name no interface; with any, nothing is opened.
    pub unknown: Vec<String>,
}

impl Default for AdapterRequest {
    fn default() -> Self {
        Self { backends: Backends::all() - Backends::NOOP, name: None, unknown: Vec::new() }
    }
}

impl AdapterRequest {
    /// What `WGPU_BACKEND` (`vulkan`, `gl`, `metal`, `dx12`, `noop`, separated by commas) and `WGPU_ADAPTER_NAME` (a part
    /// of the name) ask for; the defaults where they are not set.
    pub fn from_env() -> Self {
        let variable = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty());
        let text = |value: std::ffi::OsString| value.to_string_lossy().into_owned();
        let asked = variable("WGPU_BACKEND").map(text);
        let name = variable("WGPU_ADAPTER_NAME").map(text);
        Self { name, ..asked.map_or_else(Self::default, |words| Self::of_backends(&words)) }
    }

    /// Interfaces by name, separated by commas.
    fn of_backends(words: &str) -> Self {
        let mut request = Self { backends: Backends::empty(), ..Self::default() };
        for word in words.split(',').map(str::trim) {
            match Backends::from_comma_list(word) {
                known if !known.is_empty() => request.backends |= known,
                _ => request.unknown.push(word.to_owned()),
            }
        }
        request
    }

    /// Whether `info` is what was asked for.
    pub fn accepts(&self, info: &AdapterInfo) -> bool {
        let name = info.name.to_lowercase();
        self.backends.contains(Backends::from(info.backend))
            && self.name.as_ref().is_none_or(|wanted| name.contains(&wanted.to_lowercase()))
    }
}

/// Smaller is better: discrete, integrated, virtual, unknown, then software; among equals the explicit interfaces first.
pub(crate) fn rank(info: &AdapterInfo) -> (u8, u8) {
    let kind = match info.device_type {
        DeviceType::DiscreteGpu => 0,
        DeviceType::IntegratedGpu => 1,
        DeviceType::VirtualGpu => 2,
        DeviceType::Other => 3,
        DeviceType::Cpu => 4,
    };
    let interface = match info.backend {
        Backend::Vulkan | Backend::Metal => 0,
        Backend::Dx12 => 1,
        Backend::BrowserWebGpu => 2,
        Backend::Gl => 3,
        Backend::Noop => 4,
    };
    (kind, interface)
}

/// Whether there can be a GPU at all: on Linux every driver has a device node, and starting an interface to find that
/// there is none takes time and prints complaints.
pub(crate) fn may_have_hardware() -> bool {
    let nodes = ["/dev/dri", "/dev/nvidiactl", "/dev/dxg", "/dev/kgsl-3d0", "/dev/mali0"];
    !cfg!(target_os = "linux") || nodes.iter().any(|node| std::path::Path::new(node).exists())
}

/// Whether the adapter renders in software on the CPU.
pub fn is_software(info: &AdapterInfo) -> bool {
    info.device_type == DeviceType::Cpu
}

/// Name, kind, interface and driver in one line: `llvmpipe (LLVM 15.0.6, 256 bits) (software, vulkan, llvmpipe Mesa 22.3.6)`.
pub fn describe(info: &AdapterInfo) -> String {
    let kind = match info.device_type {
        DeviceType::DiscreteGpu => "discrete GPU",
        DeviceType::IntegratedGpu => "integrated GPU",
        DeviceType::VirtualGpu => "virtual GPU",
        DeviceType::Other => "unknown kind",
        DeviceType::Cpu => "software",
    };
    let driver = [info.driver.as_str(), info.driver_info.as_str()].into_iter().filter(|s| !s.is_empty());
    let driver = driver.collect::<Vec<_>>().join(" ");
    let driver = if driver.is_empty() { "no driver named".to_owned() } else { driver };
    format!("{} ({kind}, {}, {driver})", info.name, info.backend)
}

/// Every adapter on the interfaces asked for. Those of the second rank are looked at only when the first ones offer
/// nothing that fits, or only software although there may be a GPU.
pub(crate) fn adapters(request: &AdapterRequest) -> Vec<Adapter> {
    let first = enumerate(request.backends & Backends::PRIMARY);
    let enough = |info: AdapterInfo| request.accepts(&info) && !(is_software(&info) && may_have_hardware());
    let rest = request.backends - Backends::PRIMARY;
    if rest.is_empty() || first.iter().any(|a| enough(a.get_info())) {
        return first;
    }
    first.into_iter().chain(enumerate(rest)).collect()
}

fn enumerate(backends: Backends) -> Vec<Adapter> {
    if backends.is_empty() {
        return Vec::new();
    }
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = backends;
    descriptor.backend_options = wgpu::BackendOptions::from_env_or_default();
    descriptor.backend_options.noop.enable = backends == Backends::NOOP;
    descriptor.backend_options.noop.limits = Some(noop_limits());
    // The driver's own validation is for those who ask for it (WGPU_VALIDATION, WGPU_DEBUG); wgpu's is always on.
    descriptor.flags = wgpu::InstanceFlags::VALIDATION_INDIRECT_CALL.with_env();
    pollster::block_on(Instance::new(descriptor).enumerate_adapters(backends))
}

/// WebGPU's guaranteed limits, and several layers attached at once: by itself the adapter that does nothing has no limits, which
/// overflow inside wgpu.
fn noop_limits() -> Limits {
    Limits { max_multiview_view_count: u32::BITS, ..Limits::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn info(name: &str, kind: DeviceType, backend: Backend) -> AdapterInfo {
        AdapterInfo { name: name.into(), ..AdapterInfo::new(kind, backend) }
    }

    #[test]
    fn hardware_comes_before_software() {
        let mut all = [
            info("llvmpipe", DeviceType::Cpu, Backend::Vulkan),
            info("old card", DeviceType::Other, Backend::Gl),
            info("card", DeviceType::DiscreteGpu, Backend::Gl),
            info("card", DeviceType::DiscreteGpu, Backend::Vulkan),
            info("chip", DeviceType::IntegratedGpu, Backend::Vulkan),
        ];
        all.sort_by_key(rank);
        let order: Vec<_> = all.iter().map(|i| (i.name.as_str(), i.backend)).collect();
        let expected = [
            ("card", Backend::Vulkan),
            ("card", Backend::Gl),
            ("chip", Backend::Vulkan),
            ("old card", Backend::Gl),
            ("llvmpipe", Backend::Vulkan),
        ];
        assert_eq!(order, expected);
    }

    #[test]
    fn a_request_filters_by_name_and_interface() {
        let pipe = info("llvmpipe (LLVM)", DeviceType::Cpu, Backend::Vulkan);
        let noop = info("nothing", DeviceType::Other, Backend::Noop);
        assert!(AdapterRequest::default().accepts(&pipe) && !AdapterRequest::default().accepts(&noop));
        let named = AdapterRequest { name: Some("LLVMpipe".into()), ..Default::default() };
        assert!(named.accepts(&pipe));
        let other = AdapterRequest { backends: Backends::GL, ..Default::default() };
        assert!(!other.accepts(&pipe));
    }

    #[test]
    fn interfaces_are_told_from_words_that_name_none() {
        let both = AdapterRequest::of_backends("vulkan, GL");
        assert_eq!((both.backends, both.unknown.len()), (Backends::VULKAN | Backends::GL, 0));
        let typed = AdapterRequest::of_backends("vulcan,gl");
        assert_eq!((typed.backends, typed.unknown), (Backends::GL, vec!["vulcan".to_owned()]));
    }

    #[test]
    fn an_adapter_is_described_in_one_line() {
        let mut pipe = info("llvmpipe", DeviceType::Cpu, Backend::Vulkan);
        pipe.driver = "llvmpipe".into();
        pipe.driver_info = "Mesa 22.3.6".into();
        assert_eq!(describe(&pipe), "llvmpipe (software, vulkan, llvmpipe Mesa 22.3.6)");
    }
}
