//! Drawings as data: shapes in a plane, with areas that react to the pointer.
//!
//! Views create drawings from a plan without a window. A panel paints them with pan and zoom, and [`svg()`] writes the
//! shapes to a file.

mod ink;
mod svg;

pub use ink::{Ink, Theme};
pub use svg::svg;

/// Advance width of a character relative to the font size. Fonts are monospaced, on screen (Hack) and in files (DejaVu).
pub const ADVANCE: f32 = 0.602;
/// Line height relative to the font size.
pub const LINE: f32 = 1.35;

/// Selectable item.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Item {
    /// Pass by index.
    Pass(usize),
    /// Step by index.
    Step(usize),
    /// Resource by index.
    Resource(usize),
    /// Flow from pass to pass by index.
    Flow(usize),
}

/// Horizontal alignment of text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    /// Text starts at its position.
    Left,
    /// Text is centered at its position.
    Center,
    /// Text ends at its position.
    Right,
}

/// Shape of a drawing. Lengths are in points: pixels at zoom 1 on a display of scale 1.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// Rectangle.
    Rect {
        /// Left, top, right, bottom.
        bounds: [f32; 4],
        /// Fill color.
        fill: Option<Ink>,
        /// Outline color.
        stroke: Option<Ink>,
        /// Dashed outline, which marks something absent.
        dashed: bool,
    },
    /// Polyline.
    Line {
        /// At least two points.
        points: Vec<[f32; 2]>,
        /// Color.
        ink: Ink,
        /// Width.
        width: f32,
        /// Dashed line.
        dashed: bool,
    },
    /// Filled triangle, for arrow heads and marks.
    Triangle {
        /// Corners.
        points: [[f32; 2]; 3],
        /// Color.
        ink: Ink,
    },
    /// Single line of text.
    Text {
        /// Position: vertically centered, horizontally aligned by `align`.
        at: [f32; 2],
        /// Font size.
        size: f32,
        /// Horizontal alignment.
        align: Align,
        /// Color.
        ink: Ink,
        /// Counter-clockwise rotation about `at`, in degrees.
        turned: f32,
        /// Characters.
        text: String,
    },
}

/// Area that reacts to the pointer.
#[derive(Clone, Debug, PartialEq)]
pub struct Hit {
    /// Left, top, right, bottom.
    pub bounds: [f32; 4],
    /// Item that a click selects.
    pub item: Option<Item>,
    /// Tooltip.
    pub tip: String,
}

/// Drawing of a view.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawing {
    /// Shapes from bottom to top.
    pub shapes: Vec<Shape>,
    /// Pointer areas from bottom to top.
    pub hits: Vec<Hit>,
    /// Shapes that are highlighted with an item, by index.
    pub marks: Vec<(usize, Item)>,
    /// Right and bottom end of all shapes.
    pub size: [f32; 2],
}

/// Returns the width of a text.
pub fn text_width(text: &str, size: f32) -> f32 {
    text.chars().count() as f32 * size * ADVANCE
}

/// Returns the number of characters that fit a width.
pub fn letters_in(width: f32, size: f32) -> usize {
    (width / (size * ADVANCE)).max(0.0) as usize
}

/// Shortens text to a number of characters, with an ellipsis at the end if necessary.
pub fn shortened(text: &str, letters: usize) -> String {
    if text.chars().count() <= letters {
        return text.into();
    }
    text.chars().take(letters.saturating_sub(1)).chain(['…']).collect()
}

/// Wraps text at a number of characters, between words where possible.
pub fn wrapped(text: &str, letters: usize) -> Vec<String> {
    let letters = letters.max(8);
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let mut word: Vec<char> = word.chars().collect();
        loop {
            let line = lines.last_mut().map_or(0, |line| line.chars().count());
            let space = usize::from(line > 0);
            if line + space + word.len() <= letters {
                if let Some(last) = lines.last_mut() {
                    last.extend(std::iter::repeat_n(' ', space).chain(word));
                }
                break;
            }
            if line > 0 {
                lines.push(String::new());
            } else {
                let rest = word.split_off(letters);
                lines.push(String::new());
                let at = lines.len() - 2;
                lines[at].extend(word);
                word = rest;
            }
        }
    }
    lines
}

impl Drawing {
    fn reach(&mut self, right: f32, bottom: f32) {
        self.size = [self.size[0].max(right), self.size[1].max(bottom)];
    }

    /// Adds a rectangle.
    pub fn rect(&mut self, bounds: [f32; 4], fill: impl Into<Option<Ink>>, stroke: impl Into<Option<Ink>>) {
        self.reach(bounds[2], bounds[3]);
        self.shapes.push(Shape::Rect { bounds, fill: fill.into(), stroke: stroke.into(), dashed: false });
    }

    /// Adds a rectangle with a dashed outline.
    pub fn ghost(&mut self, bounds: [f32; 4], stroke: Ink) {
        self.reach(bounds[2], bounds[3]);
        self.shapes.push(Shape::Rect { bounds, fill: None, stroke: Some(stroke), dashed: true });
    }

    /// Adds a polyline.
    pub fn line(&mut self, points: Vec<[f32; 2]>, ink: Ink, width: f32) {
        for [x, y] in &points {
            self.reach(*x, *y);
        }
        self.shapes.push(Shape::Line { points, ink, width, dashed: false });
    }

    /// Adds a dashed polyline.
    pub fn dashes(&mut self, points: Vec<[f32; 2]>, ink: Ink, width: f32) {
        for [x, y] in &points {
            self.reach(*x, *y);
        }
        self.shapes.push(Shape::Line { points, ink, width, dashed: true });
    }

    /// Adds a filled triangle.
    pub fn triangle(&mut self, points: [[f32; 2]; 3], ink: Ink) {
        for [x, y] in points {
            self.reach(x, y);
        }
        self.shapes.push(Shape::Triangle { points, ink });
    }

    /// Adds left-aligned text, vertically centered at `at`.
    pub fn text(&mut self, at: [f32; 2], size: f32, ink: Ink, text: impl Into<String>) {
        self.aligned(at, size, Align::Left, ink, text);
    }

    /// Adds aligned text, vertically centered at `at`.
    pub fn aligned(&mut self, at: [f32; 2], size: f32, align: Align, ink: Ink, text: impl Into<String>) {
        let text = text.into();
        let width = text_width(&text, size);
        let right = match align {
            Align::Left => at[0] + width,
            Align::Center => at[0] + width / 2.0,
            Align::Right => at[0],
        };
        self.reach(right, at[1] + size * LINE / 2.0);
        self.shapes.push(Shape::Text { at, size, align, ink, turned: 0.0, text });
    }

    /// Adds text rotated counter-clockwise about its start, in degrees.
    pub fn slanted(&mut self, at: [f32; 2], size: f32, ink: Ink, turned: f32, text: impl Into<String>) {
        let text = text.into();
        let reach = text_width(&text, size) * turned.to_radians().cos();
        self.reach(at[0] + reach + size, at[1] + size / 2.0);
        self.shapes.push(Shape::Text { at, size, align: Align::Left, ink, turned, text });
    }

    /// Adds a pointer area.
    pub fn hit(&mut self, bounds: [f32; 4], item: impl Into<Option<Item>>, tip: impl Into<String>) {
        self.hits.push(Hit { bounds, item: item.into(), tip: tip.into() });
    }

    /// Highlights the last shape together with an item.
    pub fn mark(&mut self, item: Item) {
        self.marks.push((self.shapes.len().saturating_sub(1), item));
    }

    /// Returns the topmost pointer area at a position.
    pub fn at(&self, [x, y]: [f32; 2]) -> Option<&Hit> {
        self.hits.iter().rev().find(|h| {
            let [left, top, right, bottom] = h.bounds;
            left <= x && x < right && top <= y && y < bottom
        })
    }

    /// Returns all text, line by line from the top left, for copying.
    pub fn words(&self) -> String {
        let mut rows: Vec<(i64, i64, &str)> = Vec::new();
        for shape in &self.shapes {
            if let Shape::Text { at: [x, y], text, .. } = shape {
                rows.push(((y / 4.0).round() as i64, *x as i64, text));
            }
        }
        rows.sort_unstable();
        let mut out = String::new();
        for (index, (line, _, text)) in rows.iter().enumerate() {
            if index > 0 {
                out.push_str(if rows[index - 1].0 == *line { "\t" } else { "\n" });
            }
            out.push_str(text);
        }
        out.push('\n');
        out
    }
}
