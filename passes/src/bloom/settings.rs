//! What bloom is made of. Defaults are Filament's.

/// What of a picture glows, how far, and how it is laid over the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct BloomSettings {
    /// How much of the glow is added, 0 to 1; 0 leaves bloom out.
    pub strength: f32,
    /// Height of the largest level in texels, 16 to 2048; the width follows the picture's.
    pub height_texels: u32,
    /// How many levels, each half as large as the one before, up to [`BloomSettings::MOST_LEVELS`] and as many as the size
    /// has: more glow farther. 0 leaves bloom out.
    pub levels: u8,
    /// How a picture of more than twice the height is made smaller.
    pub quality: BloomQuality,
    /// How the glow is laid over the picture.
    pub blend: Blend,
    /// What glows.
    pub threshold: Threshold,
    /// Pre-exposed radiance from which on something glows, 0 or more, where there is a threshold.
    pub threshold_at: f32,
    /// Pre-exposed radiance that bright glow nears, above 0; infinite for none. Where there is a threshold.
    pub highlight: f32,
    /// Single bright texels count less, where there is a threshold. Anti-aliasing over time does that already, so a frame with it
    /// leaves it out.
    pub fireflies: bool,
    /// Levels are added up by a box of a texel instead of a tent of three, as Filament does on phones.
    pub narrow: bool,
    /// Factor on the dirt of the lens, where [`Slot::LENS_DIRT`](crate::Slot::LENS_DIRT) holds some, 0 or more.
    pub dirt: f32,
    /// Lens flare of what glows; none for nothing.
    pub flare: Option<FlareSettings>,
    /// The glow spans a picture whose sides are rounded up to a multiple of this, with the own one at its bottom left; 1 for
    /// the picture's own. Filament renders into multiples of 16.
    pub multiple_px: u32,
}

/// How a picture of more than twice the height of the largest level is made smaller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum BloomQuality {
    /// By halves; sides of levels are multiples of 16, so that the four next ones are halves of them.
    Low,
    /// By halves.
    Medium,
    /// Not at all: the largest level is twice as large instead, and there is one more.
    High,
}

/// How the glow is laid over the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Blend {
    /// Added: the picture gets brighter.
    Add,
    /// In the place of as much of the picture.
    Interpolate,
}

/// What glows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Threshold {
    /// Everything.
    None,
    /// What is above the threshold, channel by channel; single bright texels count less.
    Soft,
    /// All of a color whose brightest channel reaches the threshold; single bright texels count less.
    Hard,
}

/// Ghosts and a halo of what glows.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct FlareSettings {
    /// Only rays about the middle are left of it, which turn with the camera.
    pub starburst: bool,
    /// How far apart red and blue are, in shares of the picture, 0 to 1.
    pub aberration: f32,
    /// How many ghosts, 0 to 16.
    pub ghosts: u8,
    /// Between ghosts, in shares of the way through the middle, 0 to 1.
    pub ghost_spacing: f32,
    /// Glow from which on there are ghosts, 0 or more.
    pub ghost_threshold: f32,
    /// Radius of the halo in shares of the height, 0 to 0.5.
    pub halo_radius: f32,
    /// Thickness of the halo in shares of the height, 0 to 1; 0 for no halo.
    pub halo_thickness: f32,
    /// Glow from which on there is a halo, 0 or more.
    pub halo_threshold: f32,
    /// Sides of the picture that ghosts, halo and rays are centered in are rounded up to a multiple of this, in pixels. The
    /// own picture is at its bottom left. 1 centers them in the own picture; Filament renders into multiples of 16.
    pub multiple_px: u32,
}

/// From coordinates of what glows to coordinates of the span that a flare is centered in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlareSpan {
    /// Factor.
    pub scale: [f32; 2],
    /// Summand after the factor.
    pub offset: [f32; 2],
}

impl FlareSpan {
    /// The span of `flare` in a picture of `size_px`, whose glow spans multiples of `glow_multiple_px`.
    pub fn new(flare: &FlareSettings, size_px: [u32; 2], glow_multiple_px: u32) -> Self {
        let (glow, glow_begin) = BloomSettings::span(size_px, glow_multiple_px);
        let (span, begin) = BloomSettings::span(size_px, flare.multiple_px);
        Self { scale: [0, 1].map(|i| glow[i] / span[i]), offset: [0, 1].map(|i| (begin[i] - glow_begin[i]) / span[i]) }
    }
}

impl Default for BloomSettings {
    /// [`BloomSettings::DEFAULT`].
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl BloomSettings {
    /// The most levels that there may be.
    pub const MOST_LEVELS: u8 = 12;

    /// Filament's.
    pub const DEFAULT: Self = Self {
        strength: 0.1,
        height_texels: 384,
        levels: 6,
        quality: BloomQuality::Low,
        blend: Blend::Add,
        threshold: Threshold::Soft,
        threshold_at: 1.0,
        highlight: 1000.0,
        fireflies: true,
        narrow: false,
        dirt: 0.2,
        flare: None,
        multiple_px: 1,
    };

    /// Whether anything of it is seen.
    pub fn is_seen(&self) -> bool {
        self.strength > 0.0 && self.levels > 0
    }

    /// The size that the glow of such a picture spans, and where in it the picture begins, in pixels.
    pub(crate) fn span([width, height]: [u32; 2], multiple_px: u32) -> ([f32; 2], [f32; 2]) {
        let multiple = multiple_px.clamp(1, 1 << 16);
        let span = [width, height].map(|side| side.max(1).next_multiple_of(multiple) as f32);
        (span, [0.0, span[1] - height.max(1) as f32])
    }
}

impl Default for FlareSettings {
    /// [`FlareSettings::DEFAULT`].
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl FlareSettings {
    /// Filament's.
    pub const DEFAULT: Self = Self {
        starburst: true,
        aberration: 0.005,
        ghosts: 4,
        ghost_spacing: 0.6,
        ghost_threshold: 10.0,
        halo_radius: 0.4,
        halo_thickness: 0.1,
        halo_threshold: 10.0,
        multiple_px: 16,
    };

    /// Whether anything of it is seen.
    pub fn is_seen(&self) -> bool {
        self.ghosts > 0 || self.halo_thickness > 0.0
    }
}
