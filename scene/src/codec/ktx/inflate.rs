//! Supercompression of levels (KTX 2.0, section 3.11): none, Zstandard or zlib.

use std::io::Read;

use ruzstd::decoding::StreamingDecoder;

/// Compression of the levels of a texture, each by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scheme {
    Plain,
    Zstandard,
    Zlib,
}

/// Window that every decoder of Zstandard is recommended to provide, in bytes (RFC 8878, section 3.1.1.1.2).
const ZSTD_WINDOW_BYTES: u64 = 8 << 20;

impl Scheme {
    /// Returns the scheme with this number.
    pub fn of(number: u32) -> Option<Self> {
        match number {
            0 => Some(Self::Plain),
            2 => Some(Self::Zstandard),
            3 => Some(Self::Zlib),
            _ => None,
        }
    }

    /// Returns the maximum number of bytes that decompression of a level allocates in addition to its output.
    pub fn working_bytes(self, level_bytes: u64) -> u64 {
        match self {
            Self::Plain => 0,
            Self::Zstandard => 2 * level_bytes.max(ZSTD_WINDOW_BYTES),
            // A growing `Vec`, and the window of 32 KiB.
            Self::Zlib => level_bytes + (64 << 10),
        }
    }
}

/// Returns the decompressed level if it has exactly `expected` bytes. Never writes more than that.
pub(super) fn inflate(scheme: Scheme, bytes: &[u8], expected: usize) -> Option<Vec<u8>> {
    match scheme {
        Scheme::Plain => (bytes.len() == expected).then(|| bytes.to_vec()),
        Scheme::Zlib => miniz_oxide::inflate::decompress_to_vec_zlib_with_limit(bytes, expected)
            .ok()
            .filter(|level| level.len() == expected),
        Scheme::Zstandard => {
            let window = ZSTD_WINDOW_BYTES.max(expected as u64);
            let mut decoder = StreamingDecoder::new_with_max_window_size(bytes, window).ok()?;
            let mut level = vec![0; expected];
            decoder.read_exact(&mut level).ok()?;
            let is_at_end = decoder.read(&mut [0]).ok()? == 0;
            is_at_end.then_some(level)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A thousand zeros, as zlib 1.3.1 and zstd 1.5.7 compress them.
    const ZLIB: &[u8] =
        &[0x78, 0x9c, 0x63, 0x60, 0x18, 0x05, 0xa3, 0x60, 0x14, 0x0c, 0x77, 0x00, 0x00, 0x03, 0xe8, 0x00, 0x01];
    const ZSTD: &[u8] = &[
        0x28, 0xb5, 0x2f, 0xfd, 0x60, 0xe8, 0x02, 0x4d, 0x00, 0x00, 0x10, 0x00, 0x00, 0x01, 0x00, 0xe3, 0x2b, 0x80,
        0x05,
    ];

    #[test]
    fn levels_inflate_to_their_size_alone() {
        for (scheme, bytes) in [(Scheme::Zlib, ZLIB), (Scheme::Zstandard, ZSTD)] {
            assert_eq!(inflate(scheme, bytes, 1000).as_deref(), Some([0; 1000].as_slice()), "{scheme:?}");
            for other in [0, 999, 1001] {
                assert_eq!(inflate(scheme, bytes, other), None, "{scheme:?} {other}");
            }
            assert_eq!(inflate(scheme, &bytes[..bytes.len() / 2], 1000), None, "{scheme:?}");
        }
        assert_eq!(inflate(Scheme::Plain, &[1, 2], 2), Some(vec![1, 2]));
        assert_eq!(inflate(Scheme::Plain, &[1, 2], 1), None);
    }

    /// A frame that states a window of 2 GiB does not allocate it.
    #[test]
    fn large_windows_are_refused() {
        let huge = [0x28, 0xb5, 0x2f, 0xfd, 0x00, 0xa8, 0x01, 0x00, 0x00];
        assert_eq!(inflate(Scheme::Zstandard, &huge, 0), None);
        let small = [0x28, 0xb5, 0x2f, 0xfd, 0x00, 0x00, 0x01, 0x00, 0x00];
        assert_eq!(inflate(Scheme::Zstandard, &small, 0), Some(Vec::new()));
    }
}
