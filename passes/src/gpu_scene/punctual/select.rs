//! Which lights of a scene are shaded with, and why the others are not.

use super::reach::Reach;
use crate::gpu_scene::shadow_views::FitCamera;
use crate::gpu_scene::upload::pack::light_uniforms;
use framegraph_scene::{Aabb, Frustum, Light, Renderables, Scene};
use framegraph_shaders::layout::LightError;
use glam::{DVec3, DVec4};

/// More tests of a light against a box than this are not made: what is seen is then one box.
const MAX_TESTS: usize = 1 << 20;

/// Why a light cannot add anything to a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DropReason {
    /// Its intensity or its color is zero.
    Off,
    /// It breaks a promise of the scene's lights.
    Unusable(LightError),
    /// It reaches nothing beyond the camera's near plane.
    Behind,
    /// It reaches nothing before the camera's far plane.
    Beyond,
    /// It reaches nothing within the picture's borders.
    Beside,
    /// It reaches none of the surfaces that may be seen.
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

/// The lights of a scene for cameras that share them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Selection<'a> {
    /// Those that may add something, those without an end first, else in the scene's order.
    pub kept: Vec<&'a Light>,
    /// How many of them have no end.
    pub everywhere: usize,
    /// Numbers of the others among the scene's lights. The sun is in neither.
    pub dropped: Vec<(usize, DropReason)>,
}

impl Selection<'_> {
    /// Returns true if some light and some instance may share no light channel.
    pub fn differs_in_channels(&self, instances: &Renderables) -> bool {
        let common = self.kept.iter().fold(instances.common_light_channels(), |common, light| common & light.channels);
        common == 0 && !self.kept.is_empty()
    }
}

/// Sorts the lights of a scene but the sun. A light is kept if any of the cameras may see what it lights.
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

/// Whether a light that is kept has an end; or why it is dropped.
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

/// What one camera may see.
struct Seen {
    eye: DVec3,
    /// Left, right, bottom, top, near, and far if there is one; world axes, about the eye.
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
        // Behind comes first: a light behind the camera is often beside it too.
        let which = [4, 5, 0, 1, 2, 3].into_iter().find(|which| self.planes.get(*which).is_some_and(outside));
        match which {
            Some(4) => Some(DropReason::Behind),
            Some(5) => Some(DropReason::Beyond),
            Some(_) => Some(DropReason::Beside),
            None => self.surfaces.iter().all(|bounds| reach.misses(bounds, self.eye)).then_some(DropReason::NoSurface),
        }
    }
}
