//! Histories of an executor.

use super::Executor;
use crate::frame_key::FrameKey;
use framegraph::{Kind, Plan, ResourceId};

impl Executor {
    /// Copies histories and the poison option of `other`, to execute its next frame in its place. Images written here
    /// are those that `other` overwrites in its next frame.
    pub(crate) fn borrow(&mut self, other: &Self) {
        self.histories = other.histories.clone();
        self.options.poison = other.options.poison;
    }

    /// Returns the size of a previous image of a history, which may differ from the size in `plan`. `None` for other
    /// resources, and for images without valid contents.
    pub(crate) fn earlier_texels(&self, plan: &Plan, owner: &FrameKey, resource: ResourceId) -> Option<[u32; 2]> {
        let Kind::HistoryPrevious { current, age } = plan.graph().resources()[resource.index()].kind else {
            return None;
        };
        self.histories.texels(owner, plan.graph().resource_name(current), age)
    }

    /// Invalidates the history with this full name in all [`Frame`](crate::Frame)s, for example after a camera cut.
    pub fn reset_history(&mut self, name: &str) {
        self.histories.reset(name);
    }

    /// Invalidates all histories, for example after a camera cut. Recorders of the next frame find them invalid, as in
    /// the first frame.
    pub fn reset_histories(&mut self) {
        self.histories.reset_all();
    }
}
