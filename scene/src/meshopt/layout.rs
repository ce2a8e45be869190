//! Layout of a compressed buffer view, and the extension's rules for it.

use super::error::MeshoptError;

/// Bitstream of a compressed buffer view (`mode` in the extension).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mode {
    /// Attributes of any type, as byte differences.
    Attributes,
    /// Indices of a triangle list.
    Triangles,
    /// Arbitrary index sequence.
    Indices,
}

/// Transformation of decoded attributes (`filter` in the extension).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Filter {
    /// No transformation.
    None,
    /// Unit vectors in octahedral encoding.
    Octahedral,
    /// Unit quaternions without their largest component.
    Quaternion,
    /// Floats as a 24-bit mantissa and an 8-bit exponent.
    Exponential,
    /// Colors in YCoCg.
    Color,
}

/// Layout of the decoded elements of a buffer view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Layout {
    /// Number of elements, or of indices.
    pub count: usize,
    /// Bytes of an element.
    pub stride: usize,
    /// Bitstream.
    pub mode: Mode,
    /// Transformation after decoding.
    pub filter: Filter,
}

/// Maximum number of elements in a block of attributes.
pub(super) const MAX_BLOCK_ELEMENTS: usize = 256;

impl Layout {
    /// Checks count, stride, mode and filter against the rules of the extension, and the length of the stream against
    /// the layout.
    pub fn check(&self, stream_bytes: usize) -> Result<(), MeshoptError> {
        self.check_rules()?;
        let needed = self.min_stream_bytes();
        if (stream_bytes as u64) < needed {
            return Err(MeshoptError::TooShort { bytes: stream_bytes, needed });
        }
        Ok(())
    }

    fn check_rules(&self) -> Result<(), MeshoptError> {
        let Self { count, stride, mode, filter } = *self;
        let stride_of = |user, valid: bool, allowed| {
            if valid { Ok(()) } else { Err(MeshoptError::Stride { stride, user, allowed }) }
        };
        if count == 0 {
            return Err(MeshoptError::Count { count, allowed: "at least 1 is needed" });
        }
        if mode == Mode::Attributes {
            let valid = stride.is_multiple_of(4) && (4..=256).contains(&stride);
            stride_of("the mode ATTRIBUTES", valid, "a multiple of 4 from 4 to 256")?;
        } else {
            stride_of("the modes of indices", matches!(stride, 2 | 4), "2 or 4")?;
        }
        if mode == Mode::Triangles && !count.is_multiple_of(3) {
            return Err(MeshoptError::Count { count, allowed: "three indices make a triangle" });
        }
        match filter {
            Filter::None => Ok(()),
            _ if mode != Mode::Attributes => Err(MeshoptError::FilterOfIndices),
            Filter::Octahedral => stride_of("the filter OCTAHEDRAL", matches!(stride, 4 | 8), "4 or 8"),
            Filter::Quaternion => stride_of("the filter QUATERNION", stride == 8, "8"),
            // Every attribute stride is a multiple of four.
            Filter::Exponential => Ok(()),
            Filter::Color => stride_of("the filter COLOR", matches!(stride, 4 | 8), "4 or 8"),
        }
    }

    /// Returns the number of decoded bytes. The layout must be valid.
    pub fn bytes(&self) -> u64 {
        self.count as u64 * self.stride as u64
    }

    /// Returns the number of elements in a full block of attributes: as many as 8 KiB hold, a multiple of 16, at most
    /// 256.
    pub fn block_elements(&self) -> usize {
        ((8192 / self.stride) & !15).min(MAX_BLOCK_ELEMENTS)
    }

    /// Returns the length of the shortest stream of this layout in bytes. The layout must be valid.
    fn min_stream_bytes(&self) -> u64 {
        let count = self.count as u64;
        match self.mode {
            // A header, two bits for each byte of a block's elements, and the tail of version 1.
            Mode::Attributes => {
                let channels = self.stride as u64 / 4;
                let blocks = count.div_ceil(self.block_elements() as u64);
                blocks.saturating_mul(channels).saturating_add(1 + (5 * channels).max(24))
            }
            // A header, a code for each triangle, and the table of codes.
            Mode::Triangles => 1 + count / 3 + 16,
            // A header, at least a byte for each index, and four bytes at the end.
            Mode::Indices => count.saturating_add(1 + 4),
        }
    }
}
