//! Records the copies that `graph_contents::copy` defines for a pass.

#![allow(unsafe_code, reason = "Vulkan has no safe calls")]

use super::record::Frame;
use framegraph::{Access, Aspect, Format, Graph};
use framegraph_vulkan::ash::vk;
use framegraph_vulkan::{BoundBuffer, BoundImage, Cx, RecordError, ViewShape};
use graph_contents::code::{bytes_of, coding, texel_hash, word};
use graph_contents::copy::{Copy, NOTE_BYTES, Spot, copies};
use graph_contents::spec;

fn flags(plane: Aspect, format: Format) -> vk::ImageAspectFlags {
    match (plane, format.has_depth(), format.has_stencil()) {
        (Aspect::Depth, ..) => vk::ImageAspectFlags::DEPTH,
        (Aspect::Stencil, ..) | (Aspect::All, false, true) => vk::ImageAspectFlags::STENCIL,
        (Aspect::All, true, true) => vk::ImageAspectFlags::DEPTH | vk::ImageAspectFlags::STENCIL,
        (Aspect::All, true, false) => vk::ImageAspectFlags::DEPTH,
        (Aspect::All, false, false) => vk::ImageAspectFlags::COLOR,
    }
}

fn layers(spot: Spot, aspect_mask: vk::ImageAspectFlags) -> vk::ImageSubresourceLayers {
    vk::ImageSubresourceLayers {
        aspect_mask,
        mip_level: spot.mip.into(),
        base_array_layer: spot.layer.into(),
        layer_count: 1,
    }
}

fn extent([width, height]: [u32; 2]) -> vk::Extent3D {
    vk::Extent3D { width, height, depth: 1 }
}

/// Returns the copy between a buffer with rows of `pitch` bytes and an image.
fn region(
    buffer_offset: u64,
    pitch: u32,
    texel: u32,
    to: vk::ImageSubresourceLayers,
    size: [u32; 2],
) -> vk::BufferImageCopy {
    vk::BufferImageCopy {
        buffer_offset,
        buffer_row_length: pitch / texel,
        image_subresource: to,
        image_extent: extent(size),
        ..Default::default()
    }
}

fn texel_bytes(format: Format, plane: Aspect) -> u32 {
    match plane {
        Aspect::Stencil => 1,
        Aspect::Depth => 4,
        Aspect::All => format.block_bytes(),
    }
}

impl Frame<'_> {
    /// Records a copy pass.
    pub fn copies(&mut self, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let graph = cx.plan().graph();
        let (pass, accesses) = (cx.pass(), graph.accesses_of(cx.pass()));
        let salt = spec::salt(pass, self.number);
        for copy in copies(graph, pass).ok_or("a copy that WebGPU does not have")? {
            let format = |spot: Spot| format_of(graph, &accesses[spot.access]);
            match copy {
                Copy::Pattern { into, plane } => {
                    let bytes = pattern(graph, &accesses[into.access], into, plane, salt);
                    let (source, target) = (self.put(&bytes)?, image(cx, &accesses[into.access])?);
                    let size = spec::texels(graph, accesses[into.access].resource, into.mip);
                    let to = layers(into, flags(plane, format(into)));
                    upload(cx, source, target, region(source.offset, 0, 1, to, size));
                }
                Copy::Zero { into } => {
                    let target = image(cx, &accesses[into.access])?;
                    zero(cx, target, layers(into, flags(Aspect::All, format(into))));
                }
                Copy::Texture { from, into, texels } => {
                    let (source, target) = (image(cx, &accesses[from.access])?, image(cx, &accesses[into.access])?);
                    let region = vk::ImageCopy {
                        src_subresource: layers(from, flags(Aspect::All, format(from))),
                        dst_subresource: layers(into, flags(Aspect::All, format(into))),
                        extent: extent(texels),
                        ..Default::default()
                    };
                    let (from, to) = (source.layout, target.layout);
                    // SAFETY: both images belong to the device, in the layouts of copies, and have these parts.
                    unsafe {
                        cx.device().cmd_copy_image(cx.commands(), source.image, from, target.image, to, &[region]);
                    };
                }
                Copy::PatternBuffer { into, bytes } => {
                    let tag = spec::tag(into, 0, 0);
                    let words: Vec<u8> = (0..bytes as u32 / 4).flat_map(|i| word(salt, tag, i).to_le_bytes()).collect();
                    let source = self.put(&words)?;
                    buffer(cx, source, cx.buffer_of(&accesses[into])?, bytes);
                }
                Copy::Buffer { from, into, bytes } => {
                    buffer(cx, cx.buffer_of(&accesses[from])?, cx.buffer_of(&accesses[into])?, bytes);
                }
                Copy::Rows { from, into, offset, pitch, texels } => {
                    let (source, target) = (image(cx, &accesses[from.access])?, cx.buffer_of(&accesses[into])?);
                    let texel = texel_bytes(format(from), Aspect::All);
                    let part = layers(from, flags(Aspect::All, format(from)));
                    download(cx, source, target, region(target.offset + offset, pitch, texel, part, texels));
                }
                Copy::Note { note, from, plane, pitch, texels } => {
                    let (source, target) = (image(cx, &accesses[from.access])?, self.note(pass.index(), note));
                    let texel = texel_bytes(format(from), plane);
                    let part = layers(from, flags(plane, format(from)));
                    download(cx, source, target, region(target.offset, pitch, texel, part, texels));
                }
                Copy::NoteBuffer { note, from, bytes } => {
                    let target = self.note(pass.index(), note);
                    buffer(cx, cx.buffer_of(&accesses[from])?, target, bytes);
                }
            }
            between(cx);
        }
        Ok(())
    }

    fn note(&mut self, pass: usize, note: usize) -> BoundBuffer {
        let range = self.notes.take(NOTE_BYTES);
        self.noted.push((pass, note, range.offset));
        range
    }
}

fn format_of(graph: &Graph, access: &Access) -> Format {
    graph.resources()[access.resource.index()].desc.texture().map_or(Format::R8Unorm, |t| t.format)
}

fn image(cx: &mut Cx<'_>, access: &Access) -> Result<BoundImage, RecordError> {
    // Only the image and its layout are used.
    let two = format_of(cx.plan().graph(), access).planes() > 1 && access.range.aspect == Aspect::All;
    let aspect = two.then_some(Aspect::Depth);
    Ok(cx.bind(access, ViewShape { arrayed: true, aspect, ..ViewShape::default() })?)
}

fn upload(cx: &Cx<'_>, from: BoundBuffer, to: BoundImage, region: vk::BufferImageCopy) {
    // SAFETY: buffer and image belong to the device, have these parts, and the image is in the layout of copies.
    unsafe { cx.device().cmd_copy_buffer_to_image(cx.commands(), from.buffer, to.image, to.layout, &[region]) };
}

fn download(cx: &Cx<'_>, from: BoundImage, to: BoundBuffer, region: vk::BufferImageCopy) {
    // SAFETY: buffer and image belong to the device, have these parts, and the image is in the layout of copies.
    unsafe { cx.device().cmd_copy_image_to_buffer(cx.commands(), from.image, from.layout, to.buffer, &[region]) };
}

fn buffer(cx: &Cx<'_>, from: BoundBuffer, to: BoundBuffer, size: u64) {
    let region = vk::BufferCopy { src_offset: from.offset, dst_offset: to.offset, size };
    // SAFETY: both buffers belong to the device and have these bytes.
    unsafe { cx.device().cmd_copy_buffer(cx.commands(), from.buffer, to.buffer, &[region]) };
}

fn zero(cx: &Cx<'_>, to: BoundImage, part: vk::ImageSubresourceLayers) {
    let range = vk::ImageSubresourceRange {
        aspect_mask: part.aspect_mask,
        base_mip_level: part.mip_level,
        level_count: 1,
        base_array_layer: part.base_array_layer,
        layer_count: 1,
    };
    // SAFETY: the image belongs to the device, is in the layout of copies, and has this part.
    unsafe {
        let (commands, layout) = (cx.commands(), to.layout);
        if part.aspect_mask == vk::ImageAspectFlags::COLOR {
            cx.device().cmd_clear_color_image(commands, to.image, layout, &Default::default(), &[range]);
        } else {
            cx.device().cmd_clear_depth_stencil_image(commands, to.image, layout, &Default::default(), &[range]);
        }
    }
}

/// Orders copies of one pass.
fn between(cx: &Cx<'_>) {
    let (stage, none) = (vk::PipelineStageFlags::TRANSFER, vk::DependencyFlags::empty());
    let barrier = vk::MemoryBarrier::default()
        .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
        .dst_access_mask(vk::AccessFlags::TRANSFER_READ | vk::AccessFlags::TRANSFER_WRITE);
    // SAFETY: the commands are being recorded, outside of a render pass.
    unsafe { cx.device().cmd_pipeline_barrier(cx.commands(), stage, stage, none, &[barrier], &[], &[]) };
}

/// Returns the bytes of a pattern, row by row.
fn pattern(graph: &Graph, row: &Access, into: Spot, plane: Aspect, salt: u32) -> Vec<u8> {
    let format = format_of(graph, row);
    let [width, height] = spec::texels(graph, row.resource, into.mip);
    let tag = spec::tag(into.access, spec::plane_index(format, plane), into.mip) + u32::from(into.layer);
    let coding = coding(format, plane);
    let texels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    texels.flat_map(|(x, y)| bytes_of(format, plane, coding.painted(texel_hash(salt, tag, x, y)))).collect()
}
