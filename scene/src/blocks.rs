//! Blocks of consecutive instances.

use super::boxes::BLOCK;

/// Returns the instance numbers of a block.
pub(crate) fn numbers_of(block: u32) -> std::ops::Range<u32> {
    block * BLOCK as u32..(block + 1) * BLOCK as u32
}

/// Splits ascending instance numbers into runs of the same block. A run of [`BLOCK`] numbers is a whole block.
pub(crate) fn runs_of(mut numbers: &[u32]) -> impl Iterator<Item = &[u32]> {
    std::iter::from_fn(move || {
        let end = numbers_of(numbers.first()? / BLOCK as u32).end;
        let is_whole = numbers.get(BLOCK - 1).is_some_and(|last| last + 1 == end);
        let count = if is_whole { BLOCK } else { numbers.iter().take_while(|number| **number < end).count() };
        let (run, rest) = numbers.split_at(count);
        numbers = rest;
        Some(run)
    })
}
