//! Image views, found again by what they show.

use crate::convert::{image_usage, planes, vk_format};
use crate::driver::{Driver, Object};
use crate::error::Error;
use ash::vk;
use framegraph::{Aspect, Dimension, Format, Plan, Range, ResourceId};
use std::collections::BTreeMap;

/// Identity of a view.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct ViewKey {
    image: vk::Image,
    kind: vk::ImageViewType,
    format: vk::Format,
    aspect: vk::ImageAspectFlags,
    mips: [u32; 2],
    layers: [u32; 2],
    storage: bool,
}

/// Shape in which a shader binds a texture.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub struct ViewShape {
    /// Binds an array view, even of one layer.
    pub arrayed: bool,
    /// Binds one level only, instead of all levels of the access.
    pub mip: Option<u8>,
    /// Binds one plane of a depth-stencil texture, instead of the planes of the access.
    pub aspect: Option<Aspect>,
    /// Overrides the type of the view, for example for cubes, which need square textures with six layers and one sample.
    /// An import must have been created as compatible with the type.
    pub kind: Option<vk::ImageViewType>,
}

/// Views of an executor. Views of imports live for one frame, because the engine can destroy the images.
#[derive(Default)]
pub(crate) struct Views {
    kept: BTreeMap<ViewKey, vk::ImageView>,
    of_imports: BTreeMap<ViewKey, vk::ImageView>,
}

/// Image with the resource that it belongs to.
#[derive(Clone, Copy)]
pub(crate) struct Viewed {
    pub(crate) image: vk::Image,
    pub(crate) resource: ResourceId,
    pub(crate) imported: bool,
}

impl Views {
    /// Returns a view of a range for shaders.
    pub(crate) fn bound(
        &mut self,
        driver: &Driver,
        plan: &Plan,
        of: Viewed,
        range: &Range,
        storage: bool,
        shape: ViewShape,
    ) -> Result<vk::ImageView, Error> {
        let range = Range { aspect: shape.aspect.unwrap_or(range.aspect), ..*range };
        let range = shape.mip.map_or(range, |mip| Range { mip, mips: 1, ..range });
        self.view(driver, plan, of, &range, storage, (shape.arrayed, shape.kind), false)
    }

    /// Returns a view for a framebuffer. It shows every plane.
    pub(crate) fn attached(
        &mut self,
        driver: &Driver,
        plan: &Plan,
        of: Viewed,
        range: &Range,
    ) -> Result<vk::ImageView, Error> {
        let range = Range { aspect: Aspect::All, ..*range };
        let arrayed = range.layers > 1;
        self.view(driver, plan, of, &range, false, (arrayed, None), true)
    }

    fn view(
        &mut self,
        driver: &Driver,
        plan: &Plan,
        of: Viewed,
        range: &Range,
        storage: bool,
        (arrayed, kind): (bool, Option<vk::ImageViewType>),
        attached: bool,
    ) -> Result<vk::ImageView, Error> {
        let desc = plan.graph().resources()[of.resource.index()].desc;
        let desc = desc.texture().ok_or(Error::NotPrepared)?;
        let format = plan.format(of.resource).unwrap_or(desc.format);
        let (mips, layers) = (range.mip_range(desc.mip_count(plan.frame())), range.layer_range(desc.tracked_layers()));
        let kind = kind.unwrap_or(match desc.dimension {
            Dimension::D3 if !attached => vk::ImageViewType::TYPE_3D,
            _ if arrayed || layers.len() > 1 => vk::ImageViewType::TYPE_2D_ARRAY,
            _ => vk::ImageViewType::TYPE_2D,
        });
        let key = ViewKey {
            image: of.image,
            kind,
            format: vk_format(if attached || !storage { range.view.unwrap_or(format) } else { format }),
            aspect: planes(format, range.aspect),
            mips: [mips.start, mips.len() as u32],
            layers: [layers.start, layers.len() as u32],
            storage,
        };
        let known = if of.imported { &mut self.of_imports } else { &mut self.kept };
        if let Some(view) = known.get(&key) {
            return Ok(*view);
        }
        let mut usage =
            vk::ImageViewUsageCreateInfo::default().usage(view_usage(plan, of.resource, format, storage, attached));
        let info = vk::ImageViewCreateInfo::default()
            .image(key.image)
            .view_type(key.kind)
            .format(key.format)
            .subresource_range(vk::ImageSubresourceRange {
                aspect_mask: key.aspect,
                base_mip_level: key.mips[0],
                level_count: key.mips[1],
                base_array_layer: key.layers[0],
                layer_count: key.layers[1],
            });
        // A view in another format must not have usages that this format lacks.
        let info = if plan.resources()[of.resource.index()].srgb_views { info.push_next(&mut usage) } else { info };
        let view = driver.view(&info)?;
        known.insert(key, view);
        Ok(view)
    }

    /// Removes the views of imports, for destruction when the frame has ended.
    pub(crate) fn take_imported(&mut self) -> Vec<Object> {
        std::mem::take(&mut self.of_imports).into_values().map(Object::View).collect()
    }

    /// Destroys all views.
    pub(crate) fn clear(&mut self, driver: &Driver) {
        let mut all = self.take_imported();
        all.extend(std::mem::take(&mut self.kept).into_values().map(Object::View));
        all.into_iter().for_each(|view| driver.destroy(view));
    }
}

fn view_usage(plan: &Plan, id: ResourceId, format: Format, storage: bool, attached: bool) -> vk::ImageUsageFlags {
    let own = match (storage, attached) {
        (true, _) => return vk::ImageUsageFlags::STORAGE,
        (_, true) if format.is_depth_stencil() => vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT,
        (_, true) => vk::ImageUsageFlags::COLOR_ATTACHMENT,
        _ => vk::ImageUsageFlags::empty(),
    };
    let usage = image_usage(plan.resources()[id.index()].usage, format, false);
    own | usage & (vk::ImageUsageFlags::INPUT_ATTACHMENT | vk::ImageUsageFlags::SAMPLED)
}
