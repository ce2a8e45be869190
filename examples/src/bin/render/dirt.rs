//! Lens dirt texture for bloom.

use crate::run::{Failure, input};
use framegraph::{Entry, Exit, Extent, Format, Texture, TextureDesc};
use framegraph_passes::{Handles, Slot, World};
use framegraph_scene::Memory;
use framegraph_scene::picture::read_rgba8_within;
use framegraph_wgpu::{Frame, Gpu, Imports};
use std::path::Path;

/// Lens dirt on the device, stretched over the frame.
#[derive(Clone, Debug)]
pub struct Dirt(wgpu::Texture);

impl Dirt {
    /// Loads a PNG or JPEG picture within a memory budget. White scatters all of the glow, black none.
    ///
    /// # Errors
    /// One line that names the file and the reason.
    pub fn load(gpu: &Gpu, file: &Path, memory: &Memory) -> Result<Self, Failure> {
        let (size, rgba8, _loan) =
            read_rgba8_within(file, memory).map_err(|error| input(format!("--dirt: {error}")))?;
        let max = gpu.caps().max_texture_texels;
        if size.into_iter().any(|side| side > max) {
            let [width, height] = size;
            return Err(input(format!(
                "--dirt {}: {width}x{height} texels exceed the adapter's limit of {max}x{max}; use a smaller picture",
                file.display()
            )));
        }
        let [width, height] = size;
        let extent = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("lens_dirt"),
            size: extent,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8UnormSrgb,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let layout = wgpu::TexelCopyBufferLayout { bytes_per_row: Some(4 * width), ..Default::default() };
        gpu.queue.write_texture(texture.as_image_copy(), &rgba8, layout, extent);
        Ok(Self(texture))
    }

    /// Imports the texture as lens dirt of the frame.
    pub fn declare(&self, frame: &mut Frame<World>, handles: Handles, imports: &mut Imports) -> Handles {
        let extent = Extent::absolute(self.0.width(), self.0.height());
        let desc = TextureDesc::new(extent, Format::Rgba8UnormSrgb);
        let dirt: Texture = frame.graph_mut().import_texture("lens_dirt", desc, Entry::Defined, Exit::Keep);
        imports.texture(dirt, &self.0);
        handles.with(Slot::LENS_DIRT, dirt)
    }
}
