//! Curve editor of grading: shadow gamma, middle and highlight scale per channel, edited with handles.

use crate::drawing::Ink;
use crate::panel::{color, theme};
use egui::{CollapsingHeader, Color32, Painter, Pos2, Rect, Role, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2};
use framegraph_shaders::layout::Grading;
use framegraph_shaders::reference::grading::toe_and_shoulder;
use glam::Vec3;

/// Plotted range of linear light in stops about 1, on both axes.
const STOPS: [f32; 2] = [-8.0, 4.0];
/// Positions of the outer handles in stops from the middle: shadows and highlights.
const HANDLES: [f32; 2] = [-3.0, 2.0];
/// Number of points per curve.
const POINTS: u8 = 96;
/// Channel colors that color-blind users can distinguish.
pub(super) const CHANNELS: [[u8; 3]; 3] = [[213, 94, 0], [0, 158, 115], [0, 114, 178]];

/// Parameter that a handle edits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Handle {
    /// Exponent below the middle.
    Gamma,
    /// Middle, along the diagonal.
    Middle,
    /// Slope above the middle.
    Scale,
}

impl Handle {
    const ALL: [Self; 3] = [Self::Gamma, Self::Middle, Self::Scale];

    const fn name(self) -> &'static str {
        match self {
            Self::Gamma => "shadow gamma",
            Self::Middle => "middle",
            Self::Scale => "highlight scale",
        }
    }

    /// Returns its position on a channel's curve: input and output light in stops about 1.
    pub fn place(self, grading: &Grading, channel: usize) -> [f32; 2] {
        let middle = grading.middle[channel].max(1e-5);
        let stops = middle.log2()
            + match self {
                Self::Gamma => HANDLES[0],
                Self::Middle => 0.0,
                Self::Scale => HANDLES[1],
            };
        [stops, out_stops(grading, channel, stops)]
    }

    /// Moves the handle to a position in stops, for the selected channels.
    pub fn drag(self, grading: &mut Grading, chosen: [bool; 3], [in_stops, out_stops]: [f32; 2]) {
        for channel in (0..3).filter(|channel| chosen[*channel]) {
            let middle = grading.middle[channel].max(1e-5);
            // Convert the position to the parameter of the settings.
            match self {
                Self::Gamma => {
                    grading.shadow_gamma[channel] = ((out_stops - middle.log2()) / HANDLES[0]).clamp(0.05, 8.0);
                }
                Self::Middle => grading.middle[channel] = in_stops.clamp(STOPS[0], STOPS[1]).exp2(),
                Self::Scale => {
                    let over = (out_stops.exp2() / middle - 1.0) / (HANDLES[1].exp2() - 1.0);
                    grading.highlight_scale[channel] = over.clamp(0.0, 16.0);
                }
            }
        }
    }
}

/// Returns the output of a channel in stops about 1.
fn out_stops(grading: &Grading, channel: usize, in_stops: f32) -> f32 {
    let [gamma, middle, scale] = [grading.shadow_gamma, grading.middle, grading.highlight_scale].map(|of| of[channel]);
    let light = toe_and_shoulder(in_stops.exp2().into(), gamma.max(1e-5).into(), middle.max(1e-5).into(), scale.into());
    (light.max(1e-9) as f32).log2()
}

/// Plots the three curves with handles for the selected channels; returns whether grading changed.
pub(super) fn curves(ui: &mut Ui, grading: &mut Grading) -> bool {
    let before = *grading;
    CollapsingHeader::new("curves").default_open(false).show(ui, |ui| {
        let id = ui.scope_id().with("channels");
        let mut chosen = ui.data(|data| data.get_temp::<[bool; 3]>(id)).unwrap_or([true; 3]);
        ui.horizontal(|ui| {
            let tip = "Channels that the handles edit";
            for (only, name) in [
                ([true; 3], "all"),
                ([true, false, false], "red"),
                ([false, true, false], "green"),
                ([false, false, true], "blue"),
            ] {
                if ui.selectable_label(chosen == only, name).on_hover_text(tip).clicked() {
                    chosen = only;
                }
            }
            if ui.small_button("Reset").on_hover_text("Reset to neutral curves").clicked() {
                (grading.shadow_gamma, grading.middle, grading.highlight_scale) = (Vec3::ONE, Vec3::ONE, Vec3::ONE);
            }
        });
        ui.data_mut(|data| data.insert_temp(id, chosen));
        plot(ui, grading, chosen);
    });
    *grading != before
}

/// Mapping from stops to the screen.
#[derive(Clone, Copy, Debug)]
struct Axes(Rect);

impl Axes {
    fn at(self, [x, y]: [f32; 2]) -> Pos2 {
        let [low, high] = STOPS;
        let share = |stops: f32| ((stops - low) / (high - low)).clamp(0.0, 1.0);
        pos2(self.0.left() + self.0.width() * share(x), self.0.bottom() - self.0.height() * share(y))
    }

    fn stops(self, at: Pos2) -> [f32; 2] {
        let [low, high] = STOPS;
        let (x, y) = ((at.x - self.0.left()) / self.0.width(), (self.0.bottom() - at.y) / self.0.height());
        [x, y].map(|share| low + (high - low) * share)
    }
}

fn plot(ui: &mut Ui, grading: &mut Grading, chosen: [bool; 3]) {
    let side = ui.available_width().clamp(120.0, 260.0);
    let (response, painter) = ui.allocate_painter(vec2(side, side), Sense::hover());
    let axes = Axes(response.rect.shrink(7.0));
    let faint = Stroke::new(1.0, color(Ink::Faint, theme(ui)));
    painter.rect_stroke(axes.0, 0.0, faint, egui::StrokeKind::Middle);
    painter.line_segment([axes.at([STOPS[0]; 2]), axes.at([STOPS[1]; 2])], faint);
    for channel in 0..3 {
        line(&painter, axes, grading, channel);
    }
    let Some(shown) = chosen.iter().position(|is| *is) else { return };
    for handle in Handle::ALL {
        let at = axes.at(handle.place(grading, shown));
        let held =
            ui.interact(Rect::from_center_size(at, vec2(14.0, 14.0)), response.id.with(handle.name()), Sense::drag());
        held.widget_info(|| WidgetInfo::labeled(Role::Slider, true, handle.name()));
        if held.dragged()
            && let Some(pointer) = held.interact_pointer_pos()
        {
            handle.drag(grading, chosen, axes.stops(pointer));
        }
        let ink = color(if held.hovered() || held.dragged() { Ink::Selected } else { Ink::Text }, theme(ui));
        painter.circle(
            axes.at(handle.place(grading, shown)),
            4.5,
            ui.visuals().extreme_bg_color,
            Stroke::new(1.5, ink),
        );
        let [gamma, middle, scale] =
            [grading.shadow_gamma, grading.middle, grading.highlight_scale].map(|of| of[shown]);
        held.on_hover_text(match handle {
            Handle::Gamma => format!("shadow gamma {gamma:.3}"),
            Handle::Middle => format!("middle {middle:.3}"),
            Handle::Scale => format!("highlight scale {scale:.3}"),
        });
    }
}

fn line(painter: &Painter, axes: Axes, grading: &Grading, channel: usize) {
    let [low, high] = STOPS;
    let point = |index: u8| {
        let stops = low + (high - low) * f32::from(index) / f32::from(POINTS);
        axes.at([stops, out_stops(grading, channel, stops)])
    };
    let [r, g, b] = CHANNELS[channel];
    painter.add(Shape::line((0..=POINTS).map(point).collect(), Stroke::new(1.5, Color32::from_rgb(r, g, b))));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A dragged handle stays at its position, and only selected channels change.
    #[test]
    fn curves_go_through_their_handles() {
        for handle in Handle::ALL {
            let mut grading = Grading { middle: Vec3::new(0.5, 0.3, 0.8), ..Grading::NEUTRAL };
            let start = handle.place(&grading, 1);
            let to = if handle == Handle::Middle { [-2.0, -2.0] } else { [start[0], start[1] + 0.7] };
            handle.drag(&mut grading, [false, true, true], to);
            let [x, y] = handle.place(&grading, 1);
            assert!((x - to[0]).abs() < 1e-4 && (y - to[1]).abs() < 1e-4, "{handle:?}: {x} {y} for {to:?}");
            assert_eq!(grading.middle.x, 0.5);
            assert_eq!((grading.shadow_gamma.x, grading.highlight_scale.x), (1.0, 1.0));
        }
        let mut straight = Grading::NEUTRAL;
        for handle in Handle::ALL {
            let place = handle.place(&straight, 0);
            assert!((place[0] - place[1]).abs() < 1e-5, "neutral curves are the diagonal: {place:?}");
            handle.drag(&mut straight, [true; 3], place);
        }
        let off =
            [straight.shadow_gamma, straight.middle, straight.highlight_scale].map(|of| (of - 1.0).abs().max_element());
        assert!(off.into_iter().all(|off| off < 1e-5), "{straight:?}");
    }
}
