//! Eviction of objects that recent frames did not use, and cleanup after failed frames.

use super::Executor;
use crate::placed::arenas::Arenas;
use crate::resources::physical::{PhysicalBufferDesc, PhysicalTextureDesc};
use crate::resources::pool::Pool;

impl Executor {
    /// Drops all objects that the current frame used. Called after a device error, since they may be invalid.
    pub(super) fn discard_frame(&mut self) {
        let Self { caches, textures, buffers, histories, arenas, realized, recording, threads, .. } = self;
        recording.requests.release_views();
        threads.release_views();
        realized.clear();
        arenas.discard_frame();
        caches.views.clear();
        caches.groups.clear();
        textures.discard_frame(|_| ());
        buffers.discard_frame(|_| ());
        histories.discard_frame();
    }

    /// Frees everything that the last frame did not use, regardless of age, and returns the number of bytes. Affects
    /// pools and memory blocks, with their views and bind groups, but not histories.
    pub fn trim(&mut self) -> u64 {
        let Self { caches, textures, buffers, arenas, recording, threads, .. } = self;
        recording.requests.release_views();
        threads.release_views();
        let held = |textures: &Pool<PhysicalTextureDesc>, buffers: &Pool<PhysicalBufferDesc>, arenas: &Arenas| {
            textures.counts().bytes + buffers.counts().bytes + arenas.bytes()
        };
        let before = held(textures, buffers, arenas);
        arenas.trim(|object| caches.forget_placed(object));
        textures.trim(|texture| caches.forget(texture));
        buffers.trim(|buffer| caches.groups.forget_buffer(buffer));
        before - held(textures, buffers, arenas)
    }

    /// Drops objects that recent frames did not use, and references to surface textures.
    pub(super) fn drop_unused(&mut self) {
        let Self { caches, textures, buffers, arenas, options, recording, threads, .. } = self;
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
            recording.requests.release_views();
            threads.release_views();
        }
        self.end_loans();
    }

    /// Drops references to surface textures, also after a frame that failed.
    pub(super) fn end_loans(&mut self) {
        let Self { caches, realized, .. } = self;
        // These textures have no cached requests.
        realized.end_loans(|texture| caches.forget(texture));
    }
}
