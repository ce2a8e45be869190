//! State of drawing the live frame: the thread that works on it, and the last picture.

use super::bisecting::Bisecting;
use super::frame::Running;
use super::preview::Found;
use crate::job::Job;
use egui::TextureId;
use framegraph_wgpu::inspect::Inspector;
use std::time::{Duration, Instant};

/// Time after which work on a frame is shown with its progress.
const LONG: Duration = Duration::from_millis(150);

/// Result of work on the frame.
pub(super) enum Done {
    /// It was drawn.
    Drawn(Result<(), String>),
    /// A texture was read.
    Read(Box<(Inspector, Result<Found, String>)>),
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

    /// Ends the work on the frame. If it creates pipelines, the last change of settings is undone afterward.
    pub fn stop(&mut self) {
        if let Some((job, _)) = &self.job {
            job.cancel();
            self.stopped = true;
        }
    }

    /// Returns the state for another scene. A frame of the old scene that is still drawn is dropped.
    pub fn restarted(&self) -> Self {
        let Self { picture, shown, blocking, .. } = *self;
        Self { picture, shown, blocking, ..Self::default() }
    }
}
