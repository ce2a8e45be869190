//! Pictures as data: shapes in a plane, with what lies under which place. A view makes one from a plan without a window;
//! a panel paints it, pans and zooms, and a file gets the same shapes ([`svg()`]).

mod ink;
mod svg;

pub use ink::{Ink, Theme};
pub use svg::svg;

/// Width of a letter as a share of the height of the font: fonts are monospaced, here (Hack) and in files (DejaVu).
pub const ADVANCE: f32 = 0.602;
/// Height of a line as a share of the height of the font.
pub const LINE: f32 = 1.35;

/// What can be selected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Item {
    /// A pass, by its index.
    Pass(usize),
    /// A step, by its index.
    Step(usize),
    /// A resource, by its index.
    Resource(usize),
    /// A flow from pass to pass, by its index.
    Flow(usize),
}

/// Where text stands against its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    /// It begins there.
    Left,
    /// Its middle is there.
    Center,
    /// It ends there.
    Right,
}

/// One shape. Lengths are in points: pixels at a zoom of 1 on a display of scale 1.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A box.
    Rect {
        /// Left, top, right, bottom.
        bounds: [f32; 4],
        /// What it is filled with.
        fill: Option<Ink>,
        /// What its edge is drawn with.
        stroke: Option<Ink>,
        /// The edge is dashed: what is not there.
        dashed: bool,
    },
    /// A line through points.
    Line {
        /// At least two.
        points: Vec<[f32; 2]>,
        /// Its color.
        ink: Ink,
        /// Its width.
        width: f32,
        /// It is dashed.
        dashed: bool,
    },
    /// A filled triangle: heads of arrows, marks.
    Triangle {
        /// The corners.
        points: [[f32; 2]; 3],
        /// Its color.
        ink: Ink,
    },
    /// One line of text.
    Text {
        /// Where its middle line meets the side that `align` names.
        at: [f32; 2],
        /// Height of the font.
        size: f32,
        /// Which side.
        align: Align,
        /// Its color.
        ink: Ink,
        /// Turned about `at`, against the clock, in degrees.
        turned: f32,
        /// The letters.
        text: String,
    },
}

/// A place that can be pointed at.
#[derive(Clone, Debug, PartialEq)]
pub struct Hit {
    /// Left, top, right, bottom.
    pub bounds: [f32; 4],
    /// What is there, if it can be selected.
    pub item: Option<Item>,
    /// What to say about it.
    pub tip: String,
}

/// A picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawing {
    /// Shapes, the first at the bottom.
    pub shapes: Vec<Shape>,
    /// Places, the last on top.
    pub hits: Vec<Hit>,
    /// Shapes that belong to an item: they are lit with it.
    pub marks: Vec<(usize, Item)>,
    /// Right and bottom end of all shapes.
    pub size: [f32; 2],
}

/// The width of a text.
pub fn text_width(text: &str, size: f32) -> f32 {
    text.chars().count() as f32 * size * ADVANCE
}

/// The letters that fit a width.
pub fn letters_in(width: f32, size: f32) -> usize {
    (width / (size * ADVANCE)).max(0.0) as usize
}

/// At most so many letters, the last an ellipsis where some are left out.
pub fn shortened(text: &str, letters: usize) -> String {
    if text.chars().count() <= letters {
        return text.into();
    }
    text.chars().take(letters.saturating_sub(1)).chain(['…']).collect()
}

/// The text in lines of at most so many letters, broken between words where that can be done.
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

    /// A box.
    pub fn rect(&mut self, bounds: [f32; 4], fill: impl Into<Option<Ink>>, stroke: impl Into<Option<Ink>>) {
        self.reach(bounds[2], bounds[3]);
        self.shapes.push(Shape::Rect { bounds, fill: fill.into(), stroke: stroke.into(), dashed: false });
    }

    /// A box with a dashed edge.
    pub fn ghost(&mut self, bounds: [f32; 4], stroke: Ink) {
        self.reach(bounds[2], bounds[3]);
        self.shapes.push(Shape::Rect { bounds, fill: None, stroke: Some(stroke), dashed: true });
    }

    /// A line through points.
    pub fn line(&mut self, points: Vec<[f32; 2]>, ink: Ink, width: f32) {
        for [x, y] in &points {
            self.reach(*x, *y);
        }
        self.shapes.push(Shape::Line { points, ink, width, dashed: false });
    }

    /// A dashed line.
    pub fn dashes(&mut self, points: Vec<[f32; 2]>, ink: Ink, width: f32) {
        for [x, y] in &points {
            self.reach(*x, *y);
        }
        self.shapes.push(Shape::Line { points, ink, width, dashed: true });
    }

    /// A filled triangle.
    pub fn triangle(&mut self, points: [[f32; 2]; 3], ink: Ink) {
        for [x, y] in points {
            self.reach(x, y);
        }
        self.shapes.push(Shape::Triangle { points, ink });
    }

    /// A line of text that begins at a place, its middle line there.
    pub fn text(&mut self, at: [f32; 2], size: f32, ink: Ink, text: impl Into<String>) {
        self.aligned(at, size, Align::Left, ink, text);
    }

    /// A line of text.
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

    /// Text that climbs to the right from a place, by so many degrees.
    pub fn slanted(&mut self, at: [f32; 2], size: f32, ink: Ink, turned: f32, text: impl Into<String>) {
        let text = text.into();
        let reach = text_width(&text, size) * turned.to_radians().cos();
        self.reach(at[0] + reach + size, at[1] + size / 2.0);
        self.shapes.push(Shape::Text { at, size, align: Align::Left, ink, turned, text });
    }

    /// A place that can be pointed at.
    pub fn hit(&mut self, bounds: [f32; 4], item: impl Into<Option<Item>>, tip: impl Into<String>) {
        self.hits.push(Hit { bounds, item: item.into(), tip: tip.into() });
    }

    /// The last shape belongs to an item.
    pub fn mark(&mut self, item: Item) {
        self.marks.push((self.shapes.len().saturating_sub(1), item));
    }

    /// What lies on top at a place.
    pub fn at(&self, [x, y]: [f32; 2]) -> Option<&Hit> {
        self.hits.iter().rev().find(|h| {
            let [left, top, right, bottom] = h.bounds;
            left <= x && x < right && top <= y && y < bottom
        })
    }

    /// Its letters, line by line, from the top, from the left: what is copied as text.
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
