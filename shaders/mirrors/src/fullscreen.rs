//! Mirror of `wgsl/lib/fullscreen.wgsl`.

use glam::{DVec2, DVec4};

/// Returns the clip position of vertex 0, 1 or 2.
pub fn fullscreen_position(vertex: u32, depth: f64) -> DVec4 {
    let corner = [DVec2::new(-1.0, -1.0), DVec2::new(3.0, -1.0), DVec2::new(-1.0, 3.0)];
    corner[vertex as usize % 3].extend(depth).extend(1.0)
}

/// Returns the texture coordinates of a clip position.
pub fn uv_from_clip(clip: DVec2) -> DVec2 {
    DVec2::new(clip.x * 0.5 + 0.5, 0.5 - clip.y * 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_triangle_covers_every_corner_counter_clockwise() {
        let [a, b, c] = [0, 1, 2].map(|i| fullscreen_position(i, 0.0));
        let side = |p: DVec4, q: DVec4, at: DVec2| (q.x - p.x) * (at.y - p.y) - (q.y - p.y) * (at.x - p.x);
        for corner in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
            let at = DVec2::from(corner);
            let sides = [side(a, b, at), side(b, c, at), side(c, a, at)];
            assert!(sides.iter().all(|s| *s >= 0.0), "{corner:?}: {sides:?}");
        }
    }

    #[test]
    fn the_top_left_corner_is_the_origin() {
        assert_eq!(uv_from_clip(DVec2::new(-1.0, 1.0)), DVec2::ZERO);
        assert_eq!(uv_from_clip(DVec2::new(1.0, -1.0)), DVec2::ONE);
    }
}
