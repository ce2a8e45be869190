//! From the names in a file to rows of what is switched on.

use super::error::{FileError, FileReason};
use super::form::PassForm;
use super::plugin::Takes;
use super::select::{Declared, ENTRY, MOST_ERRORS, PassRow, SlotsOf, Touch, Wanted, named};
use super::spot::{Source, Spot};
use super::suggest::nearest;
use std::collections::HashMap;

/// Names on the way to rows.
#[derive(Default)]
pub(super) struct Names<'f> {
    pub(super) resources: HashMap<&'f str, usize>,
    pub(super) passes: HashMap<&'f str, usize>,
    /// Ids that exist with other features, with their conditions.
    pub(super) resources_off: HashMap<&'f str, &'f str>,
    pub(super) passes_off: HashMap<&'f str, &'f str>,
}

/// Looks names up for errors that say where they stand.
pub(super) struct Lookup<'s, 'n, 'f> {
    pub(super) source: Source<'s>,
    pub(super) names: &'n Names<'f>,
}

impl<'f> Lookup<'_, '_, 'f> {
    /// The row and version that a reference names.
    pub(super) fn reference(&self, spot: &'f Spot<String>) -> Result<(usize, Wanted), FileError> {
        let Names { resources, resources_off, passes, passes_off } = self.names;
        let (id, suffix) = match spot.value.split_once('@') {
            Some((id, suffix)) => (id, Some(suffix)),
            None => (spot.value.as_str(), None),
        };
        let resource = find(resources, resources_off, "resource", id);
        let resource = resource.map_err(|reason| self.source.error(spot, reason))?;
        let Some(suffix) = suffix else {
            return Ok((resource, Wanted::Newest));
        };
        if let Some(age) = suffix.strip_prefix('-').and_then(|age| age.parse().ok()) {
            return Ok((resource, Wanted::Previous(age)));
        }
        if suffix == ENTRY {
            return Ok((resource, Wanted::Entry));
        }
        match find(passes, passes_off, "pass", suffix) {
            Ok(pass) => Ok((resource, Wanted::By(pass))),
            Err(reason) => Err(self.source.error(spot, reason)),
        }
    }

    /// Finds the histories of the previous images that the file lists.
    pub(super) fn previous(&self, declared: &mut Vec<Declared<'f>>, errors: &mut Vec<FileError>) {
        let Names { resources, resources_off, .. } = self.names;
        declared.retain_mut(|row| {
            let Declared::Previous(history, _, of) = row else {
                return true;
            };
            match find(resources, resources_off, "resource", &of.value) {
                Ok(found) => *history = found,
                Err(reason) => errors.push(self.source.error(*of, reason)),
            }
            *history != usize::MAX
        });
    }

    pub(super) fn after(&self, row: &mut PassRow<'f>, errors: &mut Vec<FileError>) {
        let after = match row.form {
            PassForm::Raster(w) | PassForm::Compute(w) | PassForm::Copy(w) => &w.after,
            PassForm::Plugin(p) => &p.after,
        };
        for spot in after {
            match find(&self.names.passes, &self.names.passes_off, "pass", &spot.value) {
                Ok(pass) => row.after.push(pass),
                // A pass that does not run has nothing to wait for.
                Err(FileReason::SwitchedOff { .. }) => {}
                Err(reason) => errors.push(self.source.error(spot, reason)),
            }
        }
    }

    pub(super) fn touches(
        &self,
        row: &mut PassRow<'f>,
        slots_of: &SlotsOf<'_>,
        on: &mut impl FnMut(Option<&'f Spot<String>>, &mut Vec<FileError>) -> bool,
        errors: &mut Vec<FileError>,
    ) {
        let mut touch = |index, spot: &'f Spot<String>, writes, errors: &mut Vec<FileError>| match self.reference(spot)
        {
            Ok((_, Wanted::Previous(_))) if writes => {
                let reason = FileReason::Value {
                    detail: "an earlier frame's image cannot be written".into(),
                    hint: "write the history by its plain name".into(),
                };
                errors.push(self.source.error(spot, reason));
            }
            Ok((resource, version)) => {
                row.touches.push(Touch { index, resource, version, writes, spot });
            }
            Err(error) => errors.push(error),
        };
        match row.form {
            PassForm::Raster(w) | PassForm::Compute(w) | PassForm::Copy(w) => {
                for (index, access) in w.accesses.iter().enumerate() {
                    let (spot, when, writes) = named(access);
                    if errors.len() < MOST_ERRORS && on(when, errors) {
                        touch(index, spot, writes, errors);
                    }
                }
            }
            PassForm::Plugin(p) => {
                let slots = slots_of(&p.kind.value).unwrap_or_default();
                for (index, (slot, bound)) in p.slots.0.iter().enumerate() {
                    let known = slots.iter().find(|s| s.name == slot.value);
                    if let (Some(known), true) = (known, errors.len() < MOST_ERRORS) {
                        let writes = matches!(known.takes, Takes::Target | Takes::TargetBuffer);
                        touch(index, bound, writes, errors);
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
) -> Result<usize, FileReason> {
    if let Some(row) = on.get(name) {
        return Ok(*row);
    }
    let name_owned = name.to_owned();
    if let Some(when) = off.get(name) {
        let when = (*when).to_owned();
        return Err(FileReason::SwitchedOff { what, name: name_owned, when });
    }
    let mut names: Vec<_> = on.iter().map(|(name, row)| (*row, *name)).collect();
    names.sort_unstable();
    let names = || names.iter().map(|(_, name)| *name);
    Err(FileReason::Unknown {
        what,
        name: name_owned,
        near: nearest(name, names()).map(str::to_owned),
        known: names().take(9).map(str::to_owned).collect(),
    })
}
