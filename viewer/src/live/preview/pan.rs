//! Zoom and position of a picture in its panel.

/// Minimum and maximum zoom, in points per texel.
const ZOOM: [f32; 2] = [1.0 / 64.0, 64.0];

/// Zoom and position.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pan {
    /// Points per texel; `None` fits the picture into its panel.
    zoom: Option<f32>,
    /// Center of the picture relative to the center of the panel, in points.
    offset: [f32; 2],
}

impl Pan {
    /// Fits the picture into its panel.
    pub fn fit(&mut self) {
        *self = Self::default();
    }

    /// Shows one texel per point times `zoom`, in the center.
    pub fn set_zoom(&mut self, zoom: f32) {
        *self = Self { zoom: Some(zoom), offset: [0.0; 2] };
    }

    /// Returns the zoom in points per texel.
    pub fn zoom(&self, size: [u32; 2], panel: [f32; 2]) -> f32 {
        let fitted = || {
            let [x, y] = [0, 1].map(|axis| panel[axis].max(1.0) / size[axis].max(1) as f32);
            x.min(y).clamp(ZOOM[0], ZOOM[1])
        };
        self.zoom.unwrap_or_else(fitted)
    }

    /// Moves the picture by points.
    pub fn drag(&mut self, size: [u32; 2], panel: [f32; 2], by: [f32; 2]) {
        self.zoom = Some(self.zoom(size, panel));
        // The center of the panel stays within the picture.
        let reach = [0, 1].map(|axis| 0.5 * size[axis] as f32 * self.zoom(size, panel));
        self.offset = [0, 1].map(|axis| (self.offset[axis] + by[axis]).clamp(-reach[axis], reach[axis]));
    }

    /// Zooms by a factor about a position relative to the center of the panel, in points.
    pub fn zoom_about(&mut self, size: [u32; 2], panel: [f32; 2], factor: f32, at: [f32; 2]) {
        let before = self.zoom(size, panel);
        let after = (before * factor).clamp(ZOOM[0], ZOOM[1]);
        let moved = [0, 1].map(|axis| at[axis] + (self.offset[axis] - at[axis]) * after / before);
        (self.zoom, self.offset) = (Some(after), moved);
        self.drag(size, panel, [0.0; 2]);
    }

    /// Returns left, top, right and bottom of the picture relative to the center of the panel, in points.
    pub fn bounds(&self, size: [u32; 2], panel: [f32; 2]) -> [f32; 4] {
        let zoom = self.zoom(size, panel);
        let half = size.map(|side| 0.5 * side as f32 * zoom);
        let [x, y] = self.offset;
        [x - half[0], y - half[1], x + half[0], y + half[1]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_is_fitted_zoomed_at_the_pointer_and_stays_in_sight() {
        let (size, panel) = ([100, 50], [200.0, 200.0]);
        let mut pan = Pan::default();
        assert_eq!((pan.zoom(size, panel), pan.bounds(size, panel)), (2.0, [-100.0, -50.0, 100.0, 50.0]));
        // The texel under the pointer stays there.
        pan.zoom_about(size, panel, 4.0, [50.0, 25.0]);
        assert_eq!((pan.zoom(size, panel), pan.bounds(size, panel)), (8.0, [-550.0, -275.0, 250.0, 125.0]));
        pan.drag(size, panel, [1e6, -1e6]);
        assert_eq!(pan.bounds(size, panel)[0], 0.0);
        pan.set_zoom(1.0);
        assert_eq!(pan.bounds(size, panel), [-50.0, -25.0, 50.0, 25.0]);
        pan.fit();
        assert_eq!(pan, Pan::default());
        assert!(pan.zoom([0, 0], [0.0, -4.0]).is_finite());
    }
}
