//! What-if: changed conditions of a plan, such as device, size, order, memory aliasing and features.

use crate::plan_data::PlanData;
use framegraph::{Alias, Caps, Options, Order};

/// Conditions of a plan. `None` keeps the frame's own value.
#[derive(Clone, Debug, PartialEq)]
pub struct WhatIf {
    /// Device.
    pub caps: Caps,
    /// Width and height of the frame in texels.
    pub frame: Option<[u32; 2]>,
    /// Order of passes.
    pub order: Order,
    /// Memory aliasing.
    pub alias: Alias,
    /// Culls unneeded passes.
    pub cull: bool,
    /// Merges passes into steps.
    pub merge: bool,
    /// Inlines point-wise passes into the shader of their producer.
    pub inline: bool,
    /// Makes attachments of a single step memoryless.
    pub memoryless: bool,
    /// Features of the frame with their state.
    pub features: Vec<(String, bool)>,
}

impl WhatIf {
    /// Returns the default what-if for a device.
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

    /// Returns the conditions of a plan that was compiled for a device with `options`, without features.
    pub fn of(caps: Caps, options: &Options) -> Self {
        let Options { frame, order, alias, cull, merge, inline, memoryless, .. } = *options;
        Self { caps, frame: Some(frame), order, alias, cull, merge, inline, memoryless, features: Vec::new() }
    }

    /// Returns the options of a plan under these conditions. `own` is the frame's own value of everything else.
    #[must_use]
    pub fn options(&self, own: Options) -> Options {
        let Self { order, alias, cull, merge, inline, memoryless, .. } = *self;
        let frame = self.frame.unwrap_or(own.frame);
        Options { frame, order, alias, cull, merge, inline, memoryless, ..own }
    }

    /// Applies the changes from `was` to `self` onto `base`.
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

/// Common frame sizes by name, in texels.
pub const SIZES: [(&str, [u32; 2]); 6] = [
    ("720p", [1280, 720]),
    ("1080p", [1920, 1080]),
    ("1440p", [2560, 1440]),
    ("4K", [3840, 2160]),
    ("5K", [5120, 2880]),
    ("8K", [7680, 4320]),
];

/// Source of plans: a graph file, or the frame of an engine. Plans are compiled on a separate thread.
pub trait Planner: Send + Sync {
    /// Returns the name of the frame: a path or a description.
    fn name(&self) -> &str;

    /// Returns the features with their default state.
    fn features(&self) -> Vec<(String, bool)>;

    /// Compiles a plan.
    ///
    /// # Errors
    /// All errors of the frame or of the what-if, one line each.
    fn plan(&self, what_if: &WhatIf) -> Result<PlanData, String>;
}
