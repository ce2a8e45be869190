//! How a loader reports what it does, and how it is stopped.

use std::fmt;
use std::ops::ControlFlow;
use std::path::Path;

use super::error::{SceneError, one_line};

/// What a loader is busy with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Reading files named by the scene.
    Files,
    /// Decoding images.
    Images,
    /// Building vertex streams, normals and tangents.
    Geometry,
    /// Decoding or evaluating an environment.
    Environment,
    /// Filtering an environment on the GPU, and integrating the tables that go with it.
    Lighting,
    /// Copying to the GPU, mip levels included.
    Upload,
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Files => "reading files",
            Self::Images => "decoding images",
            Self::Geometry => "building geometry",
            Self::Environment => "preparing the environment",
            Self::Lighting => "filtering the environment",
            Self::Upload => "uploading",
        })
    }
}

/// One report: `done` of `total` items of `stage`, of which `item` is the latest.
#[derive(Clone, Copy, Debug)]
pub struct Progress<'a> {
    /// What the loader is busy with.
    pub stage: Stage,
    /// Items finished.
    pub done: usize,
    /// Items of this stage in all; at least `done`.
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
        ControlFlow::Break(()) => {
            Err(SceneError::Interrupted { file: one_line(&file.display().to_string()), stage: report.stage })
        }
    }
}

/// A [`ProgressFn`] that shows nothing and never stops.
pub fn silent(_: Progress<'_>) -> ControlFlow<()> {
    ControlFlow::Continue(())
}
