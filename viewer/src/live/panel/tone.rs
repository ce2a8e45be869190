//! Plot of the tone curve, from scene light to display values, with the function of the current look.

use crate::drawing::Ink;
use crate::panel::{color, theme};
use egui::{Align2, FontId, Pos2, Sense, Shape, Stroke, Ui, pos2, vec2};
use framegraph_passes::PostSettings;
use framegraph_passes::grading::Extras;
use glam::DVec3;

/// Plotted range in stops about middle gray.
const STOPS: [f64; 2] = [-8.0, 8.0];
/// Scene luminance of middle gray.
const MIDDLE: f64 = 0.18;
/// Number of points of the curve.
const POINTS: usize = 97;

/// Returns the display value, 0 to 1 per channel, of a gray at `stops` above middle gray, before dither.
pub(super) fn codes(post: &PostSettings, stops: f64) -> Option<DVec3> {
    let extras = Extras::default();
    let function = post.look.function(&extras).ok()?;
    let light = MIDDLE * (stops + f64::from(post.compensation_ev)).exp2();
    Some(function(DVec3::splat(light)))
}

/// Plots the curve of each channel over stops.
pub(super) fn curve(ui: &mut Ui, post: &PostSettings) {
    egui::CollapsingHeader::new("tone curve").default_open(false).show(ui, |ui| {
        let size = vec2(ui.available_width().clamp(120.0, 420.0), 130.0);
        let (response, painter) = ui.allocate_painter(size, Sense::hover());
        let rect = response.rect.shrink2(vec2(4.0, 12.0));
        let theme = theme(ui);
        let faint = color(Ink::Faint, theme);
        painter.rect_stroke(rect, 0.0, Stroke::new(1.0, faint), egui::StrokeKind::Middle);
        let [low, high] = STOPS;
        let at = |stops: f64, code: f64| {
            let x = rect.left() + rect.width() * ((stops - low) / (high - low)) as f32;
            pos2(x, rect.bottom() - rect.height() * code.clamp(0.0, 1.0) as f32)
        };
        painter.line_segment([at(0.0, 0.0), at(0.0, 1.0)], Stroke::new(1.0, faint));
        let found: Vec<(f64, DVec3)> = (0..POINTS)
            .map(|index| low + (high - low) * index as f64 / (POINTS - 1) as f64)
            .filter_map(|stops| Some((stops, codes(post, stops)?)))
            .collect();
        for (channel, [r, g, b]) in super::curves::CHANNELS.into_iter().enumerate() {
            let points: Vec<Pos2> = found.iter().map(|(stops, codes)| at(*stops, codes[channel])).collect();
            painter.add(Shape::line(points, Stroke::new(1.5, egui::Color32::from_rgb(r, g, b))));
        }
        let font = FontId::proportional(10.0);
        for (stops, text) in [(low, "-8"), (0.0, "middle gray"), (high, "+8 stops")] {
            let align = if stops < 0.0 {
                Align2::LEFT_TOP
            } else if stops > 0.0 {
                Align2::RIGHT_TOP
            } else {
                Align2::CENTER_TOP
            };
            painter.text(at(stops, 0.0), align, text, font.clone(), color(Ink::Text, theme));
        }
        if let Some(pointer) = response.hover_pos() {
            let stops = low + (high - low) * f64::from((pointer.x - rect.left()) / rect.width());
            if let Some(codes) = codes(post, stops) {
                let codes = codes * 255.0;
                response
                    .on_hover_text(format!("{stops:+.2} stops: {:.0} {:.0} {:.0} of 255", codes.x, codes.y, codes.z));
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_rises_and_compensation_shifts_it() {
        let mut post = PostSettings::DEFAULT;
        let plain: Vec<f64> = (-8..=8).filter_map(|stops| Some(codes(&post, stops.into())?.y)).collect();
        assert!(plain.len() == 17 && plain.is_sorted() && plain[0] < 0.05 && plain[16] > 0.95, "{plain:?}");
        post.compensation_ev = 1.0;
        assert_eq!(codes(&post, 1.0).map(|c| c.y), Some(plain[10]));
    }
}
