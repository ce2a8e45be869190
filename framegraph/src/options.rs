//! What a compile is asked for beside the graph and the device: frame size, order, aliasing, and switches to find the
//! optimization that breaks a frame.

pub use crate::pack::Effort;
use crate::words::words;

/// In which order surviving passes run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Order {
    /// In the order in which they were declared.
    #[default]
    Declared,
    /// Few steps, then few bytes of memory, then few bytes between tile and memory, as far as schedules and moves of passes
    /// find them; never worse than declared.
    Optimized,
}

words! { Order: Declared "declared", Optimized "optimized" }

/// How transient resources share memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Alias {
    /// Not at all.
    Off,
    /// Resources of one shape share physical textures.
    #[default]
    Pool,
    /// Byte ranges of one heap are shared, whatever the shape; falls back to `Pool` where the device cannot place.
    Heap,
}

words! { Alias: Off "off", Pool "pool", Heap "heap" }

/// What a compile is asked for. Plans depend on nothing else than graph, caps and this: never on time or machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "files", serde(default, deny_unknown_fields))]
pub struct Options {
    /// Width and height of the frame in texels, which relative extents follow.
    pub frame: [u32; 2],
    /// In which order the passes that are kept run.
    pub order: Order,
    /// Sharing of memory.
    pub alias: Alias,
    /// How hard the heap is packed.
    pub effort: Effort,
    /// Steps of the exact search at most; a step looks at 64 array entries.
    pub budget_steps: u64,
    /// Remove passes whose results are not needed.
    pub cull: bool,
    /// Run consecutive passes as one step where that is sound.
    pub merge: bool,
    /// Make point-wise passes epilogues of their producer's shader where that is sound.
    pub inline: bool,
    /// Give attachments that live in one step no memory.
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
    /// The defaults for a frame of `width` × `height` texels.
    pub fn for_frame(width: u32, height: u32) -> Self {
        Self { frame: [width, height], ..Self::default() }
    }

    /// Everything switched off that changes what the user wrote: no culling, reordering, merging, inlining, memoryless
    /// attachments or aliasing. For finding the optimization that breaks a frame.
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
