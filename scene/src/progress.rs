//! Progress of loading: how it is reported, and how a load is stopped.

use std::ops::ControlFlow;
use std::path::Path;

use super::error::SceneError;
pub use super::stage::Stage;

/// One report: `done` of `total` items of `stage`, of which `item` is the latest.
#[derive(Clone, Copy, Debug)]
pub struct Progress<'a> {
    /// The stage of loading.
    pub stage: Stage,
    /// How many items of this stage are finished.
    pub done: usize,
    /// How many items this stage has; at least `done`.
    pub total: usize,
    /// The item just finished, as a name to show. May be empty.
    pub item: &'a str,
}

/// Called on the loading thread after each item; [`ControlFlow::Break`] stops the load, which then
/// returns [`SceneError::Interrupted`].
pub type ProgressFn<'a> = dyn FnMut(Progress<'_>) -> ControlFlow<()> + 'a;

/// Passes a report on, and turns a request to stop into the error for `file`.
pub fn report(progress: &mut ProgressFn<'_>, file: &Path, report: Progress<'_>) -> Result<(), SceneError> {
    match progress(report) {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(SceneError::Interrupted { file: file.into(), stage: report.stage }),
    }
}

/// A [`ProgressFn`] that shows nothing and never stops.
pub fn silent(_: Progress<'_>) -> ControlFlow<()> {
    ControlFlow::Continue(())
}
