//! Cached attachments of a step. They stay valid until the plan or one of the attached textures changes.

use crate::execute::attached::Attached;
use crate::execute::targets::Targets;
use framegraph::Counts;

/// Cached state of a step. See the [module documentation](self).
#[derive(Debug, Default)]
pub(crate) struct CachedStep {
    /// Compilation number of the plan; 0 before the first use.
    pub(crate) compilation: u64,
    /// Stamps of the attached textures, if `attached` is valid.
    pub(crate) stamps: Vec<u64>,
    /// True if `attached` is valid while the textures have these stamps.
    pub(crate) valid: bool,
    pub(crate) targets: Targets,
    pub(crate) attached: Attached,
    /// Operations that executing the step adds to the counts.
    pub(crate) counts: Counts,
    /// Number of planes filled by poisoning.
    pub(crate) poisoned: u32,
    /// True if a pass declares a resource as cleared without attaching it.
    pub(crate) clears_stored: bool,
}

impl CachedStep {
    /// Releases the attached views.
    pub(crate) fn release_views(&mut self) {
        self.valid = false;
        self.attached.clear();
    }

    /// Ends the step. Releases views of surface textures, which are imported for one frame only.
    pub(crate) fn close(&mut self) {
        if !self.valid {
            self.attached.clear();
        }
    }
}
