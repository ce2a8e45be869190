//! Differences of one byte of consecutive elements, in groups of 16 (appendix A, mode 0, data blocks).

use super::error::MeshoptError;
use super::input::Input;

/// Elements of a group.
pub(super) const GROUP: usize = 16;

/// Bits of a difference, by the two bits that the header states for a group.
pub(super) type Widths = [u8; 4];

/// Reads the differences of a data block. `differences` has a multiple of 16 places, at most 256.
pub(super) fn read(input: &mut Input<'_>, widths: Widths, differences: &mut [u8]) -> Result<(), MeshoptError> {
    let header = input.take((differences.len() / GROUP).div_ceil(4))?;
    for (group, differences) in differences.chunks_exact_mut(GROUP).enumerate() {
        let mode = header[group / 4] >> (group % 4 * 2) & 3;
        match widths[usize::from(mode)] {
            0 => differences.fill(0),
            1 => packed(input, differences, 1, |byte, place| byte >> place)?,
            2 => packed(input, differences, 2, |byte, place| byte >> (6 - 2 * place))?,
            4 => packed(input, differences, 4, |byte, place| byte >> (4 - 4 * place))?,
            _ => differences.copy_from_slice(input.take(GROUP)?),
        }
    }
    Ok(())
}

/// Reads 16 differences of `width` bits. One with all bits set stands for a byte behind them. `shift` moves a difference,
/// by its place in a byte, to the lowest bits.
fn packed(
    input: &mut Input<'_>,
    differences: &mut [u8],
    width: usize,
    shift: impl Fn(u8, usize) -> u8,
) -> Result<(), MeshoptError> {
    let bytes = input.take(GROUP * width / 8)?;
    let escape = (1 << width) - 1;
    let per_byte = 8 / width;
    for (place, difference) in differences.iter_mut().enumerate() {
        let value = shift(bytes[place / per_byte], place % per_byte) & escape;
        *difference = if value == escape { input.byte()? } else { value };
    }
    Ok(())
}
