//! Input of the rules.

use super::effect::EffectSet;
use super::fact::Proof;
use super::memory::FactMemory;
use super::scene_summary::SceneSummary;
use super::visibility::{Surfaces, Visibility, fit_camera};
use crate::effects::exposure::Measurement;
use crate::frame::Settings;
use crate::gpu_scene::punctual::{DropReason, select};
use crate::gpu_scene::shadow_views::ShadowNeed;
use crate::gpu_scene::view::{Background, ViewSettings};
use crate::light::ibl::{IRRADIANCE_COEFFICIENTS, ImageLight};
use crate::light::sun::sun_of;
use framegraph_scene::environment::ShBands;
use framegraph_scene::{Light, Scene};
use glam::Vec4;

/// Summary of an environment, as far as rules need it.
#[derive(Clone, Copy, Debug)]
pub struct EnvironmentSummary<'a> {
    /// [`ImageLight::irradiance`].
    pub irradiance: &'a [Vec4; IRRADIANCE_COEFFICIENTS],
    /// [`ImageLight::bands`].
    pub bands: ShBands,
    /// [`ImageLight::luminance_nits`].
    pub luminance_nits: f32,
    /// [`ImageLight::sun`].
    pub sun: Option<&'a Light>,
}

impl<'a> From<&'a ImageLight> for EnvironmentSummary<'a> {
    fn from(light: &'a ImageLight) -> Self {
        let ImageLight { irradiance, bands, luminance_nits, sun, .. } = light;
        Self { irradiance, bands: *bands, luminance_nits: *luminance_nits, sun: sun.as_ref() }
    }
}

/// Input of [`decide`](super::decide).
#[derive(Clone, Copy, Debug)]
pub struct FactInput<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Summary of the surfaces of the same scene.
    pub survey: &'a SceneSummary,
    /// The environment.
    pub around: EnvironmentSummary<'a>,
    /// The background.
    pub background: &'a Background,
    /// Cameras with sizes and exposures, of one view or of all views that share the settings. Their shadow settings
    /// are ignored; those of `settings` apply.
    pub views: &'a [ViewSettings],
    /// Requested settings.
    pub settings: &'a Settings,
    /// Measurements of earlier frames; [`Measurement::Off`] if frames are not measured.
    pub measured: Measurement,
    /// Effects that are always kept.
    pub forced: EffectSet,
    /// Greatest allowed change of a pixel by one drop, in 8-bit steps.
    pub max_steps: f32,
}

impl FactInput<'_> {
    /// Default limit on the change of a pixel by one drop, in 8-bit steps.
    pub const MAX_CODES: f32 = 2.0;
}

/// Input of one rule.
pub(super) struct RuleInput<'a> {
    pub(super) input: &'a FactInput<'a>,
    pub(super) settings: &'a Settings,
    pub(super) memory: &'a FactMemory,
    pub(super) seen: Visibility<'a>,
    pub(super) surfaces: Surfaces,
    /// The sun, if it is on and a visible surface may face it.
    pub(super) sun: Option<&'a Light>,
    /// The sun, if it is on.
    pub(super) risen: Option<&'a Light>,
    pub(super) need: ShadowNeed,
    /// Number of punctual lights that contribute, and the reasons why others do not.
    pub(super) lights: (usize, Vec<(usize, DropReason)>),
}

impl<'a> RuleInput<'a> {
    pub(super) fn new(input: &'a FactInput<'a>, memory: &'a FactMemory) -> Self {
        let FactInput { scene, survey, views, settings, .. } = *input;
        let seen = Visibility::new(scene, survey, views);
        let risen = sun_of(scene, input.around.sun);
        let sun = risen.filter(|sun| seen.may_face(-sun.direction.as_dvec3()));
        let cameras: Vec<_> = views.iter().map(fit_camera).collect();
        let selection = select(scene, &seen.renderables, risen, &cameras);
        let need = match &settings.shadows {
            Some(shadows) => ShadowNeed::of(&seen.renderables, sun, &selection.kept, &cameras, shadows),
            None => ShadowNeed::default(),
        };
        let lights = (selection.kept.len(), selection.dropped);
        Self { input, settings, memory, surfaces: seen.surfaces(), seen, sun, risen, need, lights }
    }

    /// Returns everything that the frame leaves out structurally.
    pub(super) fn always(&self) -> Vec<(Proof, String)> {
        let mut told = Vec::new();
        let (kept, dropped) = &self.lights;
        if !dropped.is_empty() {
            let mut reasons: Vec<(String, usize)> = Vec::new();
            for reason in dropped.iter().map(|(_, reason)| reason.to_string()) {
                match reasons.iter_mut().find(|(known, _)| *known == reason) {
                    Some((_, count)) => *count += 1,
                    None => reasons.push((reason, 1)),
                }
            }
            let reasons: Vec<_> = reasons.into_iter().map(|(reason, count)| format!("{count} {reason}")).collect();
            let all = kept + dropped.len();
            told.push((
                Proof::Exact,
                format!("{} of {all} lights are not looked at: {}", dropped.len(), reasons.join(", ")),
            ));
        }
        let (scene, seen) = (self.seen.scene.lobes(), self.surfaces.lobes);
        let unused: Vec<_> =
            framegraph_scene::Lobe::ALL.iter().filter(|l| scene.contains(**l) && !seen.contains(**l)).collect();
        if !unused.is_empty() {
            told.push((Proof::Variant, format!("no shader of the lobes {unused:?}: nothing in view has them")));
        }
        let dark = self.input.survey.surfaces.iter().filter(|surface| surface.dark_emission).count();
        if dark > 0 {
            told.push((Proof::Exact, format!("{dark} textures of emission are not fetched: their factor is 0")));
        }
        told
    }

    /// Returns whether there is no image-based light.
    pub(super) fn is_dark(&self) -> bool {
        let EnvironmentSummary { irradiance, luminance_nits, .. } = self.input.around;
        let none = luminance_nits == 0.0 && irradiance.iter().all(|c| *c == Vec4::ZERO);
        none || self.input.views.iter().all(|view| view.environment_intensity == 0.0)
    }
}
