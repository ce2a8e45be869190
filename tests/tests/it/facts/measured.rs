//! Maximum and minimum of a picture, computed by the shader and on the CPU.

use super::TestResult;
use crate::stage::gpu;
use framegraph::{Entry, Exit, Extent, Format, Options, Plan, Scratch, Texture, TextureDesc, compile};
use framegraph_passes::effects::exposure::{MeasurePass, MeasureStep};
use framegraph_passes::program::Programs;
use framegraph_wgpu::{Frame, Gpu, Imports, read_texture};
use half::f16;
use tests::executors;

/// Returns the output of a step for half-float texels with `channels` channels, row by row.
fn measured(
    gpu: &Gpu,
    step: fn(Texture) -> MeasureStep,
    [width, height]: [u32; 2],
    channels: usize,
    texels: &[f16],
) -> Result<Vec<[f32; 2]>, Box<dyn std::error::Error>> {
    let (of_device, format) = match channels {
        1 => (wgpu::TextureFormat::R16Float, Format::R16Float),
        2 => (wgpu::TextureFormat::Rg16Float, Format::Rg16Float),
        _ => (wgpu::TextureFormat::Rgba16Float, Format::Rgba16Float),
    };
    let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("picture"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: of_device,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let bytes: Vec<u8> = texels.iter().flat_map(|texel| texel.to_le_bytes()).collect();
    let row_bytes = width * channels as u32 * 2;
    let layout = wgpu::TexelCopyBufferLayout { bytes_per_row: Some(row_bytes), ..Default::default() };
    gpu.queue.write_texture(texture.as_image_copy(), &bytes, layout, size);
    let (mut frame, mut imports) = (Frame::<Programs>::new(), Imports::new());
    let extent = Extent::absolute(width, height);
    let picture =
        frame.graph_mut().import_texture("picture", TextureDesc::new(extent, format), Entry::Defined, Exit::Keep);
    imports.texture(picture, &texture);
    let result = frame.add("measured", MeasurePass { step: step(picture), extent, eighths: 1 })?.result;
    frame.graph_mut().readback(result)?;
    let mut plan = Plan::new();
    let options = Options::for_frame(width, height);
    compile(frame.graph(), &gpu.caps(), &options, &mut Scratch::new(), &mut plan)?;
    let mut executor = executors::lend(gpu);
    executor.execute(&plan, &frame, &Programs::new(), &imports)?;
    let found = read_texture(gpu, executor.texture(&plan, result).ok_or("nothing was measured")?)?;
    Ok(found.rgba().iter().map(|found| [found[0], found[1]]).collect())
}

/// Every texel counts in its 8×8 block, in any channel, also at the border of pictures whose sizes are not multiples of
/// eight. The initial values of the shader do not influence the result.
#[test]
fn every_texel_counts_for_the_most_and_the_least() -> TestResult {
    let Some(gpu) = gpu("every_texel_counts_for_the_most_and_the_least") else { return Ok(()) };
    let size @ [width, height] = [29_u32, 13];
    // All texels differ, in random order, from 2^-14 to 2^-5 with all bits of a half float.
    let value = |texel: usize, channel: usize| f16::from_bits(0x0400 + ((texel * 2477 + channel * 3331) % 9001) as u16);
    // Channels of which the maximum and the minimum are taken; for light, both use the brightest of three.
    type Case = (fn(Texture) -> MeasureStep, usize, [std::ops::Range<usize>; 2]);
    let steps: [Case; 3] = [
        (|hdr| MeasureStep::Light { hdr }, 4, [0..3, 0..3]),
        (|depth| MeasureStep::Depth { depth }, 1, [0..1, 0..1]),
        (|measured| MeasureStep::Smaller { measured }, 2, [0..1, 1..2]),
    ];
    for (step, channels, [most, least]) in steps {
        let texels: Vec<f16> =
            (0..width * height).flat_map(|at| (0..channels).map(move |c| value(at as usize, c))).collect();
        let brightest = |x: u32, y: u32, of: &std::ops::Range<usize>| {
            let texel = &texels[(y * width + x) as usize * channels..][of.clone()];
            texel.iter().map(|half| half.to_f32()).fold(0.0, f32::max)
        };
        let mut expected = Vec::new();
        for (y, x) in (0..height).step_by(8).flat_map(|y| (0..width).step_by(8).map(move |x| (y, x))) {
            let mut both = [0.0, f32::INFINITY];
            for (y, x) in (y..height.min(y + 8)).flat_map(|y| (x..width.min(x + 8)).map(move |x| (y, x))) {
                both = [both[0].max(brightest(x, y, &most)), both[1].min(brightest(x, y, &least))];
            }
            expected.push(both);
        }
        assert_eq!(measured(&gpu, step, size, channels, &texels)?, expected, "{channels} channels");
    }
    Ok(())
}

/// NaN counts as black, infinity as the largest half float, as in bloom.
#[test]
fn what_is_no_number_is_measured_as_bloom_takes_it() -> TestResult {
    let Some(gpu) = gpu("what_is_no_number_is_measured_as_bloom_takes_it") else { return Ok(()) };
    for (bits, both) in [(0x7e00_u16, [1.5, 0.0]), (0x7c00, [65504.0, 1.5]), (0xfc00, [1.5, 0.0])] {
        let texel = |at: usize| [f16::from_bits(if at == 27 { bits } else { 0x3e00 }); 4];
        let texels: Vec<f16> = (0..64).flat_map(texel).collect();
        let found = measured(&gpu, |hdr| MeasureStep::Light { hdr }, [8, 8], 4, &texels)?;
        assert_eq!(found, [both], "{bits:04x}");
    }
    Ok(())
}
