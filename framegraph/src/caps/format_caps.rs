//! Uses and sample counts of each format on a device.

use crate::enum_names::bits;
use crate::format::Format;
#[cfg(feature = "files")]
use std::collections::BTreeMap;

bits! {
    /// Uses and sample counts of a format on a device, as a set of bits. Names of sample counts are `samples_2` to
    /// `samples_16`; one sample is always included.
    FormatCaps {
        /// Textures can be sampled, or read by texel fetch.
        SAMPLED = 1 "sampled";
        /// Samplers can filter it linearly. Not checked, because graphs declare no samplers.
        FILTERABLE = 2 "filterable";
        /// Textures can be color or depth-stencil attachments.
        RENDERABLE = 4 "renderable";
        /// Attachments can be blended. Not checked, because graphs declare no blend states.
        BLENDABLE = 8 "blendable";
        /// Storage textures can be read.
        STORAGE_READ = 16 "storage_read";
        /// Storage textures can be written.
        STORAGE_WRITE = 32 "storage_write";
        /// One shader can read and write a storage texture. Not checked: a pass with `Modify` may only write.
        STORAGE_READ_WRITE = 64 "storage_read_write";
        /// Samples can be averaged while a step is stored.
        RESOLVABLE = 128 "resolvable";
        /// Textures can be the source of a copy.
        COPY_SOURCE = 256 "copy_source";
        /// Textures can be the target of a copy.
        COPY_TARGET = 512 "copy_target";
        /// Textures can be three-dimensional.
        VOLUME = 1024 "volume";
        /// 2 samples per texel.
        SAMPLES_2 = 2048 "samples_2";
        /// 4 samples per texel.
        SAMPLES_4 = 4096 "samples_4";
        /// 8 samples per texel.
        SAMPLES_8 = 8192 "samples_8";
        /// 16 samples per texel.
        SAMPLES_16 = 16384 "samples_16";
    }
}

impl FormatCaps {
    /// Returns the bit of a sample count; the empty set for 1, and `None` for other values than 1, 2, 4, 8 and 16.
    pub const fn of_samples(samples: u8) -> Option<Self> {
        match samples {
            1 => Some(Self::NONE),
            2 => Some(Self::SAMPLES_2),
            4 => Some(Self::SAMPLES_4),
            8 => Some(Self::SAMPLES_8),
            16 => Some(Self::SAMPLES_16),
            _ => None,
        }
    }

    /// Returns `true` if textures with several samples exist.
    pub const fn is_multisampled(self) -> bool {
        let every = Self::SAMPLES_2.union(Self::SAMPLES_4).union(Self::SAMPLES_8).union(Self::SAMPLES_16);
        self.without(every).0 != self.0
    }

    /// Returns the uses of `self` that are not in `other`.
    #[inline]
    #[must_use]
    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Returns the supported sample counts up to `max`, including 1.
    pub fn sample_counts(self, max: u8) -> impl Iterator<Item = u8> {
        let has = move |count: &u8| Self::of_samples(*count).is_some_and(|bit| self.contains(bit));
        [1, 2, 4, 8, 16].into_iter().filter(move |count| *count <= max.max(1)).filter(has)
    }
}

/// Capabilities of every format. Serialized as a map from a format to the names of its uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "files", serde(from = "BTreeMap<Format, FormatCaps>", into = "BTreeMap<Format, FormatCaps>"))]
pub struct FormatTable([FormatCaps; Format::ALL.len()]);

impl FormatTable {
    /// No use of any format.
    pub const NONE: Self = Self([FormatCaps::NONE; Format::ALL.len()]);

    /// Every use of every format, for a device without limits.
    pub fn all() -> Self {
        let all = FormatCaps::NAMES.iter().fold(FormatCaps::NONE, |all, (bit, _)| all.union(*bit));
        Self([all; Format::ALL.len()])
    }

    /// Returns the capabilities of a format.
    #[inline]
    pub const fn get(&self, format: Format) -> FormatCaps {
        self.0[format as usize]
    }

    /// Returns the table with other capabilities of one format.
    #[must_use]
    pub const fn with(mut self, format: Format, caps: FormatCaps) -> Self {
        self.0[format as usize] = caps;
        self
    }

    /// Returns the table without a use of one format.
    #[must_use]
    pub const fn without(self, format: Format, uses: FormatCaps) -> Self {
        self.with(format, self.get(format).without(uses))
    }
}

#[cfg(feature = "files")]
impl From<BTreeMap<Format, FormatCaps>> for FormatTable {
    fn from(map: BTreeMap<Format, FormatCaps>) -> Self {
        map.into_iter().fold(Self::NONE, |table, (format, caps)| table.with(format, caps))
    }
}

#[cfg(feature = "files")]
impl From<FormatTable> for BTreeMap<Format, FormatCaps> {
    fn from(table: FormatTable) -> Self {
        Format::ALL.into_iter().map(|format| (format, table.get(format))).collect()
    }
}

#[cfg(feature = "files")]
impl serde::Serialize for FormatCaps {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        // Binary formats need the length of a sequence.
        serializer.collect_seq(self.names().collect::<Vec<_>>())
    }
}

#[cfg(feature = "files")]
impl<'de> serde::Deserialize<'de> for FormatCaps {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let names = Vec::<String>::deserialize(deserializer)?;
        names.iter().try_fold(Self::NONE, |all, name| {
            let known = Self::NAMES.iter().find(|(_, word)| word == name);
            let listed = || Self::NAMES.iter().map(|(_, word)| *word).collect::<Vec<_>>().join(", ");
            let unknown =
                || serde::de::Error::custom(format!("unknown use of a format `{name}`; expected {}", listed()));
            known.map(|(bit, _)| all.union(*bit)).ok_or_else(unknown)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sample_counts_are_listed() {
        let caps = FormatCaps::SAMPLES_4.union(FormatCaps::SAMPLES_8);
        assert_eq!(caps.sample_counts(8).collect::<Vec<_>>(), [1, 4, 8]);
        assert_eq!(caps.sample_counts(4).collect::<Vec<_>>(), [1, 4]);
        assert!(caps.is_multisampled() && !FormatCaps::RENDERABLE.is_multisampled());
        assert_eq!(FormatCaps::of_samples(3), None);
    }
}
