//! Lookup of the textures and buffers behind the handles and tokens of a pass.
//!
//! Every lookup is checked against the pass's declaration and noted. Undeclared accesses are errors, and unused
//! declarations can be listed.

use crate::device::error::DeviceError;
use crate::device::format::texture_format;
use crate::execute::cx::Cx;
use crate::execute::error::RecordError;
use crate::execute::part::{BoundBuffer, BoundResource, HistoryImage, ViewPart};
use crate::execute::request_cache::LastView;
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
    /// Returns the view of a texture that the pass declared to read. One layer becomes a 2D view, several layers a 2D
    /// array view; of depth-stencil textures the depth plane is viewed.
    ///
    /// # Errors
    /// Fails if the token belongs to another graph or pass.
    pub fn view(&mut self, view: View) -> Result<TextureView, RecordError> {
        let access = self.read(view)?;
        self.view_at(access, ViewPart::WHOLE)
    }

    /// Returns the view of a part of a texture that the pass declared to read, or with another dimension.
    ///
    /// # Errors
    /// Fails like [`Cx::view`], and if the level or layer was not declared.
    pub fn view_part(&mut self, view: View, part: ViewPart) -> Result<TextureView, RecordError> {
        let access = self.read(view)?;
        self.view_at(access, part)
    }

    /// Returns the view of a storage texture that the pass writes. `texture` is the handle that the write returned. If
    /// the pass writes several levels, select one with [`Cx::view_of_part`].
    ///
    /// # Errors
    /// Fails if the handle belongs to another graph, or the pass did not write it.
    pub fn view_of(&mut self, texture: Texture) -> Result<TextureView, RecordError> {
        let access = self.written(texture)?;
        self.view_at(access, ViewPart::WHOLE)
    }

    /// Returns the view of a part of a storage texture that the pass writes, or with another dimension.
    ///
    /// # Errors
    /// Fails like [`Cx::view_of`], and if the level or layer was not declared.
    pub fn view_of_part(&mut self, texture: Texture, part: ViewPart) -> Result<TextureView, RecordError> {
        let access = self.written(texture)?;
        self.view_at(access, part)
    }

    /// Returns the texture that the pass declared to read, for copies.
    ///
    /// # Errors
    /// Fails like [`Cx::view`].
    pub fn texture(&mut self, view: View) -> Result<wgpu::Texture, RecordError> {
        let access = self.read(view)?;
        self.physical_texture(access.1.resource).map(|(texture, _)| texture.clone())
    }

    /// Returns the texture that the pass writes, for copies. `texture` is the handle that the write returned.
    ///
    /// # Errors
    /// Fails like [`Cx::view_of`].
    pub fn texture_of(&mut self, texture: Texture) -> Result<wgpu::Texture, RecordError> {
        let access = self.written(texture)?;
        self.physical_texture(access.1.resource).map(|(texture, _)| texture.clone())
    }

    /// Returns width and height in texels of the first level of an access. For previous images of a history, this is
    /// the size they were written with, which may differ from the current size.
    ///
    /// # Errors
    /// Fails like [`Cx::view`].
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

    /// Returns the format of a texture, for any version of the handle. This is the declared format; if the plan inlines
    /// the pass that reads it, it is the format of the target drawn instead.
    ///
    /// # Errors
    /// Fails if the handle belongs to another graph.
    pub fn format_of(&self, texture: Texture) -> Result<Format, RecordError> {
        let resource = self.graph().resource_of(texture).ok_or(RecordError::Foreign)?;
        self.frame.plan.format(resource).ok_or(RecordError::Foreign)
    }

    /// Returns the buffer that the pass declared to read, ready to bind.
    ///
    /// # Errors
    /// Fails if the token belongs to another graph or pass.
    pub fn buffer(&mut self, view: BufferView) -> Result<BoundBuffer, RecordError> {
        let access = self.graph().access_of_buffer(view).ok_or(RecordError::Foreign)?;
        self.touch(access)?;
        self.physical_buffer(access)
    }

    /// Returns the buffer that the pass writes, ready to bind. `buffer` is the handle that the write returned.
    ///
    /// # Errors
    /// Fails if the handle belongs to another graph, or the pass did not write it.
    pub fn buffer_of(&mut self, buffer: Buffer) -> Result<BoundBuffer, RecordError> {
        self.graph().resource_of_buffer(buffer).ok_or(RecordError::Foreign)?;
        let access = self.graph().writer_of_buffer(buffer).ok_or(RecordError::NotWritten)?;
        self.touch(access)?;
        self.physical_buffer(access)
    }

    /// Returns validity, age and size of a previous image of a history.
    ///
    /// # Errors
    /// Fails if the handle belongs to another graph.
    pub fn history(&self, previous: Previous) -> Result<HistoryImage, RecordError> {
        let resource = self.graph().resource_of_previous(previous).ok_or(RecordError::Foreign)?;
        Ok(match self.frame.realized.get(resource) {
            Physical::Texture { missed, shape: PhysicalTextureDesc { size: [width, height, _], .. }, .. } => {
                HistoryImage { valid: missed.is_some(), missed: missed.unwrap_or(0), texels: [*width, *height] }
            }
            Physical::Buffer { .. } | Physical::Absent(_) => HistoryImage { valid: false, missed: 0, texels: [0; 2] },
        })
    }

    /// Returns whether a previous image of a history has valid contents ([`HistoryImage::valid`]).
    ///
    /// # Errors
    /// Fails if the handle belongs to another graph.
    pub fn is_valid(&self, previous: Previous) -> Result<bool, RecordError> {
        Ok(self.history(previous)?.valid)
    }

    /// Returns the accesses of the pass. For generic recorders, such as those of graph files, tools and tests.
    pub fn accesses(&self) -> impl Iterator<Item = AccessId> + use<> {
        let rows = self.graph().passes()[self.pass.index()].accesses.range();
        rows.filter_map(AccessId::new)
    }

    /// Returns the texture or buffer of an access. Views of storage textures show the first level of the access, other
    /// views all of it.
    ///
    /// # Errors
    /// Fails if the access belongs to another pass, or its resource has no memory.
    pub fn resource(&mut self, access: AccessId) -> Result<BoundResource, RecordError> {
        let row = self.graph().accesses().get(access.index()).ok_or(RecordError::Foreign)?;
        let storage = matches!(row.kind, AccessKind::StorageRead | AccessKind::StorageWrite);
        self.resource_part(access, ViewPart { mip: storage.then_some(row.range.mip), ..ViewPart::WHOLE })
    }

    /// Returns the texture or buffer of an access, with a view of the given part. The part is ignored for buffers.
    ///
    /// # Errors
    /// Fails like [`Cx::resource`], and if the level or layer was not declared.
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

    /// Marks `access` as used and returns it with its index. Fails if it belongs to another pass.
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

    /// Returns the view of a part of an access.
    fn view_at(&mut self, (index, access): (usize, &Access), part: ViewPart) -> Result<TextureView, RecordError> {
        let stamp = self.frame.realized.stamp(access.resource);
        let request = stamp.map(|stamp| (index, part, stamp));
        let last = self.recording.requests.step().views.next();
        if let (Some(request), LastView(Some((known, view)))) = (request, last)
            && request == *known
        {
            let view = view.clone();
            self.recording.requests.views_found += 1;
            return Ok(view);
        }
        let view = self.make_view(access, part)?;
        let last = self.recording.requests.step().views.last();
        *last = LastView(request.map(|request| (request, view.clone())));
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
        // The texture may have been created in the linear form of an sRGB format, with usages that an sRGB view cannot
        // have.
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
