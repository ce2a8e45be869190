//! Slots of the textures that stages exchange.

use framegraph::{Extent, Format, TextureDesc};
use std::fmt;

/// Content of a slot's texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Holds {
    /// Color with one sample per texel.
    Color,
    /// Color with one or more samples per texel.
    ColorSamples,
    /// Depth with one sample per texel.
    Depth,
    /// Depth with one or more samples per texel.
    DepthSamples,
}

/// Named slot for a texture that stages exchange. The constants are the slots of the standard frame; applications can
/// create their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Slot {
    /// Name, also used in messages. Slots with the same name are the same slot.
    pub name: &'static str,
    /// Content of the texture.
    pub holds: Holds,
}

impl Slot {
    /// Shadow maps with reversed depth, one layer each. If set before the first stage, they are not drawn again.
    pub const SHADOW_MAP: Self = Self::new("shadow_map", Holds::Depth);
    /// Shadow maps with moments, for [`ShadowFilter::Vsm`](crate::gpu_scene::shadow_views::ShadowFilter).
    pub const SHADOW_MOMENTS: Self = Self::new("shadow_moments", Holds::Color);
    /// Reversed depth of everything drawn so far, with the samples of the frame. For one sample per texel see
    /// [`single_sample_depth`](crate::effects::depth::resolve::single_sample_depth).
    pub const DEPTH: Self = Self::new("depth", Holds::DepthSamples);
    /// Pyramid of the reversed depth of opaque surfaces, with one sample per texel, at the size of the view's pictures.
    /// The first stage that needs it declares it; see [`structure`](crate::effects::depth::structure::structure).
    pub const STRUCTURE: Self = Self::new("structure", Holds::Depth);
    /// Pyramid of reversed depth as [`Slot::STRUCTURE`], at half the width and height.
    pub const HALF_STRUCTURE: Self = Self::new("half_structure", Holds::Depth);
    /// Ambient occlusion: visibility, 0 to 1, in red. In format Rgba16Float, the other channels hold the bent normal in
    /// world space. If smaller than the view's pictures, it needs [`Slot::HALF_STRUCTURE`].
    pub const OCCLUSION: Self = Self::new("occlusion", Holds::Color);
    /// Pyramid of screen-space reflections: radiance premultiplied by its weight, and the weight in alpha. Has the size
    /// of the view's pictures.
    pub const REFLECTIONS: Self = Self::new("reflections", Holds::Color);
    /// Hit distances of [`Slot::REFLECTIONS`] in meters; required with it.
    pub const HIT_DISTANCE: Self = Self::new("reflection_hit_distance", Holds::Color);
    /// Texture into which to draw the radiance, so that the next frame can read it. Still empty when set; the radiance
    /// itself is [`Slot::HDR`].
    pub const HDR_HISTORY: Self = Self::new("hdr_history", Holds::Color);
    /// Motion vectors: offset to the previous position in texture coordinates, multiplied by a count, and the count in
    /// alpha. Alpha is 0 where nothing moves. Only set if something may move.
    pub const VELOCITY: Self = Self::new("velocity", Holds::Color);
    /// Pre-exposed scene-referred radiance, linear Rec.709.
    pub const HDR: Self = Self::new("hdr", Holds::Color);
    /// Radiance of each sample, if the frame has several per texel. The stage `transparent` draws into it and resolves
    /// it into [`Slot::HDR`] again. A stage between `color` and `transparent` that changes one of them has to set both.
    pub const HDR_SAMPLES: Self = Self::new("hdr_samples", Holds::ColorSamples);
    /// Pyramid of the radiance behind transmissive surfaces, with distance in alpha. Only set if the scene has such
    /// surfaces.
    pub const SCENE_LEVELS: Self = Self::new("scene_levels", Holds::Color);
    /// Sum of all bloom levels, which post-processing adds to the radiance.
    pub const BLOOM: Self = Self::new("bloom", Holds::Color);
    /// Lens flare, added to the radiance with [`Slot::BLOOM`].
    pub const FLARE: Self = Self::new("flare", Holds::Color);
    /// Lens dirt: fraction of bloom that lights up, over the whole picture. Set by the application.
    pub const LENS_DIRT: Self = Self::new("lens_dirt", Holds::Color);
    /// Maximum and minimum light of parts of the picture, for readback. Only set if measured
    /// ([`Measure`](crate::effects::exposure::Measure)).
    pub const MEASURED_LIGHT: Self = Self::new("measured_light", Holds::Color);
    /// Nearest and farthest reversed depth of parts of the picture, for readback. Only set if measured.
    pub const MEASURED_DEPTH: Self = Self::new("measured_depth", Holds::Color);
    /// Picture for the display.
    pub const PICTURE: Self = Self::new("picture", Holds::Color);

    /// Creates a slot.
    pub const fn new(name: &'static str, holds: Holds) -> Self {
        Self { name, holds }
    }

    /// Slots whose textures have the size of the view's pictures.
    const OF_THE_VIEW: [&'static str; 3] = [Self::DEPTH.name, Self::HDR_SAMPLES.name, Self::VELOCITY.name];

    /// Returns the reason why a texture does not fit the slot of a view with pictures of this size, if any.
    pub(super) fn fault(self, desc: &TextureDesc, view: Extent) -> Option<SlotFault> {
        let TextureDesc { format, samples, extent, .. } = *desc;
        // Sizes relative to the frame and absolute ones are equal for some frames.
        let apart = match (extent, view) {
            (Extent::Absolute { .. }, Extent::Absolute { .. }) => extent != view,
            // Fractions may be written in several ways.
            (Extent::Relative { .. }, Extent::Relative { .. }) => {
                [[1920, 1080], [1001, 997]].iter().any(|frame| extent.texels(*frame) != view.texels(*frame))
            }
            _ => false,
        };
        let depth = matches!(self.holds, Holds::Depth | Holds::DepthSamples);
        let single = matches!(self.holds, Holds::Color | Holds::Depth);
        if format.has_depth() != depth {
            Some(SlotFault::Format { format, depth })
        } else if single && samples > 1 {
            Some(SlotFault::Samples { samples })
        } else if apart && Self::OF_THE_VIEW.contains(&self.name) {
            Some(SlotFault::Extent { extent, view })
        } else {
            None
        }
    }
}

/// Reason why a texture does not fit a slot.
#[derive(Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum SlotFault {
    /// The format is depth where color is required, or the reverse.
    #[error("its format is {format:?}, and a {} format is needed", if *.depth { "depth" } else { "color" })]
    Format {
        /// Format of the texture.
        format: Format,
        /// True if the slot requires depth.
        depth: bool,
    },
    /// The texture has several samples per texel, and the slot requires one.
    #[error("it has {samples} samples per texel, and one is needed; resolve it")]
    Samples {
        /// Samples per texel of the texture.
        samples: u8,
    },
    /// The texture has another size than the pictures of the view.
    #[error("its size is {}, and the view has {}; use `Handles::extent`", shown(.extent), shown(.view))]
    Extent {
        /// Size of the texture.
        extent: Extent,
        /// Size of the view's pictures.
        view: Extent,
    },
}

/// Describes a size: texels, or the fraction of the frame.
fn shown(extent: &Extent) -> String {
    match extent {
        Extent::Absolute { width, height } => format!("{width}x{height} texels"),
        relative => {
            let [width, height] = relative.texels([1000, 1000]).map(|side| f64::from(side) / 1000.0);
            format!("{width} x {height} of the frame")
        }
    }
}

impl fmt::Debug for SlotFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}
