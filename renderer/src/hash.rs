//! Hash functions: FNV-1a for stable names, and a fast hash for cache keys.

use std::hash::{BuildHasherDefault, Hasher};

/// Returns the 64-bit FNV-1a hash of the bytes (Fowler, Noll, Vo, 1991).
pub(crate) fn fnv(bytes: impl IntoIterator<Item = u8>) -> u64 {
    bytes.into_iter().fold(FNV_START, fnv_step)
}

/// FNV-1a hash of an empty sequence.
pub(crate) const FNV_START: u64 = 0xcbf2_9ce4_8422_2325;

/// Continues an FNV-1a hash with more bytes.
pub(crate) const fn fnv_append(mut hash: u64, bytes: &[u8]) -> u64 {
    let mut index = 0;
    while index < bytes.len() {
        hash = fnv_step(hash, bytes[index]);
        index += 1;
    }
    hash
}

const fn fnv_step(hash: u64, byte: u8) -> u64 {
    (hash ^ byte as u64).wrapping_mul(0x0100_0000_01b3)
}

/// Builds hashers for cache keys, which are short and never chosen by an attacker.
pub(crate) type KeyHashBuilder = BuildHasherDefault<KeyHasher>;

/// Hashes words by rotating, XOR and multiplying, like `rustc-hash` 1.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct KeyHasher(u64);

impl KeyHasher {
    fn mix(&mut self, word: u64) {
        self.0 = (self.0.rotate_left(5) ^ word).wrapping_mul(0x517c_c1b7_2722_0a95);
    }
}

impl Hasher for KeyHasher {
    fn finish(&self) -> u64 {
        // Hash tables use the low and the high bits; only the high bits are well mixed.
        self.0.rotate_left(26)
    }

    fn write(&mut self, bytes: &[u8]) {
        let (words, rest) = bytes.as_chunks::<8>();
        words.iter().for_each(|w| self.mix(u64::from_le_bytes(*w)));
        if !rest.is_empty() {
            let mut last = [0; 8];
            last[..rest.len()].copy_from_slice(rest);
            self.mix(u64::from_le_bytes(last));
        }
    }

    fn write_u8(&mut self, word: u8) {
        self.mix(word.into());
    }

    fn write_u16(&mut self, word: u16) {
        self.mix(word.into());
    }

    fn write_u32(&mut self, word: u32) {
        self.mix(word.into());
    }

    fn write_u64(&mut self, word: u64) {
        self.mix(word);
    }

    fn write_usize(&mut self, word: usize) {
        self.mix(word as u64);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use std::hash::BuildHasher;

    #[test]
    fn hashes_equal_published_values() {
        // From the test suite of the reference implementation.
        assert_eq!(fnv([]), 0xcbf2_9ce4_8422_2325);
        assert_eq!(fnv(*b"a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(fnv(*b"foobar"), 0x8594_4171_f739_67e8);
        assert_eq!(fnv_append(fnv(*b"foo"), b"bar"), fnv(*b"foobar"));
    }

    #[test]
    fn similar_keys_spread() {
        let hashed = |key: (u32, u8, &str)| KeyHashBuilder::default().hash_one(key);
        let keys = (0..64u32).flat_map(|a| (0..16u8).map(move |b| (a, b, "name")));
        let hashes: Vec<u64> = keys.map(hashed).collect();
        assert_eq!(hashes.iter().collect::<BTreeSet<_>>().len(), 1024, "no two are equal");
        let low: BTreeSet<u64> = hashes.iter().map(|h| h & 0x7f).collect();
        let high: BTreeSet<u64> = hashes.iter().map(|h| h >> 57).collect();
        // With 1024 keys, 128 bins stay empty with negligible probability, so both ends should take nearly all values.
        assert!(low.len() > 110 && high.len() > 110, "{} {}", low.len(), high.len());
        assert_ne!(hashed((1, 2, "a")), hashed((1, 2, "b")));
    }
}
