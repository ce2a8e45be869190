//! Bisection of debug modes: draws the frame in each mode, one per call, and compares the pictures.

use super::capture::Document;
use super::frame::{DrawOptions, Running};
use crate::job::Handle;
use framegraph_wgpu::debug::{Mode, Modes, Outcome, bisect};
use framegraph_wgpu::read_texture;

/// Frames drawn in each mode before the picture is read, so that histories settle.
const FRAMES: u32 = 3;

/// Picture in a mode.
pub struct Drawn {
    /// Mode; `None` for the unmodified frame.
    pub mode: Option<Mode>,
    /// RGBA, 8 bits per channel.
    pub rgba8: Vec<u8>,
}

/// Running or finished bisection.
pub struct Bisecting {
    /// Settings at the start.
    document: Document,
    /// Animation state at the start.
    options: DrawOptions,
    /// Size of the pictures.
    pub size_px: [u32; 2],
    /// Pictures of the unmodified frame, twice, and of each mode.
    pub drawn: Vec<Drawn>,
    /// Results, after all pictures were drawn.
    pub outcomes: Vec<Outcome>,
    /// Index of the displayed mode.
    pub shown: usize,
}

impl Bisecting {
    /// Starts a bisection of the current frame.
    pub fn new(document: Document, options: &DrawOptions, size_px: [u32; 2]) -> Self {
        let options = DrawOptions { modes: Modes::default(), playing: false, ..options.clone() };
        Self { document, options, size_px, drawn: Vec::new(), outcomes: Vec::new(), shown: 0 }
    }

    /// Returns whether all modes were drawn.
    pub fn is_done(&self) -> bool {
        !self.outcomes.is_empty()
    }

    /// Draws and compares all modes. Ends early after cancellation.
    ///
    /// # Errors
    /// An error of the frame or the device.
    pub fn run(&mut self, running: &mut Running, handle: &Handle) -> Result<(), String> {
        while !self.is_done() && !handle.is_cancelled() {
            self.step(running)?;
            handle.step(self.drawn.len() as u64, Mode::ALL.len() as u64 + 2);
        }
        Ok(())
    }

    /// Draws the next mode.
    ///
    /// # Errors
    /// An error of the frame or the device in this mode.
    fn step(&mut self, running: &mut Running) -> Result<(), String> {
        let mode = match self.drawn.len() {
            0 | 1 => None,
            tried => Mode::ALL.get(tried - 2).copied(),
        };
        let options = DrawOptions { modes: Modes(mode.into_iter().collect()), ..self.options.clone() };
        running.restart();
        for _ in 0..FRAMES {
            running.draw(self.size_px, &self.document, &options, &mut |_, _| ())?;
        }
        let texture = running.picture_texture().ok_or("the frame has no picture")?;
        let pixels = read_texture(&running.screen().gpu, texture).map_err(|e| e.to_string())?;
        self.drawn.push(Drawn { mode, rgba8: pixels.rgba8() });
        if self.drawn.len() == Mode::ALL.len() + 2 {
            let mut pictures = self.drawn.iter();
            let next = |_| Ok::<_, String>(pictures.next().map_or_else(Vec::new, |drawn| drawn.rgba8.clone()));
            self.outcomes = bisect(next)?;
            running.restart();
        }
        Ok(())
    }

    /// Returns the unmodified picture, the picture of a mode, and their difference times 16.
    pub fn pictures(&self, outcome: usize) -> Option<[Vec<u8>; 3]> {
        let (first, other) = (self.drawn.first()?, self.drawn.get(outcome + 1)?);
        let difference = first
            .rgba8
            .iter()
            .zip(&other.rgba8)
            .enumerate()
            .map(|(index, (a, b))| if index % 4 == 3 { 255 } else { a.abs_diff(*b).saturating_mul(16) });
        Some([first.rgba8.clone(), other.rgba8.clone(), difference.collect()])
    }
}
