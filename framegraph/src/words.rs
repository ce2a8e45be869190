//! The words by which dumps, errors and JSON call the variants of an enumeration, or the bits of a set.

/// Gives an enumeration its words.
macro_rules! words {
    ($name:ident: $($variant:ident $word:literal),+) => {
        impl $name {
            /// The word that dumps, errors and JSON use.
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

/// Makes a set of bits, each with its name.
macro_rules! bits {
    ($(#[$meta:meta])* $set:ident { $($(#[$doc:meta])* $bit:ident = $value:literal $name:literal;)+ }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $set(u16);

        impl $set {
            /// The empty set.
            pub const NONE: Self = Self(0);
            $($(#[$doc])* pub const $bit: Self = Self($value);)+

            pub(crate) const NAMES: &[(Self, &'static str)] = &[$((Self::$bit, $name)),+];

            /// What is in either.
            #[inline]
            #[must_use]
            pub const fn union(self, other: Self) -> Self {
                Self(self.0 | other.0)
            }

            /// Whether everything of `other` is in `self`.
            #[inline]
            pub const fn contains(self, other: Self) -> bool {
                self.0 & other.0 == other.0
            }

            /// The names of what is in it, in a fixed order.
            pub fn names(self) -> impl Iterator<Item = &'static str> {
                Self::NAMES.iter().filter(move |(bit, _)| self.contains(*bit)).map(|(_, name)| *name)
            }
        }
    };
}

pub(crate) use {bits, words};
