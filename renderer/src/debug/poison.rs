//! Poisoning: fills undefined contents with conspicuous values, so that a pass that reads them becomes visible.
//!
//! Enabled by [`ExecutorOptions::poison`](crate::ExecutorOptions). Three kinds of contents are filled:
//!
//! - Contents that are undefined when the frame begins: pooled textures and buffers, history images, and imports
//!   without contents. They are filled before their first use.
//! - Attachments that start with don't-care contents, at the start of the step.
//! - Attachments whose contents are discarded, after the step.
//!
//! Float formats are filled with NaN, other color formats with magenta, depth with 0.5, and buffers with all bits set.
//! A correct frame renders the same image with and without poisoning. Otherwise NaN or magenta shows up in the image.
//!
//! Memoryless attachments are filled at their start only. Imports that lack the usage flags for filling are left
//! unchanged.

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

/// Depth value that is neither the near nor the far plane.
const DEPTH: f32 = 0.5;
/// Stencil value with every other bit set.
const STENCIL: u32 = 0xAA;
/// Byte with all bits set: NaN as floats, the maximum as unsigned integers.
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

/// Returns the clear color for a format filled by a render pass.
fn color(format: Format) -> Color {
    match format.numeric() {
        Numeric::Uint | Numeric::Sint => Color { r: 85.0, g: 85.0, b: 85.0, a: 85.0 },
        _ if is_float(format) => Color { r: f64::NAN, g: f64::NAN, b: f64::NAN, a: f64::NAN },
        _ => Color { r: 1.0, g: 0.0, b: 1.0, a: 1.0 },
    }
}

/// Returns the byte to fill a format with by a copy: all bits set for floats (NaN), otherwise every other bit.
fn byte(format: Format) -> u8 {
    if is_float(format) { BYTE } else { 0x55 }
}

/// Returns whether the resource's contents are undefined when the frame begins.
fn is_undefined(plan: &Plan, resource: ResourceId) -> bool {
    !plan.graph().resources()[resource.index()].kind.defined_on_entry()
}

/// Fills every undefined resource that `step` is the first to use. Returns the number of fills.
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

/// Fills all levels and layers. Returns false if the texture's usages do not allow it.
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

/// Creates a buffer filled with one byte value. Not cached, since poisoning need not be fast.
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

/// Turns don't-care load operations of the step into clears. Returns the number of planes.
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

/// Fills discarded attachments after the step. Returns the number of attachments.
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

/// Returns the planes whose contents are discarded at the end of the step.
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

/// Fills the given planes of one level and layer with a render pass.
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
    // A view that cannot be created is skipped; the pass that uses it reports the error.
    let Ok(view) = frame.caches.views.get(&frame.gpu.device, texture, part, "poisoned") else { return };
    let depth_slice = (shape.dimension == Dimension::D3).then_some(range.layer.into());
    let values = Values { color: color(format), depth: DEPTH, stencil: STENCIL };
    fill_view("poison", (&view, depth_slice), (format, range.aspect), values, encoder);
}
