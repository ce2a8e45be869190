//! Picture with zoom and pan, and the values of texels.

use crate::live::panel::texture;
use crate::live::preview::{Found, Preview};
use egui::{Color32, Rect, Sense, Stroke, StrokeKind, Ui, pos2, vec2};

/// Shows the values of the texel under the pointer and of the pinned one, and the picture in the remaining space.
pub(super) fn picture(ui: &mut Ui, preview: &mut Preview) {
    let Some(found) = preview.found.clone() else { return };
    let size = found.texels.size;
    let Some((handle, size_px)) = preview
        .picture
        .as_ref()
        .map(|picture| (texture(ui.ctx(), "preview", picture.made, picture.size, &picture.rgba8), picture.size))
    else {
        ui.spinner();
        return;
    };
    // The lines below the picture have a fixed height, so that its size does not depend on them.
    let lines = 3.0 * ui.text_style_height(&egui::TextStyle::Body) + 3.0 * ui.spacing().item_spacing.y;
    let room = vec2(ui.available_width(), ui.available_height() - lines).max(vec2(16.0, 48.0));
    let (response, painter) = ui.allocate_painter(room, Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, format!("texture {}", found.title)));
    let (rect, panel) = (response.rect, [room.x, room.y]);
    if response.dragged() {
        let by = response.drag_delta();
        preview.pan.drag(size_px, panel, [by.x, by.y]);
    }
    if let Some(pointer) = response.hover_pos() {
        let (scroll, pinch) = ui.input(|i| (i.smooth_scroll_delta().y, i.zoom_delta()));
        let factor = pinch * (scroll / 120.0).exp2();
        if factor != 1.0 {
            let at = pointer - rect.center();
            preview.pan.zoom_about(size_px, panel, factor, [at.x, at.y]);
        }
    }
    if response.double_clicked() {
        preview.pan.fit();
    }
    let [left, top, right, bottom] = preview.pan.bounds(size_px, panel);
    let center = rect.center();
    let shown = Rect::from_min_max(center + vec2(left, top), center + vec2(right, bottom));
    let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    painter.image(handle.id(), shown, whole, Color32::WHITE);
    painter.rect_stroke(shown, 0.0, ui.visuals().widgets.noninteractive.bg_stroke, StrokeKind::Outside);
    let zoom = preview.pan.zoom(size_px, panel);
    let at = |pointer: egui::Pos2| {
        let at = (pointer - shown.min) / zoom;
        (at.x >= 0.0 && at.y >= 0.0).then_some([at.x as u32, at.y as u32])
    };
    let hovered = response.hover_pos().and_then(at).filter(|at| found.texel(*at).is_some());
    if response.clicked() {
        preview.pinned = hovered.filter(|at| preview.pinned != Some(*at));
    }
    for [x, y] in [hovered.filter(|_| zoom >= 4.0), preview.pinned].into_iter().flatten() {
        let texel = Rect::from_min_size(shown.min + vec2(x as f32, y as f32) * zoom, vec2(zoom, zoom));
        painter.rect_stroke(texel.expand(1.0), 0.0, Stroke::new(1.5, Color32::BLACK), StrokeKind::Outside);
        painter.rect_stroke(texel, 0.0, Stroke::new(1.0, Color32::WHITE), StrokeKind::Outside);
    }
    let bad = if found.non_finite > 0 { format!(", {} NaN or infinite", found.non_finite) } else { String::new() };
    let [width, height] = size;
    let line = |ui: &mut Ui, text: String| ui.add(egui::Label::new(text).truncate());
    line(ui, format!("{}  {width}x{height} {:?}, {:.0} %{bad}", found.title, found.texels.format, 100.0 * zoom));
    line(ui, preview.pinned.map_or_else(String::new, |at| format!("pinned {}", values(&found, at))));
    line(ui, hovered.map_or_else(|| "click a texel to pin its values".into(), |at| values(&found, at)));
}

/// Returns position and values of a texel.
fn values(found: &Found, [x, y]: [u32; 2]) -> String {
    let Some(texel) = found.texel([x, y]) else { return String::new() };
    let names = if found.is_depth() { ["depth", "", "", ""] } else { ["R", "G", "B", "A"] };
    let numbers = texel.iter().zip(names).take(found.channels()).map(|(value, name)| format!("{name} {value:.6}"));
    let mut text = format!("{x}, {y}: {}", numbers.collect::<Vec<_>>().join("  "));
    if found.is_depth() && found.near_m > 0.0 {
        text += &format!("  {:.3} m", found.near_m / texel[0]);
    }
    text
}
