//! Adapter selection: prefers hardware over software and follows environment variables.

#[cfg(not(target_arch = "wasm32"))]
use wgpu::{Adapter, Instance, Limits};
use wgpu::{AdapterInfo, Backend, Backends, DeviceType};

/// Requirements for an adapter. Programs usually create it with [`AdapterRequest::from_env`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterRequest {
    /// Graphics APIs that may be used. The `NOOP` backend is used only if it is the only one.
    pub backends: Backends,
    /// Part of the adapter's name, case-insensitive; `None` accepts every adapter.
    pub name: Option<String>,
    /// Words of `WGPU_BACKEND` that name no graphics API. If there are any, opening a device fails.
    pub unknown: Vec<String>,
}

impl Default for AdapterRequest {
    fn default() -> Self {
        Self { backends: Backends::all() - Backends::NOOP, name: None, unknown: Vec::new() }
    }
}

impl AdapterRequest {
    /// Reads the request from environment variables. Unset variables leave the defaults.
    ///
    /// - `WGPU_BACKEND`: `vulkan`, `gl`, `metal`, `dx12` or `noop`, separated by commas
    /// - `WGPU_ADAPTER_NAME`: part of the adapter's name
    pub fn from_env() -> Self {
        let variable = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty());
        let text = |value: std::ffi::OsString| value.to_string_lossy().into_owned();
        let asked = variable("WGPU_BACKEND").map(text);
        let name = variable("WGPU_ADAPTER_NAME").map(text);
        Self { name, ..asked.map_or_else(Self::default, |words| Self::of_backends(&words)) }
    }

    /// Parses names of graphics APIs, separated by commas.
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

    /// Returns whether an adapter fulfills the request.
    pub fn accepts(&self, info: &AdapterInfo) -> bool {
        let name = info.name.to_lowercase();
        self.backends.contains(Backends::from(info.backend))
            && self.name.as_ref().is_none_or(|wanted| name.contains(&wanted.to_lowercase()))
    }
}

/// Returns a sort key; smaller is better. Discrete GPUs come first, then integrated, virtual and unknown ones, then
/// software. Ties prefer Vulkan and Metal, then DirectX 12, WebGPU and OpenGL.
#[cfg_attr(target_arch = "wasm32", expect(dead_code, reason = "browsers choose the adapter"))]
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

/// Returns whether the system may have a GPU. On Linux every GPU driver has a device node; checking it is faster than
/// starting a graphics API, and prints no complaints.
#[cfg(not(target_arch = "wasm32"))]
pub(crate) fn may_have_hardware() -> bool {
    let nodes = ["/dev/dri", "/dev/nvidiactl", "/dev/dxg", "/dev/kgsl-3d0", "/dev/mali0"];
    !cfg!(target_os = "linux") || nodes.iter().any(|node| std::path::Path::new(node).exists())
}

/// Returns whether the adapter is a software renderer on the CPU.
pub fn is_software(info: &AdapterInfo) -> bool {
    info.device_type == DeviceType::Cpu
}

/// Describes an adapter in one line, for example `llvmpipe (LLVM 15.0.6, 256 bits) (software, vulkan, llvmpipe Mesa
/// 22.3.6)`.
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
    let driver = if driver.is_empty() { "unknown driver".to_owned() } else { driver };
    format!("{} ({kind}, {}, {driver})", info.name, info.backend)
}

/// Enumerates the adapters of the requested graphics APIs. Secondary APIs are enumerated only if the primary ones have
/// no acceptable adapter, or only software although there may be a GPU.
#[cfg(not(target_arch = "wasm32"))]
pub(crate) fn adapters(request: &AdapterRequest) -> Vec<Adapter> {
    let first = enumerate(request.backends & Backends::PRIMARY);
    let enough = |info: AdapterInfo| request.accepts(&info) && !(is_software(&info) && may_have_hardware());
    let rest = request.backends - Backends::PRIMARY;
    if rest.is_empty() || first.iter().any(|a| enough(a.get_info())) {
        return first;
    }
    first.into_iter().chain(enumerate(rest)).collect()
}

#[cfg(not(target_arch = "wasm32"))]
fn enumerate(backends: Backends) -> Vec<Adapter> {
    if backends.is_empty() {
        return Vec::new();
    }
    pollster::block_on(instance(backends).enumerate_adapters(backends))
}

/// Returns an instance with these graphics APIs.
pub(crate) fn instance(backends: Backends) -> Instance {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = backends;
    descriptor.backend_options = wgpu::BackendOptions::from_env_or_default();
    descriptor.backend_options.noop.enable = backends == Backends::NOOP;
    descriptor.backend_options.noop.limits = Some(noop_limits());
    // Driver validation is off unless requested (WGPU_VALIDATION, WGPU_DEBUG). wgpu's own validation is always on.
    descriptor.flags = wgpu::InstanceFlags::VALIDATION_INDIRECT_CALL.with_env();
    Instance::new(descriptor)
}

/// Returns WebGPU's default limits with multiview. The default limits of wgpu's noop adapter are so large that they
/// overflow inside wgpu.
#[cfg(not(target_arch = "wasm32"))]
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
    fn a_request_filters_by_name_and_graphics_api() {
        let pipe = info("llvmpipe (LLVM)", DeviceType::Cpu, Backend::Vulkan);
        let noop = info("nothing", DeviceType::Other, Backend::Noop);
        assert!(AdapterRequest::default().accepts(&pipe) && !AdapterRequest::default().accepts(&noop));
        let named = AdapterRequest { name: Some("LLVMpipe".into()), ..Default::default() };
        assert!(named.accepts(&pipe));
        let other = AdapterRequest { backends: Backends::GL, ..Default::default() };
        assert!(!other.accepts(&pipe));
    }

    #[test]
    fn unknown_graphics_apis_are_reported() {
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
