//! Shapes and text as SVG elements, and how far they reach.

use crate::plain::plain;
use std::fmt::Write;

/// Space around everything, in user units (one unit is a pixel at 100 %).
pub(super) const MARGIN: f64 = 16.0;
/// Width of the column of names on the left, shared by matrix and memory map.
pub(super) const NAMES: f64 = 330.0;
/// Width of a step.
pub(super) const STEP: f64 = 40.0;

/// The left edge of a step.
pub(super) fn step_x(step: usize) -> f64 {
    MARGIN + NAMES + STEP * step as f64
}

/// How text looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ink {
    /// The heading of the picture.
    Title,
    /// The heading of a part.
    Heading,
    /// Names and figures.
    Plain,
    /// What matters less.
    Faint,
    /// Inside of a coloured box.
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

    /// Width of a letter, in user units: the fonts asked for are monospaced.
    pub(super) const fn advance(self) -> f64 {
        match self {
            Self::Title => 10.8,
            Self::Heading => 8.4,
            Self::Plain | Self::Faint => 7.2,
            Self::Small => 6.0,
        }
    }
}

const STYLE: &str = "\
text{font-family:'DejaVu Sans Mono',Menlo,Consolas,monospace;font-size:12px;fill:#222}\
.t{font-size:18px;font-weight:bold}.h{font-size:14px;font-weight:bold}.f{fill:#666}.s{font-size:10px}";

/// A document in the making.
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

    /// Text whose line of writing starts at `x`, `y`.
    pub(super) fn text(&mut self, x: f64, y: f64, ink: Ink, text: &str) {
        let letters = text.chars().count() as f64;
        self.reach(x + letters * ink.advance(), y + 4.0);
        let class = ink.class();
        // Writing to a string cannot fail; here and below.
        let _ =
            writeln!(self.body, "<text class=\"{class}\" x=\"{x:.1}\" y=\"{y:.1}\">{}</text>", escaped(&plain(text)));
    }

    /// Text that climbs to the right from `x`, `y`, as column heads do.
    pub(super) fn slanted(&mut self, x: f64, y: f64, text: &str) {
        let length = text.chars().count() as f64 * Ink::Plain.advance();
        self.reach(x + 0.5 * length, y);
        let text = escaped(&plain(text));
        let _ = writeln!(
            self.body,
            "<text class=\"p\" x=\"{x:.1}\" y=\"{y:.1}\" transform=\"rotate(-60 {x:.1} {y:.1})\">{text}</text>"
        );
    }

    /// A box with a tooltip; `stroke` may be `none`.
    pub(super) fn rect(&mut self, at: [f64; 2], size: [f64; 2], fill: &str, stroke: &str, tip: &str) {
        let ([x, y], [w, h]) = (at, size);
        self.reach(x + w, y + h);
        let _ = write!(
            self.body,
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{w:.1}\" height=\"{h:.1}\" fill=\"{fill}\" stroke=\"{stroke}\""
        );
        self.close("rect", tip);
    }

    /// Lines and areas in SVG's path language, with a tooltip.
    pub(super) fn path(&mut self, path: &str, fill: &str, stroke: &str, tip: &str) {
        let _ = write!(self.body, "<path d=\"{path}\" fill=\"{fill}\" stroke=\"{stroke}\" stroke-width=\"1.5\"");
        self.close("path", tip);
    }

    fn close(&mut self, element: &str, tip: &str) {
        let _ = match tip {
            "" => writeln!(self.body, "/>"),
            tip => writeln!(self.body, "><title>{}</title></{element}>", escaped(tip)),
        };
    }

    /// The whole document, with `margin` beyond the farthest shape.
    pub(super) fn finish(self, margin: f64) -> String {
        let (w, h) = ((self.right + margin).ceil(), (self.bottom + margin).ceil());
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\">\n\
             <style>{STYLE}</style>\n<rect width=\"{w}\" height=\"{h}\" fill=\"#fff\"/>\n{}</svg>\n",
            self.body
        )
    }
}

/// Text that XML 1.0 can hold, of which names are [`plain`] already.
pub(super) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            // Line feeds part the lines of a tooltip. The two last of the plane are no characters of XML.
            c if c != '\n' && c.is_control() || matches!(c, '\u{FFFE}' | '\u{FFFF}') => out.push('\u{FFFD}'),
            c => out.push(c),
        }
    }
    out
}

/// At most `letters` letters, the last of them an ellipsis where some are left out.
pub(super) fn shortened(text: &str, letters: usize) -> String {
    if text.chars().count() <= letters {
        return text.into();
    }
    let kept: String = text.chars().take(letters.saturating_sub(1)).collect();
    kept + "…"
}
