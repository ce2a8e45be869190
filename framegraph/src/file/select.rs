//! Selects the enabled entries of a file and resolves their names.
//!
//! A reference consists of a name and a version. `"hdr"` is the newest version at that position of the file;
//! `"hdr@scene"` is the version written by pass `scene`, at any position. `"hdr@entry"` is the initial version, and
//! `"taa@-1"` is the image of history `taa` one frame ago.

use super::error::{FileError, FileErrors, FileReason};
use super::expand::Expanded;
use super::features::Features;
use super::form::{ExportForm, PassForm, ResourceForm};
use super::names::{Lookup, Names};
use super::selected::{Declared, Mention, PassRow, Selected, SlotsOf};
use super::spanned::{Source, Spanned};
use super::value::ValueReason;

/// Resolves all names and collects errors.
pub(super) fn select<'f>(
    source: Source<'_>,
    entries: &'f Expanded,
    features: &Features,
    slots_of: &SlotsOf<'_>,
    errors: &mut FileErrors,
) -> Selected<'f> {
    let mut out = Selected::default();
    let mut names = Names::default();
    resources(source, &entries.resources, features, &mut out, &mut names, errors);
    for pass in &entries.passes {
        let head = pass.head();
        if !on(source, features, head.when, errors) {
            names.passes_off.insert(&head.id.value, head.when.map_or("", |w| &w.value));
            continue;
        }
        let found = errors.count();
        if names.passes.insert(&head.id.value, out.passes.len()).is_some() {
            errors.push(|| duplicate(source, "pass", head.id));
        }
        let failed = errors.count() != found;
        out.passes.push(PassRow { id: head.id, form: pass, after: Vec::new(), mentions: Vec::new(), failed });
    }
    name_what_plugins_make(&mut out, &mut names, slots_of);
    out.lost.resize(out.resources.len(), false);
    let look_up = Lookup { source, names: &names, features };
    look_up.declared(&mut out.declared, errors);
    let Selected { passes, blind, .. } = &mut out;
    for row in passes {
        let found = errors.count();
        look_up.after(row, errors);
        look_up.mentions(row, slots_of, blind, errors);
        row.failed |= errors.count() != found;
    }
    for export in &entries.exports {
        let r = match export {
            ExportForm::Keep(r) | ExportForm::Readback(r) => r,
            ExportForm::Forward(form) => {
                if look_up.on(form.when.as_ref(), errors) {
                    let mut found = |at| look_up.reference(at, errors.is_full()).map_err(|e| errors.push(|| e)).ok();
                    if let (Some((of, _)), Some((to, _))) = (found(&form.of), found(&form.to)) {
                        out.forwards.push((form, of, to));
                    }
                }
                continue;
            }
        };
        if look_up.on(r.when.as_ref(), errors) {
            match look_up.reference(&r.of, errors.is_full()) {
                Ok((resource, version)) => {
                    let mention = Mention { index: 0, resource, version, writes: false, at: &r.of };
                    out.exports.push((export, mention));
                }
                Err(error) => errors.push(|| error),
            }
        }
    }
    out
}

fn on(source: Source<'_>, features: &Features, when: Option<&Spanned<String>>, errors: &mut FileErrors) -> bool {
    Lookup { source, names: &Names::default(), features }.on(when, errors)
}

fn duplicate(source: Source<'_>, what: &'static str, id: &Spanned<String>) -> FileError {
    source.error(id, FileReason::Duplicate { what, name: id.value.clone() })
}

/// Adds the enabled resources.
fn resources<'f>(
    source: Source<'_>,
    forms: &'f [ResourceForm],
    features: &Features,
    out: &mut Selected<'f>,
    names: &mut Names<'f>,
    errors: &mut FileErrors,
) {
    for resource in forms {
        let head = match resource {
            ResourceForm::Texture(t) => t.head(),
            ResourceForm::Buffer(b) => b.head(),
            ResourceForm::Previous(p) => {
                if on(source, features, p.when.as_ref(), errors) {
                    out.declared.push(Declared::Previous(usize::MAX, p.age, &p.of));
                }
                continue;
            }
            ResourceForm::MayAlias(a) => {
                if on(source, features, a.when.as_ref(), errors) {
                    out.declared.push(Declared::Alias([usize::MAX; 2], a));
                }
                continue;
            }
        };
        if !on(source, features, head.when, errors) {
            names.resources_off.insert(&head.id.value, head.when.map_or("", |w| &w.value));
            continue;
        }
        if head.id.value.is_empty() || head.id.value.contains('@') {
            errors.push(|| source.value(head.id, ValueReason::Id(head.id.value.clone())));
        }
        if names.resources.insert(&head.id.value, out.resources.len()).is_some() {
            errors.push(|| duplicate(source, "resource", head.id));
        }
        out.declared.push(Declared::Resource(out.resources.len(), resource));
        out.resources.push(&head.id.value);
    }
}

/// Adds the resources that plugins create: names bound to a target slot that no resource has.
///
/// An unknown slot counts as a target, because it may be misspelled. This avoids further errors in passes that use its
/// result.
fn name_what_plugins_make<'f>(out: &mut Selected<'f>, names: &mut Names<'f>, slots_of: &SlotsOf<'_>) {
    for row in &out.passes {
        let PassForm::Plugin(plugin) = row.form else {
            continue;
        };
        let slots = slots_of(&plugin.kind.value);
        for (slot, bound) in &plugin.slots.0 {
            let known = slots.and_then(|slots| slots.iter().find(|s| s.name == slot.value));
            let target = known.is_none_or(|slot| slot.ty.is_target());
            let id = bound.value.as_str();
            let free = !names.resources.contains_key(id) && !names.resources_off.contains_key(id);
            if target && free && !id.contains('@') && !id.is_empty() {
                names.resources.insert(id, out.resources.len());
                out.lost.resize(out.resources.len(), false);
                out.lost.push(known.is_none());
                out.resources.push(id);
            }
        }
    }
}
