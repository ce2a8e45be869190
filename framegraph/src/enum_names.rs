//! Macros that define the names of enumeration variants and of bits, as used in dumps, errors and JSON.

/// Defines the names of an enumeration's variants.
macro_rules! enum_names {
    ($name:ident: $($variant:ident $word:literal),+) => {
        impl $name {
            /// Name of the variant in dumps, errors and JSON.
            pub const fn word(self) -> &'static str {
                match self {
                    $(Self::$variant { .. } => $word,)+
                }
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(self.word())
            }
        }
    };
}

/// Defines a set of named bits.
macro_rules! bits {
    ($(#[$meta:meta])* $set:ident { $($(#[$doc:meta])* $bit:ident = $value:literal $name:literal;)+ }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $set(u16);

        impl $set {
            /// The empty set.
            pub const NONE: Self = Self(0);
            $($(#[$doc])* pub const $bit: Self = Self($value);)+

            /// Every element with its name.
            pub const NAMES: &[(Self, &'static str)] = &[$((Self::$bit, $name)),+];

            /// Returns the union of both sets.
            #[inline]
            #[must_use]
            pub const fn union(self, other: Self) -> Self {
                Self(self.0 | other.0)
            }

            /// Returns `true` if `self` contains all of `other`.
            #[inline]
            pub const fn contains(self, other: Self) -> bool {
                self.0 & other.0 == other.0
            }

            /// Returns the names of the elements, in a fixed order.
            pub fn names(self) -> impl Iterator<Item = &'static str> {
                Self::NAMES.iter().filter(move |(bit, _)| self.contains(*bit)).map(|(_, name)| *name)
            }
        }
    };
}

pub(crate) use {bits, enum_names};
