//! A radiance picture on the device, processed by passes and read back.

use crate::parts::Parts;
use framegraph::{Entry, Exit, Extent, Format, Options, Plan, Scratch, Texture, TextureDesc, compile};
use framegraph_passes::StageError;
use framegraph_wgpu::{Frame, Gpu, Imports, read_texture, texture_2d};
use glam::DVec3;
use half::f16;
use std::error::Error;
use tests::executors;
use wgpu::util::{DeviceExt, TextureDataOrder};
use wgpu::{TextureFormat, TextureUsages};

/// Pixels, rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    pub size: [u32; 2],
    pub texels: Vec<DVec3>,
}

impl Image {
    pub fn from_fn(size: [u32; 2], color: impl Fn(u32, u32) -> DVec3) -> Self {
        let texels = (0..size[0] * size[1]).map(|i| color(i % size[0], i / size[0])).collect();
        Self { size, texels }
    }

    /// Returns the nearest pixel.
    pub fn at(&self, x: i64, y: i64) -> DVec3 {
        let [width, height] = self.size.map(i64::from);
        self.texels[(y.clamp(0, height - 1) * width + x.clamp(0, width - 1)) as usize]
    }

    /// Interpolates linearly between pixel centers; coordinates are in 0…1.
    pub fn sample(&self, u: f64, v: f64) -> DVec3 {
        let (x, y) = (u * f64::from(self.size[0]) - 0.5, v * f64::from(self.size[1]) - 0.5);
        let (fx, fy) = (x - x.floor(), y - y.floor());
        let (x, y) = (x.floor() as i64, y.floor() as i64);
        let row = |y| self.at(x, y).lerp(self.at(x + 1, y), fx);
        row(y).lerp(row(y + 1), fy)
    }

    /// Returns the largest difference, relative to the brightest channel of `truth`.
    pub fn off(&self, truth: &Self) -> f64 {
        assert_eq!(self.size, truth.size);
        let most = truth.texels.iter().map(|c| c.max_element()).fold(1e-9, f64::max);
        let apart = self.texels.iter().zip(&truth.texels).map(|(a, b)| (*a - *b).abs().max_element());
        apart.fold(0.0, f64::max) / most
    }

    pub fn mean(&self) -> DVec3 {
        self.texels.iter().sum::<DVec3>() / self.texels.len() as f64
    }

    /// Rounds the picture to half floats.
    pub fn rounded(&self) -> Self {
        let round = |c: DVec3| DVec3::from_array(c.to_array().map(|x| f16::from_f64(x).to_f64()));
        Self { size: self.size, texels: self.texels.iter().map(|c| round(*c)).collect() }
    }

    fn upload(&self, gpu: &Gpu) -> wgpu::Texture {
        let halves = |c: &DVec3| [c.x, c.y, c.z, 1.0].map(|x| f16::from_f64(x).to_bits().to_le_bytes());
        let bytes: Vec<u8> = self.texels.iter().flat_map(|c| halves(c).concat()).collect();
        let [width, height] = self.size;
        let desc = texture_2d("picture", [width, height], TextureFormat::Rgba16Float, TextureUsages::TEXTURE_BINDING);
        gpu.device.create_texture_with_data(&gpu.queue, &desc, TextureDataOrder::LayerMajor, &bytes)
    }
}

/// Runs declared passes on pictures. Returns level 0 of the resulting texture, and the plan.
pub fn made<const N: usize>(
    gpu: &Gpu,
    parts: &Parts,
    pictures: [&Image; N],
    declare: impl FnOnce(&mut Frame<Parts>, [Texture; N]) -> Result<Texture, StageError>,
) -> Result<(Image, Plan), Box<dyn Error>> {
    let mut frame = Frame::<Parts>::new();
    let imports = pictures.map(|image| {
        let [width, height] = image.size;
        let desc = TextureDesc::new(Extent::absolute(width, height), Format::Rgba16Float);
        frame.graph_mut().import_texture("picture", desc, Entry::Defined, Exit::Discard)
    });
    let result = declare(&mut frame, imports)?;
    frame.graph_mut().readback(result)?;
    let mut plan = Plan::new();
    let [width, height] = pictures[0].size;
    compile(frame.graph(), &gpu.caps(), &Options::for_frame(width, height), &mut Scratch::new(), &mut plan)?;
    let mut bound = Imports::new();
    let textures = pictures.map(|image| image.upload(gpu));
    imports.iter().zip(&textures).for_each(|(import, texture)| {
        bound.texture(*import, texture);
    });
    let mut executor = executors::lend(gpu);
    executor.execute(&plan, &frame, parts, &bound)?;
    assert_eq!(executor.executed(), plan.counts(), "executed against planned");
    let texture = executor.texture(&plan, result).ok_or("there is no result")?;
    let pixels = read_texture(gpu, texture)?;
    assert!(pixels.rgba().iter().all(|texel| texel[3] == 1.0), "alpha stays");
    let rgb = |[r, g, b, _]: [f32; 4]| DVec3::new(r.into(), g.into(), b.into());
    Ok((Image { size: pixels.texels, texels: pixels.rgba().into_iter().map(rgb).collect() }, plan))
}
