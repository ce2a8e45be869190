//! Serde types for maps that keep their order and reject duplicate keys, and for numbers that may depend on features.

use super::spanned::Spanned;
use serde::de::{Deserialize, Deserializer, Error, MapAccess, Visitor};
use std::collections::HashSet;
use std::fmt;
use std::marker::PhantomData;

/// The entries of a map, in the order of the text.
#[derive(Clone, Debug)]
pub(super) struct Entries<V>(pub(super) Vec<(Spanned<String>, V)>);

impl<V> Default for Entries<V> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<'de, V: Deserialize<'de>> Deserialize<'de> for Entries<V> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(InOrder(PhantomData))
    }
}

struct InOrder<V>(PhantomData<V>);

impl<'de, V: Deserialize<'de>> Visitor<'de> for InOrder<V> {
    type Value = Entries<V>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a map with names as keys, `{\"name\": …}`")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut entries = Vec::new();
        let mut keys = HashSet::new();
        while let Some((key, value)) = map.next_entry::<Spanned<String>, V>()? {
            if !keys.insert(key.value.clone()) {
                let message = format!("duplicate key `{}`", key.value);
                return Err(key.refuse(&message, "remove one of them"));
            }
            entries.push((key, value));
        }
        Ok(Entries(entries))
    }
}

/// A number, `"all"`, or a choice by features.
#[derive(Clone, Debug)]
pub(super) enum Count {
    /// A literal number.
    Fixed(u64),
    /// All: the full mip chain.
    All,
    /// The number of the first condition that holds; the condition `else` always holds.
    Choice(Vec<(Spanned<String>, u64)>),
}

impl<'de> Deserialize<'de> for Count {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Number)
    }
}

struct Number;

impl<'de> Visitor<'de> for Number {
    type Value = Count;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a whole number, \"all\", or a choice `{\"feature\": 4, \"else\": 1}`")
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Count, E> {
        Ok(Count::Fixed(value))
    }

    fn visit_str<E: Error>(self, value: &str) -> Result<Count, E> {
        match value {
            "all" => Ok(Count::All),
            other => Err(E::invalid_value(serde::de::Unexpected::Str(other), &self)),
        }
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Count, A::Error> {
        let Entries(choices) = InOrder(PhantomData).visit_map(map)?;
        Ok(Count::Choice(choices))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::syntax;

    fn count(text: &str) -> Result<Count, ron::error::SpannedError> {
        syntax::options().from_str(text)
    }

    #[test]
    fn counts_have_three_forms() {
        assert!(matches!(count("4"), Ok(Count::Fixed(4))));
        assert!(matches!(count("\"all\""), Ok(Count::All)));
        let Ok(Count::Choice(choices)) = count("{\"b\": 4, \"a\": 2, \"else\": 1}") else {
            panic!("expected a choice");
        };
        let flat: Vec<_> = choices.iter().map(|(k, v)| (k.value.as_str(), *v)).collect();
        assert_eq!(flat, [("b", 4), ("a", 2), ("else", 1)]);
        for bad in ["-1", "1.5", "\"some\"", "true", "[1]", "{\"a\": 1, \"a\": 2}"] {
            assert!(count(bad).is_err(), "{bad}");
        }
    }
}
