//! Errors of the device as values: lost devices, exhausted memory and refused calls become errors, never panics.
//!
//! wgpu reports in three ways: error scopes (per thread), a handler for what no scope caught, and a callback when the
//! device is lost. [`DeviceErrors`] collects the last two for a device that this crate opened; [`ErrorScopes`] wraps a
//! piece of work in the first, [`Watch`] a part of a frame in what costs least. An engine that owns its device keeps its own handlers and forwards losses with
//! [`DeviceErrors::report_lost`].

use std::cell::Cell;
use std::sync::Mutex;
use wgpu::{Device, ErrorFilter, ErrorScopeGuard};

thread_local! {
    /// [`ErrorScopes`] that are open on this thread.
    static OPEN: Cell<u32> = const { Cell::new(0) };
    /// What a [`Watch`] of this thread does.
    static DOING: Cell<Option<&'static str>> = const { Cell::new(None) };
}

/// What went wrong on the device.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub enum DeviceError {
    /// The device is gone, with everything made on it; open a new one.
    #[error("the device was lost while {doing}: {reason}; open a new device and make everything anew")]
    Lost {
        /// What was being done: the end of "while …" or "refused …".
        doing: &'static str,
        /// What the driver said.
        reason: String,
    },
    /// The device has no memory left for what was asked.
    #[error("the device is out of memory while {doing}; use a smaller frame, fewer samples or smaller textures")]
    OutOfMemory {
        /// What was being done: the end of "while …" or "refused …".
        doing: &'static str,
    },
    /// wgpu refused a call: wrong use, or something that the device cannot do.
    #[error("wgpu refused {doing}: {message}")]
    Refused {
        /// What was being done: the end of "while …" or "refused …".
        doing: &'static str,
        /// wgpu's reason, on one line.
        message: String,
    },
    /// The driver failed inside.
    #[error("the driver failed while {doing}: {message}")]
    Internal {
        /// What was being done: the end of "while …" or "refused …".
        doing: &'static str,
        /// What it said, on one line.
        message: String,
    },
}

impl std::fmt::Debug for DeviceError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// What the device's own handlers reported since it was last asked.
#[derive(Debug, Default)]
pub struct DeviceErrors {
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    lost: Option<String>,
    uncaught: Option<DeviceError>,
}

impl DeviceErrors {
    /// Notes that the device is lost; the first reason stays.
    pub fn report_lost(&self, reason: impl Into<String>) {
        self.locked().lost.get_or_insert_with(|| reason.into());
    }

    /// Notes an error that no scope caught; the first one stays until it is taken.
    pub(crate) fn uncaught(&self, error: &wgpu::Error) {
        let doing = DOING.get().unwrap_or("something outside of a frame");
        self.locked().uncaught.get_or_insert_with(|| from_wgpu(error, doing));
    }

    /// Why the device was lost, if it was.
    pub fn lost(&self) -> Option<String> {
        self.locked().lost.clone()
    }

    /// The loss as an error, if there was one; then the uncaught error, which is forgotten.
    ///
    /// # Errors
    /// What was noted.
    pub fn check(&self, doing: &'static str) -> Result<(), DeviceError> {
        let mut state = self.locked();
        if let Some(reason) = &state.lost {
            return Err(DeviceError::Lost { doing, reason: reason.clone() });
        }
        state.uncaught.take().map_or(Ok(()), Err)
    }

    fn locked(&self) -> std::sync::MutexGuard<'_, State> {
        // A panic while the lock was held cannot leave half a note behind: each is one assignment.
        self.state.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
    }
}

/// Open error scopes for all three kinds of error on this thread.
#[must_use = "errors are reported by `close`"]
pub struct ErrorScopes {
    // Closed in reverse order of opening.
    guards: [ErrorScopeGuard; 3],
    counted: Counted,
}

/// One more in [`OPEN`] while it lives.
struct Counted;

impl Counted {
    fn new() -> Self {
        OPEN.set(OPEN.get() + 1);
        Self
    }
}

impl Drop for Counted {
    fn drop(&mut self) {
        OPEN.set(OPEN.get() - 1);
    }
}

impl ErrorScopes {
    /// Opens the scopes: errors of this thread are caught from now on.
    pub fn open(device: &Device) -> Self {
        let kinds = [ErrorFilter::Internal, ErrorFilter::OutOfMemory, ErrorFilter::Validation];
        Self { guards: kinds.map(|kind| device.push_error_scope(kind)), counted: Counted::new() }
    }

    /// Closes the scopes.
    ///
    /// # Errors
    /// The first error of the gravest kind that was caught: exhausted memory, then internal failure, then refusal.
    pub fn close(self, doing: &'static str) -> Result<(), DeviceError> {
        let Self { guards: [internal, memory, validation], counted: _counted } = self;
        let validation = pollster::block_on(validation.pop());
        let memory = pollster::block_on(memory.pop());
        let internal = pollster::block_on(internal.pop());
        memory.or(internal).or(validation).map_or(Ok(()), |e| Err(from_wgpu(&e, doing)))
    }
}

/// A part of a frame, whose errors are found when it ends. Opening and closing scopes takes wgpu as long as recording a small pass, so
/// they are opened only where errors would not come to the device's own handler: a device whose handler is not this crate's, or a
/// thread with [`ErrorScopes`] around the frame.
#[must_use = "errors are reported by `end`"]
pub(crate) struct Watch {
    scopes: Option<ErrorScopes>,
    doing: &'static str,
}

impl Watch {
    /// Begins: `handled` says that what no scope catches is noted in the errors that are handed to [`Watch::end`].
    pub(crate) fn begin(device: &Device, handled: bool, doing: &'static str) -> Self {
        let scopes = (!handled || OPEN.get() > 0).then(|| ErrorScopes::open(device));
        DOING.set(Some(doing));
        Self { scopes, doing }
    }

    /// Ends.
    ///
    /// # Errors
    /// What was caught, or noted in `errors`.
    pub(crate) fn end(self, errors: &DeviceErrors) -> Result<(), DeviceError> {
        DOING.set(None);
        self.scopes.map_or(Ok(()), |scopes| scopes.close(self.doing)).and_then(|()| errors.check(self.doing))
    }
}

fn from_wgpu(error: &wgpu::Error, doing: &'static str) -> DeviceError {
    match error {
        wgpu::Error::OutOfMemory { .. } => DeviceError::OutOfMemory { doing },
        wgpu::Error::Validation { description, .. } => DeviceError::Refused { doing, message: one_line(description) },
        wgpu::Error::Internal { description, .. } => DeviceError::Internal { doing, message: one_line(description) },
    }
}

/// wgpu writes a tree of causes over several lines; the causes alone, from the outside in, on one, whatever labels they name.
pub(crate) fn one_line(description: &str) -> String {
    let noise = ["Validation Error", "Caused by:"];
    let lines = description.lines().map(str::trim).filter(|l| !l.is_empty() && !noise.contains(l));
    framegraph::sanitize::line(&lines.collect::<Vec<_>>().join(": "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_loss_stays_and_an_uncaught_error_is_told_once() {
        let errors = DeviceErrors::default();
        assert_eq!(errors.check("testing"), Ok(()));
        let refused =
            wgpu::Error::Validation { source: "x".into(), description: "Validation Error\n\nCaused by:\n  no".into() };
        errors.uncaught(&refused);
        let told = errors.check("testing").map_err(|e| e.to_string());
        assert_eq!(told, Err("wgpu refused something outside of a frame: no".into()));
        assert_eq!(errors.check("testing"), Ok(()));
        errors.report_lost("unplugged");
        errors.report_lost("again");
        let lost = DeviceError::Lost { doing: "testing", reason: "unplugged".into() };
        assert_eq!((errors.check("testing"), errors.check("testing")), (Err(lost.clone()), Err(lost)));
    }

    #[test]
    fn causes_are_joined_on_one_line() {
        let tree = "Validation Error\n\nCaused by:\n  In a pass\n    In a draw\n      no pipeline\n";
        assert_eq!(one_line(tree), "In a pass: In a draw: no pipeline");
    }
}
