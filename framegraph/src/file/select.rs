//! What a file declares once its features are set: conditions evaluated, names looked up.
//!
//! A reference is a name and which version is meant: `"hdr"` is the newest one at that place of the file, `"hdr@scene"`
//! the one that pass `scene` wrote, wherever that pass stands, `"hdr@entry"` the contents before any pass wrote them, and
//! `"taa@-1"` the history `taa` one frame ago.

use super::error::{FileError, FileReason};
use super::features::Features;
use super::form::{ExportForm, GraphForm, PassForm, ResourceForm};
use super::names::{Lookup, Names};
use super::plugin::PluginSlot;
use super::spanned::{Source, Spanned};
use super::value::ValueFault;

/// Everything that is switched on.
#[derive(Debug, Default)]
pub(super) struct Selected<'f> {
    /// The ids of resources that passes can name: declared ones in the order of the file, then those that plugins make.
    pub(super) resources: Vec<&'f str>,
    /// Passes in the order of the file.
    pub(super) passes: Vec<PassRow<'f>>,
    /// Exports in the order of the file.
    pub(super) exports: Vec<(&'f ExportForm, Mention<'f>)>,
    /// The declared resources, and previous images among them, in the order of the file.
    pub(super) declared: Vec<Declared<'f>>,
}

/// What is declared before the passes.
#[derive(Clone, Copy, Debug)]
pub(super) enum Declared<'f> {
    /// A row of [`Selected::resources`].
    Resource(usize, &'f ResourceForm),
    /// The image of a history (a row of [`Selected::resources`]), that many frames ago.
    Previous(usize, u8, &'f Spanned<String>),
}

#[derive(Debug)]
pub(super) struct PassRow<'f> {
    pub(super) id: &'f Spanned<String>,
    pub(super) form: &'f PassForm,
    /// Rows of passes that must run before, as far as they are switched on.
    pub(super) after: Vec<usize>,
    /// What it names, in the order of its accesses or slots that are switched on.
    pub(super) mentions: Vec<Mention<'f>>,
}

/// One mention of a resource.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mention<'f> {
    /// Index of the access or slot within the pass's form; 0 for an export.
    pub(super) index: usize,
    /// A row of [`Selected::resources`].
    pub(super) resource: usize,
    pub(super) version: Wanted,
    pub(super) writes: bool,
    /// Where it stands.
    pub(super) at: &'f Spanned<String>,
}

/// Which version is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wanted {
    /// The newest one at that place of the file.
    Newest,
    /// The one that this pass wrote.
    By(usize),
    /// The contents on entry, before any pass wrote them.
    Entry,
    /// The image of that many frames ago.
    Previous(u8),
}

/// The word that means the contents on entry; no pass can be called so.
pub(super) const ENTRY: &str = "entry";

/// So many errors of a file are looked for: each costs a search for the name that was meant.
pub(super) const MOST_ERRORS: usize = 100;

/// The slots of a kind of plugin.
pub(super) type SlotsOf<'r> = dyn Fn(&str) -> Option<&'r [PluginSlot]> + 'r;

/// Looks everything up; what cannot be found goes to `errors`.
pub(super) fn select<'f>(
    source: Source<'_>,
    form: &'f GraphForm,
    features: &Features,
    slots_of: &SlotsOf<'_>,
    errors: &mut Vec<FileError>,
) -> Selected<'f> {
    let mut out = Selected::default();
    let mut names = Names::default();
    let mut on = |when: Option<&'f Spanned<String>>, errors: &mut Vec<FileError>| {
        features.holds(source, when).unwrap_or_else(|error| {
            errors.push(error);
            false
        })
    };
    let duplicate =
        |what, id: &Spanned<String>| source.error(id, FileReason::Duplicate { what, name: id.value.clone() });
    for resource in &form.resources {
        let head = match resource {
            ResourceForm::Texture(t) => t.head(),
            ResourceForm::Buffer(b) => b.head(),
            ResourceForm::Previous(p) => {
                if on(p.when.as_ref(), errors) {
                    out.declared.push(Declared::Previous(usize::MAX, p.age, &p.of));
                }
                continue;
            }
        };
        if !on(head.when, errors) {
            names.resources_off.insert(&head.id.value, head.when.map_or("", |w| &w.value));
            continue;
        }
        if head.id.value.is_empty() || head.id.value.contains('@') {
            errors.push(source.value(head.id, ValueFault::Id(head.id.value.clone())));
        }
        if names.resources.insert(&head.id.value, out.resources.len()).is_some() {
            errors.push(duplicate("resource", head.id));
        }
        out.declared.push(Declared::Resource(out.resources.len(), resource));
        out.resources.push(&head.id.value);
    }
    for pass in &form.passes {
        let head = pass.head();
        if !on(head.when, errors) {
            names.passes_off.insert(&head.id.value, head.when.map_or("", |w| &w.value));
            continue;
        }
        if names.passes.insert(&head.id.value, out.passes.len()).is_some() {
            errors.push(duplicate("pass", head.id));
        }
        out.passes.push(PassRow { id: head.id, form: pass, after: Vec::new(), mentions: Vec::new() });
    }
    name_what_plugins_make(&mut out, &mut names, slots_of);
    let look_up = Lookup { source, names: &names };
    look_up.previous(&mut out.declared, errors);
    for row in &mut out.passes {
        if errors.len() >= MOST_ERRORS {
            return out;
        }
        look_up.after(row, errors);
        look_up.mentions(row, slots_of, &mut on, errors);
    }
    for export in &form.exports {
        if errors.len() >= MOST_ERRORS {
            return out;
        }
        let (ExportForm::Keep(r) | ExportForm::Readback(r)) = export;
        if on(r.when.as_ref(), errors) {
            match look_up.reference(&r.of) {
                Ok((resource, version)) => {
                    let mention = Mention { index: 0, resource, version, writes: false, at: &r.of };
                    out.exports.push((export, mention));
                }
                Err(error) => errors.push(error),
            }
        }
    }
    out
}

/// A target slot bound to a name that nothing has makes a resource of that name.
fn name_what_plugins_make<'f>(out: &mut Selected<'f>, names: &mut Names<'f>, slots_of: &SlotsOf<'_>) {
    for row in &out.passes {
        let PassForm::Plugin(plugin) = row.form else {
            continue;
        };
        let slots = slots_of(&plugin.kind.value).unwrap_or_default();
        for (slot, bound) in &plugin.slots.0 {
            let target = slots.iter().any(|s| s.name == slot.value && s.takes.is_target());
            let id = bound.value.as_str();
            let free = !names.resources.contains_key(id) && !names.resources_off.contains_key(id);
            if target && free && !id.contains('@') && !id.is_empty() {
                names.resources.insert(id, out.resources.len());
                out.resources.push(id);
            }
        }
    }
}
