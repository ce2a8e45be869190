//! Runs a single pass over an 8-bit picture.

use crate::executors;
use framegraph::{DeclareError, Entry, Exit, Extent, Format, Options, Plan, Scratch, Texture, TextureDesc, compile};
use framegraph_passes::program::Programs;
use framegraph_wgpu::{Frame, Gpu, Imports, read_texture, texture_2d};
use std::error::Error;
use wgpu::util::{DeviceExt, TextureDataOrder};
use wgpu::{TextureFormat, TextureUsages};

/// Returns the output of a pass for a picture of four bytes per texel, left to right and top to bottom.
///
/// # Errors
/// Any error of the frame, the compiler or the device.
pub fn filtered(
    gpu: &Gpu,
    codes: &[u8],
    [width, height]: [u32; 2],
    declare: impl Fn(&mut Frame<Programs>, Texture) -> Result<Texture, DeclareError>,
) -> Result<Vec<u8>, Box<dyn Error>> {
    let mut frame = Frame::<Programs>::new();
    let desc = TextureDesc::new(Extent::absolute(width, height), Format::Rgba8Unorm);
    let given = frame.graph_mut().import_texture("given", desc, Entry::Defined, Exit::Discard);
    let output = declare(&mut frame, given)?;
    frame.graph_mut().readback(output)?;
    let mut plan = Plan::new();
    compile(frame.graph(), &gpu.caps(), &Options::for_frame(width, height), &mut Scratch::new(), &mut plan)?;
    let texture = gpu.device.create_texture_with_data(
        &gpu.queue,
        &texture_2d("given", [width, height], TextureFormat::Rgba8Unorm, TextureUsages::TEXTURE_BINDING),
        TextureDataOrder::LayerMajor,
        codes,
    );
    let mut imports = Imports::new();
    imports.texture(given, &texture);
    let mut executor = executors::lend(gpu);
    executor.execute(&plan, &frame, &Programs::new(), &imports)?;
    Ok(read_texture(gpu, executor.texture(&plan, output).ok_or("there is no picture")?)?.rgba8())
}
