//! What an executor gives up: objects that no recent frame used, and those of a frame that failed.

use super::Executor;
use crate::execute::prepared::Caches;
use crate::placed::driver::Object;
use crate::resources::physical::{PhysicalBufferDesc, PhysicalTextureDesc};
use crate::resources::pool::Pool;
use wgpu::Texture;

impl Executor {
    /// After the device refused something: objects made in this frame may be no good, so none that it used is kept.
    pub(super) fn forget_frame(&mut self) {
        let Self { caches, textures, buffers, histories, arenas, realized, recording, threads, .. } = self;
        recording.remembered.let_go();
        threads.let_go();
        realized.clear();
        arenas.forget_frame();
        caches.views.clear();
        caches.groups.clear();
        textures.forget_frame(|_| ());
        buffers.forget_frame(|_| ());
        histories.forget_frame();
    }

    /// Gives up at once what the last frame did not use, and returns how many bytes that were: textures and buffers of
    /// the pools with their views and bind groups, whatever their age. Histories stay.
    pub fn trim(&mut self) -> u64 {
        let Self { caches, textures, buffers, recording, threads, .. } = self;
        recording.remembered.let_go();
        threads.let_go();
        let held = |textures: &Pool<PhysicalTextureDesc>, buffers: &Pool<PhysicalBufferDesc>| {
            textures.counts().bytes + buffers.counts().bytes
        };
        let before = held(textures, buffers);
        textures.trim(|texture| caches.forget(texture));
        buffers.trim(|buffer| caches.groups.forget_buffer(buffer));
        before - held(textures, buffers)
    }

    /// Drops objects that no recent frame used, and what was lent for this frame alone.
    pub(super) fn give_up(&mut self) {
        let Self { caches, textures, buffers, arenas, realized, options, recording, threads, .. } = self;
        let mut any = false;
        let mut forget = |caches: &mut Caches, texture: &Texture| {
            any = true;
            caches.forget(texture);
        };
        arenas.evict(options.max_age, |object| match object {
            Object::Texture(placed) => forget(caches, placed.texture()),
            Object::Buffer(buffer) => caches.groups.forget_buffer(buffer),
        });
        textures.evict(|texture| forget(caches, texture));
        buffers.evict(|buffer| caches.groups.forget_buffer(buffer));
        if any {
            recording.remembered.let_go();
            threads.let_go();
        }
        // Nothing of these is remembered.
        realized.end_loans(|texture| caches.forget(texture));
    }
}
