//! From the handles and tokens of a pass to the textures and buffers behind them.
//!
//! Every look-up is checked against what the pass declared, and noted, so that both an undeclared access and an unused
//! declaration come to light.

use crate::device::error::DeviceError;
use crate::device::format::texture_format;
use crate::execute::cx::Cx;
use crate::execute::error::RecordError;
use crate::execute::part::{BoundBuffer, BoundResource, HistoryImage, ViewPart};
use crate::execute::remembered::LastView;
use crate::named::Named;
use crate::resources::no_memory::NoMemory;
use crate::resources::physical::PhysicalTextureDesc;
use crate::resources::realize::{Physical, Realized};
use crate::resources::views::ViewDesc;
use framegraph::{
    Access, AccessId, AccessKind, Buffer, BufferView, Format, Graph, Plan, Previous, ResourceId, Texture, View,
};
use std::sync::atomic::Ordering;
use wgpu::TextureView;

impl<'a> Cx<'a> {
    /// The view behind the token of a read: one layer as two-dimensional, several as an array, depth with stencil as
    /// depth.
    ///
    /// # Errors
    /// A token of another graph or pass.
    pub fn view(&mut self, view: View) -> Result<TextureView, RecordError> {
        let access = self.read(view)?;
        self.view_at(access, ViewPart::WHOLE)
    }

    /// As [`Cx::view`], a part of it, or bound by shaders as another dimension.
    ///
    /// # Errors
    /// As [`Cx::view`], and a level or layer that the pass did not declare.
    pub fn view_part(&mut self, view: View, part: ViewPart) -> Result<TextureView, RecordError> {
        let access = self.read(view)?;
        self.view_at(access, part)
    }

    /// The view of the part that this pass writes as storage; `texture` is the handle that the write returned. Where the
    /// pass writes several levels, name one: [`Cx::view_of_part`].
    ///
    /// # Errors
    /// A handle of another graph, or one that this pass did not write.
    pub fn view_of(&mut self, texture: Texture) -> Result<TextureView, RecordError> {
        let access = self.written(texture)?;
        self.view_at(access, ViewPart::WHOLE)
    }

    /// As [`Cx::view_of`], a part of it, or bound by shaders as another dimension.
    ///
    /// # Errors
    /// As [`Cx::view_of`], and a level or layer that the pass did not declare.
    pub fn view_of_part(&mut self, texture: Texture, part: ViewPart) -> Result<TextureView, RecordError> {
        let access = self.written(texture)?;
        self.view_at(access, part)
    }

    /// The texture behind the token of a read, for copies.
    ///
    /// # Errors
    /// As [`Cx::view`].
    pub fn texture(&mut self, view: View) -> Result<wgpu::Texture, RecordError> {
        let access = self.read(view)?;
        self.physical_texture(access.1.resource).map(|(texture, _)| texture.clone())
    }

    /// The texture that this pass writes, for copies; `texture` is the handle that the write returned.
    ///
    /// # Errors
    /// As [`Cx::view_of`].
    pub fn texture_of(&mut self, texture: Texture) -> Result<wgpu::Texture, RecordError> {
        let access = self.written(texture)?;
        self.physical_texture(access.1.resource).map(|(texture, _)| texture.clone())
    }

    /// Width and height in texels of the first level of the part that a token names. That of a history's earlier image is
    /// the size in which it was written, which a resize or dynamic resolution may have changed since.
    ///
    /// # Errors
    /// As [`Cx::view`].
    pub fn texels(&self, view: View) -> Result<[u32; 2], RecordError> {
        let access = self.graph().access_of(view).ok_or(RecordError::Foreign)?;
        let level = u32::from(access.range.mip);
        if let Physical::Texture { shape: PhysicalTextureDesc { size: [width, height, _], .. }, .. } =
            self.frame.realized.get(access.resource)
        {
            return Ok([width, height].map(|side| side.unbounded_shr(level).max(1)));
        }
        let desc = self.graph().resources()[access.resource.index()].desc;
        Ok(desc.texture().map_or([0; 2], |t| t.mip_extent(self.frame.plan.frame(), level)))
    }

    /// The format that a texture is made with: the declared one, or that of the target which an inlined pass draws in its
    /// stead. Any version of the handle will do.
    ///
    /// # Errors
    /// A handle of another graph.
    pub fn format_of(&self, texture: Texture) -> Result<Format, RecordError> {
        let resource = self.graph().resource_of(texture).ok_or(RecordError::Foreign)?;
        self.frame.plan.format(resource).ok_or(RecordError::Foreign)
    }

    /// The buffer behind the token of a read, ready to bind.
    ///
    /// # Errors
    /// A token of another graph or pass.
    pub fn buffer(&mut self, view: BufferView) -> Result<BoundBuffer, RecordError> {
        let access = self.graph().access_of_buffer(view).ok_or(RecordError::Foreign)?;
        self.touch(access)?;
        self.physical_buffer(access)
    }

    /// The buffer that this pass writes, ready to bind; `buffer` is the handle that the write returned.
    ///
    /// # Errors
    /// A handle of another graph, or one that this pass did not write.
    pub fn buffer_of(&mut self, buffer: Buffer) -> Result<BoundBuffer, RecordError> {
        self.graph().resource_of_buffer(buffer).ok_or(RecordError::Foreign)?;
        let access = self.graph().writer_of_buffer(buffer).ok_or(RecordError::NotWritten)?;
        self.touch(access)?;
        self.physical_buffer(access)
    }

    /// What there is of the image of an earlier frame: whether that frame wrote it, and in which size.
    ///
    /// # Errors
    /// A handle of another graph.
    pub fn history(&self, previous: Previous) -> Result<HistoryImage, RecordError> {
        let resource = self.graph().resource_of_previous(previous).ok_or(RecordError::Foreign)?;
        Ok(match self.frame.realized.get(resource) {
            Physical::Texture { missed, shape: PhysicalTextureDesc { size: [width, height, _], .. }, .. } => {
                HistoryImage { valid: missed.is_some(), missed: missed.unwrap_or(0), texels: [*width, *height] }
            }
            Physical::Buffer { .. } | Physical::Absent(_) => HistoryImage { valid: false, missed: 0, texels: [0; 2] },
        })
    }

    /// Whether the image of an earlier frame holds what that frame wrote ([`HistoryImage::valid`]).
    ///
    /// # Errors
    /// A handle of another graph.
    pub fn is_valid(&self, previous: Previous) -> Result<bool, RecordError> {
        Ok(self.history(previous)?.valid)
    }

    /// The accesses of the pass, for recorders that are not written for one pass: graphs from files, tools, tests.
    pub fn accesses(&self) -> impl Iterator<Item = AccessId> + use<> {
        let rows = self.graph().passes()[self.pass.index()].accesses.range();
        rows.filter_map(AccessId::new)
    }

    /// What stands behind an access of the pass; the view of a texture is that of the accessed part, of its first level
    /// when it is used as storage.
    ///
    /// # Errors
    /// When the access is of another pass, or what it names has no memory.
    pub fn resource(&mut self, access: AccessId) -> Result<BoundResource, RecordError> {
        let row = self.graph().accesses().get(access.index()).ok_or(RecordError::Foreign)?;
        let storage = matches!(row.kind, AccessKind::StorageRead | AccessKind::StorageWrite);
        self.resource_part(access, ViewPart { mip: storage.then_some(row.range.mip), ..ViewPart::WHOLE })
    }

    /// As [`Cx::resource`], the view being that of a part; a buffer has no parts.
    ///
    /// # Errors
    /// As [`Cx::resource`], and a level or layer that the pass did not declare.
    pub fn resource_part(&mut self, access: AccessId, part: ViewPart) -> Result<BoundResource, RecordError> {
        let access = self.graph().accesses().get(access.index()).ok_or(RecordError::Foreign)?;
        let (index, access) = self.touch(access)?;
        if self.graph().resources()[access.resource.index()].desc.texture().is_none() {
            return self.physical_buffer(access).map(BoundResource::Buffer);
        }
        let view = self.view_at((index, access), part)?;
        let texture = self.physical_texture(access.resource)?.0.clone();
        Ok(BoundResource::Texture { texture, view })
    }

    pub(super) fn graph(&self) -> &'a Graph {
        self.frame.plan.graph()
    }

    fn read(&mut self, view: View) -> Result<(usize, &'a Access), RecordError> {
        let access = self.graph().access_of(view).ok_or(RecordError::Foreign)?;
        self.touch(access)
    }

    fn written(&mut self, texture: Texture) -> Result<(usize, &'a Access), RecordError> {
        self.graph().resource_of(texture).ok_or(RecordError::Foreign)?;
        let access = self.graph().writer_of(texture).ok_or(RecordError::NotWritten)?;
        self.touch(access)
    }

    /// Notes that the recorder uses `access`, which must be of its own pass, and returns it with its number.
    fn touch<'g>(&self, access: &'g Access) -> Result<(usize, &'g Access), RecordError> {
        let own = self.graph().passes()[self.pass.index()].accesses.range();
        let index = own.clone().find(|a| std::ptr::eq(&self.graph().accesses()[*a], access));
        let Some(index) = index else {
            return Err(self.undeclared(access));
        };
        self.frame.touched[index].store(true, Ordering::Relaxed);
        Ok((index, access))
    }

    fn undeclared(&self, access: &Access) -> RecordError {
        RecordError::Undeclared { resource: Named::resource(self.frame.plan, access.resource), access: access.kind }
    }

    /// The view of a part of what an access names.
    fn view_at(&mut self, (index, access): (usize, &Access), part: ViewPart) -> Result<TextureView, RecordError> {
        let stamp = self.frame.realized.stamp(access.resource);
        let asked = stamp.map(|stamp| (index, part, stamp));
        let last = self.recording.remembered.step().views.next();
        if let (Some(asked), LastView(Some((known, view)))) = (asked, last)
            && asked == *known
        {
            let view = view.clone();
            self.recording.remembered.views_found += 1;
            return Ok(view);
        }
        let view = self.make_view(access, part)?;
        let last = self.recording.remembered.step().views.last();
        *last = LastView(asked.map(|asked| (asked, view.clone())));
        Ok(view)
    }

    pub(super) fn make_view(&mut self, access: &Access, part: ViewPart) -> Result<TextureView, RecordError> {
        let realized = self.frame.realized;
        let (texture, shape) = physical_texture(realized, self.frame.plan, access.resource)?;
        let format = access.range.view.or(self.frame.plan.format(access.resource)).unwrap_or(shape.format);
        let counts = (shape.mips, shape.size[2]);
        let range = part.of(access.range, counts).ok_or_else(|| self.undeclared(access))?;
        let mut view = ViewDesc::new(format, shape.dimension, range, counts, false);
        view = part.dimension.map_or(view, |d| view.as_dimension(d));
        // The texture may be made in the linear form of the view's sRGB format, and have uses that the view cannot have.
        if texture.format() != texture_format(format) {
            view = view.used_as(shape.view_usages(format));
        }
        let name = self.graph().resource_name(access.resource);
        self.frame.caches.views.get(&self.frame.gpu.device, texture, view, name).map_err(|error| match error {
            DeviceError::Refused { message, .. } => {
                RecordError::View { resource: Named::resource(self.frame.plan, access.resource), message }
            }
            other => other.into(),
        })
    }

    fn physical_texture(
        &self,
        resource: ResourceId,
    ) -> Result<(&'a wgpu::Texture, &'a PhysicalTextureDesc), RecordError> {
        physical_texture(self.frame.realized, self.frame.plan, resource)
    }

    fn physical_buffer(&self, access: &Access) -> Result<BoundBuffer, RecordError> {
        let resource = access.resource;
        match self.frame.realized.get(resource) {
            Physical::Buffer { buffer, bytes } => {
                let named = self.graph().bytes_of(access);
                let (offset, bytes) = named.map_or((0, *bytes), |named| (named.offset, named.bytes));
                Ok(BoundBuffer { buffer: buffer.clone(), offset, bytes })
            }
            Physical::Texture { .. } => Err(nowhere(self.frame.plan, resource, NoMemory::IsTexture)),
            Physical::Absent(why) => Err(nowhere(self.frame.plan, resource, *why)),
        }
    }
}

fn physical_texture<'r>(
    realized: &'r Realized,
    plan: &Plan,
    resource: ResourceId,
) -> Result<(&'r wgpu::Texture, &'r PhysicalTextureDesc), RecordError> {
    match realized.get(resource) {
        Physical::Texture { shape, .. } if shape.is_memoryless() => Err(nowhere(plan, resource, NoMemory::Memoryless)),
        Physical::Texture { texture, shape, .. } => Ok((texture, shape)),
        Physical::Buffer { .. } => Err(nowhere(plan, resource, NoMemory::IsBuffer)),
        Physical::Absent(why) => Err(nowhere(plan, resource, *why)),
    }
}

fn nowhere(plan: &Plan, resource: ResourceId, why: NoMemory) -> RecordError {
    RecordError::NoMemory { resource: Named::resource(plan, resource), why }
}
