//! Source of random decisions: a seed, or the bytes of a fuzzer.

/// A source of random decisions. Equal sources give equal decisions on every machine.
///
/// When the bytes are used up, every decision is the first option. Loops then end and graphs stay small, so that a
/// fuzzer can shorten its input.
#[derive(Clone, Debug)]
pub struct Entropy<'a> {
    source: Source<'a>,
}

#[derive(Clone, Debug)]
enum Source<'a> {
    /// The state of splitmix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014).
    Seed(u64),
    /// The remaining bytes.
    Bytes(&'a [u8]),
}

impl<'a> Entropy<'a> {
    /// Creates an endless source from a seed.
    pub const fn seeded(seed: u64) -> Self {
        Self { source: Source::Seed(seed) }
    }

    /// Creates a source from bytes; each decision uses one or two of them.
    pub const fn from_bytes(bytes: &'a [u8]) -> Self {
        Self { source: Source::Bytes(bytes) }
    }

    /// Returns a number below `bound`, or 0 if `bound` is 0. `bound` is at most 2¹⁶.
    pub fn below(&mut self, bound: u32) -> u32 {
        if bound <= 1 {
            return 0;
        }
        match &mut self.source {
            Source::Seed(state) => {
                *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
                let mut z = *state;
                z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
                z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
                z ^= z >> 31;
                (((z >> 32) * u64::from(bound)) >> 32) as u32
            }
            Source::Bytes(bytes) => {
                let mut byte = || match bytes.split_first() {
                    Some((first, rest)) => {
                        *bytes = rest;
                        u32::from(*first)
                    }
                    None => 0,
                };
                let mut value = byte();
                if bound > 256 {
                    value = value << 8 | byte();
                }
                value % bound
            }
        }
    }

    /// Returns `true` with a probability of 1 in `n`; `false` when the bytes are used up.
    pub fn one_in(&mut self, n: u32) -> bool {
        n <= 1 || self.below(n) == n - 1
    }

    /// Returns one of `options`.
    ///
    /// # Panics
    /// Panics if `options` is empty.
    pub fn pick<T: Copy>(&mut self, options: &[T]) -> T {
        options[self.below(options.len() as u32) as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_reaches_every_option_and_bytes_run_out() {
        let mut seeded = Entropy::seeded(1);
        let mut seen = [false; 7];
        for _ in 0..200 {
            seen[seeded.below(7) as usize] = true;
        }
        assert_eq!(seen, [true; 7], "200 draws of 7 miss one with p < 1e-12");
        let mut bytes = Entropy::from_bytes(&[9, 1, 2]);
        assert_eq!((bytes.below(4), bytes.below(1000)), (1, 258));
        assert_eq!((bytes.below(9), bytes.one_in(5)), (0, false));
    }
}
