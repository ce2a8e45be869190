//! Resolves names in a file to the enabled resources and passes.

use super::error::{FileError, FileErrors, FileReason};
use super::features::Features;
use super::form::PassForm;
use super::selected::{Declared, ENTRY, Mention, PassRow, SlotsOf, Wanted};
use super::spanned::{Source, Spanned};
use super::value::ValueReason;
use std::collections::HashMap;

/// Names and the rows they refer to.
#[derive(Default)]
pub(super) struct Names<'f> {
    pub(super) resources: HashMap<&'f str, usize>,
    pub(super) passes: HashMap<&'f str, usize>,
    /// Disabled ids with their conditions.
    pub(super) resources_off: HashMap<&'f str, &'f str>,
    pub(super) passes_off: HashMap<&'f str, &'f str>,
}

impl Names<'_> {
    fn resource(&self, name: &str, brief: bool) -> Result<usize, FileReason> {
        find(&self.resources, &self.resources_off, "resource", name, brief)
    }

    fn pass(&self, name: &str, brief: bool) -> Result<usize, FileReason> {
        find(&self.passes, &self.passes_off, "pass", name, brief)
    }
}

/// Looks up names and reports errors with their positions.
pub(super) struct Lookup<'s, 'n, 'f> {
    pub(super) source: Source<'s>,
    pub(super) names: &'n Names<'f>,
    pub(super) features: &'n Features,
}

impl<'f> Lookup<'_, '_, 'f> {
    /// Returns the row and version of a reference. A `brief` error contains no suggestions.
    pub(super) fn reference(&self, at: &'f Spanned<String>, brief: bool) -> Result<(usize, Wanted), FileError> {
        let refused = |reason| self.source.unless(brief).error(at, reason);
        let (id, suffix) = match at.value.split_once('@') {
            Some((id, suffix)) => (id, Some(suffix)),
            None => (at.value.as_str(), None),
        };
        let resource = self.names.resource(id, brief).map_err(refused)?;
        let age = |suffix: &str| suffix.strip_prefix('-').and_then(|age| age.parse().ok());
        let version = match suffix {
            None => Wanted::Newest,
            Some(ENTRY) => Wanted::Entry,
            Some(suffix) => match age(suffix) {
                Some(age) => Wanted::Previous(age),
                None => Wanted::By(self.names.pass(suffix, brief).map_err(refused)?),
            },
        };
        Ok((resource, version))
    }

    /// Returns `true` if a condition holds. Reports an invalid condition and treats it as false.
    pub(super) fn on(&self, when: Option<&Spanned<String>>, errors: &mut FileErrors) -> bool {
        let source = self.source.unless(errors.is_full());
        self.features.holds(source, when).unwrap_or_else(|error| {
            errors.push(|| error);
            false
        })
    }

    /// Looks up the histories of the declared previous images, and the imports that may alias.
    pub(super) fn declared(&self, declared: &mut Vec<Declared<'f>>, errors: &mut FileErrors) {
        declared.retain_mut(|row| {
            let mut find = |of: &Spanned<String>| match self.names.resource(&of.value, errors.is_full()) {
                Ok(found) => found,
                Err(reason) => {
                    errors.push(|| self.source.error(of, reason));
                    usize::MAX
                }
            };
            match row {
                Declared::Resource(..) => true,
                Declared::Previous(history, _, of) => {
                    *history = find(of);
                    *history != usize::MAX
                }
                Declared::Alias(pair, form) => {
                    *pair = [find(&form.of), find(&form.with)];
                    !pair.contains(&usize::MAX)
                }
            }
        });
    }

    /// Looks up the passes that a pass must run after.
    pub(super) fn after(&self, row: &mut PassRow<'f>, errors: &mut FileErrors) {
        for at in row.form.head().after {
            match self.names.pass(&at.value, errors.is_full()) {
                Ok(pass) => row.after.push(pass),
                // A disabled pass imposes no order.
                Err(FileReason::SwitchedOff { .. }) => {}
                Err(reason) => errors.push(|| self.source.error(at, reason)),
            }
        }
    }

    /// Looks up the resources in the accesses or slots of a pass. Sets `blind` if an unknown resource may be one that
    /// the pass writes.
    pub(super) fn mentions(
        &self,
        row: &mut PassRow<'f>,
        slots_of: &SlotsOf<'_>,
        blind: &mut bool,
        errors: &mut FileErrors,
    ) {
        let mut mention = |index, at: &'f Spanned<String>, writes, errors: &mut FileErrors| match self
            .reference(at, errors.is_full())
        {
            Ok((_, Wanted::Previous(_))) if writes => {
                errors.push(|| self.source.value(at, ValueReason::WritesEarlierFrame));
            }
            Ok((resource, version)) => row.mentions.push(Mention { index, resource, version, writes, at }),
            Err(error) => {
                *blind |= writes;
                errors.push(|| error);
            }
        };
        match row.form {
            PassForm::Raster(w) | PassForm::Compute(w) | PassForm::Copy(w) => {
                for (index, access) in w.accesses.iter().enumerate() {
                    if self.on(access.when.as_ref(), errors) {
                        mention(index, &access.of, access.intent.is_some(), errors);
                    }
                }
            }
            PassForm::Plugin(p) => {
                let slots = slots_of(&p.kind.value).unwrap_or_default();
                for (index, (slot, bound)) in p.slots.0.iter().enumerate() {
                    if let Some(known) = slots.iter().find(|s| s.name == slot.value) {
                        mention(index, bound, known.ty.is_target(), errors);
                    }
                }
            }
        }
    }
}

fn find(
    on: &HashMap<&str, usize>,
    off: &HashMap<&str, &str>,
    what: &'static str,
    name: &str,
    brief: bool,
) -> Result<usize, FileReason> {
    if let Some(row) = on.get(name) {
        return Ok(*row);
    }
    if let Some(when) = off.get(name) {
        return Err(FileReason::SwitchedOff { what, name: name.to_owned(), when: (*when).to_owned() });
    }
    if brief {
        return Err(FileReason::unknown(what, "", [].into_iter()));
    }
    let mut names: Vec<_> = on.iter().map(|(name, row)| (*row, *name)).collect();
    names.sort_unstable();
    Err(FileReason::unknown(what, name, names.iter().map(|(_, name)| *name)))
}
