//! Small hashes: one for names that is the same in every run, one for keys of caches that costs next to nothing.

use std::hash::{BuildHasherDefault, Hasher};

/// FNV-1a of 64 bits over the bytes, in order (Fowler, Noll, Vo, 1991).
pub(crate) fn fnv(bytes: impl IntoIterator<Item = u8>) -> u64 {
    bytes.into_iter().fold(FNV_START, fnv_step)
}

/// The hash of no bytes.
pub(crate) const FNV_START: u64 = 0xcbf2_9ce4_8422_2325;

/// The FNV-1a hash of what `hash` is the hash of, followed by `bytes`.
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

/// Hashes the keys of caches: short, many, and never chosen by an adversary.
pub(crate) type Keyed = BuildHasherDefault<KeyHasher>;

/// Rotate, mix in a word, multiply: the scheme of rustc's own tables (`rustc-hash` 1).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct KeyHasher(u64);

impl KeyHasher {
    fn mix(&mut self, word: u64) {
        self.0 = (self.0.rotate_left(5) ^ word).wrapping_mul(0x517c_c1b7_2722_0a95);
    }
}

impl Hasher for KeyHasher {
    fn finish(&self) -> u64 {
        // The high bits are the mixed ones, and tables look at both ends.
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
    fn published_values_are_met() {
        // From the test suite of the reference implementation.
        assert_eq!(fnv([]), 0xcbf2_9ce4_8422_2325);
        assert_eq!(fnv(*b"a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(fnv(*b"foobar"), 0x8594_4171_f739_67e8);
        assert_eq!(fnv_append(fnv(*b"foo"), b"bar"), fnv(*b"foobar"));
    }

    #[test]
    fn neighbouring_keys_spread() {
        let hashed = |key: (u32, u8, &str)| Keyed::default().hash_one(key);
        let keys = (0..64u32).flat_map(|a| (0..16u8).map(move |b| (a, b, "name")));
        let hashes: Vec<u64> = keys.map(hashed).collect();
        assert_eq!(hashes.iter().collect::<BTreeSet<_>>().len(), 1024, "no two are equal");
        let low: BTreeSet<u64> = hashes.iter().map(|h| h & 0x7f).collect();
        let high: BTreeSet<u64> = hashes.iter().map(|h| h >> 57).collect();
        // Both ends of a table's hash take nearly all of their 128 values: 1024 throws miss 4 % of bins by chance.
        assert!(low.len() > 110 && high.len() > 110, "{} {}", low.len(), high.len());
        assert_ne!(hashed((1, 2, "a")), hashed((1, 2, "b")));
    }
}
