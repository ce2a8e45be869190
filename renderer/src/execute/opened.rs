//! A step as it was opened last: what it attaches stays as it is while its plan and the textures behind its attachments do.

use crate::execute::attached::Attached;
use crate::execute::targets::Targets;
use framegraph::Counts;

/// See the [module](self).
#[derive(Debug, Default)]
pub(crate) struct Opened {
    /// The compilation of the plan; 0 before the first.
    pub(crate) compilation: u64,
    /// Of the textures that are attached; none where `attached` is not of them.
    pub(crate) stamps: Option<Vec<u64>>,
    pub(crate) targets: Targets,
    pub(crate) attached: Attached,
    /// What opening it adds to the counts of what was executed.
    pub(crate) counts: Counts,
    /// Planes that are filled because their contents may be anything.
    pub(crate) poisoned: u32,
    /// A pass declares something as cleared that it does not attach.
    pub(crate) clears_stored: bool,
}

impl Opened {
    /// Lets go of the attached views.
    pub(crate) fn let_go(&mut self) {
        self.stamps = None;
        self.attached.clear();
    }

    /// Ends the step: views of textures that are lent for this frame alone are let go of.
    pub(crate) fn close(&mut self) {
        if self.stamps.is_none() {
            self.attached.clear();
        }
    }
}
