//! SIGINT and SIGTERM as a question that long work asks at each step.
//!
//! The first signal is remembered, so that the work can stop in order; a second one ends the program at once. Elsewhere than
//! on Unix nothing is watched, and the system ends the program.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::Duration;

/// The signal that came, or zero.
static SIGNAL: OnceLock<Arc<AtomicUsize>> = OnceLock::new();

/// How often [`exit_when_asked`] looks.
const PAUSE: Duration = Duration::from_millis(20);

/// Whether the work from now on ends by itself once a signal came.
static IN_ORDER: AtomicBool = AtomicBool::new(false);

/// The run was asked to stop.
#[derive(Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("stopped by signal {signal}; no file was written")]
pub struct Stopped {
    /// Number of the signal.
    pub signal: u8,
}

impl std::fmt::Debug for Stopped {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

impl Stopped {
    /// What shells report of a program that a signal ended.
    #[must_use]
    pub fn code(self) -> u8 {
        128 + self.signal
    }
}

/// Watches from now on. A system that refuses ends the program at a signal, as it does without this.
pub fn watch() {
    let signal = SIGNAL.get_or_init(Arc::default);
    #[cfg(unix)]
    {
        use signal_hook::consts::{SIGINT, SIGTERM};
        use signal_hook::flag;
        let again = Arc::default();
        for number in [SIGINT, SIGTERM] {
            let _ = flag::register_conditional_shutdown(number, 128 + number, Arc::clone(&again));
            let _ = flag::register(number, Arc::clone(&again));
            let _ = flag::register_usize(number, Arc::clone(signal), number as usize);
        }
    }
    #[cfg(not(unix))]
    let _ = signal;
}

/// Ends the program soon after a signal, with its parts of files removed: for work that has no steps to stop at.
pub fn exit_when_asked() {
    watch();
    std::thread::spawn(|| {
        loop {
            if let (Err(stopped), false) = (check(), IN_ORDER.load(Ordering::Relaxed)) {
                crate::part::remove_all();
                crate::print::error(stopped);
                std::process::exit(stopped.code().into());
            }
            std::thread::sleep(PAUSE);
        }
    });
}

/// From now on the work itself ends at a signal, with what it has: [`exit_when_asked`] no longer does.
pub fn end_in_order() {
    IN_ORDER.store(true, Ordering::Relaxed);
}

/// Whether to go on.
///
/// # Errors
/// [`Stopped`], once a signal came.
pub fn check() -> Result<(), Stopped> {
    match SIGNAL.get().map_or(0, |signal| signal.load(Ordering::Relaxed)) {
        0 => Ok(()),
        signal => Err(Stopped { signal: signal as u8 }),
    }
}

/// The same for work that asks its caller.
pub fn flow() -> ControlFlow<()> {
    if check().is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
}
