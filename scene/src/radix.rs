//! Radix sort of 64-bit keys.

/// Bits of a digit; its counters fill an eighth of an L1 cache.
const DIGIT_BITS: u32 = 11;
const DIGITS: usize = 1 << DIGIT_BITS;
/// Number of keys below which comparison sorting is faster.
const FEW: usize = 512;

/// Returns a key that sorts by `order`, then by `number`. Floats are in ascending order with −0 before +0, and NaN at
/// both ends.
#[must_use]
pub fn sort_key(order: f32, number: u32) -> u64 {
    let bits = order.to_bits();
    // Negative numbers invert all bits, so that larger magnitudes come first; others set the sign bit.
    let rising = if bits >> 31 == 0 { bits | 1 << 31 } else { !bits };
    u64::from(rising) << 32 | u64::from(number)
}

/// Sorts keys whose lower halves are already ascending.
pub fn sort_upper_halves(keys: &mut Vec<u64>, spare: &mut Vec<u64>) {
    if keys.len() < FEW {
        keys.sort_unstable();
        return;
    }
    // Excess elements are overwritten by the first pass.
    spare.resize(keys.len(), 0);
    const SHIFTS: [u32; 3] = [32, 32 + DIGIT_BITS, 32 + 2 * DIGIT_BITS];
    let digit_at = |key: u64, shift: u32| (key >> shift) as usize & (DIGITS - 1);
    let mut counts = [[0_u32; DIGITS]; SHIFTS.len()];
    for key in keys.iter() {
        for (places, shift) in counts.iter_mut().zip(SHIFTS) {
            places[digit_at(*key, shift)] += 1;
        }
    }
    for (mut places, shift) in counts.into_iter().zip(SHIFTS) {
        let digit = |key: u64| digit_at(key, shift);
        if places[digit(keys[0])] as usize == keys.len() {
            continue;
        }
        let mut next = 0;
        for place in &mut places {
            (*place, next) = (next, next + *place);
        }
        for key in keys.iter() {
            let place = &mut places[digit(*key)];
            spare[*place as usize] = *key;
            *place += 1;
        }
        std::mem::swap(keys, spare);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_sort_as_their_numbers_do() {
        let order = [f32::NEG_INFINITY, -3.5e7, -1.0, -1e-40, -0.0, 0.0, 1e-40, 0.25, 2.0, f32::INFINITY, f32::NAN];
        let keys = order.map(|value| sort_key(value, 7));
        assert!(keys.is_sorted());
        assert!(sort_key(1.0, 2) < sort_key(1.0, 3));
    }

    /// Compared with the standard stable sort on few and many keys, on values that differ in one digit, and on equal
    /// ones.
    #[test]
    fn digits_sort_as_comparing_does() {
        let mut state = 1_u64;
        for (count, spread) in [(5, 1e3), (511, 1e3), (512, 1e-3), (10_000, 1e6), (10_000, 1.0), (3000, 0.0)] {
            let values: Vec<f32> = (0..count)
                .map(|_| {
                    state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                    ((state >> 50) as f32 - 8000.0) * spread
                })
                .collect();
            let mut keys: Vec<u64> = (0..).zip(&values).map(|(number, value)| sort_key(*value, number)).collect();
            sort_upper_halves(&mut keys, &mut Vec::new());
            let mut expected: Vec<u32> = (0..count).collect();
            expected.sort_by(|a, b| values[*a as usize].total_cmp(&values[*b as usize]));
            assert!(keys.iter().map(|key| *key as u32).eq(expected), "{count} {spread}");
        }
    }
}
