//! Compares the blur with an independent double-precision blur on the CPU.

use super::{TestResult, with_engine};
use custom_pass::blur::{RADIUS, blur};
use custom_pass::engine::Engine;
use framegraph::{Entry, Exit, Extent, Format, Options, Plan, Scratch, TextureDesc};
use framegraph_wgpu::Frame;
use framegraph_wgpu::{Executor, Gpu, Imports, read_texture};
use half::f16;
use wgpu::{Extent3d, TextureDescriptor, TextureFormat, TextureUsages};

/// Linear light, three channels per texel.
struct Image {
    size: [usize; 2],
    texels: Vec<[f64; 3]>,
}

impl Image {
    /// Creates an image of values that half floats represent exactly: `of` returns multiples of 1/256.
    fn new(size: [usize; 2], of: impl Fn(usize, usize) -> [u32; 3]) -> Self {
        let places = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
        Self { size, texels: places.map(|(x, y)| of(x, y).map(|n| f64::from(n) / 256.0)).collect() }
    }

    /// Returns the texel at a position, clamped to the edges.
    fn at(&self, x: isize, y: isize) -> [f64; 3] {
        let [width, height] = self.size;
        let (x, y) = (x.clamp(0, width as isize - 1) as usize, y.clamp(0, height as isize - 1) as usize);
        self.texels[y * width + x]
    }

    /// Returns the first texel and channel that differ, with both values.
    fn differs(&self, found: &Self) -> Option<(usize, usize, f64, f64)> {
        let pairs = self.texels.iter().zip(&found.texels).enumerate();
        let mut values = pairs.flat_map(|(at, (e, f))| [0, 1, 2].map(|c| (at, c, e[c], f[c])));
        // Half floats below 2⁻¹⁴ have a constant spacing.
        values.find(|(_, _, e, f)| (e - f).abs() > TOLERANCE * e + 3.0 * 2.0_f64.powi(-24))
    }

    fn total(&self) -> [f64; 3] {
        self.texels.iter().fold([0.0; 3], |sum, t| [0, 1, 2].map(|c| sum[c] + t[c]))
    }

    /// Creates an image from a function of the position.
    fn map(size: [usize; 2], of: impl Fn(isize, isize) -> [f64; 3]) -> Self {
        let places = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x as isize, y as isize)));
        Self { size, texels: places.map(|(x, y)| of(x, y)).collect() }
    }

    /// Averages 2x2 texels.
    fn halved(&self) -> Self {
        Self::map(self.size.map(|side| side.div_ceil(2)), |x, y| {
            let corners = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| self.at(2 * x + dx, 2 * y + dy));
            [0, 1, 2].map(|c| corners.iter().map(|t| t[c]).sum::<f64>() / 4.0)
        })
    }

    /// Applies a two-dimensional Gaussian in one sum, the reference of the separable blur.
    fn blurred(&self) -> Self {
        let radius = RADIUS as isize;
        let weight = |d: isize| (-0.5 * (d as f64 * 3.0 / RADIUS as f64).powi(2)).exp();
        let total: f64 = (-radius..=radius).map(weight).sum();
        Self::map(self.size, |x, y| {
            let mut sum = [0.0; 3];
            for (dx, dy) in (-radius..=radius).flat_map(|dx| (-radius..=radius).map(move |dy| (dx, dy))) {
                let (texel, share) = (self.at(x + dx, y + dy), weight(dx) * weight(dy) / (total * total));
                (0..3).for_each(|c| sum[c] += share * texel[c]);
            }
            sum
        })
    }
}

/// Runs the effect on the device, in a frame without other passes.
fn on_device(engine: &Engine, image: &Image) -> Result<Image, Box<dyn std::error::Error>> {
    let gpu = Gpu::wrap(&engine.adapter, &engine.device, &engine.queue);
    let [width, height] = image.size.map(|side| side as u32);
    let texture = engine.device.create_texture(&TextureDescriptor {
        label: Some("image"),
        size: Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: TextureFormat::Rgba16Float,
        usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let bytes: Vec<u8> = image
        .texels
        .iter()
        .flat_map(|[r, g, b]| [*r, *g, *b, 1.0].map(|v| f16::from_f64(v).to_le_bytes()).concat())
        .collect();
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(8 * width), rows_per_image: None };
    engine.queue.write_texture(texture.as_image_copy(), &bytes, layout, texture.size());

    let mut frame = Frame::<()>::new();
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba16Float);
    let handle = frame.graph_mut().import_texture("image", desc, Entry::Defined, Exit::Discard);
    let blurred = blur(&mut frame, handle)?;
    frame.graph_mut().readback(blurred)?;
    let (mut plan, mut executor) = (Plan::new(), Executor::new(&gpu));
    let options = Options::for_frame(width, height);
    framegraph::compile(frame.graph(), &gpu.caps(), &options, &mut Scratch::new(), &mut plan)?;
    let mut imports = Imports::new();
    imports.texture(handle, &texture);
    executor.execute(&plan, &frame, &(), &imports)?;
    let pixels = read_texture(&gpu, executor.texture(&plan, blurred).ok_or("nothing was written")?)?;
    let texels = pixels.rgba().into_iter().map(|[r, g, b, _]| [r, g, b].map(f64::from)).collect();
    Ok(Image { size: pixels.texels.map(|side| side as usize), texels })
}

/// Relative tolerance. Three textures are written and rounded to 11 bits, toward zero on some devices, so a value may lose
/// 2⁻¹⁰ of itself three times. Sums of 25 products in single precision are far more accurate.
const TOLERANCE: f64 = 3.0 / 1024.0;

#[test]
fn it_is_a_gaussian_of_the_smaller_level() -> TestResult {
    with_engine("it_is_a_gaussian_of_the_smaller_level", |engine| {
        // Odd sides, several stretches per line and bright edges cover the corner cases of a workgroup.
        for size in [[37, 29], [150, 9], [6, 141], [1, 1]] {
            let image = Image::new(size, |x, y| {
                let noise = (x * 7919 + y * 104_729) % 257;
                let edge = if x == 0 || y + 1 == size[1] { 2048 } else { 0 };
                [noise as u32, edge, (x * 8) as u32]
            });
            let (expected, found) = (image.halved().blurred(), on_device(&engine, &image)?);
            assert_eq!(found.size, size.map(|side| side.div_ceil(2)));
            assert_eq!(expected.differs(&found), None, "{size:?}");
            // Negative control: the unblurred half-size image and a blur shifted by one texel are detected.
            if size[0] > 1 {
                let shifted = Image::map(expected.size, |x, y| expected.at(x + 1, y));
                assert!(image.halved().differs(&found).is_some() && shifted.differs(&found).is_some(), "{size:?}");
            }
        }
        Ok(())
    })
}

#[test]
fn it_neither_makes_nor_loses_light() -> TestResult {
    with_engine("it_neither_makes_nor_loses_light", |engine| {
        // A bright block farther from all edges than the reach of the blur: 2 · 12 texels of this size.
        let image = Image::new([96, 80], |x, y| {
            let lit = (40..56).contains(&x) && (36..44).contains(&y);
            if lit { [256, 1024 + 8 * x as u32, 77] } else { [0; 3] }
        });
        let blurred = on_device(&engine, &image)?;
        for (before, after) in image.total().into_iter().zip(blurred.total()) {
            // A texel at half size covers four texels.
            let ratio = 4.0 * after / before;
            assert!((ratio - 1.0).abs() <= TOLERANCE, "{ratio}");
        }
        let brightest = blurred.texels.iter().map(|t| t[0]).fold(0.0, f64::max);
        assert!(brightest < 0.5, "the block is spread: {brightest}");
        Ok(())
    })
}
