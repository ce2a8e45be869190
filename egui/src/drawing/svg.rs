//! Drawing as an SVG document: one file without links, scripts or embedded fonts.

use super::{ADVANCE, Align, Drawing, Ink, Shape, Theme};
use framegraph::dump::xml_escaped;
use std::fmt::Write;

/// Margin around the shapes, in points.
const MARGIN: f32 = 16.0;

/// Returns the document. Pointer areas become tooltips.
pub fn svg(drawing: &Drawing, theme: Theme) -> String {
    let color = |ink: Ink| {
        let [r, g, b] = ink.rgb(theme);
        format!("#{r:02x}{g:02x}{b:02x}")
    };
    let [w, h] = drawing.size.map(|side| (side + 2.0 * MARGIN).ceil());
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"{m} {m} {w} {h}\">\n\
         <style>text{{font-family:'DejaVu Sans Mono',Hack,Menlo,Consolas,monospace;white-space:pre}}</style>\n\
         <rect x=\"{m}\" y=\"{m}\" width=\"{w}\" height=\"{h}\" fill=\"{}\"/>\n",
        color(Ink::Background),
        m = -MARGIN,
    );
    for shape in &drawing.shapes {
        // Writing to a string never fails.
        let _ = match shape {
            Shape::Rect { bounds: [left, top, right, bottom], fill, stroke, dashed } => writeln!(
                out,
                "<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"{}\" stroke=\"{}\"{}/>",
                right - left,
                bottom - top,
                fill.map_or("none".into(), color),
                stroke.map_or("none".into(), color),
                dashes(*dashed),
            ),
            Shape::Line { points, ink, width, dashed } => {
                let points: Vec<_> = points.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
                let (points, ink) = (points.join(" "), color(*ink));
                writeln!(
                    out,
                    "<polyline points=\"{points}\" fill=\"none\" stroke=\"{ink}\" stroke-width=\"{width}\"{}/>",
                    dashes(*dashed)
                )
            }
            Shape::Triangle { points, ink } => {
                let points = points.map(|[x, y]| format!("{x:.1},{y:.1}")).join(" ");
                writeln!(out, "<polygon points=\"{points}\" fill=\"{}\"/>", color(*ink))
            }
            Shape::Text { at: [x, y], size, align, ink, turned, text } => {
                let anchor = match align {
                    Align::Left => "start",
                    Align::Center => "middle",
                    Align::Right => "end",
                };
                let turn = if *turned == 0.0 {
                    String::new()
                } else {
                    format!(" transform=\"rotate({:.0} {x:.1} {y:.1})\"", -turned)
                };
                let length = text.chars().count() as f32 * size * ADVANCE;
                writeln!(
                    out,
                    "<text x=\"{x:.1}\" y=\"{y:.1}\" dy=\"0.35em\" font-size=\"{size}\" text-anchor=\"{anchor}\" \
                     textLength=\"{length:.1}\" fill=\"{}\"{turn}>{}</text>",
                    color(*ink),
                    xml_escaped(text)
                )
            }
        };
    }
    for hit in drawing.hits.iter().filter(|h| !h.tip.is_empty()) {
        let [left, top, right, bottom] = hit.bounds;
        let _ = writeln!(
            out,
            "<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"transparent\"><title>{}</title></rect>",
            right - left,
            bottom - top,
            xml_escaped(&hit.tip)
        );
    }
    out += "</svg>\n";
    out
}

const fn dashes(dashed: bool) -> &'static str {
    if dashed { " stroke-dasharray=\"4 3\"" } else { "" }
}
