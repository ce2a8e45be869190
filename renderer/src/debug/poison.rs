//! Finding reads of undefined contents: they are filled with NaN or magenta, so that a pass that reads them shows it.
//!
//! With [`ExecutorOptions::poison`](crate::ExecutorOptions), whatever holds nothing when the frame begins (textures and
//! buffers of the pool with what their last tenant left, images of histories, imports without contents) is filled before
//! its first use, an attachment that starts with don't-care contents is filled again, and one whose contents are dropped
//! is filled after its step: with NaN where the format can hold it, magenta where it holds colors, half-way values for
//! depth, every bit in buffers. A frame whose passes keep their promises, and whose plan is right, looks the same with and
//! without; one that does not shows numbers that are not finite, or magenta.
//!
//! What lives in the tile alone is filled at its start only, and an import that the caller made without the uses that
//! filling takes is left alone.

use crate::device::gpu::Gpu;
use crate::execute::attached::Attached;
use crate::execute::clear::{Values, fill_view};
use crate::execute::prepared::Prepared;
use crate::execute::targets::Targets;
use crate::resources::physical::PhysicalTextureDesc;
use crate::resources::realize::Physical;
use crate::resources::views::ViewDesc;
use framegraph::{Aspect, Attachment, Dimension, Format, Numeric, Plan, Range, ResourceId, StepId, StoreOp};
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{Buffer, BufferUsages, Color, CommandEncoder, LoadOp, Operations, Texture, TextureUsages};

/// A depth that is neither the near plane nor the far one.
const DEPTH: f32 = 0.5;
/// Every other bit.
const STENCIL: u32 = 0xAA;
/// All bits set: NaN as floats, the largest number as unsigned integers.
const BYTE: u8 = 0xFF;

fn is_float(format: Format) -> bool {
    use Format::*;
    matches!(
        format,
        R16Float
            | Rg16Float
            | Rgba16Float
            | R32Float
            | Rg32Float
            | Rgba32Float
            | Rg11b10Ufloat
            | Rgb9e5Ufloat
            | Bc6hRgbUfloat
    )
}

/// What a color format is filled with by a render pass.
fn color(format: Format) -> Color {
    match format.numeric() {
        Numeric::Uint | Numeric::Sint => Color { r: 85.0, g: 85.0, b: 85.0, a: 85.0 },
        _ if is_float(format) => Color { r: f64::NAN, g: f64::NAN, b: f64::NAN, a: f64::NAN },
        _ => Color { r: 1.0, g: 0.0, b: 1.0, a: 1.0 },
    }
}

/// What a format is filled with by a copy: all bits of floats, which are NaN, and every other bit of the rest.
fn byte(format: Format) -> u8 {
    if is_float(format) { BYTE } else { 0x55 }
}

/// Whether nothing of use is in the resource when the frame begins, and it has memory to fill.
fn is_undefined(plan: &Plan, resource: ResourceId) -> bool {
    !plan.graph().resources()[resource.index()].kind.defined_on_entry()
}

/// Fills everything that `step` is the first to touch and that holds nothing yet. Returns how many were filled.
pub(crate) fn at_first_use(frame: &Prepared<'_>, step: StepId, encoder: &mut CommandEncoder) -> u32 {
    let Prepared { plan, gpu, realized, .. } = *frame;
    let mut fills = 0;
    for (resource, row) in plan.graph().resource_ids().zip(plan.resources()) {
        if row.first != step || !is_undefined(plan, resource) {
            continue;
        }
        let filled = match realized.get(resource) {
            Physical::Texture { texture, shape, .. } if !shape.is_memoryless() => {
                let format = plan.format(resource).unwrap_or(shape.format);
                fill_texture(frame, texture, shape, format, encoder)
            }
            Physical::Buffer { buffer, .. } if buffer.usage().contains(BufferUsages::COPY_DST) => {
                let bytes = buffer.size() / wgpu::COPY_BUFFER_ALIGNMENT * wgpu::COPY_BUFFER_ALIGNMENT;
                encoder.copy_buffer_to_buffer(&pattern(gpu, BYTE, bytes), 0, buffer, 0, bytes);
                true
            }
            Physical::Texture { .. } | Physical::Buffer { .. } | Physical::Absent(_) => false,
        };
        fills += u32::from(filled);
    }
    fills
}

/// Fills all levels and layers, if the texture allows it.
fn fill_texture(
    frame: &Prepared<'_>,
    texture: &Texture,
    shape: &PhysicalTextureDesc,
    format: Format,
    encoder: &mut CommandEncoder,
) -> bool {
    let [_, _, layers] = shape.size;
    if shape.dimension == Dimension::D2 && texture.usage().contains(TextureUsages::RENDER_ATTACHMENT) {
        for (mip, layer) in (0..shape.mips).flat_map(|mip| (0..layers).map(move |layer| (mip, layer))) {
            let range = Range { mip: mip as u8, mips: 1, layer: layer as u16, layers: 1, ..Range::ALL };
            clear(frame, texture, shape, format, range, encoder);
        }
        return true;
    }
    if !texture.usage().contains(TextureUsages::COPY_DST) || format.is_depth_stencil() {
        return false;
    }
    let (block_width, block_height) = format.block_texels();
    for mip in 0..shape.mips {
        let size = texture.size().mip_level_size(mip, texture.dimension()).physical_size(texture.format());
        let (blocks, rows) = (size.width.div_ceil(block_width), size.height.div_ceil(block_height));
        let row_bytes = (blocks * format.block_bytes()).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let bytes = u64::from(row_bytes) * u64::from(rows) * u64::from(size.depth_or_array_layers);
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row_bytes), rows_per_image: Some(rows) };
        let from = wgpu::TexelCopyBufferInfo { buffer: &pattern(frame.gpu, byte(format), bytes), layout };
        let to = wgpu::TexelCopyTextureInfo { mip_level: mip, ..texture.as_image_copy() };
        encoder.copy_buffer_to_texture(from, to, size);
    }
    true
}

/// A buffer of one byte over and over; made anew each time, since poisoning is not for the fast path.
fn pattern(gpu: &Gpu, byte: u8, bytes: u64) -> Buffer {
    let contents = vec![byte; bytes as usize];
    gpu.device.create_buffer_init(&BufferInitDescriptor {
        label: Some("poison"),
        contents: &contents,
        usage: BufferUsages::COPY_SRC,
    })
}

fn fill<V>(ops: &mut Operations<V>, value: V) -> u32 {
    let any = matches!(ops.load, LoadOp::DontCare(_));
    if any {
        ops.load = LoadOp::Clear(value);
    }
    u32::from(any)
}

/// Fills don't-care contents at the start of the step. Returns how many planes were filled.
pub(crate) fn at_start(attached: &mut Attached, targets: &Targets) -> u32 {
    let mut fills = 0;
    for (target, format) in attached.colors.iter_mut().zip(targets.colors) {
        if let (Some(target), Some(format)) = (target, format) {
            fills += fill(&mut target.ops, color(format));
        }
    }
    if let Some(depth) = &mut attached.depth {
        depth.depth.iter_mut().for_each(|ops| fills += fill(ops, DEPTH));
        depth.stencil.iter_mut().for_each(|ops| fills += fill(ops, STENCIL));
    }
    fills
}

/// Fills dropped contents after the step. Returns how many attachments were filled.
pub(crate) fn at_end(frame: &Prepared<'_>, step: StepId, encoder: &mut CommandEncoder) -> u32 {
    let Prepared { plan, realized, .. } = *frame;
    let mut fills = 0;
    for attachment in plan.attachments_of(step) {
        let Physical::Texture { texture, shape, .. } = realized.get(attachment.resource) else {
            continue;
        };
        if shape.is_memoryless() {
            continue;
        }
        let format = plan.format(attachment.resource).unwrap_or(shape.format);
        let Attachment { mip, layer, layers, .. } = *attachment;
        if let Some(aspect) = dropped(attachment, format) {
            let range = Range { mip, mips: 1, layer, layers, aspect, ..Range::ALL };
            clear(frame, texture, shape, format, range, encoder);
            fills += 1;
        }
    }
    fills
}

/// The planes whose contents are dropped at the end of the step.
fn dropped(attachment: &Attachment, format: Format) -> Option<Aspect> {
    let is_dropped = |aspect| attachment.ops(format, aspect).is_some_and(|(_, store)| store == StoreOp::Discard);
    if !format.is_depth_stencil() {
        return is_dropped(Aspect::All).then_some(Aspect::All);
    }
    match (is_dropped(Aspect::Depth), is_dropped(Aspect::Stencil)) {
        (true, true) => Some(Aspect::All),
        (true, false) => Some(Aspect::Depth),
        (false, true) => Some(Aspect::Stencil),
        (false, false) => None,
    }
}

/// Fills the planes of one level of one layer with a render pass.
fn clear(
    frame: &Prepared<'_>,
    texture: &Texture,
    shape: &PhysicalTextureDesc,
    format: Format,
    range: Range,
    encoder: &mut CommandEncoder,
) {
    let whole = Range { aspect: Aspect::All, ..range };
    let part = ViewDesc::new(format, shape.dimension, whole, (shape.mips, shape.size[2]), true);
    let part = part.used_as(TextureUsages::RENDER_ATTACHMENT);
    // What cannot be seen cannot be filled; the pass that uses it will say why.
    let Ok(view) = frame.caches.views.get(&frame.gpu.device, texture, part, "poisoned") else { return };
    let depth_slice = (shape.dimension == Dimension::D3).then_some(0);
    let values = Values { color: color(format), depth: DEPTH, stencil: STENCIL };
    fill_view("poison", (&view, depth_slice), (format, range.aspect), values, encoder);
}
