//! Selection of punctual lights, with the reasons for dropped ones.

use super::reach::Reach;
use crate::gpu_scene::shadow_views::FitCamera;
use crate::gpu_scene::upload::pack::light_uniforms;
use framegraph_scene::{Aabb, Frustum, Light, Renderables, Scene};
use framegraph_shaders::layout::LightError;
use glam::{DVec3, DVec4};

/// Maximum number of tests of lights against boxes. Above it, one box around all visible instances is tested.
const MAX_TESTS: usize = 1 << 20;

/// Reason why a light cannot contribute to a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DropReason {
    /// Intensity or color is zero.
    Off,
    /// The light is invalid.
    Unusable(LightError),
    /// Reaches no point beyond the near plane.
    Behind,
    /// Reaches no point in front of the far plane.
    Beyond,
    /// Reaches no point within the borders of the picture.
    Beside,
    /// Reaches no visible surface.
    NoSurface,
}

impl std::fmt::Display for DropReason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Off => f.write_str("off"),
            Self::Unusable(_) => f.write_str("unusable"),
            Self::Behind => f.write_str("behind the camera"),
            Self::Beyond => f.write_str("beyond the far plane"),
            Self::Beside => f.write_str("beside the view"),
            Self::NoSurface => f.write_str("out of reach of what is seen"),
        }
    }
}

/// Lights of a scene for cameras that share them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Selection<'a> {
    /// Lights that may contribute: those without a finite range first, the others in scene order.
    pub kept: Vec<&'a Light>,
    /// Number of lights without a finite range.
    pub everywhere: usize,
    /// Indices of dropped lights in the scene. The sun is in neither list.
    pub dropped: Vec<(usize, DropReason)>,
}

impl Selection<'_> {
    /// Returns true if some light and some instance may share no light channel.
    pub fn differs_in_channels(&self, instances: &Renderables) -> bool {
        let common = self.kept.iter().fold(instances.common_light_channels(), |common, light| common & light.channels);
        common == 0 && !self.kept.is_empty()
    }
}

/// Selects lights except the sun. A light is kept if any camera may see a surface that it reaches.
pub(crate) fn select<'a>(
    scene: &'a Scene,
    renderables: &Renderables,
    sun: Option<&Light>,
    cameras: &[FitCamera<'_>],
) -> Selection<'a> {
    let is_sun = |light: &Light| sun.is_some_and(|sun| std::ptr::eq(sun, light));
    let (mut found, mut ending) = (Selection::default(), Vec::new());
    if scene.lights.iter().all(is_sun) {
        return found;
    }
    let bounds = renderables.whole();
    let views: Vec<Seen> = cameras.iter().map(|camera| Seen::new(renderables, scene.lights.len(), camera)).collect();
    for (number, light) in scene.lights.iter().enumerate().filter(|(_, light)| !is_sun(light)) {
        match why_not(light, &bounds, &views) {
            Ok(true) => ending.push(light),
            Ok(false) => found.kept.push(light),
            Err(why) => found.dropped.push((number, why)),
        }
    }
    found.everywhere = found.kept.len();
    found.kept.extend(ending);
    found
}

/// Returns true if a kept light has a finite range; otherwise the reason for dropping it.
fn why_not(light: &Light, bounds: &Aabb, views: &[Seen]) -> Result<bool, DropReason> {
    if !light.is_on() {
        return Err(DropReason::Off);
    }
    light_uniforms(light, DVec3::ZERO, 1.0).map_err(DropReason::Unusable)?;
    let mut why = None;
    for view in views {
        let Some(reach) = Reach::of(light, view.eye, bounds) else { return Ok(false) };
        match view.misses(&reach) {
            None => return Ok(true),
            Some(own) => why = why.or(Some(own)),
        }
    }
    Err(why.unwrap_or(DropReason::NoSurface))
}

/// Region that one camera may see.
struct Seen {
    eye: DVec3,
    /// Planes left, right, bottom, top, near, and far if any; world axes, relative to the eye.
    planes: Vec<DVec4>,
    surfaces: Vec<Aabb>,
}

impl Seen {
    fn new(scene: &Renderables, lights: usize, FitCamera { camera, width_over_height }: &FitCamera<'_>) -> Self {
        let frustum = Frustum::of_camera(camera, *width_over_height);
        let mut seen = Vec::new();
        scene.boxes().reaching(camera.eye, frustum.planes(), None, &mut seen);
        let bounds = seen.iter().map(|number| scene.bounds()[*number as usize]);
        let mut surfaces: Vec<Aabb> = bounds.filter(|bounds| frustum.may_see(bounds)).collect();
        if surfaces.len() * lights > MAX_TESTS {
            surfaces = vec![surfaces.into_iter().fold(Aabb::EMPTY, Aabb::union)];
        }
        Self { eye: camera.eye, planes: frustum.planes().to_vec(), surfaces }
    }

    fn misses(&self, reach: &Reach) -> Option<DropReason> {
        let outside = |plane: &DVec4| plane.truncate().dot(reach.center) + plane.w < -reach.radius_m;
        // The near plane is tested first, since a light behind the camera is often outside other planes too.
        let which = [4, 5, 0, 1, 2, 3].into_iter().find(|which| self.planes.get(*which).is_some_and(outside));
        match which {
            Some(4) => Some(DropReason::Behind),
            Some(5) => Some(DropReason::Beyond),
            Some(_) => Some(DropReason::Beside),
            None => self.surfaces.iter().all(|bounds| reach.misses(bounds, self.eye)).then_some(DropReason::NoSurface),
        }
    }
}
