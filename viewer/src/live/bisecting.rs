//! Which of the compiler's liberties changes the picture: the frame is drawn under each debug mode, one a call, and compared.

use super::frame::{Asked, Running};
use super::look::Document;
use framegraph_wgpu::debug::{Mode, Modes, Outcome, bisect};
use framegraph_wgpu::read_texture;

/// Frames that are drawn under each mode before the picture is taken: histories settle.
const FRAMES: u32 = 3;

/// A picture under a mode.
pub struct Drawn {
    /// The mode; none for the frame as it is.
    pub mode: Option<Mode>,
    /// Four bytes a pixel.
    pub rgba8: Vec<u8>,
}

/// The modes that were tried, and those that are to be.
pub struct Bisecting {
    /// The frame when it began.
    document: Document,
    /// What was asked for besides.
    asked: Asked,
    /// Size of the pictures.
    pub size_px: [u32; 2],
    /// As it is, again, and under each mode.
    pub drawn: Vec<Drawn>,
    /// What came out, once all were drawn.
    pub outcomes: Vec<Outcome>,
    /// The mode whose picture is shown.
    pub shown: usize,
}

impl Bisecting {
    /// Begins with the frame as it is.
    pub fn new(document: Document, asked: &Asked, size_px: [u32; 2]) -> Self {
        let asked = Asked { modes: Modes::default(), playing: false, ..asked.clone() };
        Self { document, asked, size_px, drawn: Vec::new(), outcomes: Vec::new(), shown: 0 }
    }

    /// Whether everything was tried.
    pub fn is_done(&self) -> bool {
        !self.outcomes.is_empty()
    }

    /// How much of it was.
    pub fn progress(&self) -> f32 {
        self.drawn.len() as f32 / (Mode::ALL.len() + 2) as f32
    }

    /// Draws under the next mode.
    ///
    /// # Errors
    /// What the frame or the device refuses under it.
    pub fn step(&mut self, running: &mut Running) -> Result<(), String> {
        let mode = match self.drawn.len() {
            0 | 1 => None,
            tried => Mode::ALL.get(tried - 2).copied(),
        };
        let asked = Asked { modes: Modes(mode.into_iter().collect()), ..self.asked.clone() };
        running.restart();
        for _ in 0..FRAMES {
            running.draw(self.size_px, &self.document, &asked)?;
        }
        let texture = running.picture_texture().ok_or("the frame left no picture")?;
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

    /// The picture of an outcome, the picture without any mode, and their difference, 16 times as large.
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
