//! Traces of a device: opening a device that writes one, and reading it.
//!
//! wgpu records every call of a device if asked when the device is opened. This is how the report sees passes,
//! textures and bindings that Bevy creates, without changes to Bevy.

use bevy_render::renderer::{RenderAdapter, RenderAdapterInfo, RenderDevice, RenderInstance, RenderQueue};
use bevy_render::settings::RenderCreation;
use std::path::{Path, PathBuf};
use wgpu_core::command::PointerReferences;
use wgpu_core::device::trace::Action as CoreAction;

/// A call of the device, as wgpu recorded it.
pub(crate) type Action = CoreAction<'static, PointerReferences>;

/// Start of the label of the buffer that marks the start of a frame; the frame's index follows.
pub(crate) const FRAME_MARK: &str = "framegraph-bevy frame ";
/// Label of the view that marks the output of a camera.
pub(crate) const OUTPUT_MARK: &str = "framegraph-bevy output";

/// Failure to open a device or to read a trace.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TraceError {
    /// No adapter, or it refused the device.
    #[error("device: {0}; check the graphics driver")]
    Device(String),
    /// A file cannot be read or written.
    #[error("{}: {error}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The operating system's error.
        error: std::io::Error,
    },
    /// The trace is not one of this version of wgpu.
    #[error("{}: {error}; record the trace with the same version of wgpu", path.display())]
    Syntax {
        /// The file.
        path: PathBuf,
        /// Position and cause.
        error: Box<ron::error::SpannedError>,
    },
    /// The trace ends too early.
    #[error("frame {frame} is not in the trace; run at least {} frames with `ReportPlugin`", frame + 3)]
    NoFrame {
        /// Index of the frame.
        frame: u32,
    },
}

/// Device, queue and adapter for Bevy, opened by this crate.
#[derive(Clone)]
pub struct Device {
    /// The adapter.
    pub adapter: wgpu::Adapter,
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    instance: wgpu::Instance,
}

impl Device {
    /// Opens a device with every stable feature of the adapter. If `trace` names a folder, wgpu records all calls there.
    /// The adapter is that of the environment (`WGPU_ADAPTER_NAME`), or the first one.
    ///
    /// # Errors
    /// Fails if there is no adapter, it refuses the device, or the folder cannot be created.
    pub fn open(trace: Option<&Path>) -> Result<Self, TraceError> {
        let failed = |error: &dyn std::fmt::Display| TraceError::Device(error.to_string());
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
        let request = wgpu::RequestAdapterOptions::default();
        let adapter = block_on(instance.request_adapter(&request)).map_err(|error| failed(&error))?;
        let record = match trace {
            Some(path) => {
                std::fs::create_dir_all(path).map_err(|error| TraceError::File { path: path.into(), error })?;
                wgpu::Trace::Directory(path.into())
            }
            None => wgpu::Trace::Off,
        };
        let unwanted = wgpu::Features::all_experimental_mask() | wgpu::Features::MAPPABLE_PRIMARY_BUFFERS;
        let desc = wgpu::DeviceDescriptor {
            label: Some("framegraph-bevy"),
            required_features: adapter.features() - unwanted,
            required_limits: adapter.limits(),
            trace: record,
            ..wgpu::DeviceDescriptor::default()
        };
        let (device, queue) = block_on(adapter.request_device(&desc)).map_err(|error| failed(&error))?;
        Ok(Self { adapter, device, queue, instance })
    }

    /// Returns the value of `RenderPlugin::render_creation` that makes Bevy render on this device.
    pub fn render_creation(&self) -> RenderCreation {
        RenderCreation::manual(
            RenderDevice::from(self.device.clone()),
            RenderQueue::new(self.queue.clone()),
            RenderAdapterInfo::new(self.adapter.get_info()),
            RenderAdapter::new(self.adapter.clone()),
            RenderInstance::new(self.instance.clone()),
        )
    }

    /// Returns the device as framegraph uses it.
    pub fn gpu(&self) -> framegraph_wgpu::Gpu {
        framegraph_wgpu::Gpu::wrap(&self.adapter, &self.device, &self.queue)
    }
}

fn block_on<T>(future: impl Future<Output = T>) -> T {
    bevy_tasks::block_on(future)
}

/// Reads the trace in `folder`. The device may still be writing it.
///
/// # Errors
/// Fails if the file cannot be read or is not of this version of wgpu.
pub(crate) fn read(folder: &Path) -> Result<Vec<Action>, TraceError> {
    let path = folder.join(wgpu_core::device::trace::FILE_NAME);
    let mut text = std::fs::read_to_string(&path).map_err(|error| TraceError::File { path: path.clone(), error })?;
    if !text.trim_end().ends_with(']') {
        // The list ends when the device is dropped.
        text.push(']');
    }
    ron::from_str(&text).map_err(|error| TraceError::Syntax { path, error: Box::new(error) })
}
