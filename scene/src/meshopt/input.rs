//! Reader of bytes and numbers at the front of a stream.

use super::error::MeshoptError;

/// Remaining bytes of a stream.
pub(super) struct Input<'a> {
    rest: &'a [u8],
    /// Number of the current element, for errors.
    pub element: usize,
}

impl<'a> Input<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes, element: 0 }
    }

    /// Consumes `count` bytes.
    pub fn take(&mut self, count: usize) -> Result<&'a [u8], MeshoptError> {
        let (taken, rest) = self.rest.split_at_checked(count).ok_or(self.truncated())?;
        self.rest = rest;
        Ok(taken)
    }

    pub fn byte(&mut self) -> Result<u8, MeshoptError> {
        let (byte, rest) = self.rest.split_first().ok_or(self.truncated())?;
        self.rest = rest;
        Ok(*byte)
    }

    /// Reads an unsigned LEB128 number of one to five bytes. Bits above 32 are ignored.
    pub fn number(&mut self) -> Result<u32, MeshoptError> {
        let mut number = 0;
        for shift in (0..35).step_by(7) {
            let byte = self.byte()?;
            number |= u32::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Ok(number);
            }
        }
        Err(MeshoptError::LongNumber { element: self.element })
    }

    /// Fails if bytes remain.
    pub fn finish(&self) -> Result<(), MeshoptError> {
        if self.rest.is_empty() { Ok(()) } else { Err(MeshoptError::Trailing { bytes: self.rest.len() }) }
    }

    fn truncated(&self) -> MeshoptError {
        MeshoptError::Truncated { element: self.element }
    }
}

/// Decodes a zigzag number: the lowest bit is the sign.
pub(super) fn unzigzag(number: u32) -> u32 {
    number >> 1 ^ (number & 1).wrapping_neg()
}
