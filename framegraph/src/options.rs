//! Options of a compilation: frame size, pass order, aliasing, and switches that disable single optimizations.

use crate::enum_names::enum_names;
pub use crate::pack::Effort;

/// Order in which the kept passes run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Order {
    /// Declaration order.
    #[default]
    Declared,
    /// The best order that the scheduler finds: fewest steps, then least memory, then least traffic between tile and
    /// memory. Never worse than declaration order.
    Optimized,
}

enum_names! { Order: Declared "declared", Optimized "optimized" }

/// Memory sharing between transient resources.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Alias {
    /// No sharing.
    Off,
    /// Resources of equal shape share physical textures and buffers.
    #[default]
    Pool,
    /// Resources share byte ranges of one heap, whatever their shape. Falls back to `Pool` if the device does not
    /// support placed resources.
    Heap,
}

enum_names! { Alias: Off "off", Pool "pool", Heap "heap" }

/// Options of a compilation. A plan depends only on the graph, the caps and these options.
///
/// ```
/// use framegraph::{Alias, Options, Order};
///
/// let options = Options { order: Order::Optimized, alias: Alias::Heap, ..Options::for_frame(1280, 720) };
/// assert_eq!(options.frame, [1280, 720]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "files", serde(default, deny_unknown_fields))]
pub struct Options {
    /// Width and height of the frame in texels. Relative extents refer to it.
    pub frame: [u32; 2],
    /// Order in which the kept passes run.
    pub order: Order,
    /// Memory sharing between transient resources.
    pub alias: Alias,
    /// Effort spent on packing the heap.
    pub effort: Effort,
    /// Maximum number of steps of the exact packing search; a step examines 64 array entries.
    pub budget_steps: u64,
    /// Removes passes whose results are not used.
    pub cull: bool,
    /// Merges consecutive passes into one step where possible.
    pub merge: bool,
    /// Turns point-wise passes into epilogues of their producer's shader where possible.
    pub inline: bool,
    /// Allocates no memory for attachments that are used in a single step.
    pub memoryless: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            frame: [1920, 1080],
            order: Order::Declared,
            alias: Alias::Pool,
            effort: Effort::Exact,
            budget_steps: 1 << 18,
            cull: true,
            merge: true,
            inline: true,
            memoryless: true,
        }
    }
}

impl Options {
    /// Returns the default options for a frame of `width` × `height` texels.
    pub fn for_frame(width: u32, height: u32) -> Self {
        Self { frame: [width, height], ..Self::default() }
    }

    /// Disables culling, reordering, merging, inlining, memoryless attachments and aliasing. Useful for finding the
    /// optimization that breaks a frame.
    pub fn immediate(self) -> Self {
        Self {
            order: Order::Declared,
            alias: Alias::Off,
            cull: false,
            merge: false,
            inline: false,
            memoryless: false,
            ..self
        }
    }
}
