//! Errors of the executor.

use ash::vk;
use std::fmt;

/// Error of preparing or executing a plan.
pub enum Error {
    /// A Vulkan call failed.
    Vulkan {
        /// Purpose of the call.
        of: &'static str,
        /// Result code of the call.
        result: vk::Result,
    },
    /// No memory type fits all resources of one heap or slot.
    MemoryType {
        /// Name of the first resource that does not fit.
        resource: String,
    },
    /// The driver needs more memory for a resource than the plan reserves. Compile with [`Gpu::compile`](crate::Gpu::compile).
    Size {
        /// Name of the resource.
        resource: String,
        /// Bytes that the driver needs, from the offset of the resource.
        needed: u64,
        /// Bytes that the plan reserves.
        reserved: u64,
    },
    /// The driver needs a larger alignment than the plan used. Compile with [`Gpu::compile`](crate::Gpu::compile).
    Alignment {
        /// Name of the resource.
        resource: String,
        /// Alignment in bytes that the driver needs.
        needed: u64,
        /// Offset in bytes that the plan chose.
        offset: u64,
    },
    /// The device does not support the format with the planned usage.
    Format {
        /// Name of the resource.
        resource: String,
        /// Name of the format.
        format: String,
    },
    /// An import is not bound.
    Import {
        /// Name of the import.
        resource: String,
    },
    /// Two imports are bound to one image or buffer, and a pass writes one of them. Also two imports of one image that
    /// are used in several layouts or on several queues.
    Shared {
        /// Name of the first import.
        resource: String,
        /// Name of the second import.
        other: String,
        /// True for a buffer, false for an image.
        is_buffer: bool,
    },
    /// The schedule uses more queues than the device has.
    Queues {
        /// Number of queues of the schedule.
        wanted: usize,
        /// Number of queues given to [`Gpu::new`](crate::Gpu::new).
        given: usize,
    },
    /// The plan is compiled for more than the device has.
    Caps {
        /// Field of [`Caps`](framegraph::Caps).
        capability: &'static str,
        /// Value of the plan; 0 and 1 for flags.
        wanted: String,
        /// Value of the device.
        given: String,
    },
    /// A pass draws more layers than the device has views
    /// ([`ExecutorOptions::multiview`](crate::ExecutorOptions::multiview)).
    Views {
        /// Name of the first pass of the step.
        pass: String,
        /// Number of layers.
        wanted: u32,
        /// Number of views (`maxMultiviewViewCount`, at most 32).
        limit: u32,
    },
    /// A command needs a resource on a queue that does not own it.
    Owner {
        /// Name of the resource.
        resource: String,
        /// Index of the queue that uses it.
        queue: usize,
        /// Index of the queue that owns it.
        owner: usize,
    },
    /// The plan has no barriers.
    NoBarriers,
    /// The plan merges passes into shaders, which recorders of this crate cannot do.
    Inlined,
    /// The frame has not been prepared, or the plan is another one.
    NotPrepared,
    /// A token or access belongs to another graph, or its resource has no memory.
    Access {
        /// Name of the pass whose recorder asked.
        pass: String,
    },
    /// A recorder failed.
    Record {
        /// Name of the pass.
        pass: String,
        /// Error of the recorder.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The graph does not compile for the device.
    Compile(framegraph::CompileErrors),
}

impl Error {
    /// Returns a function that turns a result code into an error.
    pub(crate) fn of(of: &'static str) -> impl Fn(vk::Result) -> Self {
        move |result| Self::Vulkan { of, result }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Vulkan { of, result } => write!(f, "{of}: the Vulkan call failed: {result}"),
            Self::MemoryType { resource } => {
                write!(f, "{resource}: no memory type fits all resources in its memory; compile without aliasing")
            }
            Self::Size { resource, needed, reserved } => write!(
                f,
                "{resource}: the driver needs {needed} bytes and the plan reserves {reserved}; compile with `Gpu::compile`"
            ),
            Self::Alignment { resource, needed, offset } => write!(
                f,
                "{resource}: offset {offset} is not a multiple of the driver's {needed} bytes; compile with `Gpu::compile`"
            ),
            Self::Format { resource, format } => {
                write!(f, "{resource}: the device does not support {format} with this usage; use another format")
            }
            Self::Import { resource } => write!(f, "{resource}: the import is not bound; add it to `Imports`"),
            Self::Shared { resource, other, is_buffer: false } => {
                write!(f, "{resource}: it is bound to the image of the import {other}; import it once")
            }
            Self::Shared { resource, other, is_buffer: true } => write!(
                f,
                "{resource}: it is bound to the buffer of the import {other}; declare `Graph::may_alias_buffer`, or \
                 import it once"
            ),
            Self::Queues { wanted, given } => {
                write!(f, "schedule: it uses {wanted} queues and the device has {given}; schedule for fewer queues")
            }
            Self::Caps { capability, wanted, given } => write!(
                f,
                "plan: it is compiled for `{capability}` {wanted} and the device has {given}; compile it for `Gpu::caps`"
            ),
            Self::Views { pass, wanted, limit } => write!(
                f,
                "{pass}: it draws {wanted} layers and the device has {limit} views; draw fewer or disable `multiview`"
            ),
            Self::Owner { resource, queue, owner } => write!(
                f,
                "{resource}: queue {queue} uses it while queue {owner} owns it; add an ownership transfer to the commands"
            ),
            Self::NoBarriers => {
                f.write_str("plan: it has no barriers; compile it for capabilities with `explicit_barriers`")
            }
            Self::Inlined => f.write_str("plan: it inlines passes; compile it for capabilities without `inline`"),
            Self::NotPrepared => f.write_str("executor: no plan is prepared; call `prepare` first"),
            Self::Access { pass } => {
                write!(
                    f,
                    "{pass}: the access belongs to another graph or has no memory; use tokens of this declaration"
                )
            }
            Self::Record { pass, source } => write!(f, "{pass}: the recorder failed: {source}"),
            Self::Compile(errors) => errors.fmt(f),
        }
    }
}

impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Record { source, .. } => Some(&**source),
            Self::Compile(errors) => Some(errors),
            _ => None,
        }
    }
}

impl From<framegraph::CompileErrors> for Error {
    fn from(errors: framegraph::CompileErrors) -> Self {
        Self::Compile(errors)
    }
}
