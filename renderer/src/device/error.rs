//! Device errors as values: lost devices, exhausted memory and rejected calls become errors instead of panics.
//!
//! wgpu reports errors in three ways: error scopes (per thread), a handler for errors outside of scopes, and a callback
//! when the device is lost. Three types cover them:
//!
//! - [`DeviceErrors`] collects handler and callback reports of a device that this crate opened.
//! - [`ErrorScopes`] catches the errors of a piece of work.
//! - [`Watch`] catches the errors of a part of a frame at the lowest cost.
//!
//! An application that owns its device keeps its handlers, and forwards a lost device with
//! [`DeviceErrors::report_lost`].

use std::cell::Cell;
use std::sync::Mutex;
use wgpu::{Device, ErrorFilter, ErrorScopeGuard};

thread_local! {
    /// Number of open [`ErrorScopes`] on this thread.
    static OPEN: Cell<u32> = const { Cell::new(0) };
    /// Description of the current [`Watch`] on this thread.
    static DOING: Cell<Option<&'static str>> = const { Cell::new(None) };
}

/// Error of a device.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub enum DeviceError {
    /// The device is lost with all its resources. Open a new device.
    #[error("the device was lost while {doing}: {reason}; open a new device and create all resources again")]
    Lost {
        /// Operation that failed, for the text "while …" or "rejected …".
        doing: &'static str,
        /// Reason given by the driver.
        reason: String,
    },
    /// The device is out of memory.
    #[error("the device is out of memory while {doing}; use a smaller frame, fewer samples or smaller textures")]
    OutOfMemory {
        /// Operation that failed, for the text "while …" or "rejected …".
        doing: &'static str,
    },
    /// wgpu rejected a call: wrong usage, or not supported by the device.
    #[error("wgpu rejected {doing}: {message}")]
    Refused {
        /// Operation that failed, for the text "while …" or "rejected …".
        doing: &'static str,
        /// Reason given by wgpu, on one line.
        message: String,
    },
    /// The driver failed internally.
    #[error("the driver failed while {doing}: {message}")]
    Internal {
        /// Operation that failed, for the text "while …" or "rejected …".
        doing: &'static str,
        /// Reason given by the driver, on one line.
        message: String,
    },
}

impl std::fmt::Debug for DeviceError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// Errors that the handlers of a device reported since the last check.
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
    /// Reports that the device is lost. The first reason is kept.
    pub fn report_lost(&self, reason: impl Into<String>) {
        self.locked().lost.get_or_insert_with(|| reason.into());
    }

    /// Stores an error that no scope caught. The first one is kept until it is taken.
    pub(crate) fn uncaught(&self, error: &wgpu::Error) {
        let doing = DOING.get().unwrap_or("something outside of a frame");
        self.locked().uncaught.get_or_insert_with(|| from_wgpu(error, doing));
    }

    /// Returns why the device was lost, or `None` if it was not.
    pub fn lost(&self) -> Option<String> {
        self.locked().lost.clone()
    }

    /// Fails if the device is lost or a handler reported an error. Reported errors are removed; a lost device stays
    /// lost.
    ///
    /// # Errors
    /// Returns [`DeviceError::Lost`], or else the first reported error.
    pub fn check(&self, doing: &'static str) -> Result<(), DeviceError> {
        let mut state = self.locked();
        if let Some(reason) = &state.lost {
            return Err(DeviceError::Lost { doing, reason: reason.clone() });
        }
        state.uncaught.take().map_or(Ok(()), Err)
    }

    fn locked(&self) -> std::sync::MutexGuard<'_, State> {
        // A panic while the lock was held cannot leave the state inconsistent: each update is one assignment.
        self.state.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
    }
}

/// Open error scopes for all three kinds of wgpu errors on this thread.
#[must_use = "errors are reported by `close`"]
pub struct ErrorScopes {
    // Scopes are closed in reverse order of opening.
    /// `None` in browsers, which close scopes asynchronously: the device's handler reports errors there.
    guards: Option<[ErrorScopeGuard; 3]>,
    counted: Counted,
}

/// Counts one open scope in [`OPEN`] during its lifetime.
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
    /// Opens the scopes. Errors of this thread are caught from now on.
    pub fn open(device: &Device) -> Self {
        let kinds = [ErrorFilter::Internal, ErrorFilter::OutOfMemory, ErrorFilter::Validation];
        let open = || kinds.map(|kind| device.push_error_scope(kind));
        Self { guards: (!cfg!(target_arch = "wasm32")).then(open), counted: Counted::new() }
    }

    /// Closes the scopes.
    ///
    /// # Errors
    /// Returns the most severe error that was caught: out of memory, then internal errors, then validation errors.
    pub fn close(self, doing: &'static str) -> Result<(), DeviceError> {
        let Self { guards, counted: _counted } = self;
        let Some([internal, memory, validation]) = guards else { return Ok(()) };
        let validation = pollster::block_on(validation.pop());
        let memory = pollster::block_on(memory.pop());
        let internal = pollster::block_on(internal.pop());
        memory.or(internal).or(validation).map_or(Ok(()), |e| Err(from_wgpu(&e, doing)))
    }
}

/// A part of a frame whose errors are reported at its end.
///
/// Opening and closing scopes costs as much as recording a small pass. They are opened only if errors would not reach
/// this crate's handler: on devices with another handler, or within [`ErrorScopes`] on this thread.
#[must_use = "errors are reported by `end`"]
pub(crate) struct Watch {
    scopes: Option<ErrorScopes>,
    doing: &'static str,
}

impl Watch {
    /// Begins a part of a frame. `handled` says whether errors outside of scopes are stored in the `errors` passed to
    /// [`Watch::end`].
    pub(crate) fn begin(device: &Device, handled: bool, doing: &'static str) -> Self {
        let scopes = (!handled || OPEN.get() > 0).then(|| ErrorScopes::open(device));
        DOING.set(Some(doing));
        Self { scopes, doing }
    }

    /// Ends the part of the frame.
    ///
    /// # Errors
    /// Returns the error that was caught, or stored in `errors`.
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

/// Joins wgpu's multi-line tree of causes into one line, outermost cause first. Control characters in labels are
/// escaped.
pub(crate) fn one_line(description: &str) -> String {
    let noise = ["Validation Error", "Caused by:"];
    let lines = description.lines().map(str::trim).filter(|l| !l.is_empty() && !noise.contains(l));
    framegraph::sanitize::line(&lines.collect::<Vec<_>>().join(": "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_loss_is_kept_and_errors_are_reported_once() {
        let errors = DeviceErrors::default();
        assert_eq!(errors.check("testing"), Ok(()));
        let refused =
            wgpu::Error::Validation { source: "x".into(), description: "Validation Error\n\nCaused by:\n  no".into() };
        errors.uncaught(&refused);
        let report = errors.check("testing").map_err(|e| e.to_string());
        assert_eq!(report, Err("wgpu rejected something outside of a frame: no".into()));
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
