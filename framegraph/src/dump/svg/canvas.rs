//! Shapes and text as SVG elements, and their bounding box.

use crate::sanitize::escape_controls;
use std::fmt::Write;

/// Margin around the image, in user units (pixels at 100 %).
pub(super) const MARGIN: f64 = 16.0;
/// Width of the column of names, shared by matrix and memory map.
pub(super) const NAMES: f64 = 330.0;
/// Width of a step.
pub(super) const STEP: f64 = 40.0;

/// Returns the left edge of a step.
pub(super) fn step_x(step: usize) -> f64 {
    MARGIN + NAMES + STEP * step as f64
}

/// Style of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ink {
    /// Title of the image.
    Title,
    /// Heading of a section.
    Heading,
    /// Names and numbers.
    Plain,
    /// Less important text.
    Faint,
    /// Text inside of a colored box.
    Small,
}

impl Ink {
    const fn class(self) -> &'static str {
        match self {
            Self::Title => "t",
            Self::Heading => "h",
            Self::Plain => "p",
            Self::Faint => "f",
            Self::Small => "s",
        }
    }

    /// Width of a character in user units; the fonts are monospaced.
    pub(super) const fn advance(self) -> f64 {
        match self {
            Self::Title => 10.8,
            Self::Heading => 8.4,
            Self::Plain | Self::Faint => 7.2,
            Self::Small => 6.0,
        }
    }
}

const STYLE: &str = "text{font-family:'DejaVu Sans \
Mono',Menlo,Consolas,monospace;font-size:12px;fill:#222}.t{font-size:18px;font-weight:bold}.h{font-size:14px;font-weight:bold}.f{fill:#666}.s{font-size:10px}";

/// A document under construction.
#[derive(Debug)]
pub(super) struct Canvas {
    body: String,
    right: f64,
    bottom: f64,
}

impl Canvas {
    pub(super) fn new() -> Self {
        Self { body: String::new(), right: 0.0, bottom: 0.0 }
    }

    fn reach(&mut self, right: f64, bottom: f64) {
        self.right = self.right.max(right);
        self.bottom = self.bottom.max(bottom);
    }

    /// Adds text with its baseline starting at `x`, `y`.
    pub(super) fn text(&mut self, x: f64, y: f64, ink: Ink, text: &str) {
        let letters = text.chars().count() as f64;
        self.reach(x + letters * ink.advance(), y + 4.0);
        let class = ink.class();
        // Writing to a string cannot fail; also below.
        let _ = writeln!(
            self.body,
            "<text class=\"{class}\" x=\"{x:.1}\" y=\"{y:.1}\">{}</text>",
            xml_escaped(&escape_controls(text))
        );
    }

    /// Adds text that rises to the right from `x`, `y`, for column heads.
    pub(super) fn slanted(&mut self, x: f64, y: f64, text: &str) {
        let length = text.chars().count() as f64 * Ink::Plain.advance();
        self.reach(x + 0.5 * length, y);
        let text = xml_escaped(&escape_controls(text));
        let _ = writeln!(
            self.body,
            "<text class=\"p\" x=\"{x:.1}\" y=\"{y:.1}\" transform=\"rotate(-60 {x:.1} {y:.1})\">{text}</text>"
        );
    }

    /// Adds a box with a tooltip; `stroke` may be `none`.
    pub(super) fn rect(&mut self, at: [f64; 2], size: [f64; 2], fill: &str, stroke: &str, tip: &str) {
        let ([x, y], [w, h]) = (at, size);
        self.reach(x + w, y + h);
        let _ = write!(
            self.body,
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{w:.1}\" height=\"{h:.1}\" fill=\"{fill}\" stroke=\"{stroke}\""
        );
        self.close("rect", tip);
    }

    /// Adds lines and areas in SVG path syntax, with a tooltip.
    pub(super) fn path(&mut self, path: &str, fill: &str, stroke: &str, tip: &str) {
        let _ = write!(self.body, "<path d=\"{path}\" fill=\"{fill}\" stroke=\"{stroke}\" stroke-width=\"1.5\"");
        self.close("path", tip);
    }

    fn close(&mut self, element: &str, tip: &str) {
        let _ = match tip {
            "" => writeln!(self.body, "/>"),
            tip => writeln!(self.body, "><title>{}</title></{element}>", xml_escaped(tip)),
        };
    }

    /// Returns the document, with `margin` around all shapes.
    pub(super) fn finish(self, margin: f64) -> String {
        let (w, h) = ((self.right + margin).ceil(), (self.bottom + margin).ceil());
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\">\n\
             <style>{STYLE}</style>\n<rect width=\"{w}\" height=\"{h}\" fill=\"#fff\"/>\n{}</svg>\n",
            self.body
        )
    }
}

/// Escapes text for XML 1.0. Characters that XML forbids become U+FFFD.
pub fn xml_escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            // Line feeds separate the lines of a tooltip. U+FFFE and U+FFFF are not XML characters.
            c if c != '\n' && c.is_control() || matches!(c, '\u{FFFE}' | '\u{FFFF}') => out.push('\u{FFFD}'),
            c => out.push(c),
        }
    }
    out
}

/// Shortens text to `letters` characters, ending in an ellipsis.
pub(super) fn shortened(text: &str, letters: usize) -> String {
    if text.chars().count() <= letters {
        return text.into();
    }
    let kept: String = text.chars().take(letters.saturating_sub(1)).collect();
    kept + "…"
}
