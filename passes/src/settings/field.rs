//! Declarations of settings: one row per setting drives option parsing, range checks of files, documents and panels.

use super::key_value::OptionError;
use super::place::Place;

/// A setting of `S`.
pub struct Field<S: 'static> {
    /// Key in options, such as `step-power`.
    pub key: &'static str,
    /// Path in settings files, relative to the settings of the effect, such as `method.step_power`. Empty for presets.
    pub path: &'static str,
    /// Effect of the setting, as a noun phrase or a sentence without a period.
    pub about: &'static str,
    /// Minimum and maximum of numbers.
    range: [f64; 2],
    place: fn(&mut S) -> Place<'_>,
    text: Option<Text<S>>,
    former: &'static str,
}

/// Text of a field whose value is not a plain one.
struct Text<S> {
    takes: &'static str,
    examples: &'static [&'static str],
    set: fn(&mut S, &str) -> Option<()>,
}

/// Declares a number from `range[0]` to `range[1]`, or several of them.
pub(crate) const fn number<S>(
    key: &'static str,
    path: &'static str,
    range: [f64; 2],
    place: fn(&mut S) -> Place<'_>,
) -> Field<S> {
    Field { key, path, about: "", range, place, text: None, former: "" }
}

/// Declares a switch, an enumeration, or one of several numbers.
pub(crate) const fn choice<S>(key: &'static str, path: &'static str, place: fn(&mut S) -> Place<'_>) -> Field<S> {
    number(key, path, [0.0; 2], place)
}

/// Declares a field with its own syntax: `takes` describes the accepted text, and `examples` has one for each variant.
/// `set` returns `None` for invalid text.
pub(crate) const fn text<S>(
    key: &'static str,
    path: &'static str,
    takes: &'static str,
    examples: &'static [&'static str],
    set: fn(&mut S, &str) -> Option<()>,
) -> Field<S> {
    let text = Some(Text { takes, examples, set });
    Field { key, path, about: "", range: [0.0; 2], place: |_| Place::Free, text, former: "" }
}

impl<S> Field<S> {
    /// Sets the description.
    pub(crate) const fn about(mut self, about: &'static str) -> Self {
        self.about = about;
        self
    }

    /// Sets the number within a text: its range and place, checked in files.
    pub(crate) const fn with(mut self, range: [f64; 2], place: fn(&mut S) -> Place<'_>) -> Self {
        (self.range, self.place) = (range, place);
        self
    }

    /// Sets a former key, which remains valid.
    pub(crate) const fn former(mut self, former: &'static str) -> Self {
        self.former = former;
        self
    }
}

impl<S: Copy + PartialEq + 'static> Field<S> {
    /// Returns true if this is the key of the field, or a former one.
    pub(crate) fn has_key(&self, key: &str) -> bool {
        self.key == key || (!self.former.is_empty() && self.former == key)
    }

    /// Returns true if the settings have the field.
    pub(crate) fn is_in(&self, settings: &S) -> bool {
        !matches!((self.place)(&mut { *settings }), Place::Only(_))
    }

    /// Sets the value from text.
    ///
    /// # Errors
    /// Fails for an invalid value, with the accepted ones, or if the settings lack the field.
    pub fn set(&self, settings: &mut S, value: &str) -> Result<(), OptionError> {
        let takes = self.takes(settings);
        let place = (self.place)(settings);
        let key = || self.key.to_owned();
        let done = match (&self.text, place) {
            (_, Place::Only(method)) => return Err(OptionError::Other { key: key(), method }),
            (Some(text), _) => (text.set)(settings, value),
            (None, place) => place.put(value, self.range),
        };
        done.ok_or_else(|| OptionError::Value { key: key(), value: value.to_owned(), takes })
    }

    /// Describes the accepted values.
    pub fn takes(&self, settings: &S) -> String {
        match &self.text {
            Some(text) => text.takes.to_owned(),
            None => (self.place)(&mut { *settings }).takes(self.range),
        }
    }

    /// Returns the value as text; `None` if the settings lack the field, or no example gives the value.
    pub fn shown(&self, settings: &S) -> Option<String> {
        let Some(text) = &self.text else { return (self.place)(&mut { *settings }).shown() };
        let gives = |example: &&&str| {
            let mut copy = *settings;
            self.set(&mut copy, example).is_ok() && copy == *settings
        };
        text.examples.iter().find(gives).map(|example| (*example).to_owned())
    }

    /// Returns texts of values that exclude each other, one for each variant; none for numbers and switches.
    pub fn alternatives(&self, settings: &S) -> Vec<String> {
        match &self.text {
            Some(text) => text.examples.iter().map(|example| (*example).to_owned()).collect(),
            None => (self.place)(&mut { *settings }).alternatives(),
        }
    }

    /// Returns the invalid value and the accepted ones; `None` if the value is valid.
    pub fn wrong(&self, settings: &S) -> Option<(String, String)> {
        (self.place)(&mut { *settings }).wrong(self.range)
    }

    /// Returns the range of a number as stored; `None` for other fields.
    pub fn range(&self, settings: &S) -> Option<[f64; 2]> {
        let [low, high] = self.range;
        let is_angle = matches!((self.place)(&mut { *settings }), Place::Degrees(_));
        (low < high).then(|| if is_angle { self.range.map(f64::to_radians) } else { self.range })
    }
}
