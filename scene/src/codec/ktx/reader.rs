//! Reader of numbers at the front of a file.

use super::error::KtxError;

/// Reads numbers from the front of a file.
pub(super) struct Reader<'a> {
    pub bytes: &'a [u8],
    pub at: usize,
    pub big_endian: bool,
    /// Name of the part being read, for errors.
    pub what: &'static str,
}

impl<'a> Reader<'a> {
    pub fn take(&mut self, count: usize) -> Result<&'a [u8], KtxError> {
        let end = self.at.checked_add(count).ok_or(KtxError::CutShort { what: self.what })?;
        let taken = self.bytes.get(self.at..end).ok_or(KtxError::CutShort { what: self.what })?;
        self.at = end;
        Ok(taken)
    }

    pub fn u32(&mut self) -> Result<u32, KtxError> {
        let four = self.take(4)?.try_into().map_err(|_| KtxError::CutShort { what: self.what })?;
        Ok(if self.big_endian { u32::from_be_bytes(four) } else { u32::from_le_bytes(four) })
    }

    pub fn u32s<const N: usize>(&mut self) -> Result<[u32; N], KtxError> {
        let mut numbers = [0; N];
        for number in &mut numbers {
            *number = self.u32()?;
        }
        Ok(numbers)
    }

    /// Reads 64 bits, lower half first; only version 2 has them, which is little-endian.
    pub fn u64(&mut self) -> Result<u64, KtxError> {
        let [low, high] = self.u32s()?;
        Ok(u64::from(low) | u64::from(high) << 32)
    }
}
