//! Option parsing: settings given as `key=value`, and errors.

/// Error of parsing an option.
#[derive(Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OptionError {
    /// The key is unknown.
    #[error("{key}: unknown choice; there are {}", .known.join(", "))]
    Key {
        /// The key.
        key: String,
        /// The accepted keys.
        known: &'static [&'static str],
    },
    /// The value is invalid.
    #[error("{key}={value}: {takes} is needed")]
    Value {
        /// The key.
        key: String,
        /// The value.
        value: String,
        /// Description of accepted values.
        takes: &'static str,
    },
    /// The value is not a number in the accepted range.
    #[error("{key}={value}: a number from {low} to {high} is needed")]
    Number {
        /// The key.
        key: String,
        /// The value.
        value: String,
        /// The minimum.
        low: f32,
        /// The maximum.
        high: f32,
    },
    /// The value is not a list of numbers in the accepted range.
    #[error("{key}={value}: {needed} numbers separated by `:`, from {low} to {high}, are needed")]
    Numbers {
        /// The key.
        key: String,
        /// The value.
        value: String,
        /// The required number of numbers.
        needed: usize,
        /// The minimum.
        low: f32,
        /// The maximum.
        high: f32,
    },
    /// The key belongs to another method.
    #[error("{key}: only `{method}` has it")]
    Other {
        /// The key.
        key: String,
        /// The method with this key.
        method: &'static str,
    },
}

impl std::fmt::Debug for OptionError {
    /// Prints the message, as `unwrap` shows it.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// Parses `off`, or `on` with changes to `usual` made by `set`, such as `on:thickness=0.2,distance=5`. Returns `None`
/// for `off`.
pub(crate) fn switched<T>(
    text: &str,
    usual: T,
    set: fn(&mut T, &str, &str) -> Result<(), OptionError>,
) -> Result<Option<T>, OptionError> {
    let (switch, changes) = text.split_once(':').unwrap_or((text, ""));
    let mut settings = match switch {
        "off" => return Ok(None),
        "on" => usual,
        _ => return Err(KeyValue { key: switch, value: "" }.unknown(&["off", "on"])),
    };
    for KeyValue { key, value } in choices(changes) {
        set(&mut settings, key, value)?;
    }
    Ok(Some(settings))
}

/// Returns the pairs of `key=value,key=value` in order; a key without a value has the value "".
pub(crate) fn choices(text: &str) -> impl Iterator<Item = KeyValue<'_>> {
    text.split(',').filter(|choice| !choice.is_empty()).map(|choice| {
        let (key, value) = choice.split_once('=').unwrap_or((choice, ""));
        KeyValue { key, value }
    })
}

/// A key with its value.
#[derive(Clone, Copy, Debug)]
pub(crate) struct KeyValue<'t> {
    pub(crate) key: &'t str,
    pub(crate) value: &'t str,
}

impl KeyValue<'_> {
    /// Returns the error for an unknown key.
    pub(crate) fn unknown(self, known: &'static [&'static str]) -> OptionError {
        OptionError::Key { key: self.key.to_owned(), known }
    }

    /// Returns the error for an invalid value.
    pub(crate) fn wrong(self, takes: &'static str) -> OptionError {
        OptionError::Value { key: self.key.to_owned(), value: self.value.to_owned(), takes }
    }

    /// Returns the error for a key of another method.
    pub(crate) fn only(self, method: &'static str) -> OptionError {
        OptionError::Other { key: self.key.to_owned(), method }
    }

    /// Parses `on` or `off`.
    pub(crate) fn switch(self) -> Result<bool, OptionError> {
        match self.value {
            "on" => Ok(true),
            "off" => Ok(false),
            _ => Err(self.wrong("`on` or `off`")),
        }
    }

    /// Parses a number from `low` to `high`, inclusive.
    pub(crate) fn number(self, low: f32, high: f32) -> Result<f32, OptionError> {
        match self.value.parse::<f32>() {
            Ok(value) if (low..=high).contains(&value) => Ok(value),
            _ => {
                let (key, value) = (self.key.to_owned(), self.value.to_owned());
                Err(OptionError::Number { key, value, low, high })
            }
        }
    }

    /// Parses `N` numbers separated by `:`, each from `low` to `high`, inclusive.
    pub(crate) fn numbers<const N: usize>(self, low: f32, high: f32) -> Result<[f32; N], OptionError> {
        let words: Vec<&str> = self.value.split(':').collect();
        let number = |word: &&str| word.parse().ok().filter(|x| (low..=high).contains(x));
        let numbers: Option<Vec<f32>> = words.iter().map(number).collect();
        let (key, value) = (self.key.to_owned(), self.value.to_owned());
        let wrong = OptionError::Numbers { key, value, needed: N, low, high };
        numbers.and_then(|numbers| numbers.try_into().ok()).ok_or(wrong)
    }

    /// Parses an integer from `low` to `high`, inclusive.
    pub(crate) fn whole(self, low: u32, high: u32) -> Result<u32, OptionError> {
        let value = self.number(low as f32, high as f32)?;
        if value.fract() == 0.0 { Ok(value as u32) } else { Err(self.wrong("a whole number")) }
    }
}
