//! Records the copies that `copy` defines for a pass.

use super::code::{bytes_of, coding, texel_hash, word};
use super::copy::{Copy, NOTE_BYTES, NOTES, Spot, copies};
use super::record::Stage;
use super::spec;
use framegraph::{Access, Aspect, Format, Graph, PassId};
use framegraph_wgpu::{BoundResource, Cx, RecordError};
use wgpu::{
    BufferUsages, Extent3d, ImageSubresourceRange, Origin3d, TexelCopyBufferInfo, TexelCopyBufferLayout,
    TexelCopyTextureInfo, TextureAspect,
};

/// Records a copy pass.
pub fn record(cx: &mut Cx<'_>, pass: PassId, stage: &Stage) -> Result<(), RecordError> {
    let graph = cx.plan().graph();
    let accesses = graph.accesses_of(pass);
    let ids: Vec<_> = cx.accesses().collect();
    let bound = ids.iter().map(|id| cx.resource(*id)).collect::<Result<Vec<_>, _>>()?;
    let salt = spec::salt(pass, stage.frame);
    for copy in copies(graph, pass).ok_or_else(|| RecordError::custom("a copy that WebGPU has not"))? {
        match copy {
            Copy::Pattern { into, plane } => {
                let row = &accesses[into.access];
                let (bytes, pitch, size) = pattern(graph, row, into, plane, salt);
                let buffer = upload(cx, &bytes);
                let mut target = spot(&bound, into)?;
                target.aspect = aspect(plane);
                let layout = TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(pitch), rows_per_image: None };
                let source = TexelCopyBufferInfo { buffer: &buffer, layout };
                cx.encoder()?.copy_buffer_to_texture(source, target, extent(size));
            }
            Copy::Zero { into } => {
                let target = spot(&bound, into)?;
                let range = ImageSubresourceRange {
                    aspect: TextureAspect::All,
                    base_mip_level: into.mip.into(),
                    mip_level_count: Some(1),
                    base_array_layer: into.layer.into(),
                    array_layer_count: Some(1),
                };
                cx.encoder()?.clear_texture(target.texture, &range);
            }
            Copy::Texture { from, into, texels } => {
                let (source, target) = (spot(&bound, from)?, spot(&bound, into)?);
                cx.encoder()?.copy_texture_to_texture(source, target, extent(texels));
            }
            Copy::PatternBuffer { into, bytes } => {
                let target = buffer_of(&bound, into)?;
                let tag = spec::tag(into, 0, 0);
                let words: Vec<u32> = (0..bytes as u32 / 4).map(|i| word(salt, tag, i)).collect();
                let source = upload(cx, bytemuck::cast_slice(&words));
                cx.encoder()?.copy_buffer_to_buffer(&source, 0, target, 0, bytes);
            }
            Copy::Buffer { from, into, bytes } => {
                let (source, target) = (buffer_of(&bound, from)?, buffer_of(&bound, into)?);
                cx.encoder()?.copy_buffer_to_buffer(source, 0, target, 0, bytes);
            }
            Copy::Rows { from, into, offset, pitch, texels } => {
                let (source, target) = (spot(&bound, from)?, buffer_of(&bound, into)?);
                let layout = TexelCopyBufferLayout { offset, bytes_per_row: Some(pitch), rows_per_image: None };
                let target = TexelCopyBufferInfo { buffer: target, layout };
                cx.encoder()?.copy_texture_to_buffer(source, target, extent(texels));
            }
            Copy::Note { note, from, plane, pitch, texels } => {
                let mut source = spot(&bound, from)?;
                source.aspect = aspect(plane);
                let offset = note_offset(pass, note);
                let layout = TexelCopyBufferLayout { offset, bytes_per_row: Some(pitch), rows_per_image: None };
                let target = TexelCopyBufferInfo { buffer: &stage.notes, layout };
                cx.encoder()?.copy_texture_to_buffer(source, target, extent(texels));
            }
            Copy::NoteBuffer { note, from, bytes } => {
                let source = buffer_of(&bound, from)?;
                let offset = note_offset(pass, note);
                cx.encoder()?.copy_buffer_to_buffer(source, 0, &stage.notes, offset, bytes);
            }
        }
    }
    Ok(())
}

/// Returns the offset of a note in bytes.
pub fn note_offset(pass: PassId, note: usize) -> u64 {
    (pass.index() * NOTES + note) as u64 * NOTE_BYTES
}

fn spot(bound: &[BoundResource], spot: Spot) -> Result<TexelCopyTextureInfo<'_>, RecordError> {
    let BoundResource::Texture { texture, .. } = &bound[spot.access] else {
        return Err(RecordError::custom("a texture was expected"));
    };
    let origin = Origin3d { x: 0, y: 0, z: spot.layer.into() };
    Ok(TexelCopyTextureInfo { texture, mip_level: spot.mip.into(), origin, aspect: TextureAspect::All })
}

fn buffer_of(bound: &[BoundResource], access: usize) -> Result<&wgpu::Buffer, RecordError> {
    match &bound[access] {
        BoundResource::Buffer(b) => Ok(&b.buffer),
        BoundResource::Texture { .. } => Err(RecordError::custom("a buffer was expected")),
    }
}

fn extent([width, height]: [u32; 2]) -> Extent3d {
    Extent3d { width, height, depth_or_array_layers: 1 }
}

fn aspect(plane: Aspect) -> TextureAspect {
    match plane {
        Aspect::All => TextureAspect::All,
        Aspect::Depth => TextureAspect::DepthOnly,
        Aspect::Stencil => TextureAspect::StencilOnly,
    }
}

/// Returns the bytes of a pattern, its row distance in bytes, and its size in texels.
fn pattern(graph: &Graph, row: &Access, into: Spot, plane: Aspect, salt: u32) -> (Vec<u8>, u32, [u32; 2]) {
    let desc = graph.resources()[row.resource.index()].desc;
    let format = desc.texture().map_or(Format::R8Unorm, |t| t.format);
    let texel_bytes = if plane == Aspect::Stencil { 1 } else { format.block_bytes() };
    let [width, height] = spec::texels(graph, row.resource, into.mip);
    let pitch = (width * texel_bytes).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let tag = spec::tag(into.access, spec::plane_index(format, plane), into.mip) + u32::from(into.layer);
    let coding = coding(format, plane);
    let mut bytes = Vec::new();
    for y in 0..height {
        for x in 0..width {
            bytes.extend(bytes_of(format, plane, coding.painted(texel_hash(salt, tag, x, y))));
        }
        bytes.resize((pitch * (y + 1)) as usize, 0);
    }
    (bytes, pitch, [width, height])
}

/// Creates a buffer with these bytes for one frame.
fn upload(cx: &Cx<'_>, bytes: &[u8]) -> wgpu::Buffer {
    let buffer = cx.gpu().device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("pattern"),
        size: (bytes.len() as u64).next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT),
        usage: BufferUsages::COPY_SRC | BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut padded = bytes.to_vec();
    padded.resize(bytes.len().next_multiple_of(4), 0);
    cx.gpu().queue.write_buffer(&buffer, 0, &padded);
    buffer
}
