//! State of drawing the live frame: the thread that works on it, and the last picture.

use super::bisecting::Bisecting;
use super::capture::Document;
use super::frame::Running;
use super::preview::Found;
use crate::job::Job;
use egui::TextureId;
use framegraph_wgpu::debug::Modes;
use framegraph_wgpu::inspect::{InspectTarget, Inspector};
use std::time::{Duration, Instant};

/// Time after which work on a frame is shown with its progress.
const LONG: Duration = Duration::from_millis(150);

/// Result of work on the frame.
pub(super) enum Done {
    /// The frame of a document was drawn in debug modes.
    Drawn(Box<(Document, Modes)>, Result<(), String>),
    /// A subresource of a texture was read.
    Read(Box<(Inspector, InspectTarget, Result<Found, String>)>),
    /// Debug modes were compared.
    Bisected(Result<Box<Bisecting>, String>),
}

/// Picture in memory.
pub struct Copied {
    /// Width and height in pixels.
    pub size_px: [u32; 2],
    /// RGBA, 8 bits per channel.
    pub rgba8: Vec<u8>,
    /// Number of the picture, for caching.
    pub made: u64,
}

/// Work that returns the frame with the result.
pub(super) type Work = Job<(Running, Done)>;

/// State of drawing.
#[derive(Default)]
pub(super) struct Drawing {
    /// The frame while another thread works on it, and when that began.
    pub job: Option<(Work, Instant)>,
    /// Last picture: egui's id and the size in pixels.
    pub picture: Option<(TextureId, [u32; 2])>,
    /// Copy of the last picture of a frame with a device of its own.
    pub copy: Option<Copied>,
    pub copying: Option<Job<Option<([u32; 2], Vec<u8>)>>>,
    /// The viewport was shown since the last frame of the window.
    pub shown: bool,
    /// Waits for every frame.
    pub blocking: bool,
    /// The user stopped the creation of pipelines.
    pub stopped: bool,
    /// Settings of the last frame.
    pub last: Option<Document>,
}

impl Drawing {
    /// Returns the description and progress of a frame that takes long.
    pub fn doing(&self) -> Option<(&str, Option<f32>)> {
        let (job, _) = self.job.as_ref().filter(|(_, begun)| begun.elapsed() > LONG)?;
        Some((job.doing.as_str(), job.progress()))
    }

    /// Returns whether another thread works on the frame.
    pub fn is_working(&self) -> bool {
        self.job.is_some()
    }

    /// Returns whether the work on the frame can be stopped: pipelines are created, or debug modes are compared.
    pub fn can_stop(&self) -> bool {
        self.job.as_ref().is_some_and(|(job, _)| job.progress().is_some())
    }

    /// Ends the work on the frame. If it creates pipelines for new settings, they are undone afterward.
    pub fn stop(&mut self) {
        if let Some((job, _)) = self.job.as_ref().filter(|_| self.can_stop()) {
            job.cancel();
            self.stopped = true;
        }
    }

    /// Takes the settings of a drawn frame. Returns whether the current settings should be undone: the user stopped the
    /// frame, and it was the first with these settings.
    pub fn take_drawn(&mut self, drawn: &Document, now: &Document) -> bool {
        let is_new = self.last.as_ref().is_some_and(|last| last != drawn);
        self.last = Some(drawn.clone());
        std::mem::take(&mut self.stopped) && is_new && drawn == now
    }

    /// Returns the state for another scene. A frame of the old scene that is still drawn is dropped.
    pub fn restarted(&self) -> Self {
        let Self { picture, shown, blocking, .. } = *self;
        Self { picture, shown, blocking, ..Self::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_new_and_current_settings_are_undone() {
        let before = Document::default();
        let mut after = before.clone();
        after.capture.environment_intensity += 1.0;
        let drawing = |stopped| Drawing { stopped, last: Some(before.clone()), ..Drawing::default() };
        assert!(drawing(true).take_drawn(&after, &after));
        assert!(!drawing(false).take_drawn(&after, &after), "it was not stopped");
        assert!(!drawing(true).take_drawn(&before, &before), "another size or a slow frame");
        assert!(!drawing(true).take_drawn(&after, &before), "the user undid it already");
        assert!(!drawing(true).take_drawn(&before, &after), "the change came after the frame began");
        let mut first = Drawing { stopped: true, ..Drawing::default() };
        assert!(!first.take_drawn(&after, &after), "the first frame has no earlier settings");
        assert!(!first.stopped && first.last == Some(after));
    }
}
