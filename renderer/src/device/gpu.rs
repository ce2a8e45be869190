//! The opened device with its queue, limits and features, and the errors it reported.

#[cfg(not(target_arch = "wasm32"))]
use crate::device::adapter::{AdapterRequest, adapters, rank};
use crate::device::adapter::{describe, is_software};
use crate::device::error::{DeviceError, DeviceErrors, ErrorScopes, Watch};
use crate::device::format::texture_format;
use crate::device::open_error::OpenError;
use framegraph::{Caps, Format};
use std::sync::{Arc, OnceLock, atomic};
use wgpu::{
    Adapter, AdapterInfo, Backend, Device, DownlevelFlags, Features, Instance, Queue, RequestAdapterOptions, Surface,
    TextureFormatFeatureFlags, TextureFormatFeatures, TextureUsages,
};

/// A wgpu device with its queue. Clones refer to the same device and are cheap.
///
/// ```no_run
/// use framegraph_wgpu::{AdapterRequest, Gpu};
///
/// // WGPU_BACKEND and WGPU_ADAPTER_NAME select the adapter; hardware is preferred over software.
/// let gpu = Gpu::open(&AdapterRequest::from_env())?;
/// println!("rendering on {}", gpu.describe());
/// // Calls that wgpu rejects become errors, also outside of frames.
/// let sampler = gpu.guard("a sampler", || gpu.device.create_sampler(&Default::default()))?;
/// # drop(sampler);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// Applications that already have a device use [`Gpu::wrap`].
#[derive(Clone, Debug)]
pub struct Gpu {
    /// wgpu device.
    pub device: Device,
    /// Queue of the device.
    pub queue: Queue,
    adapter: Adapter,
    info: AdapterInfo,
    errors: Arc<DeviceErrors>,
    /// True if errors outside of scopes are stored in `errors`.
    handled: bool,
    waits: Arc<atomic::AtomicU64>,
    pub(super) caps: Arc<OnceLock<Caps>>,
    view_formats: bool,
    formats: Arc<[OnceLock<TextureFormatFeatures>; Format::ALL.len()]>,
    pub(super) attached_layers: Arc<OnceLock<u32>>,
}

/// Compares devices by identity. wgpu handles of devices from two instances may compare equal, so they are not used.
impl PartialEq for Gpu {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.errors, &other.errors)
    }
}

/// Features that are enabled if the adapter has them. None of them is required.
const WANTED: Features = Features::TIMESTAMP_QUERY
    .union(Features::TIMESTAMP_QUERY_INSIDE_ENCODERS)
    .union(Features::RG11B10UFLOAT_RENDERABLE)
    .union(Features::FLOAT32_FILTERABLE)
    .union(Features::FLOAT32_BLENDABLE)
    .union(Features::DEPTH32FLOAT_STENCIL8)
    .union(Features::BGRA8UNORM_STORAGE)
    .union(Features::SHADER_F16)
    .union(Features::CLEAR_TEXTURE)
    .union(Features::DEPTH_CLIP_CONTROL)
    .union(Features::INDIRECT_FIRST_INSTANCE)
    .union(Features::MULTIVIEW)
    .union(Features::PIPELINE_CACHE)
    .union(Features::TEXTURE_COMPRESSION_BC)
    .union(Features::TEXTURE_COMPRESSION_ETC2)
    .union(Features::TEXTURE_COMPRESSION_ASTC)
    .union(Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES);

impl Gpu {
    /// Opens a device on the best adapter that fulfills the request, preferring hardware over software. Adapters that
    /// fail to open are skipped.
    ///
    /// Errors outside of error scopes are stored and reported by the next frame. Do not open your own error scopes
    /// around a frame, because they would catch its errors.
    ///
    /// # Errors
    /// Fails with [`OpenError`], which lists the adapters and their reasons.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn open(request: &AdapterRequest) -> Result<Self, OpenError> {
        request.check()?;
        let built = Instance::enabled_backend_features();
        if !built.intersects(request.backends) {
            return Err(OpenError::NotBuilt { requested: request.backends, built });
        }
        Self::open_one_of(request, &adapters(request), |_| true)
    }

    /// Opens a device on the best of the adapters that fulfill the request and that `fits` accepts.
    pub(crate) fn open_one_of(
        request: &AdapterRequest,
        all: &[Adapter],
        fits: impl Fn(&Adapter) -> bool,
    ) -> Result<Self, OpenError> {
        let mut fitting: Vec<_> = all.iter().filter(|a| request.accepts(&a.get_info()) && fits(a)).collect();
        fitting.sort_by_key(|a| rank(&a.get_info()));
        if fitting.is_empty() {
            let found = all.iter().map(Adapter::get_info).collect();
            return Err(OpenError::NoAdapter { requested: request.clone(), found });
        }
        let mut refusals = Vec::new();
        for adapter in fitting {
            match open_device(adapter) {
                Ok((device, queue)) => return Ok(Self::owned(adapter.clone(), device, queue)),
                Err(error) => refusals.push((adapter.get_info(), error.to_string())),
            }
        }
        Err(OpenError::Refused { refusals })
    }

    /// Opens a device on the adapter that wgpu prefers, and that can draw into `surface` if there is one.
    ///
    /// Browsers have only this way, because they open devices asynchronously. Other programs can block on the future.
    /// Errors are handled as by `Gpu::open`. In browsers, wgpu may report a rejected call one frame later.
    ///
    /// # Errors
    /// Fails with [`OpenError`] if no adapter fits, or if it cannot open a device.
    pub async fn request(instance: &Instance, surface: Option<&Surface<'_>>) -> Result<Self, OpenError> {
        let options = RequestAdapterOptions { compatible_surface: surface, ..Default::default() };
        let adapter = instance.request_adapter(&options).await;
        let adapter = adapter.map_err(|error| OpenError::NoneFits { reason: error.to_string() })?;
        match adapter.request_device(&Self::descriptor(&adapter)).await {
            Ok((device, queue)) => Ok(Self::owned(adapter, device, queue)),
            Err(error) => Err(OpenError::Refused { refusals: vec![(adapter.get_info(), error.to_string())] }),
        }
    }

    /// Opens a device that validates all calls and draws nothing, for tests without a driver. Requires the feature
    /// `noop`.
    ///
    /// # Errors
    /// Fails with [`OpenError`] if wgpu cannot open the noop device, which is not known to happen.
    #[cfg(all(feature = "noop", not(target_arch = "wasm32")))]
    pub fn noop() -> Result<Self, OpenError> {
        Self::open(&AdapterRequest { backends: wgpu::Backends::NOOP, ..AdapterRequest::default() })
    }

    /// Wraps a device that the application opened. The application keeps its error handlers.
    ///
    /// Errors inside a frame are caught with error scopes. To make frames report a lost device, forward the loss with
    /// [`DeviceErrors::report_lost`] of [`Gpu::shared_errors`].
    pub fn wrap(adapter: &Adapter, device: &Device, queue: &Queue) -> Self {
        let (device, queue) = (device.clone(), queue.clone());
        let flags = adapter.get_downlevel_capabilities().flags;
        let view_formats = flags.contains(DownlevelFlags::VIEW_FORMATS);
        let formats = Arc::new([const { OnceLock::new() }; Format::ALL.len()]);
        Self {
            device,
            queue,
            info: adapter.get_info(),
            adapter: adapter.clone(),
            errors: Arc::default(),
            handled: false,
            waits: Arc::default(),
            caps: Arc::default(),
            view_formats,
            formats,
            attached_layers: Arc::default(),
        }
    }

    /// Returns the device descriptor to use before [`Gpu::wrap`]. It requests every useful feature the adapter offers,
    /// and all its limits.
    pub fn descriptor(adapter: &Adapter) -> wgpu::DeviceDescriptor<'static> {
        // The noop adapter claims this feature, but then reports no usages for any format.
        let noop = adapter.get_info().backend == Backend::Noop;
        let mut wanted = WANTED;
        wanted.set(Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES, !noop);
        wgpu::DeviceDescriptor {
            label: Some("renderer"),
            required_features: adapter.features() & wanted,
            required_limits: adapter.limits(),
            ..Default::default()
        }
    }

    fn owned(adapter: Adapter, device: Device, queue: Queue) -> Self {
        let gpu = Self { handled: true, ..Self::wrap(&adapter, &device, &queue) };
        let errors = gpu.errors.clone();
        device.on_uncaptured_error(Arc::new(move |error| errors.uncaught(&error)));
        let errors = gpu.errors.clone();
        device.set_device_lost_callback(move |reason, message| {
            errors.report_lost(format!("{reason:?}: {message}"));
        });
        gpu
    }

    /// Describes the adapter in one line: name, kind, graphics API and driver.
    pub fn describe(&self) -> String {
        describe(&self.info)
    }

    pub(crate) fn adapter(&self) -> &Adapter {
        &self.adapter
    }

    /// Returns wgpu's information about the adapter.
    pub fn info(&self) -> &AdapterInfo {
        &self.info
    }

    /// Returns whether the adapter is a software renderer.
    pub fn is_software(&self) -> bool {
        is_software(&self.info)
    }

    /// Returns what the device can do with a format. The driver is queried once per format. Empty if the format needs a
    /// feature that is not enabled.
    pub fn format_features(&self, format: Format) -> TextureFormatFeatures {
        *self.formats[format as usize].get_or_init(|| {
            let (format, features) = (texture_format(format), self.device.features());
            if !features.contains(format.required_features()) {
                let (allowed_usages, flags) = (TextureUsages::empty(), TextureFormatFeatureFlags::empty());
                return TextureFormatFeatures { allowed_usages, flags };
            }
            if features.contains(Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES) {
                self.adapter.get_texture_format_features(format)
            } else {
                format.guaranteed_format_features(features)
            }
        })
    }

    /// Returns whether texture views may change between linear and sRGB. OpenGL does not support this.
    pub fn has_view_formats(&self) -> bool {
        self.view_formats
    }

    /// Returns the errors that the device's handlers reported.
    pub fn errors(&self) -> &DeviceErrors {
        &self.errors
    }

    /// Returns the reported errors as a shared value for error handlers. It does not keep the device alive.
    pub fn shared_errors(&self) -> Arc<DeviceErrors> {
        self.errors.clone()
    }

    /// Runs `work` and returns errors that wgpu reports during it. `doing` completes the sentence "wgpu rejected …".
    ///
    /// # Errors
    /// Fails with [`DeviceError`] if the device is lost, or wgpu rejects a call of `work`.
    pub fn guard<T>(&self, doing: &'static str, work: impl FnOnce() -> T) -> Result<T, DeviceError> {
        self.errors.check(doing)?;
        let scopes = ErrorScopes::open(&self.device);
        let out = work();
        scopes.close(doing)?;
        self.errors.check(doing)?;
        Ok(out)
    }

    /// Begins a part of a frame whose errors are collected.
    pub(crate) fn watch(&self, doing: &'static str) -> Watch {
        Watch::begin(&self.device, self.handled, doing)
    }

    /// Runs callbacks of finished work without waiting.
    ///
    /// # Errors
    /// Fails if the device is lost.
    pub fn poll(&self) -> Result<(), DeviceError> {
        self.poll_as(wgpu::PollType::Poll, "looking for finished work")
    }

    /// Waits until all submitted work is done. In browsers, which cannot wait, this is [`Gpu::poll`].
    ///
    /// # Errors
    /// Fails if the device is lost.
    pub fn wait(&self) -> Result<(), DeviceError> {
        self.waits.fetch_add(1, atomic::Ordering::Relaxed);
        self.poll_as(wgpu::PollType::wait_indefinitely(), "waiting for submitted work")
    }

    /// Returns how many times [`Gpu::wait`] was called. Stays constant in a frame loop that never stalls.
    pub fn waits(&self) -> u64 {
        self.waits.load(atomic::Ordering::Relaxed)
    }

    pub(crate) fn poll_as(&self, kind: wgpu::PollType, doing: &'static str) -> Result<(), DeviceError> {
        self.errors.check(doing)?;
        // Browsers cannot wait: they call back when the program returns to them.
        let kind = if cfg!(target_arch = "wasm32") { wgpu::PollType::Poll } else { kind };
        // wgpu 30 panics if the device is lost during the wait (`handle_error_fatal` in `Device::poll`).
        let polled = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| self.device.poll(kind)));
        let reason = match polled {
            Ok(Ok(_)) => return self.errors.check(doing),
            Ok(Err(error)) => error.to_string(),
            Err(_) => "the driver reported a loss".to_owned(),
        };
        self.errors.report_lost(reason);
        self.errors.check(doing)
    }
}

#[cfg(not(target_arch = "wasm32"))]
fn open_device(adapter: &Adapter) -> Result<(Device, Queue), wgpu::RequestDeviceError> {
    pollster::block_on(adapter.request_device(&Gpu::descriptor(adapter)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use wgpu::Backends;

    #[test]
    fn a_device_is_opened_only_if_it_matches() -> Result<(), OpenError> {
        let noop = Gpu::noop()?;
        assert_eq!(noop.info().backend, Backend::Noop);
        assert!(noop == noop.clone() && noop != Gpu::noop()?, "devices of two instances differ");
        let named = AdapterRequest {
            backends: Backends::NOOP,
            name: Some("no such adapter".into()),
            ..AdapterRequest::default()
        };
        let error = Gpu::open(&named).map(|_| ()).map_err(|e| e.to_string());
        assert!(error.is_err_and(|e| e.contains("no such adapter") && e.contains("found:")));
        Ok(())
    }

    #[test]
    fn a_rejected_call_is_an_error_with_wgpus_reason() -> Result<(), OpenError> {
        let gpu = Gpu::noop()?;
        let size = wgpu::BufferDescriptor {
            label: Some("huge"),
            size: u64::MAX,
            usage: wgpu::BufferUsages::VERTEX,
            mapped_at_creation: false,
        };
        let refused = gpu.guard("a buffer", || gpu.device.create_buffer(&size)).map(|_| ());
        assert!(matches!(refused, Err(DeviceError::Refused { .. })), "{refused:?}");
        assert!(gpu.guard("nothing", || ()).is_ok(), "the error must not stay");
        drop(gpu.device.create_buffer(&size));
        assert!(gpu.guard("nothing", || ()).is_err(), "an error outside of a scope is reported by the next guard");
        Ok(())
    }

    #[test]
    fn a_lost_device_stays_an_error() -> Result<(), OpenError> {
        let gpu = Gpu::noop()?;
        assert!(gpu.wait().is_ok());
        gpu.device.destroy();
        drop(gpu.device.poll(wgpu::PollType::Poll));
        assert!(matches!(gpu.wait(), Err(DeviceError::Lost { .. })));
        assert!(matches!(gpu.guard("anything", || ()), Err(DeviceError::Lost { .. })));
        Ok(())
    }
}
