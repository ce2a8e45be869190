//! Visible instances of a frame's cameras, and their combined properties.

use super::scene_summary::{SceneSummary, even_scale};
use crate::gpu_scene::shadow_views::FitCamera;
use crate::gpu_scene::view::ViewSettings;
use framegraph_scene::{Aabb, DrawLists, Lobes, Renderables, Scene};
use glam::{DMat3, DVec3};
use std::borrow::Cow;

/// Maximum number of opaque and masked instances that are compared pairwise; with more, some count as neighbors.
const MAX_NEIGHBOURS: usize = 64;

/// Everything that any of the cameras may see.
pub(super) struct Visibility<'a> {
    pub scene: &'a Scene,
    pub survey: &'a SceneSummary,
    pub renderables: Renderables,
    views: &'a [ViewSettings],
    pub lists: Vec<DrawLists>,
    /// Indices of instances that some camera may see, in order.
    pub instances: Vec<usize>,
}

impl<'a> Visibility<'a> {
    pub fn new(scene: &'a Scene, survey: &'a SceneSummary, views: &'a [ViewSettings]) -> Self {
        let aspect = |view: &ViewSettings| fit_camera(view).width_over_height;
        // Instances that no view shows are ignored.
        let layers = views.iter().fold(0, |all, view| all | view.visible_layers);
        let all = Renderables::new(scene);
        let shown = match all.shown(layers) {
            Cow::Owned(shown) => Some(shown),
            Cow::Borrowed(_) => None,
        };
        let renderables = shown.unwrap_or(all);
        let seen_by =
            |v: &ViewSettings| DrawLists::seen(&renderables.shown(v.visible_layers), &v.camera, aspect(v), None);
        let lists: Vec<DrawLists> = views.iter().map(seen_by).collect();
        let all = lists.iter().flat_map(|l| [&l.opaque, &l.mask, &l.transmit, &l.blend]).flatten();
        let mut instances: Vec<usize> = all.map(|number| *number as usize).collect();
        instances.sort_unstable();
        instances.dedup();
        Self { scene, survey, renderables, views, lists, instances }
    }

    /// Returns the combined properties of all lit visible instances.
    pub fn surfaces(&self) -> Surfaces {
        let mut all = Surfaces::default();
        for instance in self.instances.iter().map(|i| &self.scene.instances[*i]) {
            let (surface, shape) = (self.survey.surface(instance), self.survey.shape(instance));
            all.may_exceed_one |= shape.colored || surface.emits;
            if surface.unlit {
                continue;
            }
            all.lit += 1;
            all.most_f0 = all.most_f0.max(surface.most_f0);
            all.least_roughness = all.least_roughness.min(surface.least_roughness);
            all.occlusion_maps += usize::from(surface.occlusion_map);
            all.lobes = all.lobes.union(surface.lobes);
        }
        all
    }

    /// Returns the maximum, over all views, of the number of instances that `list` returns.
    pub fn most(&self, list: impl Fn(&DrawLists) -> usize) -> usize {
        self.lists.iter().map(list).max().unwrap_or(0)
    }

    /// Returns the number of instances of `list` with a refractive material.
    pub fn transmissive(&self, list: &[u32]) -> usize {
        let transmits = |i: &&u32| self.survey.surface(&self.scene.instances[**i as usize]).transmits();
        list.iter().filter(transmits).count()
    }

    /// Returns true if a lit surface may turn a normal toward `light`, a unit vector, or let its light through.
    pub fn may_face(&self, light: DVec3) -> bool {
        self.instances.iter().map(|i| &self.scene.instances[*i]).any(|instance| {
            let surface = self.survey.surface(instance);
            let any = surface.mapped_normals || surface.double_sided || surface.is_translucent();
            !surface.unlit && (any || self.faces(instance, light))
        })
    }

    fn faces(&self, instance: &framegraph_scene::Instance, light: DVec3) -> bool {
        let Some((axis, cosine)) = self.survey.shape(instance).facing else { return true };
        let linear = DMat3::from_mat4(instance.world_from_model);
        let flat = cosine > 1.0 - 1e-6;
        if linear.determinant() == 0.0 || !(flat || even_scale(instance).is_some()) {
            return true;
        }
        let Some(axis) = (linear.inverse().transpose() * axis).try_normalize() else { return true };
        // Normals are within an angle about the axis: the nearest of them to the light, with room for rounding.
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let across = (1.0 - axis.dot(light).powi(2)).max(0.0).sqrt();
        axis.dot(light) * cosine + across * sine > -1e-4
    }

    /// Returns an upper bound of the squared angle in radians by which normals turn within a pixel, at least 15° from
    /// grazing. Infinite if unknown.
    pub fn turn2(&self, variance: f32) -> f64 {
        let mut most = 0.0_f64;
        for instance in self.instances.iter().map(|i| &self.scene.instances[*i]) {
            let (surface, shape) = (self.survey.surface(instance), self.survey.shape(instance));
            if surface.unlit || shape.turn_per_m == 0.0 {
                continue;
            }
            let Some(scale) = even_scale(instance) else { return f64::INFINITY };
            let pixel_m = self.views.iter().map(|view| pixel_m(view, &instance.bounds)).fold(0.0, f64::max);
            // At 15°, a pixel covers four times its width on the surface.
            let turn = 4.0 * pixel_m * shape.turn_per_m / scale;
            most = most.max(2.0 * f64::from(variance) * turn * turn);
        }
        most
    }

    /// Returns the number of depth-writing instances if all are convex and farther than `reach_m` from each other;
    /// `None` otherwise.
    pub fn loners(&self, reach_m: f64) -> Option<usize> {
        let solid = |i: usize| {
            let surface = self.survey.surface(&self.scene.instances[i]);
            !surface.transmits()
        };
        let mut seen: Vec<usize> =
            self.lists.iter().flat_map(|l| l.opaque.iter().chain(&l.mask)).map(|i| *i as usize).collect();
        seen.sort_unstable();
        seen.dedup();
        let all: Vec<usize> = (0..self.scene.instances.len()).filter(|i| solid(*i)).collect();
        if all.len() > MAX_NEIGHBOURS {
            return None;
        }
        let bounds = |i: usize| &self.scene.instances[i].bounds;
        let alone = |i: &usize| {
            let instance = &self.scene.instances[*i];
            self.survey.shape(instance).convex
                && all.iter().all(|other| other == i || apart_m(bounds(*i), bounds(*other)) > reach_m)
        };
        seen.iter().all(alone).then_some(seen.len())
    }
}

/// Combined properties of visible surfaces. Without lit surfaces, nothing reflects and everything is rough.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surfaces {
    /// Instances that light falls on.
    pub lit: usize,
    pub most_f0: f32,
    pub least_roughness: f32,
    /// Instances with a texture of ambient occlusion.
    pub occlusion_maps: usize,
    pub lobes: Lobes,
    /// Some vertices have colors, or some surface emits light: the light of what is unlit may be above 1.
    pub may_exceed_one: bool,
}

impl Default for Surfaces {
    fn default() -> Self {
        Self {
            lit: 0,
            most_f0: 0.0,
            least_roughness: f32::INFINITY,
            occlusion_maps: 0,
            lobes: Lobes::NONE,
            may_exceed_one: false,
        }
    }
}

/// The camera of a view as fits and frusta take it.
pub(super) fn fit_camera(view: &ViewSettings) -> FitCamera<'_> {
    let [width, height] = view.size_px;
    FitCamera { camera: &view.camera, width_over_height: f64::from(width.max(1)) / f64::from(height.max(1)) }
}

/// Height of a pixel in meters on what stands nearest to the eye of a box.
fn pixel_m(view: &ViewSettings, bounds: &Aabb) -> f64 {
    let camera = fit_camera(view);
    let [_, half_height] = camera.half_extent();
    let nearest = camera.camera.eye.clamp(bounds.min.min(bounds.max), bounds.max.max(bounds.min));
    let away_m = if camera.is_perspective() { (nearest - camera.camera.eye).length() } else { 1.0 };
    // Toward the corners of a picture a pixel is as wide, though farther away along the view direction.
    2.0 * half_height * away_m.max(camera.range_m().0) / f64::from(view.size_px[1].max(1))
}

/// Distance between boxes.
fn apart_m(a: &Aabb, b: &Aabb) -> f64 {
    (a.min - b.max).max(b.min - a.max).max(DVec3::ZERO).length()
}
