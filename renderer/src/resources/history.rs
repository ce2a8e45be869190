//! Images that outlive the frame in rings: what one frame writes, later ones read, without copies.
//!
//! A history of `n` frames is a ring of `n + 1` images. Each frame that succeeds moves the ring on by one. Fresh images
//! hold zeros and are not *valid*: after the first frame, a change of shape, a reset, or a frame that did not declare the
//! history, its recorders are told so ([`Cx::is_valid`](crate::Cx::is_valid)) and reject them.

use crate::device::gpu::Gpu;
use crate::resources::physical::PhysicalTextureDesc;
use crate::resources::pool::Pooled;
use crate::resources::support::Unsupported;
use std::collections::BTreeMap;
use wgpu::Texture;

/// All histories by the full name of their resource.
#[derive(Clone, Debug, Default)]
pub struct Histories {
    rings: BTreeMap<String, Ring>,
    created: u64,
}

#[derive(Clone, Debug)]
struct Ring {
    shape: PhysicalTextureDesc,
    images: Vec<Texture>,
    /// The image that this frame writes.
    head: usize,
    /// How many earlier images hold what a frame wrote.
    valid: usize,
    declared: bool,
    written: bool,
}

impl Histories {
    /// Images made since the beginning.
    pub fn created(&self) -> u64 {
        self.created
    }

    /// Begins a frame: nothing is declared yet.
    pub(crate) fn begin_frame(&mut self) {
        self.rings.values_mut().for_each(|r| r.declared = false);
    }

    /// Declares a history of `frames` earlier frames and returns the image that this frame writes, if it is `written`.
    ///
    /// # Errors
    /// When the device offers no such texture.
    pub(crate) fn current(
        &mut self,
        gpu: &Gpu,
        name: &str,
        shape: PhysicalTextureDesc,
        frames: u8,
        written: bool,
    ) -> Result<Texture, Unsupported> {
        let length = usize::from(frames) + 1;
        let fits = |ring: &Ring| ring.images.len() == length && ring.shape.serves(&shape);
        if !self.rings.get(name).is_some_and(fits) {
            let images = (0..length).map(|_| shape.create(gpu, name)).collect::<Result<Vec<_>, _>>()?;
            self.created += length as u64;
            self.rings.insert(name.to_owned(), Ring { shape, images, head: 0, valid: 0, declared: false, written });
        }
        let Some(ring) = self.rings.get_mut(name) else {
            unreachable!("it was inserted above");
        };
        (ring.declared, ring.written) = (true, written);
        Ok(ring.images[ring.head].clone())
    }

    /// The image as it was `age` frames ago and whether it is valid; `None` when the history is not declared.
    pub(crate) fn previous(&self, name: &str, age: u8) -> Option<(Texture, bool)> {
        let ring = self.rings.get(name).filter(|r| r.declared)?;
        let (age, length) = (usize::from(age), ring.images.len());
        let index = (ring.head + length - age % length) % length;
        Some((ring.images[index].clone(), age <= ring.valid))
    }

    /// Ends a frame that succeeded: rings move on, and what was not declared and written is dropped.
    pub(crate) fn advance(&mut self) {
        self.rings.retain(|_, ring| {
            let length = ring.images.len();
            ring.head = (ring.head + 1) % length;
            ring.valid = (ring.valid + 1).min(length - 1);
            ring.declared && ring.written
        });
    }

    /// Forgets the earlier frames of one history: after a camera cut, say.
    pub(crate) fn reset(&mut self, name: &str) {
        self.rings.remove(name);
    }

    /// Forgets the earlier frames of all histories.
    pub(crate) fn reset_all(&mut self) {
        self.rings.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph::{Extent, Format, TextureDesc, Usage};

    fn shape(side: u32) -> PhysicalTextureDesc {
        PhysicalTextureDesc::new(
            &TextureDesc::new(Extent::absolute(side, side), Format::R8Unorm),
            [1, 1],
            Usage::SAMPLED,
            false,
        )
    }

    #[test]
    fn a_ring_of_three_images_remembers_two_frames() -> Result<(), Box<dyn std::error::Error>> {
        let gpu = Gpu::noop()?;
        let mut histories = Histories::default();
        let mut written = Vec::new();
        for frame in 0..7 {
            histories.begin_frame();
            let current = histories.current(&gpu, "taa", shape(4), 2, true)?;
            for age in 1..=2u8 {
                let (image, valid) = histories.previous("taa", age).ok_or("not declared")?;
                assert_eq!(valid, usize::from(age) <= frame, "frame {frame}, age {age}");
                if valid {
                    assert_eq!(image, written[frame - usize::from(age)]);
                }
            }
            written.push(current);
            histories.advance();
        }
        assert_eq!(histories.created(), 3);
        Ok(())
    }

    #[test]
    fn shape_pause_and_reset_invalidate_and_a_failed_frame_does_not() -> Result<(), Box<dyn std::error::Error>> {
        let gpu = Gpu::noop()?;
        let mut histories = Histories::default();
        let valid = |h: &mut Histories, side, success: bool| {
            h.begin_frame();
            let current = h.current(&gpu, "taa", shape(side), 1, true);
            let valid = current.is_ok() && h.previous("taa", 1).is_some_and(|(_, valid)| valid);
            if success {
                h.advance();
            }
            valid
        };
        let h = &mut histories;
        assert_eq!([valid(h, 4, true), valid(h, 4, false), valid(h, 4, true)], [false, true, true]);
        assert_eq!([valid(h, 8, true), valid(h, 8, true)], [false, true], "after a resize");
        h.begin_frame();
        h.advance();
        assert_eq!([valid(h, 8, true), valid(h, 8, true)], [false, true], "after a frame without it");
        h.reset("taa");
        assert_eq!([valid(h, 8, true), valid(h, 8, true)], [false, true], "after a reset");
        Ok(())
    }
}
