//! What a file declares once its features are set: conditions evaluated, names looked up.
//!
//! A reference is a name and which version is meant: `"hdr"` is the newest one at that place of the file, `"hdr@scene"`
//! the one that pass `scene` wrote, wherever that pass stands, `"hdr@entry"` the contents before any pass wrote them, and
//! `"taa@-1"` the history `taa` one frame ago.

use super::error::{FileError, FileReason};
use super::features::Features;
use super::form::{AccessForm, ExportForm, GraphForm, PassForm, ResourceForm};
use super::names::{Lookup, Names};
use super::plugin::{PluginSlot, Takes};
use super::spot::{Source, Spot};

/// Everything that is switched on.
#[derive(Debug, Default)]
pub(super) struct Selected<'f> {
    /// Resources that passes can name: declared ones in the order of the file, then those that plugins make.
    pub(super) resources: Vec<ResourceRow<'f>>,
    /// Passes in the order of the file.
    pub(super) passes: Vec<PassRow<'f>>,
    /// Exports in the order of the file.
    pub(super) exports: Vec<(&'f ExportForm, Touch<'f>)>,
    /// Positions of the declared resources in `resources`, and of previous images among them, in the order of the file.
    pub(super) declared: Vec<Declared<'f>>,
}

/// What is declared before the passes.
#[derive(Clone, Copy, Debug)]
pub(super) enum Declared<'f> {
    /// A row of [`Selected::resources`].
    Resource(usize, &'f ResourceForm),
    /// The image of a history (a row of [`Selected::resources`]), that many frames ago.
    Previous(usize, u8, &'f Spot<String>),
}

#[derive(Debug)]
pub(super) struct ResourceRow<'f> {
    pub(super) id: &'f str,
}

#[derive(Debug)]
pub(super) struct PassRow<'f> {
    pub(super) id: &'f str,
    pub(super) spot: &'f Spot<String>,
    pub(super) form: &'f PassForm,
    /// Rows of passes that must run before, as far as they are switched on.
    pub(super) after: Vec<usize>,
    /// What it names, in the order of its accesses or slots that are switched on.
    pub(super) touches: Vec<Touch<'f>>,
}

/// One mention of a resource.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch<'f> {
    /// Index of the access or slot within the pass's form; 0 for an export.
    pub(super) index: usize,
    pub(super) resource: usize,
    pub(super) version: Wanted,
    pub(super) writes: bool,
    pub(super) spot: &'f Spot<String>,
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
    let mut on = |when: Option<&'f Spot<String>>, errors: &mut Vec<FileError>| {
        features.holds(source, when).unwrap_or_else(|error| {
            errors.push(error);
            false
        })
    };
    for resource in &form.resources {
        let (spot, when) = match resource {
            ResourceForm::Texture(t) => (t.id.as_ref().unwrap_or(&t.name), t.when.as_ref()),
            ResourceForm::Buffer(b) => (b.id.as_ref().unwrap_or(&b.name), b.when.as_ref()),
            ResourceForm::Previous(p) => {
                if on(p.when.as_ref(), errors) {
                    out.declared.push(Declared::Previous(usize::MAX, p.age, &p.of));
                }
                continue;
            }
        };
        if !on(when, errors) {
            names.resources_off.insert(&spot.value, when.map_or("", |w| &w.value));
            continue;
        }
        check_id(source, spot, errors);
        if names.resources.insert(&spot.value, out.resources.len()).is_some() {
            errors.push(duplicate(source, "resource", spot));
        }
        out.declared.push(Declared::Resource(out.resources.len(), resource));
        out.resources.push(ResourceRow { id: &spot.value });
    }
    for pass in &form.passes {
        let (spot, when) = match pass {
            PassForm::Raster(w) | PassForm::Compute(w) | PassForm::Copy(w) => {
                (w.id.as_ref().unwrap_or(&w.name), w.when.as_ref())
            }
            PassForm::Plugin(p) => (p.id.as_ref().unwrap_or(&p.name), p.when.as_ref()),
        };
        if !on(when, errors) {
            names.passes_off.insert(&spot.value, when.map_or("", |w| &w.value));
            continue;
        }
        if names.passes.insert(&spot.value, out.passes.len()).is_some() {
            errors.push(duplicate(source, "pass", spot));
        }
        let row = PassRow { id: &spot.value, spot, form: pass, after: Vec::new(), touches: Vec::new() };
        out.passes.push(row);
    }
    name_what_plugins_make(&mut out, &mut names, slots_of);
    let look_up = Lookup { source, names: &names };
    look_up.previous(&mut out.declared, errors);
    for row in &mut out.passes {
        if errors.len() >= MOST_ERRORS {
            return out;
        }
        look_up.after(row, errors);
        look_up.touches(row, slots_of, &mut on, errors);
    }
    for export in &form.exports {
        if errors.len() >= MOST_ERRORS {
            return out;
        }
        let (ExportForm::Keep(r) | ExportForm::Readback(r)) = export;
        if on(r.when.as_ref(), errors) {
            match look_up.reference(&r.of) {
                Ok((resource, version)) => {
                    let touch = Touch { index: 0, resource, version, writes: false, spot: &r.of };
                    out.exports.push((export, touch));
                }
                Err(error) => errors.push(error),
            }
        }
    }
    out
}

fn check_id(source: Source<'_>, spot: &Spot<String>, errors: &mut Vec<FileError>) {
    if spot.value.is_empty() || spot.value.contains('@') {
        let reason = FileReason::Value {
            detail: format!("`{}` cannot be named by passes", spot.value),
            hint: "give it an `id` that is not empty and has no `@`".into(),
        };
        errors.push(source.error(spot, reason));
    }
}

fn duplicate(source: Source<'_>, what: &'static str, spot: &Spot<String>) -> FileError {
    let name = spot.value.clone();
    source.error(spot, FileReason::Duplicate { what, name })
}

/// A target slot bound to a name that nothing has makes a resource of that name.
fn name_what_plugins_make<'f>(out: &mut Selected<'f>, names: &mut Names<'f>, slots_of: &SlotsOf<'_>) {
    for row in &out.passes {
        let PassForm::Plugin(plugin) = row.form else {
            continue;
        };
        let slots = slots_of(&plugin.kind.value).unwrap_or_default();
        for (slot, bound) in &plugin.slots.0 {
            let target =
                slots.iter().any(|s| s.name == slot.value && matches!(s.takes, Takes::Target | Takes::TargetBuffer));
            let id = bound.value.as_str();
            let free = !names.resources.contains_key(id) && !names.resources_off.contains_key(id);
            if target && free && !id.contains('@') && !id.is_empty() {
                names.resources.insert(id, out.resources.len());
                out.resources.push(ResourceRow { id });
            }
        }
    }
}

/// What an access names, its condition, and whether it writes.
pub(super) fn named(access: &AccessForm) -> (&Spot<String>, Option<&Spot<String>>, bool) {
    use AccessForm as A;
    match access {
        A::Color(c) => (&c.to, c.when.as_ref(), true),
        A::Resolve(r) => (&r.to, r.when.as_ref(), true),
        A::Depth(w) | A::StorageWrite(w) | A::CopyTarget(w) => (&w.to, w.when.as_ref(), true),
        A::DepthReadOnly(r)
        | A::SamePixel(r)
        | A::Sampled(r)
        | A::StorageRead(r)
        | A::Uniform(r)
        | A::Vertex(r)
        | A::Index(r)
        | A::Indirect(r)
        | A::CopySource(r) => (&r.of, r.when.as_ref(), false),
    }
}
