//! What a plan is asked for otherwise than it was made: another device, size, order, sharing of memory, other features.

use crate::plan_data::PlanData;
use framegraph::{Alias, Caps, Order};

/// The questions. `None` leaves what the frame itself says.
#[derive(Clone, Debug, PartialEq)]
pub struct WhatIf {
    /// The device.
    pub caps: Caps,
    /// Width and height of the frame in texels.
    pub frame: Option<[u32; 2]>,
    /// In which order passes run.
    pub order: Order,
    /// How memory is shared.
    pub alias: Alias,
    /// Remove what is not needed.
    pub cull: bool,
    /// Put passes into one step.
    pub merge: bool,
    /// Make point-wise passes the end of another's shader.
    pub inline: bool,
    /// Give attachments of one step no memory.
    pub memoryless: bool,
    /// Features of the frame, each with its setting.
    pub features: Vec<(String, bool)>,
}

impl WhatIf {
    /// For a device, all else as `plan` does it by default.
    pub fn on(caps: Caps) -> Self {
        Self {
            caps,
            frame: None,
            order: Order::Declared,
            alias: Alias::Heap,
            cull: true,
            merge: true,
            inline: true,
            memoryless: true,
            features: Vec::new(),
        }
    }
}

impl WhatIf {
    /// What is asked otherwise than `was`, asked of `base`.
    #[must_use]
    pub fn moved(&self, was: &Self, base: &Self) -> Self {
        fn of<T: Clone + PartialEq>(asked: &T, was: &T, base: &T) -> T {
            if asked == was { base.clone() } else { asked.clone() }
        }
        Self {
            caps: of(&self.caps, &was.caps, &base.caps),
            frame: of(&self.frame, &was.frame, &base.frame),
            order: of(&self.order, &was.order, &base.order),
            alias: of(&self.alias, &was.alias, &base.alias),
            cull: of(&self.cull, &was.cull, &base.cull),
            merge: of(&self.merge, &was.merge, &base.merge),
            inline: of(&self.inline, &was.inline, &base.inline),
            memoryless: of(&self.memoryless, &was.memoryless, &base.memoryless),
            features: of(&self.features, &was.features, &base.features),
        }
    }
}

/// Common sizes of a frame, by name, in texels.
pub const SIZES: [(&str, [u32; 2]); 6] = [
    ("720p", [1280, 720]),
    ("1080p", [1920, 1080]),
    ("1440p", [2560, 1440]),
    ("4K", [3840, 2160]),
    ("5K", [5120, 2880]),
    ("8K", [7680, 4320]),
];

/// Who can plan the frame anew: a graph file here, an engine's own frame elsewhere. Planning goes on a thread of its own.
pub trait Planner: Send + Sync {
    /// What the frame is called: a path, or a name.
    fn name(&self) -> &str;

    /// The features that can be switched, with what they are by default.
    fn features(&self) -> Vec<(String, bool)>;

    /// Plans.
    ///
    /// # Errors
    /// What is wrong with the frame, or with what is asked of it: a line each.
    fn plan(&self, what_if: &WhatIf) -> Result<PlanData, String>;
}
