//! Tests of the drawn part of a grid.

use super::*;
use crate::synthetic::large;

/// Returns the number of visible rows and of drawn shapes, in the middle of a table of 1280×720 points.
fn drawn(passes: usize) -> (usize, usize) {
    let plan = large(passes).expect("a plan");
    let shown = Shown { plan: &plan, trace: None, generation: 1, lit: &[] };
    let mut grid = Grid::new(Kind::Timeline);
    grid.make(shown);
    let counts = grid.made.as_ref().map(|made| [made.table.len(), made.rows.len()]).expect("a table");
    assert_eq!(counts[1], passes + 1, "a row for each texture and for the screen");
    let (rect, mut shapes) = (Rect::from_min_max(pos2(0.0, 0.0), pos2(1280.0, 720.0)), 0);
    let body = Rect::from_min_max(pos2(200.0, 120.0), rect.max);
    grid.view.scroll = 0.5 * (grid.view.content(counts) - body.size());
    let context = egui::Context::default();
    let mut output = context.run_ui(egui::RawInput::default(), |ui| {
        let parts = grid.paint(ui, &ui.painter().clone(), shown, rect, body, 0.0);
        shapes = parts.iter().map(|(_, drawing)| drawing.shapes.len()).sum();
    });
    output.textures_delta.clear();
    (grid.view.visible(1, counts[1], body.size()).len(), shapes)
}

#[test]
fn only_visible_cells_are_drawn() {
    let [(rows, few), (same, many)] = [200, 2000].map(drawn);
    assert!(rows == same && rows < 60, "{rows} and {same} visible rows");
    assert!(many >= rows && many < few + few / 4, "{few} and {many} shapes");
}
