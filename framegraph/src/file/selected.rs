//! The rows of what a file has switched on.

use super::form::{ExportForm, ForwardForm, PassForm, ResourceForm};
use super::slot::PluginSlot;
use super::spanned::Spanned;

/// Everything that is switched on.
#[derive(Debug, Default)]
pub(super) struct Selected<'f> {
    /// The ids of resources that passes can name: declared ones in the order of the file, then those that plugins make.
    pub(super) resources: Vec<&'f str>,
    /// Passes in the order of the file.
    pub(super) passes: Vec<PassRow<'f>>,
    /// Exports in the order of the file.
    pub(super) exports: Vec<(&'f ExportForm, Mention<'f>)>,
    /// Forwards in the order of the file, with what goes and where it goes.
    pub(super) forwards: Vec<(&'f ForwardForm, usize, usize)>,
    /// By resource: passes that are in error would have written it.
    pub(super) lost: Vec<bool>,
    /// A pass in error writes something that could not be found, so nobody knows what is lost.
    pub(super) blind: bool,
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

impl Selected<'_> {
    /// The pass is in error: what it writes is lost.
    pub(super) fn fail(&mut self, pass: usize) {
        let Self { passes, lost, .. } = self;
        passes[pass].failed = true;
        passes[pass].mentions.iter().filter(|m| m.writes).for_each(|m| lost[m.resource] = true);
    }
}

#[derive(Debug)]
pub(super) struct PassRow<'f> {
    pub(super) id: &'f Spanned<String>,
    pub(super) form: &'f PassForm,
    /// Rows of passes that must run before, as far as they are switched on.
    pub(super) after: Vec<usize>,
    /// What it names, in the order of its accesses or slots that are switched on.
    pub(super) mentions: Vec<Mention<'f>>,
    /// Something is wrong with it, or with what it needs: it is not declared.
    pub(super) failed: bool,
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

/// The slots of a kind of plugin.
pub(super) type SlotsOf<'r> = dyn Fn(&str) -> Option<&'r [PluginSlot]> + 'r;
