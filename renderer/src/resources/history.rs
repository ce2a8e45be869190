//! Histories: rings of images that outlive a frame, so that later frames read earlier results without copies.
//!
//! A history of `n` frames is a ring of `n + 1` images, identified by its [`Frame`](crate::Frame) and its full name.
//! Each successful frame that writes it advances the ring by one. New images are zero-filled and not *valid*; recorders
//! query this with [`Cx::history`](crate::Cx::history).
//!
//! A ring is dropped on reset, when its `Frame` is dropped, or when it was not written for
//! [`ExecutorOptions::max_age`](crate::ExecutorOptions::max_age) frames of the executor. Frames never share rings. A
//! change of width and height keeps previous images at the size they were written with. Any other change of shape
//! starts a new ring.

use crate::device::gpu::Gpu;
use crate::frame_key::{FrameKey, FrameTag};
use crate::resources::physical::PhysicalTextureDesc;
use crate::resources::pool::Pooled;
use crate::resources::support::Unsupported;
use wgpu::Texture;

/// All histories of an executor.
#[derive(Clone, Debug, Default)]
pub struct Histories {
    rings: Vec<Ring>,
    created: u64,
    /// Number of successful frames.
    frame: u64,
    /// Frame that is currently executed.
    now: FrameTag,
}

#[derive(Clone, Debug)]
struct Ring {
    owner: FrameTag,
    name: String,
    images: Vec<Image>,
    /// Index of the image that the current frame writes.
    head: usize,
    /// Number of previous images with valid contents.
    valid: usize,
    /// Number of executions of its frame since the last write.
    missed: u64,
    declared: bool,
    written: bool,
    /// True if an image was created in this frame.
    fresh: bool,
    /// Frame number of the last write.
    moved: u64,
}

#[derive(Clone, Debug)]
struct Image {
    texture: Texture,
    shape: PhysicalTextureDesc,
}

/// Declaration of a history in the current frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Declared {
    /// Shape of the image that the frame writes.
    pub(crate) shape: PhysicalTextureDesc,
    /// Number of previous images.
    pub(crate) frames: u8,
    /// True if a pass writes the history.
    pub(crate) written: bool,
    /// True if previous images are attached, which requires the current size.
    pub(crate) attached: bool,
    /// Minimum number of mip levels that readers of previous images need; at most that of `shape`.
    pub(crate) levels: u32,
}

/// A previous image.
#[derive(Clone, Debug)]
pub(crate) struct Earlier {
    pub(crate) texture: Texture,
    pub(crate) shape: PhysicalTextureDesc,
    /// Number of executions without a write; `None` if the contents are not valid.
    pub(crate) missed: Option<u64>,
}

impl Image {
    fn create(gpu: &Gpu, name: &str, shape: PhysicalTextureDesc) -> Result<Self, Unsupported> {
        Ok(Self { texture: shape.create(gpu, name)?, shape })
    }

    /// Returns whether the passes that read `now` can read this image, which may have another size.
    fn reads_as(&self, now: &Declared) -> bool {
        let Declared { shape, attached, levels, .. } = now;
        let Self { shape: own, .. } = self;
        let sized = PhysicalTextureDesc { size: [shape.size[0], shape.size[1], own.size[2]], mips: shape.mips, ..*own };
        if *attached { own.serves(shape) } else { own.mips >= *levels && sized.serves(shape) }
    }
}

impl Histories {
    /// Returns the number of images created.
    pub fn created(&self) -> u64 {
        self.created
    }

    /// Returns the size of all images in bytes, without padding.
    pub fn bytes(&self) -> u64 {
        self.rings.iter().flat_map(|ring| &ring.images).map(|image| image.shape.bytes()).sum()
    }

    /// Begins a frame of `owner`. Drops rings of frames that no longer exist.
    pub(crate) fn begin_frame(&mut self, owner: &FrameKey) {
        if !self.now.is_of(owner) {
            self.now = owner.tag();
        }
        self.rings.retain(|ring| !ring.owner.is_gone());
        self.rings.iter_mut().for_each(|r| (r.declared, r.fresh) = (false, false));
    }

    /// Declares a history and returns the image that the current frame writes.
    ///
    /// # Errors
    /// Fails if the device does not support the texture.
    pub(crate) fn current(&mut self, gpu: &Gpu, name: &str, now: Declared) -> Result<Texture, Unsupported> {
        let length = usize::from(now.frames) + 1;
        let is = |ring: &Ring| ring.is(&self.now, name);
        let at = match self.rings.iter().position(is) {
            Some(at) if self.rings[at].images.len() == length => at,
            other => {
                let images = (0..length).map(|_| Image::create(gpu, name, now.shape)).collect::<Result<Vec<_>, _>>()?;
                self.created += length as u64;
                let ring = Ring::new(self.now.clone(), name, images, self.frame);
                match other {
                    Some(at) => self.rings[at] = ring,
                    None => self.rings.push(ring),
                }
                other.unwrap_or(self.rings.len() - 1)
            }
        };
        let ring = &mut self.rings[at];
        // An image that cannot be read makes all older ones unreachable. Invalid images are zero-filled and have the
        // current shape.
        let kept = (1..=ring.valid).find(|age| !ring.image(*age).reads_as(&now)).map_or(ring.valid, |age| age - 1);
        for age in 0..length {
            let fits = if age <= kept && age > 0 { true } else { ring.image(age).shape.serves(&now.shape) };
            if !fits || (age > kept && age <= ring.valid) {
                *ring.image_mut(age) = Image::create(gpu, name, now.shape)?;
                (ring.fresh, self.created) = (true, self.created + 1);
            }
        }
        (ring.valid, ring.declared, ring.written) = (kept, true, now.written);
        Ok(ring.image(0).texture.clone())
    }

    /// Returns the image from `age` writes ago; `None` if the history is not declared.
    pub(crate) fn previous(&self, name: &str, age: u8) -> Option<Earlier> {
        let ring = self.rings.iter().find(|ring| ring.declared && ring.is(&self.now, name))?;
        let age = usize::from(age);
        let Image { texture, shape } = ring.image(age).clone();
        Some(Earlier { texture, shape, missed: (age <= ring.valid).then_some(ring.missed) })
    }

    /// Returns width and height of the image `age` writes before the next frame of `owner`; `None` if it is not valid.
    pub(crate) fn texels(&self, owner: &FrameKey, name: &str, age: u8) -> Option<[u32; 2]> {
        let ring = self.rings.iter().find(|ring| ring.owner.is_of(owner) && ring.name == name)?;
        let [width, height, _] = ring.image(age.into()).shape.size;
        (usize::from(age) <= ring.valid).then_some([width, height])
    }

    /// Ends a successful frame. Advances rings that it wrote, and drops rings that were not written for `max_age`
    /// frames.
    pub(crate) fn advance(&mut self, max_age: u64) {
        self.frame += 1;
        let Self { rings, frame, now, .. } = self;
        for ring in rings.iter_mut() {
            if ring.declared && ring.written {
                let length = ring.images.len();
                ring.head = (ring.head + 1) % length;
                ring.valid = (ring.valid + 1).min(length - 1);
                (ring.moved, ring.missed) = (*frame, 0);
            } else if ring.owner == *now {
                ring.missed += 1;
            }
        }
        rings.retain(|ring| *frame - ring.moved <= max_age);
    }

    /// Drops rings with images created in this frame. Called after a device error, since they may be invalid.
    pub(crate) fn discard_frame(&mut self) {
        self.rings.retain(|ring| !ring.fresh);
    }

    /// Drops all histories of this name.
    pub(crate) fn reset(&mut self, name: &str) {
        self.rings.retain(|ring| ring.name != name);
    }

    /// Drops all histories.
    pub(crate) fn reset_all(&mut self) {
        self.rings.clear();
    }
}

impl Ring {
    /// Creates a ring without valid images.
    fn new(owner: FrameTag, name: &str, images: Vec<Image>, moved: u64) -> Self {
        let (name, head, valid, missed) = (name.to_owned(), 0, 0, 0);
        Self { owner, name, images, head, valid, missed, declared: false, written: false, fresh: true, moved }
    }

    fn is(&self, owner: &FrameTag, name: &str) -> bool {
        self.owner == *owner && self.name == name
    }

    fn index(&self, age: usize) -> usize {
        let length = self.images.len();
        (self.head + length - age % length) % length
    }

    fn image(&self, age: usize) -> &Image {
        &self.images[self.index(age)]
    }

    fn image_mut(&mut self, age: usize) -> &mut Image {
        let index = self.index(age);
        &mut self.images[index]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph::{Extent, Format, TextureDesc, Usage};

    fn declared(side: u32, format: Format, frames: u8) -> Declared {
        let desc = TextureDesc::new(Extent::absolute(side, side), format);
        let shape = PhysicalTextureDesc::new(&desc, [1, 1], Usage::SAMPLED, false);
        Declared { shape, frames, written: true, attached: false, levels: 1 }
    }

    /// Histories with a frame that owns them.
    struct Bench {
        gpu: Gpu,
        histories: Histories,
        owner: FrameKey,
    }

    impl Bench {
        fn new() -> Result<Self, crate::device::open_error::OpenError> {
            Ok(Self { gpu: Gpu::noop()?, histories: Histories::default(), owner: FrameKey::new() })
        }

        /// Executes one frame with the history `taa`. Returns the width of its previous image, and whether it is valid.
        fn frame(&mut self, now: Declared, success: bool) -> Result<(u32, bool), Box<dyn std::error::Error>> {
            self.histories.begin_frame(&self.owner);
            self.histories.current(&self.gpu, "taa", now)?;
            let earlier = self.histories.previous("taa", 1).ok_or("not declared")?;
            if success {
                self.histories.advance(3);
            }
            assert_eq!(earlier.texture.width(), earlier.shape.size[0]);
            Ok((earlier.shape.size[0], earlier.missed.is_some()))
        }

        /// Executes frames that do not use the history, of its own frame or another one.
        fn without(&mut self, frames: u64, own: bool) {
            let other = FrameKey::new();
            for _ in 0..frames {
                self.histories.begin_frame(if own { &self.owner } else { &other });
                self.histories.advance(3);
            }
        }
    }

    type TestResult = Result<(), Box<dyn std::error::Error>>;

    #[test]
    fn a_ring_of_three_images_keeps_two_frames() -> TestResult {
        let Bench { gpu, mut histories, owner } = Bench::new()?;
        let mut written = Vec::new();
        for frame in 0..7 {
            histories.begin_frame(&owner);
            let current = histories.current(&gpu, "taa", declared(4, Format::R8Unorm, 2))?;
            for age in 1..=2u8 {
                let Earlier { texture, missed, .. } = histories.previous("taa", age).ok_or("not declared")?;
                let valid = missed.is_some();
                assert_eq!(valid, usize::from(age) <= frame, "frame {frame}, age {age}");
                if valid {
                    assert_eq!(texture, written[frame - usize::from(age)]);
                }
            }
            written.push(current);
            histories.advance(30);
        }
        assert_eq!((histories.created(), histories.bytes()), (3, 48));
        Ok(())
    }

    #[test]
    fn format_and_reset_invalidate_and_a_failed_frame_does_not() -> TestResult {
        let mut bench = Bench::new()?;
        let (r8, r16) = (declared(4, Format::R8Unorm, 1), declared(4, Format::R16Float, 1));
        let found = [bench.frame(r8, true)?, bench.frame(r8, false)?, bench.frame(r8, true)?];
        assert_eq!(found.map(|(_, valid)| valid), [false, true, true]);
        assert_eq!([bench.frame(r16, true)?.1, bench.frame(r16, true)?.1], [false, true], "after another format");
        bench.histories.reset("taa");
        assert_eq!([bench.frame(r16, true)?.1, bench.frame(r16, true)?.1], [false, true], "after a reset");
        Ok(())
    }

    #[test]
    fn a_history_ages_in_frames_that_do_not_write_it() -> TestResult {
        for own in [false, true] {
            let mut bench = Bench::new()?;
            let now = declared(4, Format::R8Unorm, 1);
            assert!(!bench.frame(now, true)?.1);
            for without in [1, 2, 3] {
                bench.without(without, own);
                bench.histories.begin_frame(&bench.owner);
                bench.histories.current(&bench.gpu, "taa", now)?;
                let missed = bench.histories.previous("taa", 1).and_then(|earlier| earlier.missed);
                assert_eq!(missed, Some(if own { without } else { 0 }), "after {without} frames without it");
                assert!(bench.frame(now, true)?.1);
            }
            bench.without(4, own);
            assert_eq!(bench.histories.bytes(), 0, "it is dropped, not only invalid");
            assert!(!bench.frame(now, true)?.1);
        }
        Ok(())
    }

    #[test]
    fn a_ring_belongs_to_one_frame() -> TestResult {
        let mut bench = Bench::new()?;
        let mut other = FrameKey::new();
        let (now, wide) = (declared(4, Format::R8Unorm, 1), declared(4, Format::Rgba16Float, 1));
        for round in 0..3 {
            for now in [now, wide] {
                assert_eq!(bench.frame(now, true)?.1, round > 0, "round {round}");
                std::mem::swap(&mut bench.owner, &mut other);
            }
        }
        assert_eq!((bench.histories.created(), bench.histories.bytes()), (4, 2 * 16 + 2 * 128));
        bench.owner = FrameKey::new();
        assert!(!bench.frame(now, true)?.1, "a new frame takes over nothing");
        assert_eq!((bench.histories.created(), bench.histories.bytes()), (6, 2 * 128 + 2 * 16));
        Ok(())
    }

    /// A pass that samples all levels accepts a previous image with fewer levels.
    #[test]
    fn a_resize_keeps_images_with_enough_mip_levels() -> TestResult {
        let of = |side, levels| {
            let desc = TextureDesc::new(Extent::absolute(side, side), Format::R8Unorm).mips(TextureDesc::ALL_MIPS);
            let shape = PhysicalTextureDesc::new(&desc, [1, 1], Usage::SAMPLED, false);
            Declared { shape, levels, ..declared(side, Format::R8Unorm, 1) }
        };
        let mut bench = Bench::new()?;
        let sizes = [of(8, 1), of(16, 4), of(32, 6), of(16, 5)].map(|now| bench.frame(now, true).ok());
        let expected = [(8, false), (8, true), (32, false), (32, true)];
        assert_eq!(sizes, expected.map(Some), "16 texels have five levels, not the sixth that is named at 32");
        Ok(())
    }

    #[test]
    fn images_keep_their_size_when_the_frame_size_changes() -> TestResult {
        let mut bench = Bench::new()?;
        let of = |side| declared(side, Format::R8Unorm, 1);
        let sizes = [4, 8, 8, 6, 4, 4].map(|side| bench.frame(of(side), true).ok());
        let expected = [(4, false), (4, true), (8, true), (8, true), (6, true), (4, true)];
        assert_eq!(sizes, expected.map(Some));
        let attached = Declared { attached: true, ..of(8) };
        assert_eq!(bench.frame(attached, true)?, (8, false), "an attachment has the size of its step");
        assert_eq!(bench.frame(attached, true)?, (8, true));
        Ok(())
    }
}
