//! Places of the textures that stages hand on.

use framegraph::Format;
use std::fmt;

/// What a slot's texture is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Holds {
    /// Color of one sample per texel.
    Color,
    /// Color of one or more samples per texel.
    ColorSamples,
    /// Depth of one sample per texel.
    Depth,
    /// Depth of one or more samples per texel.
    DepthSamples,
}

/// A texture that stages hand on, by name. The constants are those of the standard frame; an application's own stages make
/// slots of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Slot {
    /// Name for messages; slots of one name are one slot.
    pub name: &'static str,
    /// What its texture is.
    pub holds: Holds,
}

impl Slot {
    /// The shadow maps, reversed depth, a layer each. Those that are there from the start are not made again.
    pub const SHADOW_MAP: Self = Self::new("shadow_map", Holds::Depth);
    /// The shadow maps where they hold moments instead ([`ShadowFilter::Vsm`](crate::gpu_scene::shadow_views::ShadowFilter)).
    pub const SHADOW_MOMENTS: Self = Self::new("shadow_moments", Holds::Color);
    /// Reversed depth of what is drawn so far, of as many samples as the frame has. For one sample per texel see
    /// [`single_sample_depth`](crate::effects::depth::resolve::single_sample_depth).
    pub const DEPTH: Self = Self::new("depth", Holds::DepthSamples);
    /// Reversed depth of opaque surfaces as a pyramid of one sample per texel; see [`structure`](crate::effects::depth::structure::structure),
    /// which declares it for the first stage that asks.
    pub const STRUCTURE: Self = Self::new("structure", Holds::Depth);
    /// Ambient occlusion: visibility, 0 to 1, in red, and where it is of the format Rgba16Float the mean open direction in the
    /// other channels, in world space. One that is smaller than the view's pictures needs [`Slot::STRUCTURE`].
    pub const OCCLUSION: Self = Self::new("occlusion", Holds::Color);
    /// What rays found in the picture: radiance times how much it counts, and that in alpha, as a pyramid; of the size of the
    /// view's pictures.
    pub const REFLECTIONS: Self = Self::new("reflections", Holds::Color);
    /// How long the way to what [`Slot::REFLECTIONS`] shows is, in m; needed beside it.
    pub const REFLECTION_WAYS: Self = Self::new("reflection_ways", Holds::Color);
    /// The texture that the radiance is to be drawn into, where the next frame reads it; nothing is in it before. The radiance
    /// itself is [`Slot::HDR`].
    pub const HDR_HISTORY: Self = Self::new("hdr_history", Holds::Color);
    /// Way from a pixel to where its surface was in the frame before, in texture coordinates, times a count, and that count in
    /// alpha: 0 where nothing moves; only where something may.
    pub const VELOCITY: Self = Self::new("velocity", Holds::Color);
    /// Scene-referred radiance times exposure, linear Rec.709.
    pub const HDR: Self = Self::new("hdr", Holds::Color);
    /// The same, of each sample, where the frame has several per texel. The stage `transparent` draws into these and
    /// averages them into [`Slot::HDR`] anew: a stage between `color` and it that changes one has to hand on both.
    pub const HDR_SAMPLES: Self = Self::new("hdr_samples", Holds::ColorSamples);
    /// What is behind transmissive surfaces, a pyramid of radiance with distance in alpha; only where the scene transmits.
    pub const SCENE_LEVELS: Self = Self::new("scene_levels", Holds::Color);
    /// What glows, all its levels added up: what post-processing lays over the radiance.
    pub const BLOOM: Self = Self::new("bloom", Holds::Color);
    /// Lens flare, laid over the radiance with [`Slot::BLOOM`].
    pub const FLARE: Self = Self::new("flare", Holds::Color);
    /// What dirt on the lens lets light up of bloom, over the whole picture; an application's own.
    pub const LENS_DIRT: Self = Self::new("lens_dirt", Holds::Color);
    /// The most and the least light of parts of the picture, to be read back; only where it is measured
    /// ([`Measure`](crate::effects::exposure::Measure)).
    pub const MEASURED_LIGHT: Self = Self::new("measured_light", Holds::Color);
    /// The nearest and the farthest depth of parts of the picture, reversed, to be read back; only where it is measured.
    pub const MEASURED_DEPTH: Self = Self::new("measured_depth", Holds::Color);
    /// The picture for the display.
    pub const PICTURE: Self = Self::new("picture", Holds::Color);

    /// A slot.
    pub const fn new(name: &'static str, holds: Holds) -> Self {
        Self { name, holds }
    }

    /// What a texture of this format and sample count lacks to be held here.
    pub(super) fn fault(self, format: Format, samples: u8) -> Option<SlotFault> {
        let depth = matches!(self.holds, Holds::Depth | Holds::DepthSamples);
        let single = matches!(self.holds, Holds::Color | Holds::Depth);
        if format.has_depth() != depth {
            Some(SlotFault::Format { format, depth })
        } else if single && samples > 1 {
            Some(SlotFault::Samples { samples })
        } else {
            None
        }
    }
}

/// Why a texture cannot be in a slot.
#[derive(Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum SlotFault {
    /// It is depth where color is needed, or the other way around.
    #[error("its format is {format:?}, and a {} format is needed", if *.depth { "depth" } else { "color" })]
    Format {
        /// Its format.
        format: Format,
        /// Depth is needed.
        depth: bool,
    },
    /// It has several samples per texel where one is needed.
    #[error("it has {samples} samples per texel, and one is needed; resolve it")]
    Samples {
        /// Its samples per texel.
        samples: u8,
    },
}

impl fmt::Debug for SlotFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}
