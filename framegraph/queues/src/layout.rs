//! The queues of a device.

use framegraph::{Caps, PassKind};
use std::fmt;

/// A queue by its place in the layout.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct QueueId(pub u8);

impl QueueId {
    /// The queue that does everything.
    pub const MAIN: Self = Self(0);

    /// Its place.
    #[must_use]
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

/// A queue, and what it can run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Queue {
    /// What dumps call it.
    pub name: String,
    /// It runs render passes.
    pub raster: bool,
    /// It runs compute passes.
    pub compute: bool,
    /// It runs copies.
    pub copy: bool,
}

impl Queue {
    /// Whether it runs steps of this kind.
    #[must_use]
    pub const fn runs(&self, kind: PassKind) -> bool {
        match kind {
            PassKind::Raster => self.raster,
            PassKind::Compute => self.compute,
            PassKind::Copy => self.copy,
        }
    }
}

/// The queues of a device, the first of which runs everything.
#[derive(Clone, Debug, PartialEq)]
pub struct QueueLayout {
    /// The queues, at most 255.
    pub queues: Vec<Queue>,
    /// Microseconds from the end of a step on one queue to the begin of one on another that waits for it, beyond what one
    /// queue takes from step to step.
    pub semaphore_us: f64,
}

impl QueueLayout {
    /// What layouts by name take for a semaphore: some ten microseconds are what drivers on desktops are reported to need.
    pub const SEMAPHORE_US: f64 = 10.0;
    /// The layouts by name, as options of programs have them.
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

    /// One queue, as wgpu has.
    #[must_use]
    pub fn one() -> Self {
        Self::of(&["graphics"])
    }

    /// A queue for compute and copies beside the first.
    #[must_use]
    pub fn async_compute() -> Self {
        Self::of(&["graphics", "compute"])
    }

    /// A queue for compute and one for copies beside the first.
    #[must_use]
    pub fn async_compute_and_copy() -> Self {
        Self::of(&["graphics", "compute", "copy"])
    }

    /// What the device says that it has.
    #[must_use]
    pub fn of_device(caps: &Caps) -> Self {
        match (caps.compute_queue, caps.copy_queue) {
            (false, false) => Self::one(),
            (true, false) => Self::async_compute(),
            (false, true) => Self::of(&["graphics", "copy"]),
            (true, true) => Self::async_compute_and_copy(),
        }
    }

    /// The layout of that name ([`QueueLayout::NAMES`]).
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
        let names: Vec<_> = self.queues.iter().map(|queue| framegraph::plain::plain(&queue.name)).collect();
        write!(f, "{}, {} µs a semaphore", names.join(", "), self.semaphore_us)
    }
}
