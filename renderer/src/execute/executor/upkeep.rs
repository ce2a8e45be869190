//! What an executor gives up: objects that no recent frame used, and those of a frame that failed.

use super::Executor;
use crate::placed::arenas::Arenas;
use crate::resources::physical::{PhysicalBufferDesc, PhysicalTextureDesc};
use crate::resources::pool::Pool;

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
    /// the pools, and blocks of memory in which they are placed, with their views and bind groups, whatever their age.
    /// Histories stay.
    pub fn trim(&mut self) -> u64 {
        let Self { caches, textures, buffers, arenas, recording, threads, .. } = self;
        recording.remembered.let_go();
        threads.let_go();
        let held = |textures: &Pool<PhysicalTextureDesc>, buffers: &Pool<PhysicalBufferDesc>, arenas: &Arenas| {
            textures.counts().bytes + buffers.counts().bytes + arenas.bytes()
        };
        let before = held(textures, buffers, arenas);
        arenas.trim(|object| caches.forget_placed(object));
        textures.trim(|texture| caches.forget(texture));
        buffers.trim(|buffer| caches.groups.forget_buffer(buffer));
        before - held(textures, buffers, arenas)
    }

    /// Drops objects that no recent frame used, and what was lent for this frame alone.
    pub(super) fn give_up(&mut self) {
        let Self { caches, textures, buffers, arenas, realized, options, recording, threads, .. } = self;
        let mut any = false;
        arenas.evict(options.limits(), |object| {
            any = true;
            caches.forget_placed(object);
        });
        textures.evict(|texture| {
            any = true;
            caches.forget(texture);
        });
        buffers.evict(|buffer| caches.groups.forget_buffer(buffer));
        if any {
            recording.remembered.let_go();
            threads.let_go();
        }
        // Nothing of these is remembered.
        realized.end_loans(|texture| caches.forget(texture));
    }
}
