//! Pictures of panels without a window.

use crate::drawing::{Drawing, Theme};
use crate::live::screen::Screen;
use crate::panel::Canvas;
use eframe::egui_wgpu::{Renderer, RendererOptions, ScreenDescriptor};
use egui::mutex::RwLock;
use egui::{Context, FullOutput, RawInput, Rect, Ui, Vec2, pos2};
use framegraph_wgpu::{AdapterRequest, Gpu, read_texture};
use std::sync::Arc;
use wgpu::{TextureFormat, TextureUsages};

/// Maximum width and height of a picture in pixels.
pub const MAX_PX: u32 = 8192;

/// Device that draws the output of egui.
pub struct Offscreen {
    gpu: Gpu,
    renderer: Arc<RwLock<Renderer>>,
}

/// Format of pictures, in sRGB: egui blends in gamma space.
const FORMAT: TextureFormat = TextureFormat::Rgba8Unorm;

impl Offscreen {
    /// Opens the best available device.
    ///
    /// # Errors
    /// The reason that no device is available.
    pub fn open() -> Result<Self, String> {
        let gpu = Gpu::open(&AdapterRequest::from_env()).map_err(|e| e.to_string())?;
        Ok(Self::on(gpu))
    }

    /// Opens the best available device with the renderer options of windows, which are faster, but not identical on every
    /// driver.
    ///
    /// # Errors
    /// The reason that no device is available.
    pub fn as_windows() -> Result<Self, String> {
        let mut screen = Self::open()?;
        let renderer = Renderer::new(&screen.gpu.device, FORMAT, RendererOptions::default());
        screen.renderer = Arc::new(RwLock::new(renderer));
        Ok(screen)
    }

    /// Draws with an existing device.
    pub fn on(gpu: Gpu) -> Self {
        // Nearly identical pixels on every driver.
        let renderer = Renderer::new(&gpu.device, FORMAT, RendererOptions::PREDICTABLE);
        Self { gpu, renderer: Arc::new(RwLock::new(renderer)) }
    }

    /// Returns the device for a live frame in the panels.
    pub fn screen(&self) -> Screen {
        Screen::new(&self.gpu, Some(self.renderer.clone()))
    }

    /// Returns the device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Draws `show` into a picture of a size in pixels, at `scale` pixels per point. Returns RGBA rows.
    ///
    /// `show` runs for several frames until the layout is stable.
    ///
    /// # Errors
    /// An error of the device.
    pub fn picture(
        &mut self,
        size_px: [u32; 2],
        scale: f32,
        theme: Theme,
        mut show: impl FnMut(&mut Ui),
    ) -> Result<Vec<u8>, String> {
        let ctx = Context::default();
        ctx.set_theme(if theme == Theme::Dark { egui::Theme::Dark } else { egui::Theme::Light });
        crate::panel::dress(&ctx);
        ctx.all_styles_mut(|style| style.animation_time = 0.0);
        let size = Vec2::new(size_px[0] as f32, size_px[1] as f32) / scale;
        let mut output = None;
        for frame in 0..4 {
            let mut input = RawInput {
                screen_rect: Some(Rect::from_min_size(pos2(0.0, 0.0), size)),
                time: Some(f64::from(frame) / 10.0),
                ..RawInput::default()
            };
            input.viewports.entry(input.viewport_id).or_default().native_pixels_per_point = Some(scale);
            let mut next = ctx.run_ui(input, &mut show);
            self.take_textures(&mut next);
            output = Some(next);
        }
        let texture = self.paint(&ctx, output.unwrap_or_default(), size_px);
        let pixels = read_texture(&self.gpu, &texture).map_err(|e| e.to_string())?;
        let mut rgba = pixels.rgba8();
        // Windows are opaque.
        rgba.iter_mut().skip(3).step_by(4).for_each(|alpha| *alpha = 255);
        Ok(rgba)
    }

    /// Draws a frame of egui and waits for its completion.
    ///
    /// # Errors
    /// The device is lost.
    pub fn frame(&mut self, ctx: &Context, mut output: FullOutput, size_px: [u32; 2]) -> Result<(), String> {
        self.take_textures(&mut output);
        self.paint(ctx, output, size_px);
        self.gpu.wait().map_err(|e| e.to_string())
    }

    /// Uploads created and changed textures.
    fn take_textures(&mut self, output: &mut FullOutput) {
        let mut set: Vec<_> = output.textures_delta.set.drain().collect();
        set.sort_unstable_by_key(|(id, _)| *id);
        for (id, deltas) in set {
            for delta in deltas {
                self.renderer.write().update_texture(&self.gpu.device, &self.gpu.queue, id, &delta);
            }
        }
        // Freed textures live until the picture is drawn.
        output.textures_delta.clear();
    }

    /// Draws the shapes of a frame after its textures were uploaded.
    fn paint(&mut self, ctx: &Context, output: FullOutput, size_px: [u32; 2]) -> wgpu::Texture {
        let [width, height] = size_px.map(|side| side.clamp(1, MAX_PX));
        let device = &self.gpu.device;
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("picture"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let [r, g, b, a] = ctx.global_style().visuals.panel_fill.to_normalized_gamma_f32().map(f64::from);
        let screen = ScreenDescriptor { size_in_pixels: [width, height], pixels_per_point: output.pixels_per_point };
        let triangles = ctx.tessellate(output.shapes, output.pixels_per_point);
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("picture") });
        let queue = &self.gpu.queue;
        let before = self.renderer.write().update_buffers(device, queue, &mut encoder, &triangles, &screen);
        let mut pass = encoder
            .begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("picture"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a }),
                        store: wgpu::StoreOp::Store,
                    },
                    depth_slice: None,
                })],
                ..wgpu::RenderPassDescriptor::default()
            })
            .forget_lifetime();
        self.renderer.write().render(&mut pass, &triangles, &screen);
        drop(pass);
        queue.submit(before.into_iter().chain([encoder.finish()]));
        texture
    }

    /// Draws a complete drawing into a picture of a size in pixels.
    ///
    /// # Errors
    /// Fails like [`Offscreen::picture`].
    pub fn drawing(
        &mut self,
        drawing: &Drawing,
        size_px: [u32; 2],
        scale: f32,
        theme: Theme,
        lit: &[crate::drawing::Item],
    ) -> Result<Vec<u8>, String> {
        self.picture(size_px, scale, theme, |ui| {
            let mut canvas = Canvas::whole();
            canvas.show(ui, "picture", drawing, lit);
        })
    }
}

/// Returns the size in pixels of a picture that holds a drawing at its own size.
pub fn own_size_px(drawing: &Drawing, scale: f32) -> [u32; 2] {
    drawing.size.map(|side| (((side + 2.0 * crate::panel::MARGIN) * scale).ceil() as u32).clamp(1, MAX_PX))
}
