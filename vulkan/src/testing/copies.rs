//! Mock recording of copy passes.

#![allow(unsafe_code, reason = "Vulkan has no safe calls")]

use super::kit::Kit;
use crate::convert::planes;
use crate::cx::{Cx, RecordError};
use crate::views::ViewShape;
use ash::vk;
use framegraph::{Access, AccessKind, Aspect, Desc, Plan, TextureDesc};

/// Levels and layers of an access of a texture, with the texture.
fn parts(plan: &Plan, access: &Access) -> Option<(TextureDesc, vk::ImageSubresourceRange)> {
    let Desc::Texture(desc) = plan.graph().resources()[access.resource.index()].desc else { return None };
    let (mips, layers) =
        (access.range.mip_range(desc.mip_count(plan.frame())), access.range.layer_range(desc.tracked_layers()));
    let range = vk::ImageSubresourceRange {
        aspect_mask: planes(desc.format, access.range.aspect),
        base_mip_level: mips.start,
        level_count: mips.len() as u32,
        base_array_layer: layers.start,
        layer_count: layers.len() as u32,
    };
    Some((desc, range))
}

impl Kit {
    /// Copies the first source of equal shape into each target. Clears targets without such a source.
    pub(super) fn copies(&mut self, cx: &mut Cx<'_>, own: &[Access]) -> Result<(), RecordError> {
        let of = |kind| own.iter().filter(move |access| access.kind == kind);
        for target in of(AccessKind::CopyTarget) {
            match parts(cx.plan(), target) {
                Some((desc, range)) => {
                    let same = |source: &&Access| {
                        let shape =
                            |d: &TextureDesc| (d.format, d.samples, d.dimension, d.extent.texels(cx.plan().frame()));
                        let levels = |r: &vk::ImageSubresourceRange| (r.level_count, r.layer_count, r.base_mip_level);
                        let found = parts(cx.plan(), source);
                        found.is_some_and(|(d, r)| shape(&d) == shape(&desc) && levels(&r) == levels(&range))
                    };
                    let source = of(AccessKind::CopySource).find(same).copied();
                    self.image(cx, target, &desc, range, source)?;
                }
                None => {
                    let target = cx.buffer_of(target)?;
                    // SAFETY: the buffer belongs to the device and has these bytes; no render pass is open.
                    unsafe {
                        let bytes = target.bytes & !3;
                        cx.device().cmd_fill_buffer(cx.commands(), target.buffer, target.offset, bytes, 7);
                    }
                }
            }
        }
        self.sources(cx, own)
    }

    fn image(
        &mut self,
        cx: &mut Cx<'_>,
        target: &Access,
        desc: &TextureDesc,
        range: vk::ImageSubresourceRange,
        source: Option<Access>,
    ) -> Result<(), RecordError> {
        let shape = ViewShape { arrayed: true, ..ViewShape::default() };
        let frame = cx.plan().frame();
        let to = cx.bind(target, ViewShape { kind: None, ..shape })?;
        let Some(source) = source else {
            // SAFETY: the image is in the layout of copy targets and has these parts; no render pass is open.
            unsafe {
                let (commands, layout) = (cx.commands(), to.layout);
                if range.aspect_mask == vk::ImageAspectFlags::COLOR {
                    let value = vk::ClearColorValue { float32: [0.5; 4] };
                    cx.device().cmd_clear_color_image(commands, to.image, layout, &value, &[range]);
                } else {
                    let value = vk::ClearDepthStencilValue { depth: 0.5, stencil: 3 };
                    cx.device().cmd_clear_depth_stencil_image(commands, to.image, layout, &value, &[range]);
                }
            }
            return Ok(());
        };
        let from = cx.bind(&source, shape)?;
        let Some((_, from_range)) = parts(cx.plan(), &source) else { return Ok(()) };
        let layers = |range: &vk::ImageSubresourceRange, mip: u32| vk::ImageSubresourceLayers {
            aspect_mask: planes(desc.format, Aspect::All) & range.aspect_mask,
            mip_level: mip,
            base_array_layer: range.base_array_layer,
            layer_count: range.layer_count,
        };
        for mip in 0..range.level_count {
            let mip = range.base_mip_level + mip;
            let [width, height] = desc.mip_extent(frame, mip);
            let depth =
                if desc.dimension == framegraph::Dimension::D3 { (u32::from(desc.layers) >> mip).max(1) } else { 1 };
            let region = vk::ImageCopy {
                src_subresource: layers(&from_range, mip),
                dst_subresource: layers(&range, mip),
                extent: vk::Extent3D { width, height, depth },
                ..Default::default()
            };
            // SAFETY: both images belong to the device, are in the layouts of copies, and have these parts.
            unsafe {
                cx.device().cmd_copy_image(cx.commands(), from.image, from.layout, to.image, to.layout, &[region]);
            }
        }
        Ok(())
    }

    /// Reads buffers that are sources, so that validation sees the accesses.
    fn sources(&mut self, cx: &mut Cx<'_>, own: &[Access]) -> Result<(), RecordError> {
        for source in own.iter().filter(|access| access.kind == AccessKind::CopySource) {
            let Ok(from) = cx.buffer_of(source) else { continue };
            let bytes = from.bytes.min(1024);
            let to = self.buffer(&vec![0; bytes as usize], vk::BufferUsageFlags::empty())?;
            let region = vk::BufferCopy { src_offset: from.offset, dst_offset: 0, size: bytes };
            // SAFETY: both buffers belong to the device and have these bytes.
            unsafe { cx.device().cmd_copy_buffer(cx.commands(), from.buffer, to.buffer, &[region]) };
        }
        Ok(())
    }
}
