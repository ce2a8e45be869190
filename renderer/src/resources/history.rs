//! Images that outlive the frame in rings: what one frame writes, later ones read, without copies.
//!
//! A history of `n` frames is a ring of `n + 1` images, known by its full name. Each frame that writes it and succeeds moves
//! the ring on by one. Fresh images hold zeros and are not *valid*; recorders are told so
//! ([`Cx::history`](crate::Cx::history)) and reject them.
//!
//! A ring is kept until it is reset, until the [`Frame`](crate::Frame) that wrote it last is executed without writing it, or
//! until [`ExecutorOptions::max_age`](crate::ExecutorOptions::max_age) frames of others went by. A change of width and
//! height keeps the earlier images, each in the size that it was written in; any other change of shape starts anew.

use crate::device::gpu::Gpu;
use crate::frame_key::FrameKey;
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
    /// Frames that succeeded.
    frame: u64,
}

#[derive(Clone, Debug)]
struct Ring {
    images: Vec<Image>,
    /// The image that this frame writes.
    head: usize,
    /// How many earlier images hold what a frame wrote.
    valid: usize,
    declared: bool,
    written: bool,
    /// An image was made in this frame.
    fresh: bool,
    /// The frame that wrote it last, by number and by who declared it.
    moved: u64,
    owner: Option<FrameKey>,
}

#[derive(Clone, Debug)]
struct Image {
    texture: Texture,
    shape: PhysicalTextureDesc,
}

/// What a frame declares of a history.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Declared {
    /// The shape of the image that the frame writes.
    pub(crate) shape: PhysicalTextureDesc,
    /// How many earlier images there are.
    pub(crate) frames: u8,
    /// A pass writes it.
    pub(crate) written: bool,
    /// Earlier images are attached, so that they must have the size of this frame's.
    pub(crate) attached: bool,
}

/// The image of an earlier frame.
#[derive(Clone, Debug)]
pub(crate) struct Earlier {
    pub(crate) texture: Texture,
    pub(crate) shape: PhysicalTextureDesc,
    pub(crate) valid: bool,
}

impl Image {
    fn create(gpu: &Gpu, name: &str, shape: PhysicalTextureDesc) -> Result<Self, Unsupported> {
        Ok(Self { texture: shape.create(gpu, name)?, shape })
    }

    /// Whether passes that are declared to read `now` can read this image, which may be of another size.
    fn reads_as(&self, now: &Declared) -> bool {
        let Declared { shape, attached, .. } = now;
        let Self { shape: own, .. } = self;
        let sized = PhysicalTextureDesc { size: [shape.size[0], shape.size[1], own.size[2]], mips: shape.mips, ..*own };
        if *attached { own.serves(shape) } else { own.mips >= shape.mips && sized.serves(shape) }
    }
}

impl Histories {
    /// Images made since the beginning.
    pub fn created(&self) -> u64 {
        self.created
    }

    /// Bytes of all images, without padding.
    pub fn bytes(&self) -> u64 {
        self.rings.values().flat_map(|ring| &ring.images).map(|image| image.shape.bytes()).sum()
    }

    /// Begins a frame: nothing is declared yet.
    pub(crate) fn begin_frame(&mut self) {
        self.rings.values_mut().for_each(|r| (r.declared, r.fresh) = (false, false));
    }

    /// Declares a history and returns the image that this frame writes.
    ///
    /// # Errors
    /// When the device offers no such texture.
    pub(crate) fn current(&mut self, gpu: &Gpu, name: &str, now: Declared) -> Result<Texture, Unsupported> {
        let length = usize::from(now.frames) + 1;
        if self.rings.get(name).is_none_or(|ring| ring.images.len() != length) {
            let images = (0..length).map(|_| Image::create(gpu, name, now.shape)).collect::<Result<Vec<_>, _>>()?;
            self.created += length as u64;
            let (moved, written) = (self.frame, now.written);
            let ring = Ring { images, head: 0, valid: 0, declared: false, written, fresh: true, moved, owner: None };
            self.rings.insert(name.to_owned(), ring);
        }
        let Some(ring) = self.rings.get_mut(name) else {
            unreachable!("it was inserted above");
        };
        // An image that cannot be read makes those before it unreachable; what is not valid holds zeros in today's shape.
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

    /// The image as it was `age` frames ago; `None` when the history is not declared.
    pub(crate) fn previous(&self, name: &str, age: u8) -> Option<Earlier> {
        let ring = self.rings.get(name).filter(|r| r.declared)?;
        let age = usize::from(age);
        let Image { texture, shape } = ring.image(age).clone();
        Some(Earlier { texture, shape, valid: age <= ring.valid })
    }

    /// Width and height of the image as it was `age` frames before the frame to come; none when that is not valid.
    pub(crate) fn texels(&self, name: &str, age: u8) -> Option<[u32; 2]> {
        let ring = self.rings.get(name).filter(|ring| usize::from(age) <= ring.valid)?;
        let [width, height, _] = ring.image(age.into()).shape.size;
        Some([width, height])
    }

    /// Ends a frame of `owner` that succeeded: rings that it wrote move on; its others are dropped, and those that nobody
    /// wrote for `max_age` frames.
    pub(crate) fn advance(&mut self, owner: &FrameKey, max_age: u64) {
        self.frame += 1;
        let now = self.frame;
        self.rings.retain(|_, ring| {
            if !ring.declared {
                return ring.owner.as_ref() != Some(owner) && now - ring.moved <= max_age;
            }
            let length = ring.images.len();
            ring.head = (ring.head + 1) % length;
            ring.valid = (ring.valid + 1).min(length - 1);
            ring.moved = now;
            if ring.owner.as_ref() != Some(owner) {
                ring.owner = Some(owner.clone());
            }
            ring.written
        });
    }

    /// After the device refused something: an image made in this frame may be no good.
    pub(crate) fn forget_frame(&mut self) {
        self.rings.retain(|_, ring| !ring.fresh);
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

impl Ring {
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
        Declared { shape, frames, written: true, attached: false }
    }

    /// Histories with who executes.
    struct Bench {
        gpu: Gpu,
        histories: Histories,
        owner: FrameKey,
    }

    impl Bench {
        fn new() -> Result<Self, crate::device::gpu::OpenError> {
            Ok(Self { gpu: Gpu::noop()?, histories: Histories::default(), owner: FrameKey::new() })
        }

        /// One frame with the history `taa`: how wide its earlier image is, and whether that is valid.
        fn frame(&mut self, now: Declared, success: bool) -> Result<(u32, bool), Box<dyn std::error::Error>> {
            self.histories.begin_frame();
            self.histories.current(&self.gpu, "taa", now)?;
            let earlier = self.histories.previous("taa", 1).ok_or("not declared")?;
            if success {
                self.histories.advance(&self.owner, 3);
            }
            assert_eq!(earlier.texture.width(), earlier.shape.size[0]);
            Ok((earlier.shape.size[0], earlier.valid))
        }

        /// Frames of somebody else, without the history.
        fn others(&mut self, frames: u64) {
            let other = FrameKey::new();
            for _ in 0..frames {
                self.histories.begin_frame();
                self.histories.advance(&other, 3);
            }
        }
    }

    type TestResult = Result<(), Box<dyn std::error::Error>>;

    #[test]
    fn a_ring_of_three_images_remembers_two_frames() -> TestResult {
        let Bench { gpu, mut histories, owner } = Bench::new()?;
        let mut written = Vec::new();
        for frame in 0..7 {
            histories.begin_frame();
            let current = histories.current(&gpu, "taa", declared(4, Format::R8Unorm, 2))?;
            for age in 1..=2u8 {
                let Earlier { texture, valid, .. } = histories.previous("taa", age).ok_or("not declared")?;
                assert_eq!(valid, usize::from(age) <= frame, "frame {frame}, age {age}");
                if valid {
                    assert_eq!(texture, written[frame - usize::from(age)]);
                }
            }
            written.push(current);
            histories.advance(&owner, 30);
        }
        assert_eq!((histories.created(), histories.bytes()), (3, 48));
        Ok(())
    }

    #[test]
    fn format_pause_and_reset_invalidate_and_a_failed_frame_does_not() -> TestResult {
        let mut bench = Bench::new()?;
        let (r8, r16) = (declared(4, Format::R8Unorm, 1), declared(4, Format::R16Float, 1));
        let found = [bench.frame(r8, true)?, bench.frame(r8, false)?, bench.frame(r8, true)?];
        assert_eq!(found.map(|(_, valid)| valid), [false, true, true]);
        assert_eq!([bench.frame(r16, true)?.1, bench.frame(r16, true)?.1], [false, true], "after another format");
        bench.histories.begin_frame();
        bench.histories.advance(&bench.owner, 3);
        assert_eq!([bench.frame(r16, true)?.1, bench.frame(r16, true)?.1], [false, true], "after a frame without it");
        bench.histories.reset("taa");
        assert_eq!([bench.frame(r16, true)?.1, bench.frame(r16, true)?.1], [false, true], "after a reset");
        Ok(())
    }

    #[test]
    fn frames_of_others_age_a_history_and_do_not_drop_it() -> TestResult {
        let mut bench = Bench::new()?;
        let now = declared(4, Format::R8Unorm, 1);
        assert!(!bench.frame(now, true)?.1);
        for others in [1, 2, 3] {
            bench.others(others);
            assert!(bench.frame(now, true)?.1, "after {others} frames of others");
        }
        bench.others(4);
        assert_eq!(bench.histories.bytes(), 0, "it is dropped, not only invalid");
        assert!(!bench.frame(now, true)?.1);
        Ok(())
    }

    #[test]
    fn sizes_change_and_every_image_keeps_its_own() -> TestResult {
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
