//! Features, and conditions on them.
//!
//! A condition combines features with `!`, `&&` and `||`: `"a"`, `"!a"`, `"a && !b"`, `"a && b || c"`. `&&` binds more
//! tightly than `||`; parentheses are not supported.

use super::error::{FileError, FileReason};
use super::spanned::{Source, Spanned};
use super::value::ValueReason;

/// The features of a file and their settings.
#[derive(Clone, Debug)]
pub(super) struct Features {
    /// Names and settings, in the order of the file.
    rows: Vec<(String, bool)>,
}

impl Features {
    /// Creates the features from names and settings.
    pub(super) fn new(rows: Vec<(String, bool)>) -> Self {
        Self { rows }
    }

    /// Sets a feature. Returns `false` if it does not exist.
    pub(super) fn switch(&mut self, name: &str, on: bool) -> bool {
        let found = self.rows.iter_mut().find(|(n, _)| n == name);
        found.map(|row| row.1 = on).is_some()
    }

    /// Returns the error for an unknown feature.
    pub(super) fn unknown(&self, name: &str) -> FileReason {
        FileReason::unknown("feature", name, self.rows.iter().map(|(n, _)| n.as_str()))
    }

    /// Returns `true` if a condition holds, or if there is none.
    pub(super) fn holds(&self, source: Source<'_>, when: Option<&Spanned<String>>) -> Result<bool, FileError> {
        let Some(when) = when else { return Ok(true) };
        self.evaluate(&when.value, source.is_brief()).map_err(|reason| source.error(when, reason))
    }

    /// Evaluates a condition. Evaluates every name, so that misspelled names are always reported. A `brief` error
    /// contains no suggestions.
    fn evaluate(&self, condition: &str, brief: bool) -> Result<bool, FileReason> {
        let mut any = false;
        for term in condition.split("||") {
            let mut all = true;
            for factor in term.split("&&") {
                all &= self.factor(factor.trim(), brief)?;
            }
            any |= all;
        }
        Ok(any)
    }

    fn factor(&self, factor: &str, brief: bool) -> Result<bool, FileReason> {
        let (name, wanted) = match factor.strip_prefix('!') {
            Some(name) => (name.trim_start(), false),
            None => (factor, true),
        };
        if !is_name(name) {
            return Err(FileReason::Value(ValueReason::Condition(factor.into())));
        }
        match self.rows.iter().find(|(n, _)| n == name) {
            Some((_, on)) => Ok(*on == wanted),
            None if brief => Err(Self::new(Vec::new()).unknown(name)),
            None => Err(self.unknown(name)),
        }
    }
}

/// Returns `true` for valid feature names: letters, digits, `_`, `-` and `.`, but not `else`.
pub(super) fn is_name(name: &str) -> bool {
    let fits = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '.');
    !name.is_empty() && name != "else" && name.chars().all(fits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn and_binds_more_tightly_than_or() {
        let f = Features::new(vec![("on".into(), true), ("off".into(), false)]);
        let cases = [
            ("on", true),
            ("!on", false),
            ("off || on", true),
            ("off && on", false),
            ("off && on || on", true),
            ("on || off && off", true),
            ("! off", true),
            ("!off && !on", false),
        ];
        for (text, value) in cases {
            assert_eq!(f.evaluate(text, false).ok(), Some(value), "{text}");
        }
        for bad in ["", "on &&", "on & off", "(on)", "!!on", "on on"] {
            assert!(matches!(f.evaluate(bad, false), Err(FileReason::Value(_))), "{bad}");
        }
        // Unknown names are reported at any position.
        for unknown in ["on || offf", "off && offf"] {
            let Err(FileReason::Unknown { near, .. }) = f.evaluate(unknown, false) else {
                panic!("{unknown} is known");
            };
            assert_eq!(near.as_deref(), Some("off"));
        }
    }
}
