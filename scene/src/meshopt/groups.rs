//! Differences of one byte position in consecutive elements, in groups of 16 (appendix A, mode 0, data blocks).

use super::error::MeshoptError;
use super::input::Input;

/// Number of elements of a group.
pub(super) const GROUP: usize = 16;

/// Bits per difference, by the two header bits of a group.
pub(super) type Widths = [u8; 4];

/// Reads the differences of a data block. The length of `differences` is a multiple of 16, at most 256.
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

/// Reads 16 differences of `width` bits. A difference with all bits set refers to a full byte that follows. `shift`
/// maps the position of a difference in its byte to a right shift.
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
