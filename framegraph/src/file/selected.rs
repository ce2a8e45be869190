//! The enabled entries of a file.

use super::form::{AliasForm, ExportForm, ForwardForm, PassForm, ResourceForm};
use super::slot::PluginSlot;
use super::spanned::Spanned;

/// Everything that is enabled.
#[derive(Debug, Default)]
pub(super) struct Selected<'f> {
    /// Ids of resources: declared ones in the order of the file, then those created by plugins.
    pub(super) resources: Vec<&'f str>,
    /// Passes in the order of the file.
    pub(super) passes: Vec<PassRow<'f>>,
    /// Exports in the order of the file.
    pub(super) exports: Vec<(&'f ExportForm, Mention<'f>)>,
    /// Forwards in the order of the file, with source and target.
    pub(super) forwards: Vec<(&'f ForwardForm, usize, usize)>,
    /// By resource: an invalid pass would have written it.
    pub(super) lost: Vec<bool>,
    /// An invalid pass writes an unknown resource, so the set of lost resources is incomplete.
    pub(super) blind: bool,
    /// Declared resources and previous images, in the order of the file.
    pub(super) declared: Vec<Declared<'f>>,
}

/// A declaration before the passes.
#[derive(Clone, Copy, Debug)]
pub(super) enum Declared<'f> {
    /// A row of [`Selected::resources`].
    Resource(usize, &'f ResourceForm),
    /// The image of a history, a row of [`Selected::resources`], from that many frames ago.
    Previous(usize, u8, &'f Spanned<String>),
    /// Two rows of [`Selected::resources`] that may alias.
    Alias([usize; 2], &'f AliasForm),
}

impl Selected<'_> {
    /// Marks a pass as invalid, and its results as lost.
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
    /// Rows of enabled passes that must run before.
    pub(super) after: Vec<usize>,
    /// Resources it refers to, in the order of its enabled accesses or slots.
    pub(super) mentions: Vec<Mention<'f>>,
    /// The pass or one of its inputs is invalid, so it is not declared.
    pub(super) failed: bool,
}

/// A reference to a resource.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mention<'f> {
    /// Index of the access or slot within the pass's form; 0 for an export.
    pub(super) index: usize,
    /// A row of [`Selected::resources`].
    pub(super) resource: usize,
    pub(super) version: Wanted,
    pub(super) writes: bool,
    /// Position in the file.
    pub(super) at: &'f Spanned<String>,
}

/// The version that a reference requests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wanted {
    /// The newest version at that position of the file.
    Newest,
    /// The version written by this pass.
    By(usize),
    /// The initial version.
    Entry,
    /// The image from that many frames ago.
    Previous(u8),
}

/// The reserved word for the initial version; not allowed as the name of a pass.
pub(super) const ENTRY: &str = "entry";

/// Returns the slots of a kind of plugin.
pub(super) type SlotsOf<'r> = dyn Fn(&str) -> Option<&'r [PluginSlot]> + 'r;
