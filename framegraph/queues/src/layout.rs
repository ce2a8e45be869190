//! The queues of a device.

use framegraph::{Caps, PassKind};
use std::fmt;

/// A queue, by its index in the layout.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct QueueId(pub u8);

impl QueueId {
    /// The first queue, which runs everything.
    pub const MAIN: Self = Self(0);

    /// Index of the queue.
    #[must_use]
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

/// A queue and its capabilities.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Queue {
    /// Name in dumps.
    pub name: String,
    /// Runs render passes.
    pub raster: bool,
    /// Runs compute passes.
    pub compute: bool,
    /// Runs copies.
    pub copy: bool,
}

impl Queue {
    /// Returns `true` if the queue runs steps of this kind.
    #[must_use]
    pub const fn runs(&self, kind: PassKind) -> bool {
        match kind {
            PassKind::Raster => self.raster,
            PassKind::Compute => self.compute,
            PassKind::Copy => self.copy,
        }
    }
}

/// The queues of a device. The first one runs everything.
///
/// ```
/// use framegraph_queues::{QueueId, QueueLayout};
///
/// let layout = QueueLayout::async_compute();
/// assert_eq!(layout.queues.len(), 2);
/// assert!(layout.queues[QueueId::MAIN.index()].raster);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct QueueLayout {
    /// The queues, at most 255.
    pub queues: Vec<Queue>,
    /// Delay in microseconds from the end of a step to the start of a dependent step on another queue, compared with
    /// the same queue.
    pub semaphore_us: f64,
}

impl QueueLayout {
    /// Semaphore delay of named layouts in microseconds; about what desktop drivers are reported to need.
    pub const SEMAPHORE_US: f64 = 10.0;
    /// Names of layouts, as used by command line options.
    pub const NAMES: [&'static str; 3] = ["one", "async-compute", "async-compute-and-copy"];

    fn of(names: &[&str]) -> Self {
        let queue = |name: &&str| Queue {
            name: (*name).to_owned(),
            raster: *name == "graphics",
            compute: *name != "copy",
            copy: true,
        };
        Self { queues: names.iter().map(queue).collect(), semaphore_us: Self::SEMAPHORE_US }
    }

    /// Returns a layout with one queue, as in wgpu.
    #[must_use]
    pub fn one() -> Self {
        Self::of(&["graphics"])
    }

    /// Returns a layout with an additional queue for compute and copies.
    #[must_use]
    pub fn async_compute() -> Self {
        Self::of(&["graphics", "compute"])
    }

    /// Returns a layout with additional queues for compute and for copies.
    #[must_use]
    pub fn async_compute_and_copy() -> Self {
        Self::of(&["graphics", "compute", "copy"])
    }

    /// Returns the layout of a device.
    #[must_use]
    pub fn of_device(caps: &Caps) -> Self {
        match (caps.compute_queue, caps.copy_queue) {
            (false, false) => Self::one(),
            (true, false) => Self::async_compute(),
            (false, true) => Self::of(&["graphics", "copy"]),
            (true, true) => Self::async_compute_and_copy(),
        }
    }

    /// Returns the layout with this name ([`QueueLayout::NAMES`]).
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "one" => Some(Self::one()),
            "async-compute" => Some(Self::async_compute()),
            "async-compute-and-copy" => Some(Self::async_compute_and_copy()),
            _ => None,
        }
    }

    /// The ids of the queues.
    pub fn ids(&self) -> impl DoubleEndedIterator<Item = QueueId> + ExactSizeIterator + use<> {
        (0..self.queues.len()).map(|index| QueueId(index as u8))
    }
}

impl fmt::Display for QueueLayout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<_> =
            self.queues.iter().map(|queue| framegraph::sanitize::escape_controls(&queue.name)).collect();
        write!(f, "{}, {} µs per semaphore", names.join(", "), self.semaphore_us)
    }
}
