//! Errors of the decoder.

/// Error of decoding a compressed buffer view. The messages name neither file nor view.
#[derive(Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub(crate) enum MeshoptError {
    /// The stride is not allowed in this mode or with this filter.
    #[error("a stride of {stride} bytes is invalid for {user}, which needs {allowed}")]
    Stride {
        /// Stride of an element in bytes.
        stride: usize,
        /// Mode or filter.
        user: &'static str,
        /// Allowed strides.
        allowed: &'static str,
    },
    /// The number of elements is not allowed in this mode.
    #[error("a count of {count} is invalid; {allowed}")]
    Count {
        /// Number of elements.
        count: usize,
        /// Allowed counts.
        allowed: &'static str,
    },
    /// A filter is combined with a mode other than `ATTRIBUTES`.
    #[error("filters apply to the mode ATTRIBUTES only")]
    FilterOfIndices,
    /// The stream has fewer bytes than any stream of this layout.
    #[error("its {bytes} bytes are fewer than the {needed} that its count and stride need at least")]
    TooShort {
        /// Length of the stream in bytes.
        bytes: usize,
        /// Length of the shortest stream of this layout in bytes.
        needed: u64,
    },
    /// The first byte is not a header of this mode.
    #[error("it begins with {found:#04x}, not with {expected}")]
    Header {
        /// First byte of the stream.
        found: u8,
        /// Allowed bytes.
        expected: &'static str,
    },
    /// The stream ends before all elements are decoded.
    #[error("truncated: the data ends within element {element}")]
    Truncated {
        /// First incomplete element.
        element: usize,
    },
    /// Bytes are left after the last element.
    #[error("{bytes} bytes are left after the last element")]
    Trailing {
        /// Number of remaining bytes.
        bytes: usize,
    },
    /// The mode byte of a channel is undefined.
    #[error("the mode of channel {channel} is {mode:#04x}, which is not defined")]
    ChannelMode {
        /// Number of the channel; a channel is four bytes of each element.
        channel: usize,
        /// Mode byte.
        mode: u8,
    },
    /// The table of triangle codes is invalid.
    #[error("byte {place} of its table of codes is {byte:#04x}, which is not allowed")]
    Table {
        /// Position in the table.
        place: usize,
        /// Byte at this position.
        byte: u8,
    },
    /// A triangle refers to a vertex or an edge that is not decoded yet.
    #[error("triangle {triangle} refers to an edge or a vertex before the first")]
    BeforeFirst {
        /// Number of the triangle.
        triangle: usize,
    },
    /// A number has more than five bytes.
    #[error("a number of element {element} has more than five bytes")]
    LongNumber {
        /// Element that the number belongs to.
        element: usize,
    },
}

impl std::fmt::Debug for MeshoptError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
