//! What an executor keeps of earlier frames.

use super::Executor;
use crate::frame_key::FrameKey;
use framegraph::{Kind, Plan, ResourceId};

impl Executor {
    /// Becomes an executor of the next frame of `other`: sees histories as that left them and poisons as it does. What is
    /// written to a history here is what `other` overwrites in its next frame.
    pub(crate) fn borrow(&mut self, other: &Self) {
        self.histories = other.histories.clone();
        self.options.poison = other.options.poison;
    }

    /// The size in which an earlier image of a history was written, which may be another than that of `plan`; none for other
    /// resources, and for images that hold nothing of use.
    pub(crate) fn earlier_texels(&self, plan: &Plan, owner: &FrameKey, resource: ResourceId) -> Option<[u32; 2]> {
        let Kind::HistoryPrevious { current, age } = plan.graph().resources()[resource.index()].kind else {
            return None;
        };
        self.histories.texels(owner, plan.graph().resource_name(current), age)
    }

    /// Forgets the earlier frames of the histories of that full name, whichever [`Frame`](crate::Frame) they are of: after a
    /// camera cut.
    pub fn reset_history(&mut self, name: &str) {
        self.histories.reset(name);
    }

    /// Forgets the earlier frames of all histories: after a camera cut, what they show has nothing to do with the next
    /// frame. Its recorders find all of them not valid, as in a first frame.
    pub fn reset_histories(&mut self) {
        self.histories.reset_all();
    }
}
