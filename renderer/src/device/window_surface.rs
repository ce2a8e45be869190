//! A window's surface that follows the window: sizes, images that are late or lost, and none while it is minimized.

use crate::device::error::DeviceError;
use crate::device::gpu::Gpu;
use std::fmt;
use wgpu::{CurrentSurfaceTexture, PresentMode, Surface, SurfaceConfiguration, SurfaceTexture, TextureFormat};

/// A surface with its configuration.
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
    /// The surface is not configured as `config` says, or its images no longer fit the window.
    stale: bool,
}

/// A surface hands out no images.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub enum SurfaceError {
    /// The adapter cannot draw into the window.
    #[error("the adapter cannot draw into the window; choose another with WGPU_BACKEND or WGPU_ADAPTER_NAME")]
    Unfit,
    /// The surface is gone, and the window may still be there.
    #[error("the surface was lost; create it anew from the window and hand it to `WindowSurface::replace`")]
    Lost,
    /// wgpu refused to hand out an image.
    #[error("the surface gave no image; WGPU_VALIDATION=1 says why")]
    Refused,
    /// wgpu refused the configuration, or the device is lost.
    #[error(transparent)]
    Device(#[from] DeviceError),
}

impl fmt::Debug for SurfaceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl WindowSurface {
    /// For a window of `size` pixels: in step with the screen, and with sRGB codes where the surface can have them.
    ///
    /// # Errors
    /// [`SurfaceError::Unfit`].
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

    /// The format of its images.
    pub fn format(&self) -> TextureFormat {
        self.config.format
    }

    /// Width and height of its images in texels; 0 while the window is minimized.
    pub fn size(&self) -> [u32; 2] {
        [self.config.width, self.config.height]
    }

    /// Follows the window. Nothing is configured before the next image is asked for, so a drag that sends many sizes between
    /// two frames costs one configuration.
    pub fn resize(&mut self, size: [u32; 2]) {
        self.stale |= self.size() != size;
        [self.config.width, self.config.height] = size;
    }

    /// Takes another surface of the same window in the place of one that was lost.
    pub fn replace(&mut self, surface: Surface<'static>) {
        self.surface = surface;
        self.stale = true;
    }

    /// The next image to draw into; none when this frame is to be skipped, because the window has no texels, is hidden, or the
    /// screen is busy.
    ///
    /// # Errors
    /// [`SurfaceError`].
    pub fn acquire(&mut self) -> Result<Option<SurfaceTexture>, SurfaceError> {
        if self.size().contains(&0) {
            return Ok(None);
        }
        if std::mem::take(&mut self.stale) {
            let Self { gpu, surface, config, .. } = self;
            gpu.guard("the window's surface", || surface.configure(&gpu.device, config))?;
        }
        match self.surface.get_current_texture() {
            CurrentSurfaceTexture::Success(image) => Ok(Some(image)),
            // It can be drawn into; the next one shall fit.
            CurrentSurfaceTexture::Suboptimal(image) => {
                self.stale = true;
                Ok(Some(image))
            }
            CurrentSurfaceTexture::Timeout | CurrentSurfaceTexture::Occluded => Ok(None),
            CurrentSurfaceTexture::Outdated => {
                self.stale = true;
                Ok(None)
            }
            CurrentSurfaceTexture::Lost => Err(SurfaceError::Lost),
            CurrentSurfaceTexture::Validation => Err(SurfaceError::Refused),
        }
    }

    /// Shows an image that was drawn into.
    pub fn present(&self, image: SurfaceTexture) {
        self.gpu.queue.present(image);
    }
}

/// The first format that encodes sRGB itself.
fn preferred(offered: &[TextureFormat]) -> Option<TextureFormat> {
    offered.iter().copied().find(TextureFormat::is_srgb)
}
