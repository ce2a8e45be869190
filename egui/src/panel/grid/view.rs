//! Scroll position and zoom of a grid.

use egui::{Vec2, vec2};

/// Minimum and maximum width of a column, and height of a row, in points.
const CELL: [[f32; 2]; 2] = [[2.0, 240.0], [3.0, 60.0]];

/// Scroll position and cell size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridView {
    /// Content at the left and top of the body, in points.
    pub scroll: Vec2,
    /// Width of a column and height of a row, in points.
    pub cell: Vec2,
}

impl GridView {
    /// Returns the size of the content.
    pub fn content(&self, counts: [usize; 2]) -> Vec2 {
        vec2(counts[0] as f32, counts[1] as f32) * self.cell
    }

    /// Limits the scroll position to the content.
    pub fn limit(&mut self, counts: [usize; 2], body: Vec2) {
        let limit = self.content(counts) - body;
        self.scroll = self.scroll.min(limit).max(Vec2::ZERO);
    }

    /// Sets the cell size, and keeps the content at a position of the body.
    pub fn zoom(&mut self, cell: Vec2, at: Vec2) {
        let cell = vec2(cell.x.clamp(CELL[0][0], CELL[0][1]), cell.y.clamp(CELL[1][0], CELL[1][1]));
        self.scroll = (self.scroll + at) / self.cell * cell - at;
        self.cell = cell;
    }

    /// Fits all columns and rows into the body as far as the limits of the cell size allow.
    pub fn fit(&mut self, counts: [usize; 2], body: Vec2) {
        self.zoom(body / vec2(counts[0].max(1) as f32, counts[1].max(1) as f32), Vec2::ZERO);
        self.scroll = Vec2::ZERO;
    }

    /// Scrolls so that a cell is visible; the column or the row may be unspecified.
    pub fn reveal(&mut self, cell: [Option<usize>; 2], body: Vec2) {
        for (axis, index) in cell.into_iter().enumerate() {
            let Some(index) = index else { continue };
            let (begin, size) = (index as f32 * self.cell[axis], self.cell[axis]);
            let end = begin + size - body[axis];
            if self.scroll[axis] > begin || self.scroll[axis] < end {
                self.scroll[axis] = begin + 0.5 * (size - body[axis]);
            }
        }
    }

    /// Returns the visible columns or rows.
    pub fn visible(&self, axis: usize, count: usize, body: Vec2) -> std::ops::Range<usize> {
        let first = (self.scroll[axis] / self.cell[axis]).max(0.0) as usize;
        let last = ((self.scroll[axis] + body[axis]) / self.cell[axis]).ceil().max(0.0) as usize;
        first.min(count)..last.min(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_revealed_zoomed_and_limited() {
        let mut view = GridView { scroll: Vec2::ZERO, cell: vec2(50.0, 20.0) };
        let (counts, body) = ([2000, 2000], vec2(500.0, 200.0));
        assert_eq!((view.visible(0, 2000, body), view.visible(1, 2000, body)), (0..10, 0..10));
        view.reveal([None, Some(1000)], body);
        assert!(view.scroll.x == 0.0 && view.visible(1, 2000, body).contains(&1000), "{view:?}");
        let before = view;
        view.reveal([Some(3), Some(1001)], body);
        assert_eq!(view, before, "a visible cell does not scroll");
        view.zoom(vec2(100.0, 20.0), vec2(100.0, 0.0));
        assert_eq!(view.scroll.x, 100.0, "the content under the pointer stays");
        view.scroll = vec2(1e9, -1e9);
        view.limit(counts, body);
        assert_eq!(view.scroll, vec2(2000.0 * 100.0 - 500.0, 0.0));
        view.fit([4, 10], body);
        assert_eq!((view.cell, view.visible(1, 10, body)), (vec2(125.0, 20.0), 0..10));
        view.limit([0, 0], vec2(-5.0, 0.0));
        assert!(view.scroll.x >= 0.0 && view.visible(0, 0, vec2(-5.0, 0.0)).is_empty());
    }
}
