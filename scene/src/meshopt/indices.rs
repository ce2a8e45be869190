//! Arbitrary index sequences (appendix A, mode 2).

use super::error::MeshoptError;
use super::input::{Input, unzigzag};
use super::layout::Layout;

const HEADER: u8 = 0xd1;
/// Unused bytes at the end.
const TAIL_BYTES: usize = 4;

/// Decodes indices, each as the difference from the last index of one of two sequences.
pub(super) fn decode(layout: &Layout, bytes: &[u8]) -> Result<Vec<u8>, MeshoptError> {
    if bytes[0] != HEADER {
        return Err(MeshoptError::Header { found: bytes[0], expected: "0xd1" });
    }
    let mut input = Input::new(&bytes[1..bytes.len() - TAIL_BYTES]);
    let mut last = [0u32; 2];
    let mut decoded = Vec::with_capacity(layout.count * layout.stride);
    for element in 0..layout.count {
        input.element = element;
        let number = input.number()?;
        let last = &mut last[number as usize & 1];
        *last = last.wrapping_add(unzigzag(number >> 1));
        push(&mut decoded, *last, layout.stride);
    }
    input.finish()?;
    Ok(decoded)
}

/// Appends an index of two or four bytes; a two-byte index drops the upper half.
pub(super) fn push(decoded: &mut Vec<u8>, index: u32, stride: usize) {
    decoded.extend_from_slice(&index.to_le_bytes()[..stride]);
}
