//! Progress reports of loading, and cancellation.

use std::ops::ControlFlow;
use std::path::Path;

use super::error::SceneError;
pub use super::stage::Stage;

/// Progress report: `done` of `total` items of `stage` are finished, `item` last.
#[derive(Clone, Copy, Debug)]
pub struct Progress<'a> {
    /// Stage of loading.
    pub stage: Stage,
    /// Number of finished items of this stage.
    pub done: usize,
    /// Number of items of this stage; at least `done`.
    pub total: usize,
    /// Display name of the item just finished. May be empty.
    pub item: &'a str,
}

/// Progress callback, called on the loading thread after each item. [`ControlFlow::Break`] stops the load, which then
/// returns [`SceneError::Interrupted`].
pub type ProgressFn<'a> = dyn FnMut(Progress<'_>) -> ControlFlow<()> + 'a;

/// Passes a report to the callback, and converts a request to stop to the error for `file`.
pub fn report(progress: &mut ProgressFn<'_>, file: &Path, report: Progress<'_>) -> Result<(), SceneError> {
    match progress(report) {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(SceneError::Interrupted { file: file.into(), stage: report.stage }),
    }
}

/// A [`ProgressFn`] that ignores reports and never stops.
pub fn silent(_: Progress<'_>) -> ControlFlow<()> {
    ControlFlow::Continue(())
}
