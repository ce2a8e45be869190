//! Settings chosen by name, as `key=value`, and why a choice was refused.

/// A setting cannot be chosen by name.
#[derive(Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ChoiceError {
    /// There is nothing of that name.
    #[error("{key}: unknown choice; there are {}", .known.join(", "))]
    Key {
        /// The name.
        key: String,
        /// The names that there are.
        known: &'static [&'static str],
    },
    /// The choice takes other values.
    #[error("{key}={value}: {takes} is needed")]
    Value {
        /// The name.
        key: String,
        /// The value.
        value: String,
        /// What the choice takes.
        takes: &'static str,
    },
    /// The choice takes a number from a range.
    #[error("{key}={value}: a number from {low} to {high} is needed")]
    Number {
        /// The name.
        key: String,
        /// The value.
        value: String,
        /// The least number.
        low: f32,
        /// The greatest number.
        high: f32,
    },
    /// The choice takes several numbers from a range.
    #[error("{key}={value}: {needed} numbers separated by `:`, from {low} to {high}, are needed")]
    Numbers {
        /// The name.
        key: String,
        /// The value.
        value: String,
        /// How many.
        needed: usize,
        /// The least number.
        low: f32,
        /// The greatest number.
        high: f32,
    },
    /// Only another method has that choice.
    #[error("{key}: only `{method}` has it")]
    Other {
        /// The name.
        key: String,
        /// The method that has it.
        method: &'static str,
    },
}

impl std::fmt::Debug for ChoiceError {
    /// The sentence, since that is what an `unwrap` shows.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// What is asked for as `off`, or as `on` with changes of `usual` that `set` makes: `on:thickness=0.2,distance=5`. None is
/// `off`.
pub(crate) fn switched<T>(
    text: &str,
    usual: T,
    set: fn(&mut T, &str, &str) -> Result<(), ChoiceError>,
) -> Result<Option<T>, ChoiceError> {
    let (switch, changes) = text.split_once(':').unwrap_or((text, ""));
    let mut settings = match switch {
        "off" => return Ok(None),
        "on" => usual,
        _ => return Err(Choice { key: switch, value: "" }.unknown(&["off", "on"])),
    };
    for Choice { key, value } in choices(changes) {
        set(&mut settings, key, value)?;
    }
    Ok(Some(settings))
}

/// The choices of `key=value,key=value`, in order; a key alone has the value "".
pub(crate) fn choices(text: &str) -> impl Iterator<Item = Choice<'_>> {
    text.split(',').filter(|choice| !choice.is_empty()).map(|choice| {
        let (key, value) = choice.split_once('=').unwrap_or((choice, ""));
        Choice { key, value }
    })
}

/// One choice, as it was asked for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Choice<'t> {
    pub(crate) key: &'t str,
    pub(crate) value: &'t str,
}

impl Choice<'_> {
    /// There is no such name among the `known`.
    pub(crate) fn unknown(self, known: &'static [&'static str]) -> ChoiceError {
        ChoiceError::Key { key: self.key.to_owned(), known }
    }

    /// The value is none of what the choice `takes`.
    pub(crate) fn wrong(self, takes: &'static str) -> ChoiceError {
        ChoiceError::Value { key: self.key.to_owned(), value: self.value.to_owned(), takes }
    }

    /// Only that method has the choice.
    pub(crate) fn only(self, method: &'static str) -> ChoiceError {
        ChoiceError::Other { key: self.key.to_owned(), method }
    }

    /// `on` or `off`.
    pub(crate) fn switch(self) -> Result<bool, ChoiceError> {
        match self.value {
            "on" => Ok(true),
            "off" => Ok(false),
            _ => Err(self.wrong("`on` or `off`")),
        }
    }

    /// A number from `low` to `high`, both included.
    pub(crate) fn number(self, low: f32, high: f32) -> Result<f32, ChoiceError> {
        match self.value.parse::<f32>() {
            Ok(value) if (low..=high).contains(&value) => Ok(value),
            _ => {
                let (key, value) = (self.key.to_owned(), self.value.to_owned());
                Err(ChoiceError::Number { key, value, low, high })
            }
        }
    }

    /// So many numbers separated by `:`, each from `low` to `high`, both included.
    pub(crate) fn numbers<const N: usize>(self, low: f32, high: f32) -> Result<[f32; N], ChoiceError> {
        let words: Vec<&str> = self.value.split(':').collect();
        let number = |word: &&str| word.parse().ok().filter(|x| (low..=high).contains(x));
        let numbers: Option<Vec<f32>> = words.iter().map(number).collect();
        let (key, value) = (self.key.to_owned(), self.value.to_owned());
        let wrong = ChoiceError::Numbers { key, value, needed: N, low, high };
        numbers.and_then(|numbers| numbers.try_into().ok()).ok_or(wrong)
    }

    /// A whole number from `low` to `high`, both included.
    pub(crate) fn whole(self, low: u32, high: u32) -> Result<u32, ChoiceError> {
        let value = self.number(low as f32, high as f32)?;
        if value.fract() == 0.0 { Ok(value as u32) } else { Err(self.wrong("a whole number")) }
    }
}
