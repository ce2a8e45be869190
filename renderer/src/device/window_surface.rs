//! Window surfaces: handles resizing, outdated and lost surfaces, and minimized windows.

use crate::device::adapter::{AdapterRequest, instance};
use crate::device::error::DeviceError;
use crate::device::gpu::Gpu;
use crate::device::open_error::OpenError;
use std::fmt;
use wgpu::{
    CurrentSurfaceTexture, PresentMode, Surface, SurfaceConfiguration, SurfaceTarget, SurfaceTexture, TextureFormat,
};

/// A window surface with its configuration.
///
/// ```no_run
/// # use framegraph_wgpu::{Gpu, SurfaceError, WindowSurface};
/// # fn draw(_: &wgpu::Texture) {}
/// # fn frame(gpu: &Gpu, window: &mut WindowSurface) -> Result<(), SurfaceError> {
/// let Some(image) = window.acquire()? else { return Ok(()) }; // Minimized, hidden or late: this frame is skipped.
/// draw(&image.texture); // `Imports::surface` lends it to a graph.
/// window.present(image);
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct WindowSurface {
    gpu: Gpu,
    surface: Surface<'static>,
    config: SurfaceConfiguration,
    /// True if `config` changed since the surface was configured, or its images no longer fit the window.
    stale: bool,
}

/// Error: a surface provides no images.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub enum SurfaceError {
    /// The adapter cannot render to the surface.
    #[error("the adapter cannot draw into the window; choose another with WGPU_BACKEND or WGPU_ADAPTER_NAME")]
    Unfit,
    /// No device could be opened for the window.
    #[error(transparent)]
    Open(#[from] OpenError),
    /// The window has no surface.
    #[error("the window has no surface: {reason}; set WGPU_BACKEND to another graphics API")]
    Create {
        /// Reason given by wgpu.
        reason: String,
    },
    /// The surface was lost. The window may still exist.
    #[error("the surface was lost; create a new one from the window and pass it to `WindowSurface::replace`")]
    Lost,
    /// wgpu failed to acquire an image.
    #[error("the surface returned no image; set WGPU_VALIDATION=1 for the reason")]
    Refused,
    /// wgpu rejected the configuration, or the device is lost.
    #[error(transparent)]
    Device(#[from] DeviceError),
}

impl fmt::Debug for SurfaceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl WindowSurface {
    /// Opens a device that can draw into `window`, and a surface of `size` pixels. `window` is for example an
    /// `Arc<winit::window::Window>`.
    ///
    /// # Errors
    /// Fails with [`SurfaceError`].
    pub fn open(
        request: &AdapterRequest,
        window: impl Into<SurfaceTarget<'static>>,
        size: [u32; 2],
    ) -> Result<(Gpu, Self), SurfaceError> {
        request.check()?;
        let instance = instance(request.backends);
        let created = instance.create_surface(window);
        let surface = created.map_err(|error| SurfaceError::Create { reason: error.to_string() })?;
        let adapters = pollster::block_on(instance.enumerate_adapters(request.backends));
        let gpu = Gpu::open_one_of(request, &adapters, |adapter| adapter.is_surface_supported(&surface))?;
        let surface = Self::new(&gpu, surface, size)?;
        Ok((gpu, surface))
    }

    /// Configures a surface for a window of `size` pixels. Uses vertical synchronization, and an sRGB format if the
    /// surface offers one.
    ///
    /// # Errors
    /// Fails with [`SurfaceError::Unfit`].
    pub fn new(gpu: &Gpu, surface: Surface<'static>, size: [u32; 2]) -> Result<Self, SurfaceError> {
        let offered = surface.get_capabilities(gpu.adapter());
        let [width, height] = size.map(|side| side.max(1));
        let config = surface.get_default_config(gpu.adapter(), width, height).ok_or(SurfaceError::Unfit)?;
        let format = preferred(&offered.formats).unwrap_or(config.format);
        let config = SurfaceConfiguration { format, present_mode: PresentMode::AutoVsync, ..config };
        let mut window = Self { gpu: gpu.clone(), surface, config, stale: true };
        window.resize(size);
        Ok(window)
    }

    /// Returns the format of the surface's images.
    pub fn format(&self) -> TextureFormat {
        self.config.format
    }

    /// Returns width and height in texels; 0 while the window is minimized.
    pub fn size(&self) -> [u32; 2] {
        [self.config.width, self.config.height]
    }

    /// Sets the size of the window. The surface is configured when the next image is acquired, so several size changes
    /// between two frames cost one configuration.
    pub fn resize(&mut self, size: [u32; 2]) {
        self.stale |= self.size() != size;
        [self.config.width, self.config.height] = size;
    }

    /// Replaces a lost surface with a new one of the same window.
    pub fn replace(&mut self, surface: Surface<'static>) {
        self.surface = surface;
        self.stale = true;
    }

    /// Acquires the next image to render to. `None` if the frame should be skipped: the window is minimized or hidden,
    /// or acquiring timed out.
    ///
    /// # Errors
    /// Fails with [`SurfaceError`].
    pub fn acquire(&mut self) -> Result<Option<SurfaceTexture>, SurfaceError> {
        let Begin { skip, configure } = begin(self.size(), self.stale);
        if skip {
            return Ok(None);
        }
        if configure {
            let Self { gpu, surface, config, .. } = self;
            gpu.guard("the window's surface", || surface.configure(&gpu.device, config))?;
        }
        let (image, answer) = match self.surface.get_current_texture() {
            CurrentSurfaceTexture::Success(image) => (Some(image), Answer::Fits),
            CurrentSurfaceTexture::Suboptimal(image) => (Some(image), Answer::Suboptimal),
            CurrentSurfaceTexture::Timeout => (None, Answer::Timeout),
            CurrentSurfaceTexture::Occluded => (None, Answer::Occluded),
            CurrentSurfaceTexture::Outdated => (None, Answer::Outdated),
            CurrentSurfaceTexture::Lost => (None, Answer::Lost),
            CurrentSurfaceTexture::Validation => (None, Answer::Validation),
        };
        let After { draw, stale } = after(answer)?;
        self.stale = stale;
        Ok(image.filter(|_| draw))
    }

    /// Presents an image.
    pub fn present(&self, image: SurfaceTexture) {
        self.gpu.queue.present(image);
    }
}

/// Steps before an image is acquired.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Begin {
    skip: bool,
    configure: bool,
}

/// A window of zero size is skipped and stays unconfigured until it has a size.
fn begin(size: [u32; 2], stale: bool) -> Begin {
    let skip = size.contains(&0);
    Begin { skip, configure: stale && !skip }
}

/// Result of acquiring an image, without the image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Answer {
    Fits,
    Suboptimal,
    Timeout,
    Occluded,
    Outdated,
    Lost,
    Validation,
}

/// Consequences of a result: whether to draw, and whether to configure the surface before the next image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct After {
    draw: bool,
    stale: bool,
}

fn after(answer: Answer) -> Result<After, SurfaceError> {
    match answer {
        Answer::Fits => Ok(After { draw: true, stale: false }),
        // The image can be used, but the next one should fit.
        Answer::Suboptimal => Ok(After { draw: true, stale: true }),
        Answer::Timeout | Answer::Occluded => Ok(After { draw: false, stale: false }),
        Answer::Outdated => Ok(After { draw: false, stale: true }),
        Answer::Lost => Err(SurfaceError::Lost),
        Answer::Validation => Err(SurfaceError::Refused),
    }
}

/// Returns the first sRGB format.
fn preferred(offered: &[TextureFormat]) -> Option<TextureFormat> {
    offered.iter().copied().find(TextureFormat::is_srgb)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_minimized_window_is_skipped() {
        let cases = [
            ([0, 0], true, (true, false)),
            ([0, 9], false, (true, false)),
            ([9, 0], true, (true, false)),
            ([9, 9], true, (false, true)),
            ([9, 9], false, (false, false)),
        ];
        for (size, stale, (skip, configure)) in cases {
            assert_eq!(begin(size, stale), Begin { skip, configure }, "{size:?} {stale}");
        }
    }

    /// Checks each result: drawn or not, configured again or not, or an error.
    #[test]
    fn every_surface_status_is_handled() {
        let cases = [
            (Answer::Fits, Ok((true, false))),
            (Answer::Suboptimal, Ok((true, true))),
            (Answer::Timeout, Ok((false, false))),
            (Answer::Occluded, Ok((false, false))),
            (Answer::Outdated, Ok((false, true))),
            (Answer::Lost, Err(SurfaceError::Lost)),
            (Answer::Validation, Err(SurfaceError::Refused)),
        ];
        for (answer, expected) in cases {
            assert_eq!(after(answer).map(|a| (a.draw, a.stale)), expected, "{answer:?}");
        }
    }

    #[test]
    fn the_format_that_encodes_srgb_is_preferred() {
        let (linear, srgb) = (TextureFormat::Bgra8Unorm, TextureFormat::Bgra8UnormSrgb);
        assert_eq!(preferred(&[linear, srgb]), Some(srgb));
        assert_eq!(preferred(&[linear]), None);
    }
}
