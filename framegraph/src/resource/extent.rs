//! Width and height, fixed or relative to the frame.

/// Width and height of a texture in texels, fixed or relative to the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Extent {
    /// Fixed width and height.
    Absolute {
        /// Width in texels.
        width: u32,
        /// Height in texels.
        height: u32,
    },
    /// `ceil(frame · num / den)`, rounded up to a multiple of `align`; at least one texel.
    Relative {
        /// Numerator of the scale.
        num: u16,
        /// Denominator of the scale, not 0.
        den: u16,
        /// Width and height are rounded up to a multiple of this; 1 disables rounding.
        align: u16,
    },
}

impl Extent {
    /// The size of the frame.
    pub const FRAME: Self = Self::Relative { num: 1, den: 1, align: 1 };

    /// Returns a fixed size in texels.
    pub const fn absolute(width: u32, height: u32) -> Self {
        Self::Absolute { width, height }
    }

    /// Returns the frame size divided by `den`, rounded up.
    pub const fn fraction(den: u16) -> Self {
        Self::Relative { num: 1, den, align: 1 }
    }

    /// Width and height in texels for a frame of `frame` texels. Relative extents are at least 1 unless the frame is
    /// empty.
    #[inline]
    pub const fn texels(self, frame: [u32; 2]) -> [u32; 2] {
        match self {
            Self::Absolute { width, height } => [width, height],
            Self::Relative { num, den, align } => {
                [scaled(frame[0], num, den, align), scaled(frame[1], num, den, align)]
            }
        }
    }
}

const fn scaled(side: u32, num: u16, den: u16, align: u16) -> u32 {
    if side == 0 {
        return 0;
    }
    let den = if den == 0 { 1 } else { den as u64 };
    let align = if align == 0 { 1 } else { align as u64 };
    let exact = (side as u64 * num as u64).div_ceil(den);
    let rounded = if exact == 0 { align } else { exact.div_ceil(align) * align };
    let most = u32::MAX as u64;
    (if rounded < most { rounded } else { most }) as u32
}
