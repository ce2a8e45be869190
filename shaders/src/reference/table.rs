//! Mirror of `wgsl/lib/table.wgsl`.

use super::grading::log_c_from_linear;
use glam::DVec3;

/// Returns the coordinates of a linear Rec.709 color in a table with `entries` entries along each axis.
pub fn table_coordinates(color: DVec3, entries: f64) -> DVec3 {
    let x = log_c_from_linear(color.min(DVec3::splat(65504.0))).clamp(DVec3::ZERO, DVec3::ONE);
    (x * (entries - 1.0) + 0.5) / entries
}
