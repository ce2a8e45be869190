//! Attributes as byte differences (appendix A, mode 0), versions 0 and 1.

use super::error::MeshoptError;
use super::groups::{self, GROUP, Widths};
use super::input::Input;
use super::layout::{Layout, MAX_BLOCK_ELEMENTS};

/// Bit widths of version 0.
const WIDTHS_0: Widths = [0, 2, 4, 8];
/// Bit widths of version 1, by the control mode of a byte position.
const WIDTHS_1: [Widths; 2] = [[0, 1, 2, 4], [1, 2, 4, 8]];

/// Decodes elements block by block. A block stores the differences of each byte position separately: first those of
/// byte 0, then of byte 1.
pub(super) fn decode(layout: &Layout, bytes: &[u8]) -> Result<Vec<u8>, MeshoptError> {
    let (count, stride) = (layout.count, layout.stride);
    let version_1 = match bytes[0] {
        0xa0 => false,
        0xa1 => true,
        found => return Err(MeshoptError::Header { found, expected: "0xa0 or 0xa1" }),
    };
    let (channel_count, min_tail) = if version_1 { (stride / 4, 24) } else { (0, 32) };
    let tail_bytes = stride + channel_count;
    let padded = tail_bytes.max(min_tail);
    let Some(data_bytes) = (bytes.len() - 1).checked_sub(padded) else {
        return Err(MeshoptError::TooShort { bytes: bytes.len(), needed: 1 + padded as u64 });
    };
    let (data, tail) = bytes[1..].split_at(data_bytes);
    let (baseline, modes) = tail[padded - tail_bytes..].split_at(stride);
    let channels: Vec<Channel> =
        (0..stride / 4).map(|channel| Channel::new(channel, modes.get(channel))).collect::<Result<_, _>>()?;

    let mut input = Input::new(data);
    let mut decoded = vec![0; count * stride];
    let mut previous = baseline.to_vec();
    let mut differences = vec![0; stride * MAX_BLOCK_ELEMENTS];
    for block in decoded.chunks_mut(layout.block_elements() * stride) {
        let elements = block.len() / stride;
        let control = if version_1 { Some(input.take(stride / 4)?) } else { None };
        for (byte, row) in differences.chunks_exact_mut(MAX_BLOCK_ELEMENTS).enumerate() {
            let row = &mut row[..elements.next_multiple_of(GROUP)];
            match control.map(|control| control[byte / 4] >> (byte % 4 * 2) & 3) {
                None => groups::read(&mut input, WIDTHS_0, row)?,
                Some(mode @ 0..2) => groups::read(&mut input, WIDTHS_1[usize::from(mode)], row)?,
                Some(2) => row.fill(0),
                Some(_) => row[..elements].copy_from_slice(input.take(elements)?),
            }
        }
        for (place, channel) in channels.iter().enumerate() {
            let rows = &differences[4 * place * MAX_BLOCK_ELEMENTS..][..4 * MAX_BLOCK_ELEMENTS];
            let previous = &mut previous[4 * place..][..4];
            let mut value = [previous[0], previous[1], previous[2], previous[3]];
            for (element, out) in block.chunks_exact_mut(stride).enumerate() {
                value = channel.add(value, std::array::from_fn(|byte| rows[byte * MAX_BLOCK_ELEMENTS + element]));
                out[4 * place..][..4].copy_from_slice(&value);
            }
            previous.copy_from_slice(&value);
        }
        input.element += elements;
    }
    input.finish()?;
    Ok(decoded)
}

/// Interpretation of the differences of four consecutive bytes.
#[derive(Clone, Copy)]
enum Channel {
    /// Zigzag differences of bytes.
    Bytes,
    /// Zigzag differences of 16-bit numbers.
    Halves,
    /// 32-bit differences, combined by exclusive or after rotation to the right by this number of bits.
    Xor(u32),
}

impl Channel {
    /// Parses the mode byte of a channel; version 0 has none and always uses byte differences.
    fn new(channel: usize, mode: Option<&u8>) -> Result<Self, MeshoptError> {
        match mode.copied().unwrap_or(0) {
            0 => Ok(Self::Bytes),
            1 => Ok(Self::Halves),
            mode if mode & 15 == 2 => Ok(Self::Xor(u32::from(mode >> 4))),
            mode => Err(MeshoptError::ChannelMode { channel, mode }),
        }
    }

    /// Adds differences to the four bytes of the previous element.
    fn add(self, previous: [u8; 4], difference: [u8; 4]) -> [u8; 4] {
        match self {
            Self::Bytes => std::array::from_fn(|i| {
                previous[i].wrapping_add(difference[i] >> 1 ^ (difference[i] & 1).wrapping_neg())
            }),
            Self::Halves => {
                let add = |at: usize| {
                    let number = u16::from_le_bytes([difference[at], difference[at + 1]]);
                    let last = u16::from_le_bytes([previous[at], previous[at + 1]]);
                    last.wrapping_add(number >> 1 ^ (number & 1).wrapping_neg()).to_le_bytes()
                };
                let ([a, b], [c, d]) = (add(0), add(2));
                [a, b, c, d]
            }
            Self::Xor(rotation) => {
                let number = u32::from_le_bytes(difference).rotate_right(rotation);
                (u32::from_le_bytes(previous) ^ number).to_le_bytes()
            }
        }
    }
}
