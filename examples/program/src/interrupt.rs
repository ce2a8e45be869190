//! SIGINT and SIGTERM as a flag that long work polls at each step.
//!
//! The first signal sets the flag, so that the work can stop cleanly. A second signal ends the program at once. On
//! systems other than Unix no signal is watched, and the system ends the program.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::Duration;

/// Number of the received signal, or zero.
static SIGNAL: OnceLock<Arc<AtomicUsize>> = OnceLock::new();

/// Polling interval of [`exit_when_asked`].
const PAUSE: Duration = Duration::from_millis(20);

/// Set while the work itself stops at a signal.
static IN_ORDER: AtomicBool = AtomicBool::new(false);

/// Error of a run that a signal stopped.
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
    /// Returns the exit code that shells report for a program ended by this signal.
    #[must_use]
    pub fn code(self) -> u8 {
        128 + self.signal
    }
}

/// Starts watching for signals. If the system refuses, a signal ends the program as without this call.
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

/// Ends the program soon after a signal and removes its partial files. Meant for work without steps to stop at.
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

/// Makes the work responsible for stopping at a signal: [`exit_when_asked`] no longer ends the program.
pub fn end_in_order() {
    IN_ORDER.store(true, Ordering::Relaxed);
}

/// Checks for a signal.
///
/// # Errors
/// [`Stopped`] after a signal.
pub fn check() -> Result<(), Stopped> {
    match SIGNAL.get().map_or(0, |signal| signal.load(Ordering::Relaxed)) {
        0 => Ok(()),
        signal => Err(Stopped { signal: signal as u8 }),
    }
}

/// Returns [`ControlFlow::Break`] after a signal, for work that polls through a callback.
pub fn flow() -> ControlFlow<()> {
    if check().is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
}
