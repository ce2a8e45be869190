//! Shimmer: changes of shadows at fixed points while the camera turns and moves.

use super::{SIZE, Set, TestResult, field};
use crate::stage::gpu;
use framegraph_passes::gpu_scene::shadow_views::{Fit, ShadowSettings};
use framegraph_scene::Camera;
use framegraph_wgpu::Gpu;
use glam::{DQuat, DVec2, DVec3, Vec2};
use std::error::Error;
use truth::rays::Hit;

/// Number of pictures along a camera path.
const FRAMES: u32 = 7;

/// Visibility and surface of each pixel.
struct Seen {
    camera: Camera,
    visibility: Vec<Option<f64>>,
    hits: Vec<Option<Hit>>,
}

impl Seen {
    /// Returns the visibility of a point, interpolated from four pixels; `None` if one of them shows another surface.
    fn at(&self, place: &Hit) -> Option<f64> {
        let [width, height] = SIZE.map(f64::from);
        let clip = self.camera.clip_from_view(width / height) * self.camera.view_from_world() * place.point.extend(1.0);
        let ndc = clip.truncate() / clip.w;
        let pixel = DVec2::new((0.5 + 0.5 * ndc.x) * width, (0.5 - 0.5 * ndc.y) * height) - 0.5;
        let (low, share) = (pixel.floor(), pixel - pixel.floor());
        let mut sum = 0.0;
        for (x, y) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
            let at = low + DVec2::new(x, y);
            if at.x < 0.0 || at.y < 0.0 || at.x >= width || at.y >= height {
                return None;
            }
            let index = (at.y * width + at.x) as usize;
            let hit = self.hits[index]?;
            let same = hit.normal.dot(place.normal) > 0.999 && (hit.point - place.point).dot(place.normal).abs() < 1e-3;
            let weight = (1.0 - (x - share.x).abs()) * (1.0 - (y - share.y).abs());
            sum += weight * self.visibility[index].filter(|_| same)?;
        }
        Some(sum)
    }
}

/// Returns the root mean square difference of visibility between consecutive pictures, at points visible in both. The
/// camera moves by `step` and turns by `turn_rad` per picture; maps are offset by `moved` texels.
fn shimmer(
    gpu: &Gpu,
    settings: ShadowSettings,
    (step, turn_rad): (DVec3, f64),
    moved: impl Fn(u32) -> Vec2,
) -> Result<f64, Box<dyn Error>> {
    let (mut squares, mut count) = (0.0, 0.0);
    let mut before: Option<Seen> = None;
    for frame in 0..FRAMES {
        let mut set = Set { moved_texels: moved(frame), ..field()? };
        set.camera.eye += step * f64::from(frame);
        set.camera.world_from_view = DQuat::from_rotation_y(turn_rad * f64::from(frame)) * set.camera.world_from_view;
        let hits = set.seen(&set.triangles());
        let now = Seen { visibility: set.visibility(gpu, settings)?, hits, camera: set.camera };
        for (visibility, hit) in now.visibility.iter().zip(&now.hits) {
            let (Some(visibility), Some(hit), Some(before)) = (visibility, hit, &before) else { continue };
            if let Some(was) = before.at(hit) {
                squares += (visibility - was) * (visibility - was);
                count += 1.0;
            }
        }
        before = Some(now);
    }
    assert!(count > 15_000.0, "{count} places were compared");
    Ok((squares / count).sqrt())
}

/// Stable cascades change no shadow during camera motion, apart from the sampling of edges by the picture's own pixels.
/// Negative controls: maps offset by fractions of texels, and maps that are fitted to each view, change several times
/// as much.
#[test]
fn stable_cascades_do_not_shimmer() -> TestResult {
    let Some(gpu) = gpu("stable_cascades_do_not_shimmer") else { return Ok(()) };
    // Texels are wider than pixels, so that edges are smooth and only the map's effect remains.
    let stable =
        ShadowSettings { fit: Fit::Stable, cascades: 1, map_texels: 128, far_m: Some(30.0), ..ShadowSettings::DEFAULT };
    let tight = ShadowSettings { fit: Fit::Tight { lispsm: false }, ..stable };
    let stands = |_| Vec2::ZERO;
    // Offsets as of unrounded centers: uniform within a texel, by the additive recurrence of the plastic number.
    let falls = |frame: u32| (Vec2::new(0.754_878, 0.569_840) * frame as f32).fract() - 0.5;
    let turning = (DVec3::ZERO, 0.02);
    let moving = (DVec3::new(0.03, 0.005, -0.045), 0.0);
    for (name, path) in [("turning", turning), ("moving", moving)] {
        let still = shimmer(&gpu, stable, path, stands)?;
        let unsnapped = shimmer(&gpu, stable, path, falls)?;
        let refitted = shimmer(&gpu, tight, path, stands)?;
        println!("{name}: stable {still:.4}, without whole texels {unsnapped:.4}, tight {refitted:.4}");
        assert!(unsnapped.min(refitted) > 2.5 * still, "{name}: {still} {unsnapped} {refitted}");
    }
    Ok(())
}
