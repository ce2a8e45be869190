//! Settings with a table of their fields, and parsing of options by that table.

use super::field::Field;
use super::key_value::OptionError;

/// Settings of an effect with a table of their fields.
pub trait SettingsTable: Copy + PartialEq + 'static {
    /// Name of the option of `render`, such as `ao`; empty if several options set the fields.
    const OPTION: &'static str;
    /// Path in settings files, such as `settings.occlusion`; empty for the frame.
    const PATH: &'static str;
    /// Noun phrase that describes the effect.
    const ABOUT: &'static str;
    /// Defaults.
    const DEFAULT: Self;
    /// Methods of the effect, with their defaults; empty if an option has only fields.
    const METHODS: &'static [(&'static str, Self)];
    /// All fields.
    const FIELDS: &'static [Field<Self>];

    /// Changes one field by its key. Later changes override earlier ones, and presets include several fields.
    ///
    /// # Errors
    /// Fails for an unknown key or an invalid value; the message names it and the accepted ones.
    fn set(&mut self, key: &str, value: &str) -> Result<(), OptionError> {
        match Self::FIELDS.iter().find(|field| field.has_key(key)) {
            Some(field) => field.set(self, value),
            None => Err(unknown(key, Self::FIELDS.iter().map(|field| field.key))),
        }
    }

    /// Checks fields against each other.
    ///
    /// # Errors
    /// Fails if two fields contradict each other; the message names one of them and its accepted values.
    fn check(&self) -> Result<(), OptionError> {
        Ok(())
    }

    /// Changes fields by text: `key=value,key=value`.
    ///
    /// # Errors
    /// Fails as [`SettingsTable::set`] does.
    fn set_all(&mut self, text: &str) -> Result<(), OptionError> {
        for change in text.split(',').filter(|change| !change.is_empty()) {
            let (key, value) = change.split_once('=').unwrap_or((change, ""));
            self.set(key, value)?;
        }
        Ok(())
    }

    /// Parses a method with changes, such as `moments:precision=full`.
    ///
    /// # Errors
    /// Fails for an unknown method, an unknown key or an invalid value; the message names it and the accepted ones.
    fn parse(text: &str) -> Result<Self, OptionError> {
        method(text, &[])
    }

    /// Parses `off`, or a method with changes, such as `sao:resolution=half,radius=0.5`. Returns `None` for `off`.
    ///
    /// # Errors
    /// Fails for an unknown method, an unknown key or an invalid value; the message names it and the accepted ones.
    fn from_text(text: &str) -> Result<Option<Self>, OptionError> {
        if text == "off" { Ok(None) } else { method(text, &["off"]).map(Some) }
    }
}

/// Parses a method with changes. `others` lists further words that the caller accepts.
pub(crate) fn method<S: SettingsTable>(text: &str, others: &[&'static str]) -> Result<S, OptionError> {
    let (method, changes) = text.split_once(':').unwrap_or((text, ""));
    let found = S::METHODS.iter().find(|(name, _)| *name == method);
    let names = || others.iter().copied().chain(S::METHODS.iter().map(|(name, _)| *name));
    let mut settings = found.ok_or_else(|| unknown(method, names()))?.1;
    settings.set_all(changes)?;
    settings.check()?;
    Ok(settings)
}

/// Returns settings that have a field: the defaults, those of a method, or with one other field changed.
pub(crate) fn with_field<S: SettingsTable>(field: &Field<S>) -> S {
    let plain = || [S::DEFAULT].into_iter().chain(S::METHODS.iter().map(|(_, settings)| *settings));
    let changed = plain().flat_map(|settings| {
        S::FIELDS.iter().flat_map(move |other| {
            other.alternatives(&settings).into_iter().filter_map(move |text| {
                let mut changed = settings;
                other.set(&mut changed, &text).ok().map(|()| changed)
            })
        })
    });
    plain().chain(changed).find(|settings| field.is_in(settings)).unwrap_or(S::DEFAULT)
}

/// Returns the error for an unknown name.
pub(crate) fn unknown(name: &str, known: impl Iterator<Item = &'static str>) -> OptionError {
    OptionError::Key { key: name.to_owned(), known: known.collect() }
}

/// Checks a table: keys are unique, defaults are valid, and every text that describes a value is accepted.
#[cfg(test)]
pub(crate) fn test<S: SettingsTable + std::fmt::Debug>() {
    for (index, field) in S::FIELDS.iter().enumerate() {
        let (key, settings) = (field.key, with_field(field));
        assert!(field.is_in(&settings), "{key}: no settings have it");
        assert!(!S::FIELDS[..index].iter().any(|other| other.has_key(key)), "{key} is declared twice");
        assert!(S::METHODS.iter().all(|(_, settings)| field.wrong(settings).is_none()), "{key}: default out of range");
        assert_eq!(field.wrong(&settings), None, "{key}");
        let mut same = settings;
        if let Some(shown) = field.shown(&settings) {
            same.set(key, &shown).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(same, settings, "{key}={shown} is the value");
        }
        for text in field.alternatives(&settings) {
            { settings }.set(key, &text).unwrap_or_else(|error| panic!("{error}"));
        }
        for text in ["", "NaN", "?"] {
            let error = { settings }.set(key, text).expect_err(key).to_string();
            assert!(error.contains(key) && !error.contains('\n'), "{error}");
        }
    }
    let error = { S::DEFAULT }.set("?", "1").expect_err("an unknown key").to_string();
    assert!(error.starts_with("?: unknown choice; there are "), "{error}");
}
