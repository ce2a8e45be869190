//! Mock recorders of copy passes: copy each source to the targets of equal shape.

use crate::execute::cx::Cx;
use crate::execute::error::RecordError;
use crate::execute::part::{BoundBuffer, BoundResource};
use framegraph::{Access, AccessKind, Mode};
use wgpu::{Extent3d, Features, Texture};

pub(super) fn record(cx: &mut Cx<'_>) -> Result<(), RecordError> {
    let graph = cx.plan().graph();
    let (mut sources, mut targets) = (Vec::new(), Vec::new());
    for id in cx.accesses() {
        let access = graph.accesses()[id.index()];
        let bound = cx.resource(id)?;
        match access.kind {
            AccessKind::CopySource => sources.push((access, bound)),
            AccessKind::CopyTarget => targets.push((access, bound)),
            _ => {}
        }
    }
    for (to, target) in &targets {
        let copied = sources.iter().any(|(from, source)| copy(cx, (from, source), (to, target)).unwrap_or(false));
        if !copied && to.mode == Mode::Overwrite {
            clear(cx, to, target)?;
        }
    }
    Ok(())
}

/// Copies if source and target have equal shapes. Returns whether they have.
fn copy(cx: &mut Cx<'_>, from: (&Access, &BoundResource), to: (&Access, &BoundResource)) -> Result<bool, RecordError> {
    match (from.1, to.1) {
        (BoundResource::Texture { texture: source, .. }, BoundResource::Texture { texture: target, .. }) => {
            texture_to_texture(cx, (from.0, source), (to.0, target))
        }
        (BoundResource::Buffer(source), BoundResource::Buffer(target)) => buffer_to_buffer(cx, source, target),
        _ => Ok(false),
    }
}

fn texture_to_texture(
    cx: &mut Cx<'_>,
    (from, source): (&Access, &Texture),
    (to, target): (&Access, &Texture),
) -> Result<bool, RecordError> {
    let level = |texture: &Texture, access: &Access| {
        let size = texture.size().mip_level_size(access.range.mip.into(), texture.dimension());
        let layers = access.range.layer_range(texture.size().depth_or_array_layers).len() as u32;
        let deep = texture.dimension() == wgpu::TextureDimension::D3;
        Extent3d { depth_or_array_layers: if deep { size.depth_or_array_layers } else { layers }, ..size }
    };
    let (size, there) = (level(source, from), level(target, to));
    let alike = size == there
        && source.format().remove_srgb_suffix() == target.format().remove_srgb_suffix()
        && source.sample_count() == target.sample_count()
        && source.dimension() == target.dimension()
        && source != target;
    if alike {
        let place = |texture, access: &Access| wgpu::TexelCopyTextureInfo {
            texture,
            mip_level: access.range.mip.into(),
            origin: wgpu::Origin3d { x: 0, y: 0, z: access.range.layer.into() },
            aspect: wgpu::TextureAspect::All,
        };
        let size = size.physical_size(source.format());
        cx.encoder()?.copy_texture_to_texture(place(source, from), place(target, to), size);
    }
    Ok(alike)
}

fn buffer_to_buffer(cx: &mut Cx<'_>, source: &BoundBuffer, target: &BoundBuffer) -> Result<bool, RecordError> {
    let bytes = source.bytes / 4 * 4;
    // A partial copy would not overwrite the whole target.
    let alike = source.bytes == target.bytes && source.buffer != target.buffer;
    if alike {
        cx.encoder()?.copy_buffer_to_buffer(&source.buffer, source.offset, &target.buffer, target.offset, bytes);
    }
    Ok(alike)
}

/// Clears a target that is declared as overwritten and has no matching source.
fn clear(cx: &mut Cx<'_>, access: &Access, target: &BoundResource) -> Result<(), RecordError> {
    let clears = cx.gpu().device.features().contains(Features::CLEAR_TEXTURE);
    match target {
        BoundResource::Buffer(buffer) => {
            cx.encoder()?.clear_buffer(&buffer.buffer, buffer.offset, Some(buffer.bytes.next_multiple_of(4)));
        }
        BoundResource::Texture { texture, .. } if clears => {
            let layers = access.range.layer_range(texture.size().depth_or_array_layers);
            let deep = texture.dimension() == wgpu::TextureDimension::D3;
            let mips = access.range.mip_range(texture.mip_level_count());
            let range = wgpu::ImageSubresourceRange {
                aspect: wgpu::TextureAspect::All,
                base_mip_level: mips.start,
                mip_level_count: Some(mips.len() as u32),
                base_array_layer: if deep { 0 } else { layers.start },
                array_layer_count: Some(if deep { 1 } else { layers.len() as u32 }),
            };
            cx.encoder()?.clear_texture(texture, &range);
        }
        BoundResource::Texture { .. } => {}
    }
    Ok(())
}
